"""Every cell of every table, in text, CSV and LaTeX, against the datasets and against what the paper prints."""

import csv
import re

import pytest
from expected_tables import EXPECTED

from study.catalogue import names


def in_latex(cell: str) -> str:
    """Numbers with an exponent are written out, also after a word: "rtol 1e-06"."""
    *words, last = cell.replace("^", "\\^{}").split(" ")
    mantissa, _, exponent = last.partition("e")
    if exponent.lstrip("+-").isdecimal():
        last = f"${mantissa}\\times 10^{{{int(exponent)}}}$"
    return " ".join([*words, last]).replace("%", "\\%")


# Heading in text, heading in LaTeX, format of the cells: s text, otherwise a number.
HEADS = {
    "table1": [
        ("Ra/R", r"$R_a/R$", "g"),
        ("N R^2", r"$\bar N R^2$", "d"),
        ("N Ra^2", r"$\bar N R_a^2$", "g"),
        ("B paper", r"$B E_1^{*\beta}/R$ (paper)", ".1e"),
        ("beta paper", r"$\beta$ (paper)", ".2f"),
        ("error stated", "error stated", "s"),
        ("error found", "error found", ".1%"),
        ("B", r"$B E_1^{*\beta}/R$", ".3e"),
        ("beta", r"$\beta$", ".4f"),
        ("error", "error", ".1%"),
    ],
    "table1_lattice": [
        *(("Ra/R", r"$R_a/R$", "g"), ("N R^2", r"$\bar N R^2$", "d"), ("N Ra^2", r"$\bar N R_a^2$", "g")),
        *((f"{name} off", f"{name} off", ".1%") for name in ("paper's fit", "disc cell")),
        *(("B", r"$B E_1^{*\beta}/R$", ".3e"), ("beta", r"$\beta$", ".4f"), ("error", "error", ".1%")),
    ],
    "paper_numbers": [
        ("quantity", "quantity", "s"),
        ("paper", "paper", ".4g"),
        ("roughcoat", "roughcoat", ".5e"),
        ("difference", "difference", "+.2%"),
    ],
    "validity": [
        ("punch", "punch", "s"),
        ("error in", "error in", "s"),
        ("given", "given", "s"),
        ("frictionless 1%", r"frictionless, 1\%", ".3g"),
        ("frictionless 10%", r"frictionless, 10\%", ".3g"),
        ("nu=0 1%", r"nu=0, 1\%", ".3g"),
        ("nu=0 10%", r"nu=0, 10\%", ".3g"),
        ("nu=0.3 1%", r"nu=0.3, 1\%", ".3g"),
        ("nu=0.3 10%", r"nu=0.3, 10\%", ".3g"),
        ("nu=0.45 1%", r"nu=0.45, 1\%", ".3g"),
        ("nu=0.45 10%", r"nu=0.45, 10\%", ".3g"),
    ],
    "extremes": [
        ("base", "base", "s"),
        ("law", "law", "s"),
        ("cases", "cases", "d"),
        ("n/a", "n/a", ".2%"),
        ("lift-off", "lift-off", ".2%"),
        ("outside law", "outside law", ".2%"),
        ("converged", "converged", ".2%"),
        ("above rtol", "above rtol", ".2%"),
        ("failed", "failed", ".2%"),
        ("error 50%", r"error 50\%", ".1e"),
        ("error 99.9%", r"error 99.9\%", ".1e"),
        ("error max", "error max", ".1e"),
        ("iterations", "iterations", ".0f"),
        ("max", "max", ".0f"),
    ],
    "tradeoff": [
        ("set", "set", "s"),
        ("way", "way", "s"),
        ("setting", "setting", "s"),
        ("cases", "cases", "d"),
        ("time/us", r"time/\textmu s", ".1f"),
        ("error 50%", r"error 50\%", ".1e"),
        ("error 95%", r"error 95\%", ".1e"),
        ("largest", "largest", ".1e"),
        ("ended", "ended", ".1%"),
    ],
    "tradeoff_cheapest": [
        ("set", "set", "s"),
        ("way", "way", "s"),
        *((target, in_latex(target), ".3g") for target in ("0.01", "0.001", "0.0001", "1e-06", "1e-09")),
    ],
    "tradeoff_factors": [
        ("error", "error", "g"),
        ("the paper's way", "the paper's way", ".3g"),
        ("with", "with", "s"),
        ("Newton", "Newton", ".3g"),
        ("factor", "factor", ".0f"),
    ],
    "paper_error": [
        ("quantity", "quantity", "s"),
        ("paper", "paper", ".4g"),
        ("converged", "converged", ".5g"),
        ("converged off", "converged off", "+.2%"),
        ("iterates", "iterates", ".5g"),
        ("iterates off", "iterates off", "+.2%"),
    ],
    "literature": [
        *((text, text, "s") for text in ("formula", "interface")),
        *(("nu", r"$\nu$", "s"), ("constants read in", "constants read in", "s")),
        *(("1%", r"1\%", "s"), ("5%", r"5\%", "s")),
        *((f"a/h = {x}", f"$a/h = {x}$", "+.2%") for x in ("0.1", "0.5", "1", "2", "4")),
    ],
    "literature_coatings": [
        *((text, text, "s") for text in ("formula", "constants read in")),
        *(("a/h up to", "$a/h$ up to", "g"), ("1%", r"1\%", "s"), ("5%", r"5\%", "s")),
        *((f"n = {n}", f"$n = {n}$", ".2%") for n in ("0.01", "0.1", "0.5", "2", "10", "100")),
    ],
    "literature_decided": [
        *((text, text, "s") for text in ("quantity", "by")),
        *(("says", "says", ".4g"), ("exact", "exact", ".5g"), ("off by", "off by", "+.1%")),
    ],
    "literature_rough": [
        *(("alpha", r"$\alpha$", "g"), ("mu", r"$\mu$", "g"), ("Ra/R", "$R_a/R$", "g")),
        ("lambda(0)", r"$\lambda(0)$", ".2g"),
        *((f"p(0), {by}", f"$p(0)$, {by}", ".4f") for by in ("Greenwood and Tripp", "with neighbours")),
        ("p(0) off by", "$p(0)$ off by", "+.1%"),
        *((f"radius, {by}", f"radius, {by}", ".4f") for by in ("Greenwood and Tripp", "with neighbours")),
        ("radius off by", "radius off by", "+.1%"),
    ],
}


