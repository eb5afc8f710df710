"""Do converged answers keep their tolerance on both paths? `python tools/errors/contract.py [SIZE [SEED]]`.

SIZE random contacts (20,000 by default) of the kinds that the compiled core takes (tests/compiled/both_paths.py) are
solved at each of the tolerances RTOL by numpy and by the core, and at FINE by numpy, which is the truth. It takes some
five minutes, and prints a line for each path and tolerance:

- judged: converged answers whose truth has an `error` below a tenth of the tolerance;
- beyond rtol: the number of these that are farther from the truth than rtol, and the largest distance over rtol;
- above error: the number of these that are farther from the truth than their `error`, and the largest distance over it;
- for each base, the number of those beyond rtol.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[2] / "tests/compiled"))  # under pytest it is there already
from both_paths import by, contacts  # noqa: E402

from solver import Problem, Solution, Status  # noqa: E402
from solver.solution import JUDGED  # noqa: E402

RTOL, FINE = (1e-3, 1e-6, 1e-8), 1e-10
PATHS = {"numpy": "numpy", "core": ""}
#: Contacts that are solved together.
TOGETHER = 2000


def distances(solution: Solution, truth: Solution) -> np.ndarray:
    """Largest relative distance (B,) of the judged numbers."""
    pairs = [(getattr(solution, name), getattr(truth, name)) for name in JUDGED]
    with np.errstate(all="ignore"):
        return np.max([np.where(true == value, 0.0, np.abs(value / true - 1)) for value, true in pairs], axis=0)


def line(name: str, rtol: float, far: np.ndarray, error: np.ndarray, base: np.ndarray) -> str:
    over_rtol, over_error = far > rtol, far > error
    bases = ", ".join(f"{kind} {over_rtol[base == kind].sum()}" for kind in np.unique(base))
    worst = (far / rtol).max(initial=0), (far[over_error] / error[over_error]).max(initial=0)
    return (
        f"{name:5s} {rtol:.0e}: {len(far)} judged; beyond rtol {over_rtol.sum()}, at most {worst[0]:.2f}; "
        f"above error {over_error.sum()}, at most {worst[1]:.2f}; by base: {bases}"
    )


def main(size: int = 20_000, seed: int = 5) -> None:
    rows: dict[tuple[str, float], list] = {(name, rtol): [] for name in PATHS for rtol in RTOL}
    for start in range(0, size, TOGETHER):
        problem = contacts(min(TOGETHER, size - start), seed * 1000 + start // TOGETHER)

        def at(rtol: float, path: str, problem: Problem = problem) -> Solution:
            parameters = problem.parameters | {"rtol": np.full(len(problem), rtol)}
            return by(path, Problem(problem.control, problem.value, parameters, problem.known), (0.0, 1.0))

        truth = at(FINE, "numpy")
        for (name, rtol), parts in rows.items():
            solution = at(rtol, PATHS[name])
            judged = (solution.status == Status.CONVERGED) & (truth.error < 0.1 * rtol)
            parts.append(np.array([distances(solution, truth), solution.error])[:, judged])
            parts[-1] = (*parts[-1], problem.base[judged])
    for (name, rtol), parts in rows.items():
        print(line(name, rtol, *(np.concatenate(column) for column in zip(*parts, strict=True))), flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:3]))
