"""Shared by the benchmarks: cases, and the measurement of times."""

import os
import time
from contextlib import contextmanager

import numpy as np

from solver import Problem, solve
from solver.compiled.library import VARIABLE

CASES, REPEATS, SYSTEMS, ORDER = 16_000, 3, 20_000, 17
X = np.linspace(0.0, 1.0, 5)


def problem(micro: str, base: str, rtol: float, size: int = CASES) -> Problem:
    """Random ordinary cases on a layer (see `MODEL`: P 1e-7..1e-3, Ra 5e-4..1e-2, N̄Ra² 0.1..10)."""
    random = np.random.default_rng(1)

    def between(low, high):
        return np.exp(random.uniform(np.log(low), np.log(high), size))

    Ra = between(5e-4, 1e-2)
    return Problem.of(
        P=between(1e-7, 1e-3),
        Ra=Ra,
        Nbar=between(0.1, 10) / Ra**2,
        n=random.uniform(0.05, 0.95, size),
        h=between(1e-3, 0.1),
        micro=micro,
        base=base,
        rtol=rtol,
    )


def coatings(size: int) -> Problem:
    """Random coatings on the exact layer: n from 1e-3 to 1e3, both interfaces, ν up to 0.49."""
    random = np.random.default_rng(2)

    def between(low, high):
        return np.exp(random.uniform(np.log(low), np.log(high), size))

    return Problem.of(
        P=between(1e-7, 1e-3),
        Ra=random.choice([0.002, 0.004, 0.008], size),
        Nbar=250_000.0,
        n=between(1e-3, 1e3),
        h=between(1e-3, 0.5),
        nu1=random.uniform(0, 0.49, size),
        nu2=random.uniform(0, 0.49, size),
        bonding=random.choice(["frictionless", "bonded"], size),
        rtol=1e-6,
    )


def processor_seconds(action) -> float:
    """Processor time of one run."""
    start = time.process_time()
    action()
    return time.process_time() - start


def by_turns(*actions) -> np.ndarray:
    """Shortest processor time of each action. A turn has some runs in a row, so that each action finds its own cache;
    there are at least REPEATS turns, and a second in all."""
    times = np.empty((0, len(actions), 1 + REPEATS))
    while len(times) < REPEATS or times.sum() < 1.0:
        turn = [[processor_seconds(action) for _ in range(1 + REPEATS)] for action in actions]
        times = np.concatenate([times, [turn]])
    return times.min(axis=(0, 2))


def seconds(action) -> float:
    """Shortest time of the repeats, after one run that fills the caches."""
    action()
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return min(times)


def systems(count: int) -> tuple[np.ndarray, np.ndarray]:
    """`count` well-conditioned systems of ORDER unknowns: matrices and right-hand sides."""
    matrices = np.random.default_rng(0).standard_normal((count, ORDER, ORDER)) + ORDER * np.eye(ORDER)
    return matrices, np.random.default_rng(1).standard_normal((count, ORDER, 1))


def rated(cases: Problem) -> dict:
    """Cases per second of one call, also over the systems per second of stacked numpy.linalg.solve, by turns."""
    matrices, right = systems(SYSTEMS)
    times = by_turns(lambda: solve(cases, X), lambda: np.linalg.solve(matrices, right))
    rate, rate_of_systems = np.array([len(cases), SYSTEMS]) / times
    return {"cases_per_second": rate, "r": rate / rate_of_systems, "systems_17_per_second": rate_of_systems}


@contextmanager
def on_path(path: str):
    """Context manager: the solver takes this path, "numpy" or a variant of the compiled core."""
    before = os.environ.get(VARIABLE, "")
    os.environ[VARIABLE] = path
    try:
        yield
    finally:
        os.environ[VARIABLE] = before
