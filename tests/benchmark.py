"""Speed of the solver: cases per second on one thread, and that over the speed of stacked 17 x 17 linear solves.

    python tests/benchmark.py [bench.json]

The ratio r takes the machine out: it counts the linear systems that numpy solves in the time of one case.
"""

import json
import os
import platform
import sys
import time
from pathlib import Path

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")  # before numpy is imported

import numpy as np  # noqa: E402

from solver import NUMERICS_VERSION, Problem, Status, solve  # noqa: E402

CASES, REPEATS, SYSTEMS, ORDER = 4000, 3, 20_000, 17
X = np.linspace(0.0, 1.0, 5)


def problem(micro: str, rtol: float) -> Problem:
    """Random ordinary cases on a thin layer (see `MODEL`: P 1e-7..1e-3, Ra 5e-4..1e-2, N̄Ra² 0.1..10)."""
    random = np.random.default_rng(1)

    def between(low, high):
        return np.exp(random.uniform(np.log(low), np.log(high), CASES))

    Ra = between(5e-4, 1e-2)
    return Problem.of(
        P=between(1e-7, 1e-3),
        Ra=Ra,
        Nbar=between(0.1, 10) / Ra**2,
        n=random.uniform(0.05, 0.95, CASES),
        h=between(1e-3, 0.1),
        micro=micro,
        rtol=rtol,
    )


def seconds(action) -> float:
    """Shortest time of the repeats, after one run that fills the caches."""
    action()
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return min(times)


def systems_per_second() -> float:
    """Stacked numpy.linalg.solve of well-conditioned systems of 17 unknowns."""
    random = np.random.default_rng(0)
    matrices = random.standard_normal((SYSTEMS, ORDER, ORDER)) + ORDER * np.eye(ORDER)
    right = random.standard_normal((SYSTEMS, ORDER, 1))
    return SYSTEMS / seconds(lambda: np.linalg.solve(matrices, right))


def measure() -> dict:
    """All figures of the benchmark."""
    systems = systems_per_second()
    rows = []
    for micro in ("smooth", "disc_cell"):
        for rtol in (1e-3, 1e-6, 1e-9):
            cases = problem(micro, rtol)
            rate = CASES / seconds(lambda cases=cases: solve(cases, X))
            solution = solve(cases, X)
            row = {"micro": micro, "base": "thin_layer", "rtol": rtol, "cases_per_second": rate, "r": rate / systems}
            row |= {"converged": float(np.mean(solution.status == Status.CONVERGED))}
            rows.append(row | {"largest_error": float(np.nanmax(solution.error))})
    return {
        "numerics_version": NUMERICS_VERSION,
        "cpu": platform.processor() or platform.machine(),
        "numpy": np.__version__,
        "systems_17_per_second": systems,
        "rows": rows,
    }


def main(arguments: list[str]) -> None:
    """Print the table and write it as JSON."""
    result = measure()
    print(f"{result['systems_17_per_second']:.3g} systems of 17 x 17 per second (numpy.linalg.solve, stacked)")
    print(f"{'micro law':<10} {'rtol':>6} {'cases/s':>9} {'r':>7} {'converged':>9} {'largest error':>13}")
    for row in result["rows"]:
        print(
            f"{row['micro']:<10} {row['rtol']:>6.0e} {row['cases_per_second']:>9.3g} {row['r']:>7.4f}"
            f" {row['converged']:>9.2%} {row['largest_error']:>13.1e}"
        )
    if arguments:
        Path(arguments[0]).write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
