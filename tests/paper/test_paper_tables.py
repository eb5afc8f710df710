"""Tables: the numbers of MODEL.md's converged column, and the three formats."""

import csv

import numpy as np
import pytest
import xarray as xr
from conftest import opened

from study import StudyError
from study.catalogue import entry, names, tabulate
from study.figures import registry
from study.figures.formats import as_latex, as_text, latex
from study.figures.registry import DataTable, column
from study.studies.evidence.validity_maps import largest_thickness
from study.studies.paper import law_fits, numbers
from study.studies.paper.paper_error import paper_numbers

CONVERGED = {  # of the thin-layer equation with the power law; every digit stable under refinement
    "P": 2.70408e-5,
    "p0": 0.010448,
    "Ar_An": 0.18478,
    "p_max": 0.05271,
    "D": 1.04362e-3,
    "A0": 5.782e-5,
    "An_ratio": 0.56612,
    "Ar_An homogeneous": 0.17145,
    "p_max homogeneous": 0.09693,
    "D smooth layered": 1.00510e-3,
    "D smooth homogeneous": 7.43681e-4,
}
DIGITS = {"p0": 5, "p_max": 4, "A0": 4, "p_max homogeneous": 4, "Ar_An": 5, "An_ratio": 5, "Ar_An homogeneous": 5}


def rows_of(path) -> list[list[str]]:
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def test_paper_numbers_are_the_converged_ones(tables):
    rows = rows_of(tables / "paper_numbers.csv")[1:-3]  # the last three are bounds
    ours = {key: float(row[2]) for key, row in zip(numbers.NUMBERS, rows, strict=True)}
    for key, value in CONVERGED.items():
        digits = DIGITS.get(key, 6)
        # both are the same decimal number
        assert float(f"{ours[key]:.{digits - 1}e}") == pytest.approx(value, rel=1e-12), key
    for row in rows:
        assert float(row[3]) == pytest.approx(float(row[2]) / float(row[1]) - 1)
        assert abs(float(row[3])) < 0.05


def test_load_of_the_other_studies_is_that_of_the_reference(results):
    reference = float(opened(results / "reference_load.nc")["P"])
    for study in ("main_case", "spot_density"):
        assert float(opened(results / f"{study}.nc")["P"]) == pytest.approx(reference, rel=2e-8)


def test_table1_refits_the_paper(tables):
    rows = rows_of(tables / "table1.csv")[1:]
    expected = {"4.0": (0.0919, 0.4908, 0.077), "1.0": (0.3157, 0.5342, 0.042), "0.25": (1.0006, 0.5664, 0.025)}
    for Ra, _, ratio, _, _, _, found, B, beta, error in rows:
        coefficient, exponent, largest = expected[ratio]
        assert round(float(B) / float(Ra), 4) == coefficient
        assert round(float(beta), 4) == exponent
        assert round(float(found), 3) == largest
        assert 0 < float(error) < 0.05


def test_a_bound_of_the_paper_that_does_not_hold_is_called_so(results, monkeypatch):
    monkeypatch.setitem(numbers.ERROR_BOUNDS, 4.0, 0.07)
    studies = (opened(results / f"{name}.nc") for name in ("reference_load", "main_case"))
    assert [row[1:4:2] for row in paper_numbers(*studies)[-3:]] == [
        ("at most 7%", "does not hold"), ("at most 5%", "holds"), ("at most 5%", "holds"),
    ]  # fmt: skip


def test_error_of_printed_constants_covers_the_whole_interval():
    """The fitted constants, measured as the printed ones are, have the error that the fit itself reports."""
    fit = law_fits.fitted(0.004, 250_000)
    A = fit.B * law_fits.PRESSURES**fit.beta
    assert law_fits.largest_error(A, law_fits.exact(0.004, 250_000)) == pytest.approx(fit.max_error, rel=1e-3)


def test_the_error_counts_both_ends_of_the_interval_and_nothing_beyond(monkeypatch):
    p = np.array([0.0024, 0.0025, 0.01, 0.025, 0.0251])
    monkeypatch.setattr(law_fits, "PRESSURES", p)
    for errors, largest in (([9, 0.2, 0.1, 0.3, 9], 0.3), ([9, 0.4, -0.1, 0.3, 9], 0.4), ([9, 0.1, -0.5, 0.3, 9], 0.5)):
        true = 2 * p**0.5 / (1 + np.array(errors))
        # rounding of a ratio
        assert law_fits.largest_error(2 * p**0.5, true) == pytest.approx(largest, rel=1e-12)


