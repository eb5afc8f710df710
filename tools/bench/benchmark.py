"""Speed of the solver: cases per second on one thread, also over the speed of stacked 17 x 17 linear solves.

    python tools/bench/benchmark.py [bench.json]
    python tools/bench/benchmark.py --page docs/speed.md [--only SECTION ...]

The ratio r does not depend on the machine: it counts the linear systems that numpy solves in the time of one case, both
in processor time and by turns. Further measurements: time and memory against the number of cases, one and two threads,
asperities that feel the coated body (benchmark_felt.py), a study of a million cases, BLAS with two threads
(benchmark_threads.py has more), and at equal error the paper's method and, if they are installed (extra `peers`), other
codes.
"""

import argparse
import json
import os
import platform
import resource
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from pathlib import Path

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")  # before numpy is imported

import numpy as np  # noqa: E402
from benchmark_cases import CASES, REPEATS, X, coatings, problem, processor_seconds, rated, seconds  # noqa: E402
from benchmark_felt import felt  # noqa: E402
from benchmark_page import SECTIONS, measured_page  # noqa: E402
from benchmark_peers import peers, rough_peers  # noqa: E402
from benchmark_study import beside_the_solver, whole_run  # noqa: E402
from benchmark_threads import blas_threads  # noqa: E402

from solver import NUMERICS_VERSION, Status, solve  # noqa: E402
from study.studies.evidence.problem_sets import SETS  # noqa: E402
from study.studies.evidence.tradeoff import WAYS, measured, paper_way, selection, with_reference  # noqa: E402

SIZES = (1_000, 10_000, 100_000, 1_000_000)
#: From this size on the time per case counts as flat if it is within FLAT of its mean.
LARGE, FLAT = 10_000, 0.15
BLOCK = 8000
#: k, intervals, cases of the paper's method. Of k = 5, 10, 20, 30, 35, 40 the one with which all cases end fastest.
PAPERS = ((5, 20, 200), (5, 45, 200), (10, 80, 100), (20, 130, 50), (30, 390, 20), (30, 640, 10), (35, 1100, 5))
PAPERS_CASES = 1000


def speed() -> list[dict]:
    """Cases per second of every kind of case at three tolerances, and systems per second of stacked numpy.linalg.solve,
    well-conditioned and of 17 unknowns."""

    def row(cases):
        """One row of a problem, by turns with the linear systems."""
        solution = solve(cases, X)
        rates = rated(cases) | {"converged": float(np.mean(solution.status == Status.CONVERGED))}
        return rates | {"largest_error": float(np.nanmax(solution.error))}

    rows = []
    for micro, base in product(("smooth", "disc_cell"), ("thin_layer", "layered")):
        for rtol in (1e-3, 1e-6, 1e-9):
            rows.append({"micro": micro, "base": base, "rtol": rtol} | row(problem(micro, base, rtol)))
    for size in (4000, 100):
        kind = {"micro": "disc_cell", "base": f"coatings {size}", "rtol": 1e-6}
        rows.append(kind | row(coatings(size)))
    return rows


def layered_over_thin(rows: list[dict], micro: str, rtol: float = 1e-6) -> float:
    """Time of a case on the exact layer over that of the same case on the thin one."""
    rate = {row["base"]: row["cases_per_second"] for row in rows if row["micro"] == micro and row["rtol"] == rtol}
    return rate["thin_layer"] / rate["layered"]


def sizes(count=SIZES) -> list[dict]:
    """Processor time of one call with ever more thin rough cases, the shortest of several, in turns with the other
    sizes; and the largest memory of the process so far (this must come early)."""
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
    """The paper's method on its own cases on the layer, and Newton with the loosest rtol that is at least as accurate.

    Processor time per case, error of 95 % of the cases; a larger batch would not lower the time per case much.
    """
    cases, reference = with_reference(SETS["paper, layer"](PAPERS_CASES, 1))
    newton = [measured(WAYS["newton, rtol"], rtol, cases, reference, REPEATS) for rtol in WAYS["newton, rtol"].settings]
    rows = []
    for k, intervals, count in PAPERS:
        method = paper_way(k, most=count)
        theirs = measured(method, intervals, *selection(cases, reference, method.index(len(reference.a))), REPEATS)
        ours = next(grid_row for grid_row in newton if grid_row["most"] <= theirs["most"])
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
        "asperities_on": [*felt()],
        "blas_threads": blas_threads(("random",), (2,)),
        "whole_run": [beside_the_solver(run)],
        "papers_way": papers_way(),
        "peers": peers(seconds),
        "rough_peers": rough_peers(),
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
    for name in (
        "sizes",
        "threads",
        "asperities_on",
        "blas_threads",
        "whole_run",
        "papers_way",
        "peers",
        "rough_peers",
    ):
        print(f"\n{name}")
        for row in result[name]:
            print("  " + ", ".join(f"{key} {value:.3g}" if isinstance(value, float) else f"{key} {value}"
                                   for key, value in row.items()))  # fmt: skip


def main(arguments: list[str]) -> None:
    """Print the tables and write all numbers as JSON; or measure the numbers of docs/speed.md and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("json", nargs="?", type=Path, help="file for all figures of the full benchmark")
    parser.add_argument("--page", type=Path, help="write docs/speed.md there in place of it, in some minutes")
    parser.add_argument("--only", nargs="+", choices=SECTIONS, default=[], help="sections of the page to measure again")
    options = parser.parse_args(arguments)
    if options.page:
        old = options.page.read_text(encoding="utf-8") if options.only else ""
        options.page.write_text(measured_page(old, options.only), encoding="utf-8")
        return
    result = measure()
    report(result)
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
