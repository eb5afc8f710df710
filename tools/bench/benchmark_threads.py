"""The effect of one BLAS thread: processor and wall time of calls on the exact layer, alone and beside busy processes.

    python tools/bench/benchmark_threads.py
    python tools/bench/benchmark_threads.py core

Each row is a process of its own, whose OPENBLAS_NUM_THREADS sets the number of BLAS threads. "free" takes the limit of
the solver away (solver/numerics/threads.py), "limited" is the solver as it is. More threads than processors stand for a
machine with more processors.
"""

import json
import os
import subprocess
import sys
import threading
import time
from collections import deque
from contextlib import contextmanager
from itertools import product

CHILD = "--child"
BUSY = "while True: pass"


def random_cases() -> dict:
    """8,000 random cases of the exact layer, as arguments of `study.solve`."""
    import xarray as xr
    from solver_cases import random_cases

    drawn = random_cases(8000, seed=1)
    return {name: xr.DataArray(drawn[name], dims="case") for name in ("P", "Ra", "Nbar", "n", "h", "bonding")}


def a_map() -> dict:
    """A map of 25,000 cases, as arguments of `study.solve`."""
    import numpy as np

    axes = {"P": np.geomspace(1e-7, 1e-3, 50), "h": np.geomspace(1e-3, 0.1, 10), "n": np.linspace(0.1, 0.9, 5)}
    return axes | {"Ra": [0.001, 0.002, 0.003, 0.004, 0.005], "Nbar": 250000, "bonding": ["frictionless", "bonded"]}


GRIDS = {"random": random_cases, "map": a_map}


def child(grid: str, free: bool) -> None:
    """Print processor and wall seconds of one call of `study.solve`, after a small one that imports everything."""
    import study
    from solver.numerics import threads

    if free:
        threads._blas = lambda: (NOTHING, NOTHING)
    study.solve(P=1e-5, h=[0.01, 0.02], n=0.5, Nbar=250000, Ra=0.004)
    parameters = GRIDS[grid]()
    wall, processor = time.perf_counter(), time.process_time()
    study.solve(
        **parameters, profiles=False, workers=1
    )  # no other process computes, so that the time of this one is complete
    print(json.dumps([time.process_time() - processor, time.perf_counter() - wall]))


class _Nothing:
    """A limit that does nothing, in place of the solver's."""

    def __enter__(self):
        return None

    def __exit__(self, *_):
        return None

    def limit(self, limits):
        return self


NOTHING = _Nothing()


@contextmanager
def busy(count: int):
    """Context manager: `count` processes, each of which keeps a processor busy."""
    processes = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(count)]
    try:
        yield
    finally:
        for other in processes:
            other.kill()
            other.wait()


def measured(grid: str, threads: int, free: bool) -> tuple[float, float]:
    """Processor and wall seconds of one call in a process of its own."""
    names = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
    environment = os.environ | dict.fromkeys(names, str(threads))
    command = [sys.executable, __file__, CHILD, grid, str(int(free))]
    return tuple(json.loads(subprocess.run(command, env=environment, capture_output=True, check=True).stdout))


def blas_threads(grids=tuple(GRIDS), numbers=(2, 4, 8)) -> list[dict]:
    """A row for each setting, alone and with a busy process for each processor; processor time also over that of one
    forced thread under the same load."""
    rows = []
    for grid, busy_processes in product(grids, (0, os.cpu_count())):
        with busy(busy_processes):
            ways = {"1 forced": (1, True)}
            ways |= {f"{n}, {'free' if free else 'limited'}": (n, free) for n in numbers for free in (True, False)}
            times = {way: measured(grid, *chosen) for way, chosen in ways.items()}
        for way, (processor, wall) in times.items():
            row = {"cases": grid, "busy_processes": busy_processes, "blas_threads": way, "processor_seconds": processor}
            rows.append(row | {"over_forced": processor / times["1 forced"][0], "wall_seconds": wall})
    return rows


def core_threads() -> list[dict]:
    """A row for each base: the gain by two threads of one process on the compiled core.

    The times of each thread are measured: computing, waiting for a processor, and blocked by others that hold Python's
    lock. The bound of the gain on idle processors, 2 computed/(computed + blocked), can therefore be measured on a busy
    machine too, where it comes out too low. Linux only.
    """
    import tomllib

    import numpy as np
    from benchmark_study import STUDY

    from study.inputs.reading import from_tables
    from study.work.cases import compute, parcel

    rows = []
    for base in ("thin_layer", "layered"):
        text = STUDY.replace("thin_layer", base)
        definition = from_tables(tomllib.loads(text), base, text, base)
        drawn = np.random.default_rng(0).permutation(definition.grid.size)[:96_000]
        blocks = [parcel(definition, index) for index in np.array_split(drawn, 12)]
        compute(blocks[0])
        times = np.array(_thread_times(compute, blocks)).sum(axis=0)
        computed, waited, wall = times / 1e9
        blocked = wall - computed - waited
        row = {"base": base, "computed_s": computed, "waited_s": waited, "blocked_s": blocked}
        rows.append(row | {"bound_of_gain": 2 * computed / (computed + blocked)})
    return rows


def _thread_times(compute, blocks: list) -> list[tuple[int, int, int]]:
    """For two threads that share the blocks: ns in which each computed, waited for a processor, and existed."""
    waiting, times = deque(blocks), []

    def spent() -> list[int]:
        path = f"/proc/self/task/{threading.get_native_id()}/schedstat"
        with open(path, encoding="ascii") as file:
            return [*map(int, file.read().split()[:2]), time.perf_counter_ns()]

    def work() -> None:
        before = spent()
        while True:
            try:
                compute(waiting.popleft())
            except IndexError:
                break
        times.append(tuple(now - then for now, then in zip(spent(), before, strict=True)))

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return times


def table(rows: list[dict]) -> str:
    """The rows in Markdown."""
    cells = [[f"{value:.2f}" if isinstance(value, float) else str(value) for value in row.values()] for row in rows]
    heads = [head.replace("_", " ") for head in rows[0]]
    return "\n".join(f"| {' | '.join(line)} |" for line in [heads, ["---"] * len(heads), *cells])


if __name__ == "__main__":
    if sys.argv[1:2] == [CHILD]:
        child(sys.argv[2], sys.argv[3] == "1")
    elif sys.argv[1:2] == ["core"]:
        print(table(core_threads()))
    else:
        print(table(blas_threads()))
