"""A study of a million thin rough cases with profiles by `python -m study run`, from file to dataset; and the time of
the solver alone for such cases on two threads and on one."""

import resource
import subprocess
import sys
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from solver import Problem, solve
from study.inputs.reading import from_tables
from study.work.cases import parcel

STUDY = """
[model]
micro = "disc_cell"
base = "thin_layer"
bonding = "bonded"
n = 0.5

[axes]
P = { start = 1e-7, stop = 1e-3, num = 100, spacing = "log" }
Ra = { start = 5e-4, stop = 1e-2, num = 10, spacing = "log" }
Nbar = { start = 1e5, stop = 1e6, num = 10, spacing = "log" }
h = { start = 1e-3, stop = 0.1, num = 10, spacing = "log" }
nu1 = { start = 0.2, stop = 0.38, num = 10 }

[numerics]
rtol = 1e-6

[output]
x = 33
"""
DEFINITION = from_tables(tomllib.loads(STUDY), "million", STUDY, "million")
WORKERS, BLOCK, DRAWN, REPEATS = 2, 8000, 64_000, 3


def whole_run() -> dict:
    """Wall time of the run, memory of the largest of its 1 + WORKERS processes, and size of the dataset. It must come
    first: the measured memory of a child starts from that of this process."""
    with TemporaryDirectory() as folder:
        path = Path(folder, "million.toml")
        path.write_text(STUDY, encoding="utf-8")
        command = [sys.executable, "-m", "study", "run", str(path), "--workers", str(WORKERS), "--yes"]
        start = time.perf_counter()
        subprocess.run(command, cwd=folder, check=True, stderr=subprocess.DEVNULL)
        seconds = time.perf_counter() - start
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
        size = Path(folder, "results", "million.nc").stat().st_size
    row = {"cases": DEFINITION.grid.size, "profile_points": len(DEFINITION.x), "workers": WORKERS}
    return row | {"seconds": seconds, "peak_bytes_of_a_process": peak, "result_bytes": size}


def beside_the_solver(row: dict) -> dict:
    """The row of a run, with the time of the solver alone for the same cases (from DRAWN of them), and its share."""
    drawn = np.random.default_rng(0).permutation(row["cases"])[:DRAWN]
    blocks = [parcel(DEFINITION, drawn[i : i + BLOCK]) for i in range(0, DRAWN, BLOCK)]
    problems = [Problem.of(**block.parameters) for block in blocks]
    alone, on_one_thread = (
        min(_seconds(problems, DEFINITION.x, threads) for _ in range(REPEATS)) * row["cases"] / DRAWN
        for threads in (WORKERS, 1)
    )
    row |= {"solver_seconds": alone, "share_of_solver_rate": alone / row["seconds"]}
    return row | {"solver_seconds_one_thread": on_one_thread, "over_one_thread": row["seconds"] / on_one_thread}


def _seconds(problems: list[Problem], x: np.ndarray, threads: int) -> float:
    start = time.perf_counter()
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(lambda problem: solve(problem, x), problems))
    return time.perf_counter() - start
