"""Several contacts from the command line: lists in `point`, and the rows of a study for a spreadsheet."""

import csv
import json

import numpy as np
import pytest
from test_cli import GOOD, studies  # noqa: F401

import study
from study.__main__ import main
from study.commands import spreadsheet
from study.commands.point import listed
from study.figures.formats import csv_text
from study.in_words.text import columns

BALL = {"R": "5 mm", "E2": "70 ± 7 GPa", "nu2": 0.33, "base": "half_space", "micro": "smooth"}
WORDS = [f"{name}={value}" for name, value in BALL.items()]


def cells(line: str) -> list[str]:
    return [cell for cell in line.split("  ") if cell]


def test_a_list_is_a_table_of_the_contacts(capsys):
    """Each cell is what `point` says of that load alone."""
    assert main(["point", *WORDS, "P=1 N, 2 N,  5 N"]) == 0
    head, *lines = capsys.readouterr().out.splitlines()
    assert head.split() == ["P", "a", "D", "p0", "dP_dD", "status"]
    assert [cells(line)[0] for line in lines] == ["1 N", "2 N", "5 N"]
    for line in lines:
        load, *found, status = cells(line)
        assert main(["point", *WORDS, f"P={load}"]) == 0
        alone = capsys.readouterr().out
        assert all(f"= {text.strip()}\n" in alone for text in found) and status.strip() == "converged"


def test_a_table_says_what_is_closest_to_its_limit(capsys):
    """And its share of that, as the words of that contact alone; a column without any is left out."""
    ball = ["R=5 mm", "punch=rigid", "body=PMMA", "base=half_space", "micro=smooth"]
    assert main(["point", *ball, "P=0.1 N, 50 N"]) == 0
    head, *lines = capsys.readouterr().out.splitlines()
    assert head.split()[-3:] == ["status", "strength", "validity"]
    shown = [[cell.strip() for cell in cells(line)] for line in lines]
    assert shown[0][-1] == "body 0.2" and shown[1][-2:] == ["body 1.6", "body_yields"]
    assert main(["point", *ball, "P=50 N"]) == 0
    assert "is 1.6 times the yield strength, 63.0 ± 6.0 MPa" in capsys.readouterr().out


def test_a_contact_without_strengths_leaves_the_column_to_the_others():
    ball = {"R": "5 mm", "punch": "rigid", "body": "PMMA", "base": "half_space", "micro": "smooth"}
    contacts = study.solve(**ball, P=["0.1 N", "0.2 N"], x=2)
    heading, _, absent = columns(contacts.where(contacts.P < 0.15)).splitlines()
    assert heading.split()[-3:] == ["status", "strength", "validity"]
    assert absent.split()[-3:] == ["not_run", "-", "not_run"]


def test_a_share_that_has_yielded_is_a_number(capsys):
    given = ["P=1e-5", "base=half_space", "Nbar=250000", "Ra=0.004", "micro=elastic_plastic", "hardness=0.03"]
    assert main(["point", "--json", *given]) == 0
    share = json.loads(capsys.readouterr().out)["plastic_share"]
    assert share["unit"] == "1" and 0 < share["value"] < 1
    assert main(["point", "--json", "P=1e-5", "base=half_space", "micro=smooth"]) == 0
    assert "plastic_share" not in json.loads(capsys.readouterr().out)


def test_what_a_table_assumes_is_said_beside_it(capsys):
    """Once, however many contacts there are, and nothing of a table that assumes nothing."""
    ball = ["R=5 mm", "E1=2 MPa", "h=0.5 mm", "E2=70 GPa", "micro=smooth", "P=1 mN, 2 mN"]
    assert main(["point", *ball]) == 0
    sliding, ratio = capsys.readouterr().err.splitlines()
    assert sliding.startswith("assumed: The layer slides on the body") and ratio.startswith("assumed: nu1 = 0.3.")
    assert main(["point", *ball, "bonding=bonded", "nu1=0.49"]) == 0
    assert capsys.readouterr().err == ""


