"""Speed of the solver: cases per second on one thread, and that over the speed of stacked 17 x 17 linear solves.

    python tests/benchmark.py [bench.json]

The ratio r takes the machine out: it counts the linear systems that numpy solves in the time of one case. Last it
prints how much longer the exact layer takes than the thin one for the same batch of cases at rtol 1e-6.
"""

import json
import os
import platform
import sys
import time
from itertools import product
from pathlib import Path

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")  # before numpy is imported

import numpy as np  # noqa: E402

from solver import NUMERICS_VERSION, Problem, Status, solve  # noqa: E402

CASES, REPEATS, SYSTEMS, ORDER = 4000, 3, 20_000, 17
X = np.linspace(0.0, 1.0, 5)


def problem(micro: str, base: str, rtol: float) -> Problem:
    """Random ordinary cases on a layer (see `MODEL`: P 1e-7..1e-3, Ra 5e-4..1e-2, N̄Ra² 0.1..10)."""
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
        base=base,
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
    for micro, base in product(("smooth", "disc_cell"), ("thin_layer", "layered")):
        for rtol in (1e-3, 1e-6, 1e-9):
            cases = problem(micro, base, rtol)
            rate = CASES / seconds(lambda cases=cases: solve(cases, X))
            solution = solve(cases, X)
            row = {"micro": micro, "base": base, "rtol": rtol, "cases_per_second": rate, "r": rate / systems}
            row |= {"converged": float(np.mean(solution.status == Status.CONVERGED))}
            rows.append(row | {"largest_error": float(np.nanmax(solution.error))})
    return {
        "numerics_version": NUMERICS_VERSION,
        "cpu": platform.processor() or platform.machine(),
        "numpy": np.__version__,
        "systems_17_per_second": systems,
        "rows": rows,
        "layered_over_thin": {micro: layered_over_thin(rows, micro) for micro in ("smooth", "disc_cell")},
    }


def layered_over_thin(rows: list[dict], micro: str, rtol: float = 1e-6) -> float:
    """Time of a case on the exact layer over that of the same case on the thin one."""
    rate = {row["base"]: row["cases_per_second"] for row in rows if row["micro"] == micro and row["rtol"] == rtol}
    return rate["thin_layer"] / rate["layered"]


def main(arguments: list[str]) -> None:
    """Print the table and write it as JSON."""
    result = measure()
    print(f"{result['systems_17_per_second']:.3g} systems of 17 x 17 per second (numpy.linalg.solve, stacked)")
    print(f"{'micro law':<10} {'base':<10} {'rtol':>6} {'cases/s':>9} {'r':>7} {'converged':>9} {'largest error':>13}")
    for row in result["rows"]:
        print(
            f"{row['micro']:<10} {row['base']:<10} {row['rtol']:>6.0e} {row['cases_per_second']:>9.3g} {row['r']:>7.4f}"
            f" {row['converged']:>9.2%} {row['largest_error']:>13.1e}"
        )
    for micro, ratio in result["layered_over_thin"].items():
        print(f"{micro}: a case on the exact layer takes {ratio:.1f} times as long as on the thin one (rtol 1e-6)")
    if arguments:
        Path(arguments[0]).write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
