"""Typical work: four workloads, the latency of small batches, the second core, and the lower bound from flops.

Unless stated otherwise, times are processor times, the shortest of several by turns with stacked `numpy.linalg.solve`
of 17 unknowns.
"""

import time
from contextlib import contextmanager
from itertools import product

import numpy as np
import xarray as xr
from benchmark_cases import X, by_turns, coatings, on_path, problem, rated, systems

import study
from solver import Problem, solve
from solver.body import hankel
from solver.compiled.library import available
from solver.rough import newton, start

ROUGH = {"Nbar": 250_000.0, "Ra": 0.004}
#: The core with the widest vectors, if there is one, and numpy.
PATHS = (*available()[:1], "numpy")
SINGLE = 1000  # latencies are given over the time of so many single systems
#: The grid for the second core: 60,000 layered cases.
GRID = {
    "P": np.geomspace(1e-6, 1e-4, 30),
    "h": np.geomspace(5e-3, 0.1, 20),
    "n": np.linspace(0.1, 0.9, 10),
    "Ra": np.linspace(2e-3, 4e-3, 10),
    "Nbar": 250_000.0,
}


def load_axis(base: str, loads: int = 20, size: int = 8000) -> Problem:
    """A parameter study: `loads` loads over four decades, layers of 5 stiffnesses, and thicknesses to make `size`
    cases."""
    axes = np.geomspace(5e-3, 0.1, size // loads // 5), np.linspace(0.1, 0.9, 5), np.geomspace(1e-7, 1e-3, loads)
    h, n, P = (v.ravel() for v in np.meshgrid(*axes, indexing="ij"))
    return Problem.of(P=P, h=h, n=n, base=base, **ROUGH)


WORKLOADS = {
    "ordinary thin, 16,000": lambda: problem("disc_cell", "thin_layer", 1e-6),
    "ordinary layered, 16,000": lambda: problem("disc_cell", "layered", 1e-6),
    "random coatings, 4,000": lambda: coatings(4000),
    "random coatings, 100": lambda: coatings(100),
    "load axis thin, 8,000": lambda: load_axis("thin_layer"),
    "load axis layered, 8,000": lambda: load_axis("layered"),
}


def workloads() -> list[dict]:
    """A row for each workload on each path: cases per second, r, and the time over that of numpy's flops at the rate of
    a matrix product."""
    rows, per_flop = [], 1 / flops_per_second()
    for name, make in WORKLOADS.items():
        cases = make()
        with on_path("numpy"), counted() as flops:
            solve(cases, X)
        floor = sum(flops) * per_flop / len(cases)
        for path in PATHS:
            with on_path(path):
                rates = rated(cases)
            row = {"workload": name, "path": path, "cases_per_second": rates["cases_per_second"], "r": rates["r"]}
            rows.append(row | {"kiloflops_per_case": sum(flops) / len(cases) / 1e3,
                               "measured_over_floor": 1 / rates["cases_per_second"] / floor})  # fmt: skip
    return rows


def flops_per_second() -> float:
    """Flops per second of one thread in the product of two matrices of 512 rows."""
    matrix = np.random.default_rng(0).standard_normal((512, 512))
    return 2 * 512**3 / by_turns(lambda: matrix @ matrix)[0]


@contextmanager
def counted():
    """Context manager: a list that collects the flops of forming layered matrices from few nodes, and of
    eliminating."""
    flops, form, eliminate = [], hankel.rows_of, newton.solve_stack

    def forming(parts, mesh):
        flops.extend(2 * part.L1.size * mesh.n**2 for part in parts)
        return form(parts, mesh)

    def eliminating(K, diagonal, rhs):
        size, n, columns = rhs.shape
        flops.append(size * (2 / 3 * n**3 + 2 * n**2 * columns))
        return eliminate(K, diagonal, rhs)

    hankel.rows_of, newton.solve_stack, start.solve_stack = forming, eliminating, eliminating
    try:
        yield flops
    finally:
        hankel.rows_of, newton.solve_stack, start.solve_stack = form, eliminate, eliminate


def latency() -> list[dict]:
    """Milliseconds of a call with 1, 10 and 100 cases, also over SINGLE single solutions of 17 unknowns."""
    (matrix,), (right,) = systems(1)
    ordinary = problem("disc_cell", "layered", 1e-6, 100)
    rows, kinds = [], {"ordinary layered": ordinary, "random coatings": coatings(100)}
    for name, size, path in product(kinds, (1, 10, 100), PATHS):
        with on_path(path):
            part = kinds[name].take(np.arange(size))
            grid = labelled(part)

            def single():
                for _ in range(SINGLE):
                    np.linalg.solve(matrix, right)

            times = by_turns(single, lambda: solve(part), lambda: study.solve(**grid))  # noqa: B023
            row = {"cases": f"{size} {name}", "path": path, "single_systems_ms": 1e3 * times[0]}
            row |= {"solver_ms": 1e3 * times[1], "study_ms": 1e3 * times[2]}
            rows.append(row | {"solver_over_systems": times[1] / times[0], "study_over_systems": times[2] / times[0]})
    return rows


def labelled(part: Problem) -> dict:
    """The cases as arguments of `study.solve`."""
    names = ("h", "n", "nu1", "nu2", "bonding", "Ra", "Nbar")
    return {"P": xr.DataArray(part.value, dims="case")} | {
        name: xr.DataArray(getattr(part, name), dims="case") for name in names
    }


def second_core() -> list[dict]:
    """Wall and processor seconds of the calling process for the grid: alone, with processes that it must start, and
    with processes that wait from the call before. Wall over processor time of the first tells how idle the machine
    is."""
    study.solve(P=1e-5, h=0.02, n=0.5, **ROUGH)
    rows, reference = [], None
    for name, workers in {"one": 1, "two, started": 2, "two, waiting": 2, "one again": 1, "two again": 2}.items():
        wall, processor = time.perf_counter(), time.process_time()
        results = study.solve(**GRID, workers=workers)
        row = {"workers": name, "wall_seconds": time.perf_counter() - wall}
        row |= {"callers_processor_seconds": time.process_time() - processor}
        reference = reference or (row["wall_seconds"], results)
        same = all(results[v].values.tobytes() == reference[1][v].values.tobytes() for v in results.variables)
        rows.append(row | {"gain": reference[0] / row["wall_seconds"], "same_bits": same})
    return rows