@pytest.mark.parametrize(
    ("errors", "thickness"),
    [
        ([[0.0, 0.0, 0.2, 0.4]], 1.0 * 10**0.5),  # half-way from 0 to 0.2, in ln(h/a)
        ([[0.0, 0.0, -0.2, 0.4]], 1.0 * 10**0.5),  # too small counts as too large
        ([[0.0, 0.0, -0.2, -0.4]], 1.0 * 10**0.5),  # also where it is too small everywhere
        ([[-0.3, -0.3, -0.3, -0.3]], 0.1),
        ([[0.05, 0.2, 0.0, 0.0]], 0.1 * 10 ** (1 / 3)),  # beyond it only for a while
        ([[0.3, 0.3, 0.3, 0.3]], 0.1),  # nowhere within: the thinnest of the study
        ([[0.05, 0.05, 0.05, 0.05]], np.inf),
        ([[0.05, 0.05, 0.05, 0.05], [0.0, 0.0, 0.0, 0.2], [0.0, 0.0, 0.0, 0.4]], 10 * 10**0.25),  # the worst n
        ([[np.nan] * 4, [0.0, 0.0, 0.2, 0.4]], 1.0 * 10**0.5),  # does not apply for one n
    ],
)
@pytest.mark.parametrize("given", ["a", "P"])
def test_the_largest_thickness_is_where_the_error_first_exceeds_the_level(errors, thickness, given):
    """h/a = 0.1, 1, 10, 100 with the a of the exact layer: given, or 0.5 there and other on the thin layer."""
    radius, h = (0.5, 0.5 * 10.0 ** np.arange(-1, 3)) if given == "P" else (1.0, 10.0 ** np.arange(-1, 3))
    exact = np.full_like(errors, 3.0)
    thin = exact * (1 + np.array(errors))
    a = xr.DataArray([7.0, radius], dims="base") if given == "P" else xr.DataArray(radius)
    coordinates = {"base": ["thin_layer", "layered"], "n": 0.1 * np.arange(1, len(errors) + 1), "h": h}
    case = xr.Dataset({"p0": (("h", "base", "n"), np.array([thin, exact]).transpose(2, 0, 1)), "a": a}, coordinates)
    # interpolation between two numbers
    assert largest_thickness(case, "p0", 0.1) == pytest.approx(thickness, rel=1e-12)
    below = case.assign(p0=(("h", "base", "n"), np.array([2 * exact - thin, exact]).transpose(2, 0, 1)))
    assert largest_thickness(below, "p0", 0.1) == pytest.approx(thickness, rel=1e-12), "too small is as wrong"


@pytest.mark.parametrize("name", names("table"))
def test_text_is_aligned(tables, name):
    caption, _, head, rule, *lines = (tables / f"{name}.txt").read_text(encoding="utf-8").splitlines()
    assert caption and caption == entry("table", name).caption
    assert set(rule) == {"-"} and len(rule) == max(map(len, [head, *lines]))
    assert len({len(line) for line in lines}) == 1


@pytest.mark.parametrize("name", names("table"))
def test_latex_has_every_cell(tables, name):
    text = (tables / f"{name}.tex").read_text(encoding="utf-8")
    columns = len(entry("table", name).columns)
    body = [line for line in text.splitlines() if line.endswith(r"\\")]
    assert len(body) == len(rows_of(tables / f"{name}.csv"))
    assert all(line.count("&") == columns - 1 for line in body)
    assert not any(mark in line.replace(r"\%", "") for line in body[1:] for mark in ("%", "_", "#"))
    assert text.count(r"\begin{") == text.count(r"\end{") == 2


def test_formats_of_cells():
    assert latex("2.70e-05") == r"$2.70\times 10^{-5}$"
    assert latex("+4.5%") == r"+4.5\%"
    assert latex("nominal pressure") == "nominal pressure"
    assert latex("does not hold") == "does not hold"
    assert latex("thin_layer & #1 of p^2") == r"thin\_layer \& \#1 of p\^{}2"
    assert latex(r"5 % of $a_1^2$") == r"5 \% of $a_1^2$"
    table = DataTable((), tuple, "below 1% all is text", (column("of a_b"), column("number | .1% | $x$")))
    rows = [("one", 0.077), ("two", "at most 8%")]
    assert as_text(table, rows).splitlines()[4:] == ["one           7.7%", "two     at most 8%"]
    caption, _, _, head = as_latex(table, rows).splitlines()[2:6]
    assert (caption, head) == (r"\caption{below 1\% all is text}", r"of a\_b & $x$ \\")
    assert as_latex(table, rows).splitlines()[7:9] == [r"one & 7.7\% \\", r"two & at most 8\% \\"]


def test_columns_may_share_a_line(monkeypatch):
    """A thin space in mathtext separates no columns."""
    monkeypatch.setattr(registry, "REGISTERS", {"": {"table": {}}})
    registry.table("shared", columns="of; number | d | $N\\; R$\n    last | .1%")(list)
    assert registry.entry("table", "shared").columns == tuple(
        map(column, ("of", "number | d | $N\\; R$", "last | .1%"))
    )


def test_messages_of_table(results, tmp_path):
    with pytest.raises(StudyError, match='did you mean "table1"?'):
        tabulate("table2", results, tmp_path)
    with pytest.raises(StudyError, match="reference_load.nc: does not exist"):
        tabulate("paper_numbers", tmp_path, tmp_path)
