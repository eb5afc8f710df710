"""The time before anything is computed: processor time of new Pythons, over that of `import xarray`.

python tools/start/benchmark_start.py [ROUNDS]

The calls take turns, so that the load of the machine is the same for all. The median of the rounds counts, of user and
system time with that of child processes. Compiled modules are stored, and a first round does not count.
"""

import os
import statistics
import subprocess
import sys

SOLVE = "import study; study.solve({})"
UNITS = ("R=5 mm", "E2=210 GPa", "P=10 N", "micro=smooth")
NAMED = ("R=5 mm", "punch=alumina", "layer=TiN", "body=steel 52100", "h=3 um", "P=10 N", "micro=smooth")
CALLS = {
    "import xarray": ("-c", "import xarray"),
    "point, smooth on a half-space": ("-m", "study", "point", "P=1e-5", "micro=smooth", "base=half_space"),
    "the same with units, with strengths": ("-m", "study", "point", *UNITS, "base=half_space"),
    "point, smooth on a layer": ("-m", "study", "point", "P=1e-5", "h=0.1", "n=2", "bonding=bonded", "micro=smooth"),
    "the same with units, with strengths ": ("-m", "study", "point", *UNITS, "h=2 um", "E1=200 GPa", "bonding=bonded"),
    "the same of named materials": ("-m", "study", "point", *NAMED, "bonding=bonded"),
    "study.solve, smooth on a half-space": ("-c", SOLVE.format("P=1e-5, micro='smooth', base='half_space'")),
    "study.solve, rough on a layer": ("-c", SOLVE.format("P=1e-5, h=0.1, n=2.0, Nbar=1e4, Ra=1e-3")),
}


def seconds(arguments: tuple[str, ...]) -> float:
    """Processor time of a Python and its children."""
    before = os.times()
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    command = [sys.executable, *arguments]
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def starts(rounds: int) -> list[tuple[str, float, float]]:
    """(name, seconds, ratio) of each call."""
    for arguments in CALLS.values():
        seconds(arguments)
    times = [[seconds(arguments) for arguments in CALLS.values()] for _ in range(rounds)]
    medians = [statistics.median(column) for column in zip(*times, strict=True)]
    return [(name, median, median / medians[0]) for name, median in zip(CALLS, medians, strict=True)]


if __name__ == "__main__":
    print("| a new Python | processor seconds | over import xarray |\n| --- | ---: | ---: |")
    for what, median, ratio in starts(int(sys.argv[1]) if len(sys.argv) > 1 else 7):
        print(f"| {what.strip()} | {median:.3f} | {ratio:.2f} |")
