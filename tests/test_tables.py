"""Tables: the numbers of MODEL.md's converged column, and the three formats."""

import csv

import pytest

from study import StudyError, open_results, paper
from study.outputs import pick
from study.tables import TABLES, as_csv, as_latex, as_text, largest_error, latex, tabulate

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


@pytest.fixture(scope="module")
def written(results, tmp_path_factory):
    folder = tmp_path_factory.mktemp("tables")
    for name in TABLES:
        tabulate(name, results, folder)
    return folder


def rows_of(path) -> list[list[str]]:
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def test_paper_numbers_are_the_converged_ones(written):
    rows = rows_of(written / "paper_numbers.csv")[1:]
    ours = {key: float(row[2]) for key, row in zip(paper.NUMBERS, rows, strict=True)}
    for key, value in CONVERGED.items():
        digits = DIGITS.get(key, 6)
        assert float(f"{ours[key]:.{digits - 1}e}") == pytest.approx(value, rel=1e-12), key
    for row in rows:
        assert float(row[3]) == pytest.approx(float(row[2]) / float(row[1]) - 1)
        assert abs(float(row[3])) < 0.05


def test_load_of_the_other_studies_is_that_of_the_reference(results):
    reference = float(open_results(results / "reference_load.nc")["P"])
    for study in ("main_case", "spot_density"):
        assert float(open_results(results / f"{study}.nc")["P"]) == pytest.approx(reference, rel=2e-8)


def test_table1_refits_the_paper(written):
    rows = [[float(cell) for cell in row] for row in rows_of(written / "table1.csv")[1:]]
    assert [tuple(row[:2]) for row in rows] == [tuple(map(float, row[:2])) for row in paper.TABLE1]
    expected = {4.0: (0.0919, 0.4908, 0.077), 1.0: (0.3157, 0.5342, 0.042), 0.25: (1.0006, 0.5664, 0.025)}
    for Ra, _, ratio, _, _, printed_error, B, beta, error in rows:
        coefficient, exponent, largest = expected[round(ratio, 9)]
        assert round(B / Ra, 4) == coefficient
        assert round(beta, 4) == exponent
        assert round(printed_error, 3) == largest
        assert 0 < error < 0.05


def test_error_of_printed_constants_covers_the_whole_interval(results):
    """The fitted constants, measured as the printed ones are, have the error that the fit itself reports."""
    case = pick(open_results(results / "table1.nc"), Ra=0.004, Nbar=250_000)
    error = largest_error(case, float(case["B"]) * 0.004, float(case["beta"]))
    assert error == pytest.approx(float(case["max_error"]), rel=1e-3)


@pytest.mark.parametrize("name", TABLES)
def test_text_is_aligned(written, name):
    caption, _, head, rule, *lines = (written / f"{name}.txt").read_text(encoding="utf-8").splitlines()
    assert caption == TABLES[name].caption
    assert set(rule) == {"-"} and len(rule) == max(map(len, [head, *lines]))
    assert len({len(line) for line in lines}) == 1


@pytest.mark.parametrize("name", TABLES)
def test_latex_has_every_cell(written, name):
    text = (written / f"{name}.tex").read_text(encoding="utf-8")
    columns = len(TABLES[name].columns)
    body = [line for line in text.splitlines() if line.endswith(r"\\")]
    assert len(body) == len(rows_of(written / f"{name}.csv"))
    assert all(line.count("&") == columns - 1 for line in body)
    assert not any(mark in line.replace(r"\%", "") for line in body[1:] for mark in ("%", "_", "#"))
    assert text.count(r"\begin{") == text.count(r"\end{") == 2


def test_formats_of_cells():
    assert latex("2.70e-05") == r"$2.70\times 10^{-5}$"
    assert latex("+4.5%") == r"+4.5\%"
    assert latex("nominal pressure") == "nominal pressure"
    table = TABLES["table1"]
    row = (0.004, 250_000, 4.0, 4e-4, 0.5, 0.077, 3.677e-4, 0.4908, 0.046)
    assert as_csv(table, [row]).splitlines()[1] == "0.004,250000,4.0,0.0004,0.5,0.077,0.0003677,0.4908,0.046"
    assert "7.7%" in as_text(table, [row]) and r"7.7\%" in as_latex(table, [row])


def test_messages_of_table(results, tmp_path):
    with pytest.raises(StudyError, match='did you mean "table1"?'):
        tabulate("table2", results, tmp_path)
    with pytest.raises(StudyError, match="table1.nc: does not exist"):
        tabulate("table1", tmp_path, tmp_path)