def test_two_lists_are_all_their_contacts(capsys):
    given = [word for word in WORDS if not word.startswith("E2")]
    assert main(["point", *given, "E2=70 GPa, 210 GPa", "P=1 N, 2 N"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [[cell.strip() for cell in cells(line)[:2]] for line in lines[1:]] == [
        [load, E2] for load in ("1 N", "2 N") for E2 in ("70 GPa", "210 GPa")
    ]


def test_numbers_of_a_list_without_units(capsys):
    assert main(["point", "--json", "P=1e-5, 2e-5", "base=half_space", "micro=smooth"]) == 0
    found = study.solve(P=[1e-5, 2e-5], base="half_space", micro="smooth", x=2)
    assert [contact["a"]["value"] for contact in json.loads(capsys.readouterr().out)] == found.a.values.tolist()


def test_a_comma_without_a_blank_may_be_that_of_a_decimal(capsys):
    assert main(["point", *WORDS, "P=1,5 N"]) == 2
    assert capsys.readouterr().err.startswith('P = "1,5 N"')


def test_one_contact_of_a_list_without_a_solution(capsys):
    """The others are said; its results are no numbers."""
    assert (
        main(
            [
                "point",
                "P=1e-5",
                "h=0.01",
                "nu1=0.4",
                "n=0.5, 2",
                "bonding=bonded",
                "base=thin_layer",
                "Nbar=250000",
                "Ra=0.004",
            ]
        )
        == 1
    )
    head, good, bad = capsys.readouterr().out.splitlines()
    place = head.split().index("a")
    assert good.split()[place + 4] != "-" and "converged" in good
    assert cells(bad)[2].strip() == "-" and "converged" not in bad
    assert head.split()[-1] == "validity" and bad.endswith("n_not_below_one")


def test_a_long_list_is_cut():
    contacts = study.solve(**BALL, P=[f"{load} N" for load in range(1, 26)], x=2)
    lines = columns(contacts).splitlines()
    assert len(lines) == 22 and lines[-1] == "... and 5 more contacts"


@pytest.fixture
def results(studies, capsys):  # noqa: F811
    """The results of the study "good"."""
    assert main(["run", "good"]) == 0
    capsys.readouterr()
    return study.load("good").open()


def test_a_study_as_rows(results, capsys):
    assert main(["table", "good"]) == 0
    assert capsys.readouterr().out.splitlines() == ["tables/good.csv", "tables/good_profiles.csv"]
    with open("tables/good.csv", encoding="utf-8", newline="") as file:
        contacts = list(csv.DictReader(file))
    assert [float(row["a (R)"]) for row in contacts] == results.a.values.tolist()
    assert [float(row["P (E2* R^2)"]) for row in contacts] == results.P.values.tolist()
    assert {row["status"] for row in contacts} == {"converged"} and next(iter(contacts[0])) == "P (E2* R^2)"
    with open("tables/good_profiles.csv", encoding="utf-8", newline="") as file:
        points = list(csv.DictReader(file))
    expected = results.p.transpose("P", "x").values
    assert np.array_equal([float(row["p (E2*)"]) for row in points], expected.ravel())
    assert len(points) == expected.size and {"x", "lam"} <= {name.split()[0] for name in points[0]}


def test_a_file_of_results_as_rows_with_units_and_spreads(studies, capsys):  # noqa: F811
    contact = study.solve(**BALL, P="10 N")
    contact.to_netcdf("steel.nc")
    assert main(["table", "steel.nc"]) == 0
    with open("tables/steel.csv", encoding="utf-8", newline="") as file:
        heads, row = csv.reader(file)
    assert heads.index("a_spread (m)") == heads.index("a (m)") + 1
    assert float(row[heads.index("a_spread (m)")]) == contact.a_spread.item()
    assert float(row[heads.index("E2_spread (Pa)")]) == 7e9


def test_rows_of_xlsx(results, capsys):
    openpyxl = pytest.importorskip("openpyxl")
    assert main(["table", "good", "--format", "xlsx"]) == 0
    assert capsys.readouterr().out == "tables/good.xlsx\n"
    book = openpyxl.load_workbook("tables/good.xlsx")
    assert book.sheetnames == ["contacts", "profiles"]
    heads, *lines = book["contacts"].values
    assert [line[heads.index("a (R)")] for line in lines] == pytest.approx(results.a.values, rel=1e-15)


LABELS = ["=1+1", "@SUM(1)", "+1+1", "-2+3", "\t=2+2", "\r=2", "  =3", "\uff1d4", "#N/A", "a=b", "5-3", "a\r=1"]
FORMULAS = 8  # of the labels


@pytest.fixture
def labelled(studies):  # noqa: F811
    """Results with labels that a spreadsheet would compute, numbers below 0 and infinite ones."""
    rows = [{"label": label, "P": 1e-6 * (i + 1)} for i, label in enumerate(LABELS)]
    ball = {"R": "1 mm", "punch": "rigid", "E2": "1 GPa", "nu2": -0.2, "base": "half_space", "micro": "smooth"}
    contacts = study.solve(cases=[row | {"P": f"{row['P']} N"} for row in rows], **ball)
    contacts.to_netcdf("labels.nc")
    return contacts


def test_no_text_of_a_csv_is_a_formula(labelled):
    """Numbers stay numbers, those below 0 too."""
    assert main(["table", "labels.nc"]) == 0
    with open("tables/labels.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    plain = [text.replace("\r", "\n") for text in LABELS]
    assert [row["label"] for row in rows] == [f"'{text}" for text in plain[:FORMULAS]] + plain[FORMULAS:]
    assert {row["nu2"] for row in rows} == {"-0.2"} and {row["E_punch (Pa)"] for row in rows} == {"inf"}
    figure = csv_text(["-x", "y"], [["=1+1", -1.0], ["b", -2]])
    assert figure == "'-x,y\n'=1+1,-1.0\nb,-2\n"


def test_no_text_of_a_sheet_is_a_formula(labelled):
    openpyxl = pytest.importorskip("openpyxl")
    assert main(["table", "labels.nc", "--format", "xlsx"]) == 0
    heads, *rows = openpyxl.load_workbook("tables/labels.xlsx")["contacts"].rows
    place = {cell.value: i for i, cell in enumerate(heads)}
    labels = [row[place["label"]] for row in rows]
    assert {cell.data_type for cell in labels} == {"s"}
    assert [cell.value for cell in labels] == [text.replace("\r", "\n") for text in LABELS]  # as XML has it
    assert {(row[place["nu2"]].value, row[place["nu2"]].data_type) for row in rows} == {(-0.2, "n")}
    assert {row[place["E_punch (Pa)"]].value for row in rows} == {"inf"}


def test_what_cannot_be_written_as_rows(results, monkeypatch, capsys):
    results[["a"]].to_netcdf("no_status.nc")
    assert main(["table", "no_status.nc"]) == 2
    assert capsys.readouterr().err == "no_status.nc: this dataset is not one of contacts: it has no status\n"
    monkeypatch.setattr(spreadsheet, "find_spec", lambda _: None)
    assert main(["table", "good", "--format", "xlsx"]) == 2
    assert capsys.readouterr().err.startswith("table --format xlsx needs openpyxl: pip install 'roughcoat[xlsx]'")
    monkeypatch.setattr(spreadsheet, "find_spec", lambda _: True)
    monkeypatch.setattr(spreadsheet, "MOST_ROWS", 2)
    assert main(["table", "good", "--format", "xlsx"]) == 2
    assert capsys.readouterr().err.startswith("good: 3 rows of contacts; a sheet of .xlsx has at most 2: ")


@pytest.mark.parametrize("text", ["1N,2N", "1 N,2 N", "1 N, 2 N"])
def test_a_comma_behind_a_unit_divides_a_list(text):
    assert [str(value).replace(" ", "") for value in listed(text)] == ["1N", "2N"]


def test_numbers_with_points_or_exponents_are_a_list():
    assert listed("1e-5,2e-5") == [1e-5, 2e-5] and listed("0.1,0.25") == [0.1, 0.25]
    assert listed("1,2e-5") == "1,2e-5" and listed("1,5 N") == "1,5 N" and listed("steel 52100") == "steel 52100"
