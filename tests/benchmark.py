"""Speed of the solver: cases per second on one thread, and that over the speed of stacked 17 x 17 linear solves.

    python tests/benchmark.py [bench.json]

The ratio r takes the machine out: it counts the linear systems that numpy solves in the time of one case, both in
processor time and by turns. Beside it: time and memory against the number of cases, one and two threads, a study of a
million cases, BLAS left two threads (benchmark_threads.py has more), and at equal error the paper's way and, if they
are installed (extra `peers`), other codes.
"""

import json
import os
import platform
import resource
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from pathlib import Path

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")  # before numpy is imported

import numpy as np  # noqa: E402
from benchmark_peers import peers  # noqa: E402
from benchmark_study import beside_the_solver, whole_run  # noqa: E402
from benchmark_threads import blas_threads  # noqa: E402

from solver import NUMERICS_VERSION, Problem, Status, solve  # noqa: E402
from study.evidence.problem_sets import SETS  # noqa: E402
from study.evidence.tradeoff import WAYS, measured, paper_way, taken, with_reference  # noqa: E402

CASES, REPEATS, SYSTEMS, ORDER = 16_000, 3, 20_000, 17
SIZES = (1_000, 10_000, 100_000, 1_000_000)
#: From this size on the time per case is called flat if it is within FLAT of its mean.
LARGE, FLAT = 10_000, 0.15
BLOCK = 8000
#: k, intervals, cases of the paper's way; of k = 5, 10, 20, 30, 35, 40 that with which all end at least cost.
PAPERS = ((5, 20, 200), (5, 45, 200), (10, 80, 100), (20, 130, 50), (30, 390, 20), (30, 640, 10), (35, 1100, 5))
PAPERS_CASES = 1000
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
    """Shortest processor time of each action, of turns of some runs in a row, so that each finds its own cache: at
    least REPEATS turns, and a second in all."""
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


def speed() -> list[dict]:
    """Cases per second of every kind of case at three tolerances, and well-conditioned systems of 17 unknowns solved by
    stacked numpy.linalg.solve."""
    random = np.random.default_rng(0)
    matrices = random.standard_normal((SYSTEMS, ORDER, ORDER)) + ORDER * np.eye(ORDER)
    right = random.standard_normal((SYSTEMS, ORDER, 1))

    def row(cases, size):
        """One row of a problem of `size` cases, by turns with the linear systems."""
        times = by_turns(lambda: solve(cases, X), lambda: np.linalg.solve(matrices, right))
        rate, systems = (size, SYSTEMS) / times
        solution = solve(cases, X)
        found = {"cases_per_second": rate, "r": rate / systems, "systems_17_per_second": systems}
        found |= {"converged": float(np.mean(solution.status == Status.CONVERGED))}
        return found | {"largest_error": float(np.nanmax(solution.error))}

    rows = []
    for micro, base in product(("smooth", "disc_cell"), ("thin_layer", "layered")):
        for rtol in (1e-3, 1e-6, 1e-9):
            rows.append({"micro": micro, "base": base, "rtol": rtol} | row(problem(micro, base, rtol), CASES))
    for size in (4000, 100):
        kind = {"micro": "disc_cell", "base": f"coatings {size}", "rtol": 1e-6}
        rows.append(kind | row(coatings(size), size))
    return rows


def layered_over_thin(rows: list[dict], micro: str, rtol: float = 1e-6) -> float:
    """Time of a case on the exact layer over that of the same case on the thin one."""
    rate = {row["base"]: row["cases_per_second"] for row in rows if row["micro"] == micro and row["rtol"] == rtol}
    return rate["thin_layer"] / rate["layered"]


