"""The gain of the special solver for smooth thin layers over Newton's method: `python tools/bench/benchmark_smooth.py`.

It prints shortest processor times by turns, of a batch and of cases solved one by one.
"""

import numpy as np
from benchmark_cases import X, by_turns, problem

from solver import Problem, solve, ways

#: All ways to solve cases, and those without the special one for smooth punches on springs.
ALL = ways.WAYS
WITHOUT = tuple(way for way in ALL if way.name != "springs")


def run(table: tuple[ways.Way, ...], problems: list[Problem]) -> None:
    ways.WAYS = table
    for cases in problems:
        solve(cases, X)


def main() -> None:
    assert len(WITHOUT) == len(ALL) - 1
    many = problem("smooth", "thin_layer", 1e-6)
    alone = [many.take(np.array([i])) for i in range(40)]
    for what, problems in (("a batch of 16,000", [many]), ("40 cases, one by one", alone)):
        special, newtons = by_turns(lambda p=problems: run(ALL, p), lambda p=problems: run(WITHOUT, p))
        times = f"{1000 * special:.0f} ms, by Newton's method {1000 * newtons:.0f} ms"
        print(f"{what}: {times}, {newtons / special:.1f} times")


if __name__ == "__main__":
    main()
