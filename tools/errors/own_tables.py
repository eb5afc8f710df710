"""The reliability of `model_error` for user's tables: `python tools/errors/own_tables.py [SIZE [SEED]]`, a minute.

SIZE random tables (100 by default) are made from the laws of this package: half of them with 5 to 60 rows at random
places, the others with 60 in equal steps of log p. Contacts with each are compared with those of the law itself, on a
half-space and on the exact layer, from 1.5 times the first pressure on. It prints three lines:

- tables: the number that are not refused, and of those with an error between their rows above `error`;
- contacts: their number, the number with an error above `model_error`, and the largest ratio of the two;
- edge: the largest excess over the error of the rows, over (p1/p(0))^_STEEPNESS, which gives _GUESSED in
  solver/models/law_error.py.
"""

import sys

import numpy as np

from solver import Problem, Status, laws, solve
from solver.laws import own_table
from solver.models.law_error import _STEEPNESS
from solver.solution import JUDGED

LAWS = ("disc_cell", "power_law", "square_lattice", "hex_lattice", "normal_heights", "uniform_heights")


def table(random: np.random.Generator, even: bool):
    """The name of a random law, its parameters, and the :class:`~solver.laws.Law` of a random table of it. Raises
    ValueError for a table that is refused."""
    law, Ra = str(random.choice(LAWS)), 10 ** random.uniform(-4, -1)
    parameters = {"Nbar": 10 ** random.uniform(-2, 2) / Ra**2, "Ra": Ra}
    if law == "power_law":
        parameters |= {"B": 10 ** random.uniform(-2, 0), "beta": random.uniform(0.3, 1.0)}
    elif "heights" in law:
        parameters["sigma"] = Ra * 10 ** random.uniform(-3, -1)
    if law == "normal_heights":
        parameters["cut"] = random.uniform(3, 4.5)
    first = 10 ** random.uniform(-6, -3)
    last = min(first * 10 ** random.uniform(1, 4), 0.3)
    p = np.geomspace(first, last, 60)
    if not even:
        draw = random.choice([np.geomspace, np.linspace])(first, last, random.integers(5, 61))
        p = np.sort(draw * (1 + random.uniform(-0.2, 0.2, len(draw))))
    columns = laws.LAWS[law].at(p, 1.0, **parameters)
    own_table._check(p, *columns)
    return law, parameters, own_table.fitted_law(f"table:{random.random()}", p, *columns)


def between(law: str, parameters: dict, tabulated) -> float:
    """The largest distance of a table from its law, over `error`."""
    p = np.geomspace(tabulated.least, tabulated.most, 1000)
    pairs = zip(tabulated.at(p, 1.0), laws.LAWS[law].at(p, 1.0, **parameters), strict=True)
    return max(np.abs(near / true - 1).max() for near, true in pairs) / tabulated.error


def contacts(random: np.random.Generator, base: str, law: str, parameters: dict, tabulated) -> np.ndarray:
    """Largest relative error, `model_error` + `error`, and p1/p(0) (3, n) of contacts with a table."""
    n = 1.0 if base == "half_space" else 10 ** random.uniform(-1, 1)
    case = {"base": base, "h": 10 ** random.uniform(-3, 0), "n": n}
    true = solve(Problem.of(a=np.geomspace(tabulated.least, 10 * tabulated.most, 12), **case, **parameters, micro=law))
    control = str(random.choice(["P", "a", "D"]))
    near = solve(Problem.of(**{control: getattr(true, control)}, **case, micro=tabulated))
    ratio = tabulated.least * n / true.p0
    is_judged = (near.status == Status.CONVERGED) & (true.status == Status.CONVERGED) & (ratio < 1 / 1.5)
    error = np.max([np.abs(getattr(near, name) / getattr(true, name) - 1) for name in JUDGED], axis=0)
    return np.stack([error, near.model_error + near.error + true.error, ratio])[:, is_judged]


def main(size: int = 100, seed: int = 1) -> None:
    np.seterr(all="ignore")
    random, worst, judged, edges = np.random.default_rng(seed), [], [np.empty((3, 0))], [0.0]
    for number in range(size):
        try:
            law, parameters, tabulated = table(random, number % 2 == 0)
        except ValueError:
            continue
        worst.append(between(law, parameters, tabulated))
        for base in ("half_space", "layered"):
            judged.append(contacts(random, base, law, parameters, tabulated))
            error, _, ratio = judged[-1]
            edges.append(((error - tabulated.error) / ratio**_STEEPNESS).max(initial=0.0))
    (error, bar, _), worst = np.concatenate(judged, axis=1), np.array(worst)
    print(f"{len(worst)} tables of {size}, {(worst > 1).sum()} somewhere above error, at most {worst.max():.1f} times")
    print(f"{len(error)} contacts, {(error > bar).sum()} above model_error, at most {(error / bar).max():.2f} times")
    print(f"edge: {max(edges):.3f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
