"""The time of smooth contacts of all shapes, also with adhesion: `python tools/fields/benchmark_shapes.py`.

It prints shortest processor times of warm batches on a layer that take turns: in all, per case, and over that of
spheres under a depth.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1] / "bench"))
from benchmark_cases import by_turns  # noqa: E402

from solver import Problem, solve

CASES = 1000
LAYER = {"n": 0.3, "nu1": 0.4, "bonding": "bonded", "micro": "smooth"}
TWO = [{"h": 0.1, "n": 0.3, "nu": 0.4}, {"h": 0.1, "n": 3.0, "nu": 0.3}]
THREE = [*TWO, {"h": 0.2, "n": 1.5, "nu": 0.3}]


def problems() -> dict[str, Problem]:
    h, D = np.geomspace(0.05, 0.2, CASES), np.geomspace(0.005, 0.05, CASES)
    few, cone = slice(None, None, 10), {"shape": "cone", "half_angle": 60.0}
    stacks = {f"{len(s)} layers": Problem.of(D=D[few], layers=s, shape="sphere", micro="smooth") for s in (TWO, THREE)}
    return {
        "spheres": Problem.of(D=D, h=h, shape="sphere", **LAYER),
        "cones": Problem.of(D=D, h=h, **cone, **LAYER),
        "pull-off, JKR": Problem.of(P=0.0, h=h[few], w_adhesion=1e-4, **LAYER),
    } | stacks


def main() -> None:
    batches = problems()
    times = by_turns(*(lambda p=problem: solve(p) for problem in batches.values()))
    each = times / [len(problem) for problem in batches.values()]
    for (name, problem), whole, alone in zip(batches.items(), times, each, strict=True):
        print(
            f"{len(problem)} {name}: {1e3 * whole:.0f} ms, {1e6 * alone:.0f} us a case, "
            f"{alone / each[0]:.2f} times a sphere"
        )
    print(f"three layers over two: {each[-1] / each[-2]:.2f}")


if __name__ == "__main__":
    main()
