"""docs/speed.md as the benchmark writes it: measured by `python tools/bench/benchmark.py --page docs/speed.md`."""

import os
import platform
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

from benchmark_path import predicted, saved
from benchmark_peers import rough_peers
from benchmark_study import beside_the_solver, whole_run
from benchmark_work import latency, second_core, workloads

from solver import NUMERICS_VERSION
from study.data.provenance import blas, cpu, package_version

PAGE = """# Speed

Written by `make speed` on {date}: {machine}, {cores} processors, Python {python}, numpy {numpy}, {blas}, version
{numerics} of the numerics. Load of the machine before it, over a minute: {load:.1f}. `make bench` measures more. All
figures are of one run; ratios are by turns, in processor time, on one BLAS thread.

## What people run

*r* counts cases in the time of one system of 17 unknowns of stacked `numpy.linalg.solve`, rtol is 1e-6. The floor is
the time of the flops that form the matrices of the layer and eliminate all matrices, at the rate of a large product of
matrices; the rest is the law, the kernel of the layer, profiles and errors, and memory.

{workloads}

## Before anything is computed

Processor time of a new Python, its imports and one contact, by turns with `python -c "import xarray"` (`make start`).
A contact in the terminal is printed without xarray; scipy.special is imported for tables of layers, for panels and for
stresses, pint for units that roughcoat does not write itself.

{start}

## Few cases

A call of so many cases, and that over the time of 1,000 single solutions of 17 unknowns by `numpy.linalg.solve`.

{latency}

## The second core

`study.solve` of 60,000 layered cases. Where the caller alone takes more wall than processor time, others used the
machine, and the gain says little. Processes that wait are those of the call before.

{cores_used}

## A whole run

A million thin rough cases with profiles of 33 points by `python -m study run --workers 2`, from the study file to the
netCDF file, and what the solver alone takes for them.

{run}

## A load axis is no path

Cases that differ in the load only could begin at the solutions of their neighbours. The first table has the processor
time of a study of 8,000 cases, 20 loads each, over that of the solver as it is, if all its first guesses had an error
of 1e-3, 1e-4 or 1e-6 *at no cost*. The second has the errors of guesses from other loads, on {nodes} nodes. By a cubic
through every fourth load three quarters of the cases could be guessed in one batch: with five loads a decade to 1e-3 or
little better, with more to 1e-4 and below. The parabola through the three loads before guesses nearly all, but in
batches of as many cases as there are paths, where a case takes several times as long. What is left is three quarters
of what the first table saves, before anything is paid for the guesses: at most a fifth on layers and a tenth on thin
ones; and the numbers of a case would depend on its company, if only to rtol. So every case begins alone.

{saved}

{predicted}

## A rough sphere with other codes

Asperities on a square lattice, their pitch a tenth of the contact radius. Tamaas and ContactMechanics resolve each on a
grid, roughcoat has its micro law in their place. Errors of D are against the finest grid of each code, and against
rtol = 1e-12: so they say how well a code solves its own model. Seconds are wall time, of one case.

{peers}
"""


def measured_page() -> str:
    """The page, with all that it says measured now."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    run = whole_run()  # must come first
    return PAGE.format(
        date=f"{datetime.now(UTC):%Y-%m-%d}",
        machine=cpu(),
        cores=os.cpu_count(),
        python=platform.python_version(),
        numpy=package_version("numpy"),
        blas=blas(),
        numerics=NUMERICS_VERSION,
        load=load,
        nodes=16,
        run=upright(beside_the_solver(run)),
        start=starts(),
        workloads=table(workloads()),
        latency=table(latency()),
        cores_used=table(second_core()),
        saved=table(saved()),
        predicted=table(predicted()),
        peers="\n\n".join(table(rows) for rows in by_columns(rough_peers())),
    )


def starts() -> str:
    """The table of `make start`."""
    script = Path(__file__).parents[1] / "start" / "benchmark_start.py"
    return subprocess.run([sys.executable, str(script)], check=True, capture_output=True, text=True).stdout.strip()


def by_columns(rows: list[dict]) -> list[list[dict]]:
    """The rows in groups of the same columns."""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row), []).append(row)
    return list(groups.values())


def table(rows: list[dict]) -> str:
    """The rows in Markdown."""
    heads = [name.replace("_", " ") for name in rows[0]]
    lines = [heads, ["---"] + ["---:"] * (len(heads) - 1), *([shown(v) for v in row.values()] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def upright(row: dict) -> str:
    """One row as a table of two columns."""
    return table([{"what": name.replace("_", " "), "found": value} for name, value in row.items()])


def shown(value) -> str:
    """A cell: three digits of a number, thousands of a count."""
    if isinstance(value, (bool, str)):
        return {True: "yes", False: "no"}.get(value, value)
    if isinstance(value, int):
        return f"{value:,}"
    return f"{value:,.0f}" if value >= 1000 else f"{value:.3g}"
