"""Tables of the paper from finished datasets, as aligned text, CSV (full precision) and LaTeX (booktabs)."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from .data.derived import from_layered, nominal_area_ratio
from .evidence.extremes_map import shares
from .evidence.tradeoff_view import rows as work_precision
from .figures.sources import csv_text, open_studies, pick, write_text
from .paper import numbers
from .spec.vocabulary import VOCABULARY


@dataclass(frozen=True)
class Column:
    """One column: heading in text and in LaTeX, and the format of its numbers."""

    text: str
    latex: str
    form: str = "s"


@dataclass(frozen=True)
class Table:
    """`rows` takes the datasets of the `studies`, in this order, and gives one tuple per row, a value per column."""

    studies: tuple[str, ...]
    caption: str
    columns: tuple[Column, ...]
    rows: Callable


def largest_error(case: xr.Dataset, B: float, beta: float) -> float:
    """Largest |B p^β / A[p] - 1| over the paper's interval; B in R/E1*^β, `case` one case of a micro-law study."""
    law = case.sel(
        p=slice(*(end * factor for end, factor in zip(numbers.ERROR_INTERVAL, (1 - 1e-9, 1 + 1e-9), strict=True)))
    )
    return float(np.abs(B * law["p"] ** beta / law["A_exact"] - 1).max())


def table1(laws: xr.Dataset) -> list[tuple]:
    """Table 1: B E1*^β and β printed, with the error that the paper states and the one that we find; the same refitted,
    with their error."""
    rows = []
    for Ra, Nbar, B, beta in numbers.TABLE1:
        case, density = pick(laws, Ra=Ra, Nbar=Nbar), Nbar * Ra**2
        ours = float(case["B"]) * Ra, float(case["beta"]), float(case["max_error"])
        rows.append((Ra, Nbar, density, B, beta, bound(density), largest_error(case, B, beta), *ours))
    return rows


def bound(density: float) -> str:
    """The paper's words on the error of the fit for a density N̄Ra²."""
    return f"at most {numbers.ERROR_BOUNDS[round(density, 9)]:.0%}"


def paper_numbers(reference: xr.Dataset, main: xr.Dataset, laws: xr.Dataset) -> list[tuple]:
    """Every number that the paper prints beside ours and the relative difference; of a bound, whether it holds."""
    rough, homogeneous = (pick(main, label=f"rough, {base}") for base in ("layered", "homogeneous"))
    first = pick(laws, Ra=numbers.TABLE1[0][0], Nbar=numbers.TABLE1[0][1])
    ours = {"P": reference["P"]}
    ours |= {name: rough[name] for name in ("p0", "Ar_An", "p_max", "D", "A0")}
    ours |= {"An_ratio": nominal_area_ratio(homogeneous, reference["a"])}
    ours |= {f"{name} homogeneous": homogeneous[name] for name in ("Ar_An", "p_max")}
    ours |= {f"D smooth {base}": pick(main, label=f"smooth, {base}")["D"] for base in ("layered", "homogeneous")}
    ours |= {"B": first["B"], "beta": first["beta"]}
    rows = [
        (quantity, printed, float(ours[key]), float(ours[key]) / printed - 1)
        for key, (quantity, printed) in numbers.NUMBERS.items()
    ]
    for Ra, Nbar, B, beta in numbers.TABLE1[:3]:
        error, density = largest_error(pick(laws, Ra=Ra, Nbar=Nbar), B, beta), Nbar * Ra**2
        holds = "holds" if error <= numbers.ERROR_BOUNDS[round(density, 9)] else "does not hold"
        rows.append((f"error of the paper's fit, N Ra^2 = {density:g}", bound(density), error, holds))
    return rows


def validity(given_load: xr.Dataset, given_radius: xr.Dataset) -> list[tuple]:
    """Largest h/a up to which the thin-layer model errs by less than 1 % and 10 %, whatever n from 0.01 to 0.95."""
    rows = []
    for micro in ("smooth", "disc_cell"):
        for name in ("P", "a", "p0", "D", "Ar_An", "p_max"):
            if micro == "smooth" and name in ("Ar_An", "p_max"):
                continue
            found = (given_radius if name == "P" else given_load).sel(micro=micro)
            limits = [
                round(largest_thickness(found.isel(case=i), name, level), 3)
                for i in range(len(MATERIALS))
                for level in (0.01, 0.1)
            ]
            punch, given = "smooth" if micro == "smooth" else "rough", "a" if name == "P" else "P"
            rows.append((punch, VOCABULARY[name].symbol, given, *limits))
    return rows


def largest_thickness(case: xr.Dataset, name: str, level: float) -> float:
    """Smallest h/a, over all n, at which |error| of a quantity exceeds `level`; the error is linear in ln(h/a) between
    the points of the grid."""
    error = from_layered(case, name).transpose("n", "h")
    a = case["a"].sel(base="layered", drop=True) if "base" in case["a"].dims else case["a"]
    h_a = (case["h"] / a).broadcast_like(error).transpose("n", "h")
    crossings = [np.inf]
    for x, e in zip(np.log(h_a.values), error.values, strict=True):
        i = int(np.argmax(np.abs(e) > level))
        if abs(e[i]) > level:
            limit = np.copysign(level, e[i])
            crossings.append(x[i - 1] + (limit - e[i - 1]) * (x[i] - x[i - 1]) / (e[i] - e[i - 1]) if i else x[0])
    return float(np.exp(min(crossings)))