TOLERANCE = {"validity": {"rel": 2e-4, "abs": 5e-4}}


def rows_of(path) -> list[list[str]]:
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def test_every_table_is_checked():
    """tests/evidence/test_tradeoff_shown.py has the numbers of two, tests/literature/test_literature.py of four,
    tests/paper/test_lattice_laws.py of one."""
    elsewhere = {"tradeoff_cheapest", "tradeoff_factors", "table1_lattice"}
    elsewhere |= {"literature", "literature_coatings", "literature_decided", "literature_rough"}
    punches = {"literature_pull_off", "literature_shapes"}  # tests/literature/test_tables_of_punches.py
    assert set(EXPECTED) | elsewhere == set(HEADS) == set(names("table")) - punches


@pytest.mark.parametrize("name", EXPECTED)
def test_csv_holds_the_numbers_of_the_datasets(tables, results, name):
    head, *rows = rows_of(tables / f"{name}.csv")
    assert head == [text for text, _, _ in HEADS[name]]
    close = TOLERANCE.get(name, {"rel": 1e-12, "abs": 1e-15})  # the same arithmetic, written with all digits
    for row, expected in zip(rows, EXPECTED[name](results), strict=True):
        for cell, value in zip(row, expected, strict=True):
            if isinstance(value, str):
                assert cell == value
            else:
                assert float(cell) == pytest.approx(value, **close), (row, cell)


@pytest.mark.parametrize("name", HEADS)
def test_text_and_latex_hold_the_cells_of_the_csv(tables, name):
    head, *rows = rows_of(tables / f"{name}.csv")
    forms = [form for _, _, form in HEADS[name]]
    cells = [[as_printed(cell, form) for cell, form in zip(row, forms, strict=True)] for row in rows]
    _, blank, *lines = (tables / f"{name}.txt").read_text(encoding="utf-8").splitlines()
    assert blank == "" and set(lines[1]) == {"-"}
    assert [re.split(r" {2,}", line.strip()) for line in (lines[0], *lines[2:])] == [head, *cells]
    text = (tables / f"{name}.tex").read_text(encoding="utf-8")
    body = [line.removesuffix(r" \\").split(" & ") for line in text.splitlines() if line.endswith(r"\\")]
    assert body == [[latex for _, latex, _ in HEADS[name]], *([in_latex(cell) for cell in row] for row in cells)]
    columns = "".join("l" if form == "s" else "r" for form in forms)
    assert rf"\begin{{tabular}}{{{columns}}}" in text


def as_printed(cell: str, form: str) -> str:
    """A cell of the CSV in the format of its column; words stay."""
    try:
        number = float(cell)
    except ValueError:
        return cell
    return cell if form == "s" else f"{int(number) if form == 'd' else number:{form}}"


def test_the_first_line_says_what_the_table_shows(tables):
    for name, words in {
        "table1": "the paper's constants, the error that it states and the one that we find; our constants and their",
        "paper_numbers": "Numbers printed in the paper and the converged ones",
        "validity": "Largest h/a (0.01 or more) up to which the thin-layer model errs by less than 1% and 10%",
    }.items():
        assert words in (tables / f"{name}.txt").read_text(encoding="utf-8").splitlines()[0]
