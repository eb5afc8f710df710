"""The time of extremes and first yield: `python tools/fields/benchmark_extremes.py [CHECKOUT | --json]`.

It prints processor times of one process: the first call, and the shortest of the next ones. With another checkout of
this repository the two take turns, and it prints ratios as well, without stacks if that
checkout has no extremes of them. With --json it prints the rows of docs/speed.md.
"""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
ROUNDS = 3
#: The program of a process whose path begins with a checkout; it prints lines of a name and two times.
PROGRAM = """
import sys, time, warnings
sys.path.insert(0, sys.argv[1])
warnings.simplefilter("ignore")
import numpy as np
from solver import Problem, solve
from solver.yields.contact import of_contacts
from solver.yields.first import first_yield
try:
    from solver.yields.stacked.largest import of_contacts as of_stacks
except ImportError:  # a checkout of before there were any
    of_stacks = None

E1, E2 = 450e9 / (1 - 0.25**2), 210e9 / (1 - 0.3**2)  # TiN on steel, 3 um below a ball of alumina of 5 mm
film = {"h": 6e-4, "n": E1 / E2, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded", "micro": "smooth", "m": 0.6}

def told(name, action):
    times = []
    for _ in range(3):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    print(name, times[0], min(times[1:]), flush=True)

def extremes(**contact):
    problem = Problem.of(**contact)
    solution = solve(problem)
    return lambda: of_contacts(problem, solution)

told("50_smooth_films", extremes(P=np.geomspace(0.1, 100, 50) / (E2 * 25e-6), **film))
for thin in (0.02, 0.005):
    told(f"film_h/a={thin}", extremes(a=6e-4 / thin, **film))
random = np.random.default_rng(1)
a, n = 0.03, np.exp(random.uniform(np.log(0.05), np.log(20), 100))
rough = {"Nbar": 2.5e7, "Ra": 0.004, "bonding": "bonded", "nu1": 0.25}
told("100_rough_layers", extremes(a=a, h=a * np.exp(random.uniform(np.log(0.05), np.log(3), 100)), n=n, **rough))
stack = [{"h": 4e-4, "n": 200 / 230, "nu": 0.25}, {"h": 2e-4, "n": 290 / 230, "nu": 0.21}]  # DLC on chromium
on_stack = {"layers": [layer | {"bonding": "bonded"} for layer in stack], "nu2": 0.3, "micro": "smooth"}
problem = Problem.of(P=np.geomspace(1e-7, 1e-5, 5), **on_stack)
if of_stacks:
    told("5_on_two_layers", lambda solution=solve(problem): of_stacks(problem, solution))

def loads(body, strength, **other):
    problem = Problem.of(P=1e-6, **film | other)
    return lambda: first_yield(problem, body, np.broadcast_to(strength / E2, len(problem)))

for body, strength in (("layer", 5e9), ("body", 2e9)):
    told(f"first_yield_{body}", loads(body, strength))
spots = {"micro": "disc_cell", "Nbar": 2.5e7, "Ra": 0.004}
told("first_yield_rough_layer", loads("layer", 5e9, **spots))
thicknesses = np.exp(random.uniform(np.log(1e-3), np.log(0.05), 200))
told("first_yield_200_of_one_pair", loads("body", random.uniform(5e8, 5e9, 200), h=thicknesses))
"""


#: Name in the program -> what it computes, in the words of docs/speed.md.
WORDS = {
    "50_smooth_films": "extremes of 50 smooth contacts on 3 µm of TiN, h/a = 0.02 to 0.25",
    "film_h/a=0.02": "extremes of one, h/a = 0.02",
    "film_h/a=0.005": "extremes of one, h/a = 0.005",
    "100_rough_layers": "extremes of 100 rough contacts on random layers",
    "5_on_two_layers": "extremes of 5 smooth contacts on DLC on Cr on steel",
    "first_yield_layer": "first yield of TiN at 5 GPa",
    "first_yield_body": "first yield of steel below TiN at 2 GPa",
    "first_yield_rough_layer": "first yield of TiN below a rough punch",
    "first_yield_200_of_one_pair": "first yield of steel below 200 thicknesses of TiN",
}


def times_of(checkout: Path) -> dict[str, list[float]]:
    """Name -> the first and the shortest further time."""
    output = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(checkout)], cwd=checkout, check=True, capture_output=True, text=True
    ).stdout
    return {name: [float(first), float(later)] for name, first, later in map(str.split, output.splitlines())}


def rows() -> list[dict]:
    """A row for each name, as docs/speed.md has it."""
    times = times_of(ROOT)
    return [
        {"computed": words, "first_call_s": times[name][0], "later_s": times[name][1]} for name, words in WORDS.items()
    ]


def main() -> None:
    if sys.argv[1:] == ["--json"]:
        print(json.dumps(rows()))
        return
    checkouts = [ROOT, *(Path(path).resolve() for path in sys.argv[1:])]
    rounds = [[times_of(checkout) for checkout in checkouts] for _ in range(ROUNDS if len(checkouts) > 1 else 1)]
    for name in [name for name in rounds[0][0] if all(name in times for times in rounds[0])]:
        least = [[min(turn[i][name][j] for turn in rounds) for j in (0, 1)] for i in range(len(checkouts))]
        words = ", ".join(f"first {first:.3f} s, then {later:.3f} s" for first, later in least)
        ratios = [f"{b / a:.1f}" for a, b in zip(*least, strict=True)] if len(least) > 1 else []
        print(f"{name}: {words}" + (f"; ratios {', '.join(ratios)}" if ratios else ""), flush=True)


if __name__ == "__main__":
    main()