MATERIALS = ("frictionless", "nu=0", "nu=0.3", "nu=0.45")
"""The first cases of the validity studies: without friction, and bonded with equal Poisson ratios."""
TABLES = {
    "table1": Table(
        ("table1",),
        "Power law fitted to the additional displacement of a rough layer: the paper's constants, the error that it"
        " states and the one that we find; our constants and their error.",
        (
            Column("Ra/R", "$R_a/R$", "g"),
            Column("N R^2", r"$\bar N R^2$", "d"),
            Column("N Ra^2", r"$\bar N R_a^2$", "g"),
            Column("B paper", r"$B E_1^{*\beta}/R$ (paper)", ".1e"),
            Column("beta paper", r"$\beta$ (paper)", ".2f"),
            Column("error stated", "error stated"),
            Column("error found", "error found", ".1%"),
            Column("B", r"$B E_1^{*\beta}/R$", ".3e"),
            Column("beta", r"$\beta$", ".4f"),
            Column("error", "error", ".1%"),
        ),
        table1,
    ),
    "paper_numbers": Table(
        ("reference_load", "main_case", "table1"),
        "Numbers printed in the paper and the converged ones of the same model.",
        (
            Column("quantity", "quantity"),
            Column("paper", "paper", ".4g"),
            Column("roughcoat", "roughcoat", ".5e"),
            Column("difference", "difference", "+.2%"),
        ),
        paper_numbers,
    ),
    "validity": Table(
        ("validity", "validity_load"),
        "Largest h/a (0.01 or more) up to which the thin-layer model errs by less than 1% and 10%, n from 0.01 to 0.95;"
        " nu: bonded.",
        (
            Column("punch", "punch"),
            Column("error in", "error in"),
            Column("given", "given"),
            *(Column(f"{name} {level}%", rf"{name}, {level}\%", ".3g") for name in MATERIALS for level in (1, 10)),
        ),
        validity,
    ),
    "extremes": Table(
        ("extremes", "extremes_layered"),
        "Random cases far beyond any scene: share of the cases that have no solution (the thin layer does not apply,"
        " the punch lifts off), shares of the others, error over rtol and iterations of the converged ones.",
        (
            Column("base", "base"),
            Column("law", "law"),
            Column("cases", "cases", "d"),
            *(Column(name, name, ".2%") for name in ("n/a", "lift-off", "converged", "above rtol", "failed")),
            *(Column(name, name.replace("%", r"\%"), ".1e") for name in ("error 50%", "error 99.9%", "error max")),
            *(Column(name, name, ".0f") for name in ("iterations", "max")),
        ),
        shares,
    ),
    "tradeoff": Table(
        ("tradeoff",),
        "Work and precision: time per case on one thread, error of half and of 95% of the cases, largest error,"
        " share of the cases that ended.",
        (
            Column("set", "set"),
            Column("way", "way"),
            Column("setting", "setting"),
            Column("cases", "cases", "d"),
            Column("time/us", r"time/\textmu s", ".1f"),
            *(Column(name, name.replace("%", r"\%"), ".1e") for name in ("error 50%", "error 95%", "largest")),
            Column("ended", "ended", ".1%"),
        ),
        work_precision,
    ),
}


def tabulate(name: str, results="results", tables="tables") -> list[Path]:
    """Write a table as tables/NAME.txt, .csv and .tex; returns the three paths.

    Raises
    ------
    StudyError : there is no such table, or a study it needs has no results
    """
    table, datasets = open_studies(name, TABLES, results)
    rows = table.rows(*datasets)
    texts = {"txt": as_text(table, rows), "csv": as_csv(table, rows), "tex": as_latex(table, rows)}
    return [write_text(Path(tables) / f"{name}.{suffix}", text) for suffix, text in texts.items()]


def as_text(table: Table, rows: list[tuple]) -> str:
    """Columns aligned: text to the left, numbers to the right."""
    cells = [[column.text for column in table.columns], *formatted(table, rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    marks = ["<" if column.form == "s" else ">" for column in table.columns]
    lines = ["  ".join(f"{c:{m}{w}}" for c, m, w in zip(row, marks, widths, strict=True)).rstrip() for row in cells]
    return "\n".join([table.caption, "", lines[0], "-" * max(map(len, lines)), *lines[1:]]) + "\n"


def as_csv(table: Table, rows: list[tuple]) -> str:
    """All digits."""
    return csv_text([column.text for column in table.columns], rows)


def as_latex(table: Table, rows: list[tuple]) -> str:
    """A table environment; needs the package booktabs."""
    form = "".join("l" if column.form == "s" else "r" for column in table.columns)
    lines = [" & ".join(latex(cell) for cell in row) + r" \\" for row in formatted(table, rows)]
    head = " & ".join(column.latex for column in table.columns) + r" \\"
    body = [
        r"\begin{table}",
        r"\centering",
        rf"\caption{{{table.caption}}}",
        rf"\begin{{tabular}}{{{form}}}",
        r"\toprule",
    ]
    return "\n".join([*body, head, r"\midrule", *lines, r"\bottomrule", r"\end{tabular}", r"\end{table}"]) + "\n"


def formatted(table: Table, rows: list[tuple]) -> list[list[str]]:
    """Cells as text; a text in a column of numbers stays as it is."""
    forms = [column.form for column in table.columns]
    return [
        [cell if isinstance(cell, str) else f"{cell:{form}}" for cell, form in zip(row, forms, strict=True)]
        for row in rows
    ]


def latex(cell: str) -> str:
    """A formatted cell for LaTeX: powers of ten written out, percent signs escaped."""
    written_out = re.sub(r"([\d.+-]+)e([+-]\d+)$", lambda found: rf"${found[1]}\times 10^{{{int(found[2])}}}$", cell)
    return written_out.replace("%", r"\%")
