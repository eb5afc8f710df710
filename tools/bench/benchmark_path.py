"""A load axis as a path: the possible saving by better first guesses, and the errors of guesses from other loads.

The cases of a parameter study start from their own solutions with a relative error of `SIZES`: no prediction with such
an error can save more. The second table has the error of a cubic in ln P through every fourth load, which could predict
three quarters of the cases in one batch, and that of a parabola through the three loads before, which allows only
batches of as many cases as there are paths.
"""

from contextlib import contextmanager

import numpy as np
from benchmark_cases import by_turns, on_path
from benchmark_work import load_axis

from solver import solve
from solver.numerics.mesh import mesh_of
from solver.rough import adaptive
from solver.rough.equation import Unknowns, evaluate
from solver.rough.start import first_guess
from solver.scaling import as_cases, dimensionless

SIZES = (1e-3, 1e-4, 1e-6)
LOADS = (20, 40, 100)
NODES = 16  # of the mesh on which solutions are compared


@on_path("numpy")
def saved() -> list[dict]:
    """Processor time of a study of 8,000 cases whose first guesses have an error, over that of the unchanged solver;
    all by numpy, since its guesses can be replaced."""
    rows = []
    for base in ("thin_layer", "layered"):
        cases, solutions = load_axis(base), {}
        with started(solutions):
            solve(cases)

        def solve_from_guess(size):
            with started(solutions, size):  # noqa: B023
                solve(cases)  # noqa: B023

        times = by_turns(lambda: solve(cases), *(lambda size=size: solve_from_guess(size) for size in SIZES))  # noqa: B023
        shares = {f"from {size:.0e}": used / times[0] for size, used in zip(SIZES, times[1:], strict=True)}
        rows.append({"base": base} | shares)
    return rows


@contextmanager
def started(solutions: dict, size: float | None = None):
    """The start on the first mesh of a stack: the usual one, which fills `known` with solutions, or a distance of
    `size` from these."""
    real, solve_on = adaptive.first_guess, adaptive.solve_on
    random = np.random.default_rng(0)

    def key(cases, mesh):
        return mesh.n, len(cases.value), float(cases.value.sum())

    def first_guess(cases, mesh, a):
        state = solutions.get(key(cases, mesh))
        if size is None or state is None:
            return real(cases, mesh, a)
        y = state.y * (1 + size * random.standard_normal((len(state.y), 1)))
        return Unknowns(y, state.eta + size * random.standard_normal(len(state.eta)))

    def solve_and_note(begin, limit):
        answer = solve_on(begin, limit)
        if size is None:
            solutions.setdefault(key(begin.cases, begin.mesh), answer.at.state)
        return answer

    adaptive.first_guess, adaptive.solve_on = first_guess, solve_and_note
    try:
        yield
    finally:
        adaptive.first_guess, adaptive.solve_on = real, solve_on


def predicted() -> list[dict]:
    """Median over cases of the largest relative error of the unknowns at the nodes, by the number of loads."""
    rows = []
    for base in ("thin_layer", "layered"):
        for loads in LOADS:
            problem = dimensionless(load_axis(base, loads))
            cases, mesh = as_cases(problem), mesh_of(NODES)
            y = adaptive.solve_on(evaluate(cases, first_guess(cases, mesh), mesh), 0).at.state.y
            y, x = np.log(y).reshape(-1, loads, NODES), np.log(cases.value[:loads])
            cubic = [_missed(y, x, [k, k + 4, k + 8, k + 12], k + 6) for k in range(0, loads - 12, 4)]
            parabola = [_missed(y, x, [k, k + 1, k + 2], k + 3) for k in range(loads - 3)]
            row = {"base": base, "loads": loads, "between every fourth": np.median(cubic)}
            rows.append(row | {"after the last three": np.median(parabola)})
    return rows


def _missed(y: np.ndarray, x: np.ndarray, points: list[int], wanted: int) -> np.ndarray:
    """Largest error over the nodes of y (b, loads, n) at the load `wanted` by a polynomial through others: (b,)."""
    at = x[points]
    weights = [np.prod([(x[wanted] - b) / (a - b) for b in at if b != a]) for a in at]
    return np.abs(np.tensordot(y[:, points], weights, (1, 0)) - y[:, wanted]).max(axis=-1)
