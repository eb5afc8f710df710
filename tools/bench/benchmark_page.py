"""The page docs/speed.md, which `python tools/bench/benchmark.py --page docs/speed.md` measures and writes."""

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

How many contacts a second does roughcoat solve? *r* is the number of cases in the time of one system of 17 unknowns of
stacked `numpy.linalg.solve`; rtol is 1e-6. The floor is the time of the flops that form the matrices of the layer and
eliminate all matrices, at the rate of a large product of matrices. The rest is the law, the kernel of the layer,
profiles and errors, and memory.

{workloads}

## Before anything is computed

The table has the processor time of a new Python, its imports and one contact, measured by turns with
`python -c "import xarray"` (`make start`). A contact in the terminal needs no xarray. Tables of layers, panels and
stresses import scipy.special; units that roughcoat does not write itself import pint.

{start}

## Few cases

The table has the time of a call with a given number of cases, also over the time of 1,000 single solutions of 17
unknowns by `numpy.linalg.solve`.

{latency}

## The second core

The table has `study.solve` of 60,000 layered cases. Where the caller alone takes more wall time than processor time,
other programs used the machine, and the gain says little. Waiting processes are those of the call before.

{cores_used}

## A whole run

`python -m study run --workers 2` computes a million thin rough cases with profiles of 33 points, from the study file to
the netCDF file. The last rows have the time of the solver alone for these cases.

{run}

## A load axis is no path

Cases that differ in the load only could begin at the solutions of their neighbours. The first table has the processor
time of a study of 8,000 cases, 20 loads each, over that of the present solver, if all its first guesses had an error
of 1e-3, 1e-4 or 1e-6 *at no cost*. The second has the errors of guesses from other loads, on {nodes} nodes. A cubic
through every fourth load could guess three quarters of the cases in one batch: with five loads a decade to 1e-3 or
little better, with more to 1e-4 and below. The parabola through the three loads before could guess nearly all cases,
but in batches of as many cases as there are paths, where a case takes several times as long. So three quarters of the
saving in the first table are left, without the cost of the guesses: at most a fifth on layers and a tenth on thin
layers. And the numbers of a case would depend on its company, if only to rtol. So every case begins alone.

{saved}

{predicted}

## Fits and scans

Seconds are processor time of one curve of 80 points, in a warm process, with intervals by profiles. Under Maugis w lies
between bounds of a factor of 20. `make bench` prints the same, and a fit of nanite if that is installed.

{fits}

## A rough sphere with other codes

The asperities are on a square lattice, with a pitch of a tenth of the contact radius. Tamaas and ContactMechanics
resolve each asperity on a grid, and roughcoat has its micro law instead. Errors of D are against the finest grid of
each code, and against rtol = 1e-12: they say how well a code solves its own model. Seconds are wall time, for one case.

{peers}
"""


def measured_page() -> str:
    """The page, with all its numbers measured now."""
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
        start=printed("start/benchmark_start.py"),
        fits=printed("fit/benchmark_fits.py"),
        workloads=table(workloads()),
        latency=table(latency()),
        cores_used=table(second_core()),
        saved=table(saved()),
        predicted=table(predicted()),
        peers="\n\n".join(table(rows) for rows in by_columns(rough_peers())),
    )


def printed(name: str) -> str:
    """The tables that a script of tools prints, such as those of `make start`."""
    script = Path(__file__).parents[1] / name
    return subprocess.run([sys.executable, str(script)], check=True, capture_output=True, text=True).stdout.strip()


def by_columns(rows: list[dict]) -> list[list[dict]]:
    """The rows in groups with the same columns."""
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