def sizes(count=SIZES) -> list[dict]:
    """Processor time of one call with ever more thin rough cases, the shortest of several between those of the other
    sizes, and the largest memory of the process so far (must come early)."""
    times, peak = {size: [] for size in count}, {}
    for _ in range(REPEATS):
        for size in count:
            cases = problem("disc_cell", "thin_layer", 1e-6, size)
            runs = range(max(1, LARGE * REPEATS // size))
            times[size] += [processor_seconds(lambda cases=cases: solve(cases, X)) for _ in runs]
            used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
            peak.setdefault(size, used)
    best = {size: min(times[size]) for size in count}
    return [
        {"cases": size, "seconds": best[size], "per_case": best[size] / size, "peak_bytes": peak[size]}
        for size in count
    ]


def flatness(rows: list[dict]) -> dict:
    """Largest deviation of the time per case of the LARGE sizes from its mean, and whether that is below FLAT."""
    cost = np.array([row["per_case"] for row in rows if row["cases"] >= LARGE])
    deviation = float(np.abs(cost / cost.mean() - 1).max())
    return {"from": LARGE, "deviation": deviation, "flat": deviation <= FLAT}


def threads() -> list[dict]:
    """Cases per second of one and of two threads that share the blocks of a batch."""
    rows = []
    for micro, base in product(("disc_cell",), ("thin_layer", "layered")):
        whole = problem(micro, base, 1e-6)
        blocks = [whole.take(np.arange(i, i + BLOCK)) for i in range(0, CASES, BLOCK)]
        for count in (1, 2):
            with ThreadPoolExecutor(count) as pool:
                rate = CASES / seconds(lambda pool=pool, blocks=blocks: list(pool.map(lambda b: solve(b, X), blocks)))
            rows.append({"micro": micro, "base": base, "threads": count, "cases_per_second": rate})
    return rows


def papers_way() -> list[dict]:
    """The paper's way on its own cases on the layer, and Newton with the loosest rtol that is at least as accurate.

    Processor time per case, error of 95 % of the cases; a larger batch would lower neither's time per case by much.
    """
    cases, reference = with_reference(SETS["paper, layer"](PAPERS_CASES, 1))
    newton = [measured(WAYS["newton, rtol"], rtol, cases, reference, REPEATS) for rtol in WAYS["newton, rtol"].settings]
    rows = []
    for k, intervals, count in PAPERS:
        way = paper_way(k, most=count)
        theirs = measured(way, intervals, *taken(cases, reference, way.index(cases)), REPEATS)
        ours = next(one for one in newton if one["most"] <= theirs["most"])
        row = {"error": theirs["most"], "k": k, "intervals": intervals, "cases": count, "ended": theirs["ended"]}
        row |= {"seconds": theirs["time"], "newton_rtol": ours["setting"], "newton_error": ours["most"]}
        row |= {"newton_cases": len(reference.a), "newton_seconds": ours["time"]}
        rows.append(row | {"times_faster": theirs["time"] / ours["time"]})
    return rows


def measure() -> dict:
    """All figures of the benchmark."""
    run, by_size = whole_run(), sizes()
    rows = speed()
    return {
        "numerics_version": NUMERICS_VERSION,
        "cpu": platform.processor() or platform.machine(),
        "numpy": np.__version__,
        "systems_17_per_second": max(row["systems_17_per_second"] for row in rows),
        "rows": rows,
        "layered_over_thin": {micro: layered_over_thin(rows, micro) for micro in ("smooth", "disc_cell")},
        "sizes": by_size,
        "flatness": flatness(by_size),
        "threads": threads(),
        "blas_threads": blas_threads(("random",), (2,)),
        "whole_run": [beside_the_solver(run)],
        "papers_way": papers_way(),
        "peers": peers(seconds),
    }


def report(result: dict) -> None:
    """Print the tables."""
    print(f"{result['systems_17_per_second']:.3g} systems of 17 x 17 per second (numpy.linalg.solve, stacked)")
    print(f"{'micro law':<10} {'base':<13} {'rtol':>6} {'cases/s':>9} {'r':>7} {'converged':>9} {'largest error':>13}")
    for row in result["rows"]:
        print(
            f"{row['micro']:<10} {row['base']:<13} {row['rtol']:>6.0e} {row['cases_per_second']:>9.3g} {row['r']:>7.4f}"
            f" {row['converged']:>9.2%} {row['largest_error']:>13.1e}"
        )
    for micro, ratio in result["layered_over_thin"].items():
        print(f"{micro}: a case on the exact layer takes {ratio:.1f} times as long as on the thin one (rtol 1e-6)")
    flat = result["flatness"]
    word = "flat" if flat["flat"] else "not flat"
    print(f"time per case from {flat['from']} cases on: {word}, within {flat['deviation']:.1%} of its mean")
    for name in ("sizes", "threads", "blas_threads", "whole_run", "papers_way", "peers"):
        print(f"\n{name}")
        for row in result[name]:
            print("  " + ", ".join(f"{key} {value:.3g}" if isinstance(value, float) else f"{key} {value}"
                                   for key, value in row.items()))  # fmt: skip


def main(arguments: list[str]) -> None:
    """Print the tables and write all as JSON."""
    result = measure()
    report(result)
    if arguments:
        Path(arguments[0]).write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
