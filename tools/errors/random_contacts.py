"""How often `error` is below the truth: `python tools/errors/random_contacts.py [SIZE [SEED]]`, a minute.

SIZE random rough contacts (20 by default) of each law on each base are solved at a given load and rtol 1e-9, which is
the truth. The same contacts are solved again from their load, their radius and their depth, at the five RTOL each. It
prints a line for each law on each base, and one for all:

- answers: those whose `error` is more than ten times that of the truth;
- above: the number of these that are farther from the truth than `error`; and the largest distance in units of `error`;
- median: of the distance, in the same units.
"""

import sys

import numpy as np

from solver import Problem, Status, solve
from solver.solution import JUDGED

BASES = ("half_space", "thin_layer", "layered")
LAWS = ("disc_cell", "power_law", "square_lattice", "hex_lattice", "normal_heights", "uniform_heights")
RTOL = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
#: Ranges far wider than those of real contacts, drawn by the logarithm; NR is Nbar Ra².
RANGES = {"P": (1e-8, 1e-2), "h": (1e-3, 1e1), "n": (1e-3, 1e2), "Ra": (1e-5, 1e-1), "NR": (1e-2, 1e2),
          "B": (0.01, 1.0), "sigma": (1e-8, 1e-3)}  # fmt: skip
#: Answers with numbers and an `error`.
ENDED = (Status.CONVERGED, Status.TOLERANCE_NOT_MET)


def sample(size: int, seed: list[int]) -> dict:
    """Arguments of ``Problem.of`` without base and law: `size` contacts."""
    random = np.random.default_rng(seed)
    case = {name: np.exp(random.uniform(*np.log(limits), size)) for name, limits in RANGES.items()}
    return case | {
        "Nbar": case.pop("NR") / case["Ra"] ** 2,
        "beta": random.uniform(0.02, 1.0, size),
        "bonding": random.choice(["frictionless", "bonded"], size),
        "nu1": random.uniform(-0.5, 0.5, size),
        "nu2": random.uniform(-0.5, 0.5, size),
    }


def distances(law: str, base: str, size: int, seed: int) -> np.ndarray:
    """Distances to the truth over `error`, of all answers."""
    case = sample(size, [seed, BASES.index(base), LAWS.index(law)]) | {"base": base, "micro": law}
    truth = solve(Problem.of(**case, rtol=1e-9))
    ratios = []
    for control in ("P", "a", "D"):
        for rtol in RTOL:
            answer = solve(Problem.of(**case | {"P": None, control: getattr(truth, control), "rtol": rtol}))
            far = np.max([np.abs(getattr(answer, name) / getattr(truth, name) - 1) for name in JUDGED], axis=0)
            is_judged = (
                np.isin(answer.status, ENDED) & np.isin(truth.status, ENDED) & (truth.error < 0.1 * answer.error)
            )
            ratios.append((far / answer.error)[is_judged])
    return np.concatenate(ratios)


def line(name: str, ratios: np.ndarray) -> str:
    above, most = (ratios > 1).sum(), ratios.max(initial=0)
    return f"{name:28s} {len(ratios):6d} answers, {above:2d} above, at most {most:.2f}, median {np.median(ratios):.2f}"


def main(size: int = 20, seed: int = 1) -> None:
    np.seterr(all="ignore")
    ratios = {f"{law} {base}": distances(law, base, size, seed) for law in LAWS for base in BASES}
    for name, ratio in [*ratios.items(), ("all", np.concatenate([*ratios.values()]))]:
        print(line(name, ratio))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
