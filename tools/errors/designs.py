"""Does `study.design` find every solution? `python tools/errors/designs.py [TARGETS [SEED]]`, some minutes.

The search of `study.design` varies one input of random layered contacts, smooth and rough, until a result has a wanted
value, TARGETS times in all (10,000). In four tenths of them the input is the thickness of a layer that slides, over
which p(0) and p_max turn most. The wanted value lies between the smallest and the largest of 400 points over the
bounds, or up to a tenth of the range of its logarithm outside them. It prints for each input:

- targets, and the numbers of those with no, one, several solutions;
- differ: targets whose number of solutions is not that of the crossings of the 400 points;
- worst: the largest relative distance of the result, solved again, from the wanted value, over rtol;

and the processor time of a design of docs/design.md.
"""

import sys
import time

import numpy as np

import study
from solver import Problem, solve
from study.inverse.design_curves import crossings, scanned

POINTS, RTOL, EACH = 400, 1e-6, 20
TARGETS = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD")
LAWS = ("smooth", "disc_cell", "hex_lattice", "normal_heights")
#: Input that is varied -> its bounds.
BY = {"h": (1e-4, 1.0), "n": (1e-3, 1e2), "P": (1e-8, 1e-3), "D": (1e-6, 1e-2), "a": (1e-3, 0.1), "Nbar": (1e3, 1e7),
      "Ra": (1e-4, 1e-1), "nu1": (0.0, 0.49), "m": (1e-3, 10.0)}  # fmt: skip


def contacts(size: int, random: np.random.Generator) -> dict[str, np.ndarray]:
    """Inputs of random contacts, without a control."""

    def between(low: float, high: float) -> np.ndarray:
        return np.exp(random.uniform(np.log(low), np.log(high), size))

    Ra = between(1e-4, 1e-1)
    return {
        "h": between(1e-3, 0.3),
        "n": between(1e-3, 1e2),
        "m": random.choice([0.0, 0.5], size),
        "nu1": random.uniform(0.1, 0.49, size),
        "nu2": random.uniform(0.1, 0.4, size),
        "bonding": random.choice(["bonded", "frictionless"], size),
        "Ra": Ra,
        "Nbar": between(0.1, 10) / Ra**2,
        "sigma": between(1e-6, 1e-4),
        "micro": random.choice(LAWS, size),
    }


def tried(name: str, target: str, size: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """For EACH targets of each of `size` contacts: number of solutions, that of the 400 points, worst miss over
    rtol."""
    control = name if name in ("P", "a", "D") else "P"
    inputs = contacts(size, random) | {control: np.exp(random.uniform(np.log(1e-7), np.log(1e-4), size))}
    inputs["bonding"][:] = "frictionless" if name == "h" else inputs["bonding"]
    rough = [law for law in LAWS if law != "smooth"]
    inputs["micro"] = random.choice(rough, size) if name in ("Nbar", "Ra") or target == "Ar_An" else inputs["micro"]
    low, high = np.log(BY[name]) if BY[name][0] else BY[name]
    rows = np.arange(size)

    def results(t: np.ndarray, row: np.ndarray) -> np.ndarray:
        moved = {key: column[row] for key, column in inputs.items()}
        solution = solve(Problem.of(**moved | {name: np.exp(t) if BY[name][0] else t}, rtol=RTOL))
        return np.where(solution.status == 0, getattr(solution, target), np.nan)

    fine = np.linspace(low, high, POINTS)
    y = results(np.tile(fine, size), np.repeat(rows, POINTS)).reshape(size, POINTS)
    finite = np.isfinite(y).any(axis=1)
    least, most = (np.log(np.where(finite, extreme(y, axis=1), 1.0)) for extreme in (np.nanmin, np.nanmax))
    at = random.uniform(-0.1, 1.1, (EACH, size))
    level, row = np.exp(least + at * (most - least)).ravel(), np.tile(rows, EACH)
    t = crossings(results, scanned(results, rows, low, high).at(row), row, level, RTOL)
    place, number = np.nonzero(np.isfinite(t))
    misses, results_again = np.zeros(len(row)), results(t[place, number], row[place])
    np.maximum.at(misses, place, np.abs(results_again / level[place] - 1) / RTOL)
    above = np.where(np.isfinite(y[row]), y[row] > level[:, None], np.nan)
    counts = np.isfinite(t).sum(axis=1), (np.abs(np.diff(above, axis=1)) == 1).sum(axis=1)
    flat = finite & (most - least > 1e-4)  # the result does not depend on the input
    return tuple(array[flat[row]] for array in (*counts, misses))


def main(total: int = 10_000, seed: int = 1) -> None:
    random, start, all_parts = np.random.default_rng(seed), time.process_time(), []
    size = -(-total // (EACH * 64))  # 64 instead of 66, since flat curves do not count
    for name in BY:
        control = name if name in ("P", "a", "D") else "P"
        parts = [
            tried(name, target, size * (4 if name == "h" else 1), random) for target in TARGETS if target != control
        ]
        all_parts.append([np.concatenate(part) for part in zip(*parts, strict=True)])
        print(line(name, *all_parts[-1]), flush=True)
    print(line("all", *(np.concatenate(part) for part in zip(*all_parts, strict=True))))
    print(f"{time.process_time() - start:.0f} s of processor time, rtol {RTOL:g}")
    speed()


def speed() -> None:
    """Print the processor time of a design of docs/design.md, of many loads at once and alone."""
    bodies = {"R": "5 mm", "bonding": "bonded", "Nbar": "1e5 1/mm^2", "Ra": "2 um"}
    kinds = {
        "without spreads": bodies | {"E1": "490 MPa", "nu1": 0.46, "E2": "207 GPa"},
        "with spreads": bodies | dict.fromkeys(("punch", "body"), "steel 52100") | {"layer": "PTFE"},
    }
    for words, scene in kinds.items():
        for count in (300, 1):
            loads = [f"{load!r} N" for load in np.linspace(0.5, 4, count).tolist()]
            start = time.process_time()
            study.design({"p_max": "180 MPa"}, by={"h": ("1 um", "1 mm")}, P=loads, **scene)
            each = (time.process_time() - start) / count
            print(f"{count:3d} at once, {words}: {1e3 * each:.0f} ms each")


def line(name: str, counts: np.ndarray, fine: np.ndarray, misses: np.ndarray) -> str:
    numbers = [(counts == 0).sum(), (counts == 1).sum(), (counts > 1).sum()]
    differ = (counts != fine).sum()
    share = 100 * differ / max(1, len(counts))
    return (
        f"{name:5s}{len(counts):6d} targets: {numbers[0]:5d} none, {numbers[1]:5d} one, {numbers[2]:4d} several; "
        f"{differ:3d} differ ({share:.3f} %); worst {misses.max(initial=0):.2f} rtol"
    )


if __name__ == "__main__":
    np.seterr(all="ignore")
    main(*map(int, sys.argv[1:]))
