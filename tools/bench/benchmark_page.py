"""The page docs/speed.md, which `python tools/bench/benchmark.py --page docs/speed.md` measures and writes."""

import json
import os
import platform
import re
import subprocess
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from benchmark_cases import seconds
from benchmark_path import predicted, saved
from benchmark_peers import peers, rough_peers
from benchmark_study import beside_the_solver, whole_run
from benchmark_work import latency, second_core, workloads

from solver import NUMERICS_VERSION
from study.data.provenance import blas, cpu, package_version

INTRO = """# Speed

Measured by `make speed`: Python {python}, numpy {numpy}, {blas}, version {numerics} of the numerics. Each section
has its date, its machine and the load of it before, over a minute; its figures are of one run, on one BLAS thread, and
ratios are by turns, in processor time. `make speed ONLY="fits stresses"` measures sections again; `make bench` measures
more.
"""
#: Name of a section, for --only -> its text; the first line has its heading, and `day` the date and the load.
SECTIONS = {
    "workloads": """What people run

{day}

How many contacts a second does roughcoat solve? *r* is the number of cases in the time of one system of 17 unknowns of
stacked `numpy.linalg.solve`; rtol is 1e-6. The floor is the time of the flops that form the matrices of the layer and
eliminate all matrices, at the rate of a large product of matrices. The rest is the law, the kernel of the layer,
profiles and errors, and memory.

{workloads}
""",
    "start": """Before anything is computed

{day}

The table has the processor time of a new Python, its imports and one contact, measured by turns with
`python -c "import xarray"` (`make start`). A contact in the terminal needs no xarray. Tables of layers, panels and
stresses import scipy.special; units that roughcoat does not write itself import pint.

{start}
""",
    "latency": """Few cases

{day}

The table has the time of a call with a given number of cases, also over the time of 1,000 single solutions of 17
unknowns by `numpy.linalg.solve`.

{latency}
""",
    "cores_used": """The second core

{day}

The table has `study.solve` of 60,000 layered cases. Where the caller alone takes more wall time than processor time,
other programs used the machine, and the gain says little. Waiting processes are those of the call before.

{cores_used}
""",
    "run": """A whole run

{day}

`python -m study run --workers 2` computes a million thin rough cases with profiles of 33 points, from the study file to
the netCDF file. The last rows have the time of the solver alone for these cases.

{run}

Largest stresses stream in blocks too: a study of smooth contacts on a half-space with `[output] stresses = true` takes
167 MB for 5,000 of them and 310 MB for 1,000,000, which are computed in 19 minutes of one processor
(2026-11-30, `python tools/fields/study_memory.py 1000000`).
""",
    "paths": """A load axis is no path

{day}

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
""",
    "fits": """Fits and scans

{day}

Seconds are processor time of one curve, in a warm process, with intervals by profiles. Under Maugis w lies between
bounds of a factor of 20. The plain fits are without intervals, as that of nanite. The time of a text is over that of
`numpy.loadtxt` of the same text without missing points. The memory of a scan is the largest of three ways to read and
measure it, with a low-pass, a sphere or spikes.

{fits}
""",
    "stresses": """Stresses and first yield

{day}

Seconds are processor time, of the first call in a process and of the shortest of the next. Where nothing else is said a
smooth alumina ball of 5 mm presses on 3 µm of TiN bonded to steel 52100, with 0.1 to 100 N
(`python tools/fields/benchmark_extremes.py`).

{extremes}

The next table has the largest Mises stress below Hertz's pressure on a half-space, by wall time
(`python tools/fields/stress_peers.py`). Tamaas has a periodic body, 8 a wide, and 33 depths; slippy, whose kernels are
taken with the FFT of scipy, a free one, 2.5 a wide, and 16 depths. Both compute all stresses on a grid and have no
layers; roughcoat solves the contact too and searches the maximum.

{stress_peers}
""",
    "smooth_sphere": """A smooth sphere with other codes

{day}

Seconds are wall time of one contact of a sphere on a half-space; errors of D are against Hertz's closed form. The other
codes have a grid 3 a wide. roughcoat has the exact layer, of the material of the body: on a half-space it would only
evaluate the closed form.

{smooth_peers}
""",
    "rough_sphere": """A rough sphere with other codes

{day}

The asperities are on a square lattice, with a pitch of a tenth of the contact radius. Tamaas and ContactMechanics
resolve each asperity on a grid, and roughcoat has its micro law instead. Errors of D are against the finest grid of
each code, and against rtol = 1e-12: they say how well a code solves its own model. Seconds are wall time, for one case.

{peers}
""",
}
#: The whole page.
PAGE = "\n## ".join([INTRO, *SECTIONS.values()])


def measured_page(old: str = "", only: Sequence[str] = ()) -> str:
    """The page, with all its numbers measured now; or the old one with the sections `only` measured again."""
    wanted = list(only) or list(SECTIONS)
    texts = {name: section(name) for name in sorted(wanted, key=lambda name: name != "run")}  # the run must come first
    parts = {part.partition("\n")[0]: part for part in old.split("\n## ")[1:]}
    for name, text in SECTIONS.items():
        texts.setdefault(name, parts.get(text.partition("\n")[0], ""))
    intro = old.split("\n## ")[0] if only else INTRO.format(**about_machine())
    return "\n## ".join([intro.rstrip("\n") + "\n", *(texts[name] for name in SECTIONS)])


def section(name: str) -> str:
    """A section, measured now."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    day = f"Measured on {datetime.now(UTC):%Y-%m-%d}, {cpu()}, load {load:.1f}."
    words = re.findall(r"\{(\w+)\}", SECTIONS[name])
    return SECTIONS[name].format(day=day, **{word: FIGURES[word]() for word in words if word != "day"})


def about_machine() -> dict:
    """What the page says of the machine and of the packages."""
    return {
        "python": platform.python_version(),
        "numpy": package_version("numpy"),
        "blas": blas(),
        "numerics": NUMERICS_VERSION,
    }


def printed(name: str) -> str:
    """The tables that a script of tools prints, such as those of `make start`."""
    script = Path(__file__).parents[1] / name
    return subprocess.run([sys.executable, str(script)], check=True, capture_output=True, text=True).stdout.strip()


def rows_of(name: str) -> list[dict]:
    """The rows that a script of tools prints as JSON."""
    script = Path(__file__).parents[1] / name
    run = subprocess.run([sys.executable, str(script), "--json"], check=True, capture_output=True, text=True)
    return json.loads(run.stdout)


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


#: Placeholder of a section -> the function that measures its text.
FIGURES = {
    "workloads": lambda: table(workloads()),
    "start": lambda: printed("start/benchmark_start.py"),
    "latency": lambda: table(latency()),
    "cores_used": lambda: table(second_core()),
    "run": lambda: upright(beside_the_solver(whole_run())),
    "nodes": lambda: "16",
    "saved": lambda: table(saved()),
    "predicted": lambda: table(predicted()),
    "fits": lambda: printed("fit/benchmark_fits.py"),
    "extremes": lambda: table(rows_of("fields/benchmark_extremes.py")),
    "stress_peers": lambda: "\n\n".join(table(rows) for rows in by_columns(rows_of("fields/stress_peers.py"))),
    "smooth_peers": lambda: "\n\n".join(table(rows) for rows in by_columns(peers(seconds))),
    "peers": lambda: "\n\n".join(table(rows) for rows in by_columns(rough_peers())),
}
