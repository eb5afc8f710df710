"""Tables of `point` and `table` in the columns and units asked for, and beside the body without its layer."""

import csv
import warnings
from pathlib import Path

import pytest
from numpy.testing import assert_allclose

import study
from study.__main__ import main
from study.in_words.chosen_columns import inputs_without_layer

DLC = {"R": "5 mm", "punch": "steel 52100", "layer": "DLC a-C:H", "bonding": "bonded", "body": "steel 52100"}
DLC |= {"micro": "smooth"}
WORDS = [f"{name}={value}" for name, value in DLC.items()]
SOFT = ["h=0.01", "n=0.5", "P=1e-5", "micro=smooth"]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def table(capsys, *words: str) -> list[list[str]]:
    """The cells of each line, the headings first."""
    assert main(["point", *words]) == 0
    return [[cell for cell in line.split("  ") if cell] for line in capsys.readouterr().out.splitlines()]


def test_columns_in_units_beside_the_bare_body(capsys):
    loads, thick = ["1 N", "10 N"], ["2 um", "5 um"]
    asked = ["--columns", "a,p0,An", "--units", "um,MPa,um^2", "--beside", "bare"]
    heading, *rows = table(capsys, *WORDS, f"P={', '.join(loads)}", f"h={', '.join(thick)}", *asked)
    heading, rows = [cell.strip() for cell in heading], [[float(cell) for cell in row] for row in rows]
    plain = ["a (um)", "p0 (MPa)", "An (um^2)"]
    assert set(heading[:2]) == {"P (N)", "h (um)"}
    assert heading[2:] == [*plain, "a bare (um)", "p0 bare (MPa)", "An bare (um^2)"]
    for row in rows:
        case = dict(zip(heading, row, strict=True))
        values = {"P": f"{case['P (N)']} N", "h": f"{case['h (um)']} um"}
        coated = study.solve(**DLC, **values)
        body = {"R": "5 mm", "punch": "steel 52100", "body": "steel 52100", "base": "half_space"}
        bare = study.solve(**body, micro="smooth", P=values["P"])
        for contact, cells in ((coated, row[2:5]), (bare, row[5:])):
            exact = [contact.a * 1e6, contact.p0 / 1e6, study.derived.nominal_area(contact) * 1e12]
            assert_allclose(cells, exact, rtol=6e-4)


def test_one_contact_without_units(capsys):
    heading, row = table(capsys, *SOFT, "--beside", "bare", "--columns", "a,status")
    assert [cell.strip() for cell in heading] == ["a (R)", "status", "a bare (R)", "status bare"]
    bare = study.solve(P=1e-5, base="half_space", micro="smooth").a.item()
    assert float(row[2]) == pytest.approx(bare, rel=6e-4) and row[3].strip() == "converged"


def test_an_input_of_the_layer_has_no_column_of_the_bare_body(capsys):
    heading, _ = table(capsys, *WORDS, "h=2 um", "P=1 N", "--columns", "h,P,a", "--units", "um,N", "--beside", "bare")
    assert [cell.strip() for cell in heading] == ["h (um)", "P (N)", "a (um)", "a bare (um)"]


def test_layers_of_a_stack_are_left_out(capsys):
    stack = ["layers.1.h=0.01", "layers.1.n=3", "layers.2.h=0.02", "layers.2.n=0.5", "P=1e-5", "micro=smooth"]
    assert float(table(capsys, *stack, "--beside", "bare", "--columns", "a")[1][1]) == pytest.approx(
        study.solve(P=1e-5, base="half_space", micro="smooth").a.item(), rel=6e-4
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--columns a,q", '--columns "q" is not a column'),
        ("--columns p_mx", 'did you mean "p_max"?'),
        ("--columns p", "--columns p is a profile along x"),
        ("--units um", "--units um: no column has a unit: leave it out"),
        ("--units um --json", "--units makes a table of numbers: leave out --json"),
        ("--beside bare --stresses a.png", "leave out --stresses"),
        ("base=half_space --beside bare", "--beside bare: there is no layer to leave out"),
    ],
)
def test_what_is_refused(words, message, capsys):
    assert main(["point", *SOFT, *words.split()]) == 2
    assert message in capsys.readouterr().err


def test_a_unit_that_no_column_has_changes_nothing(capsys):
    """So that one list of units serves all tables; a word that is not a unit is refused."""
    contact = [*WORDS, "h=2 um", "P=1 N", "--columns", "a"]
    assert table(capsys, *contact, "--units", "um,MPa") == table(capsys, *contact, "--units", "um")
    assert main(["point", *contact, "--units", "um,MPaa"]) == 2
    assert capsys.readouterr().err == (
        '--units "MPaa" is not a unit of any quantity of a contact, such as um, N or MPa\n'
    )


def test_words_of_a_list_differ(capsys):
    with pytest.raises(SystemExit):
        main(["point", *SOFT, "--columns", "a,,a"])
    assert "must be different words with commas between them" in capsys.readouterr().err


def test_rows_of_a_study(capsys):
    model = "\n".join(f'{name} = "{value}"' for name, value in (DLC | {"h": "2 um"}).items())
    Path("mine.toml").write_text(f'[model]\n{model}\n[axes]\nP = ["1 N", "2 N"]\n', encoding="utf-8")
    assert main(["table", "mine.toml", "--run", "--columns", "a,An,p", "--units", "mN,nm"]) == 0
    with open("tables/mine.csv", encoding="utf-8") as file:
        heading, *rows = csv.reader(file)
    assert heading == ["P (mN)", "a (nm)", "An (m^2)"]
    contacts = study.open_results("results/mine.nc")
    assert_allclose([float(row[1]) for row in rows], contacts.a * 1e9, rtol=1e-14)
    assert [float(row[0]) for row in rows] == pytest.approx([1000, 2000])
    with open("tables/mine_profiles.csv", encoding="utf-8") as file:
        assert next(csv.reader(file)) == ["P (mN)", "x", "p (Pa)"]


def rows_in(path: str) -> list[dict[str, str]]:
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_rows_of_a_study_beside_the_bare_body(capsys):
    model = "\n".join(
        f'{name} = "{value}"' for name, value in (DLC | {"R1": "5 mm", "R2": "flat"}).items() if name != "R"
    )
    Path("mine.toml").write_text(
        f'[model]\n{model}\n[axes]\nP = ["1 N", "2 N"]\nh = ["2 um", "4 um"]\n', encoding="utf-8"
    )
    asked = ["--columns", "a,An,p", "--units", "mN,nm", "--beside", "bare"]
    assert main(["table", "mine.toml", "--run", *asked]) == 0
    rows, profiles = rows_in("tables/mine.csv"), rows_in("tables/mine_profiles.csv")
    assert [*rows[0]] == ["P (mN)", "h (nm)", "a (nm)", "An (m^2)", "a bare (nm)", "An bare (m^2)"]
    bare = study.solve(
        R="5 mm", punch="steel 52100", body="steel 52100", base="half_space", micro="smooth", P=["1 N", "2 N"]
    )
    for row in rows:
        contact = bare.sel(P=float(row["P (mN)"]) / 1e3)
        assert_allclose(float(row["a bare (nm)"]), contact.a * 1e9, rtol=1e-12)
        assert_allclose(float(row["An bare (m^2)"]), study.derived.nominal_area(contact), rtol=1e-12)
    assert_allclose(float(profiles[0]["p bare (Pa)"]), bare.p[0, 0], rtol=1e-9)
    assert main(["table", "results/mine.nc", *asked]) == 0
    assert rows_in("tables/mine.csv") == rows


@pytest.mark.parametrize(
    "inputs",
    [
        {"P": [1e-5, 2e-5], "h": 0.1, "n": 2.0, "micro": "smooth", "m": 0.1},
        {"punch": "rigid", "R": "5 mm", "layer": "PTFE", "h": "1 mm", "bonding": "bonded", "body": "PEEK", "P": ["1 N"],
         "Nbar": "0.1 1/um^2", "Ra": "2 um", "rtol": 1e-7},
        {"shape": "cone", "half_angle": 70.0, "E1": "5 GPa", "nu1": 0.3, "h": "2 um", "bonding": "bonded",
         "body": "steel 52100", "P": ["1 N"], "micro": "smooth"},
        {"cases": [{"P": 1e-5, "h": 0.1}, {"P": 3e-5, "h": 0.2}], "n": 2.0, "micro": "smooth"},
        {"P": [1e-5], "layers": [{"h": 0.1, "n": 2.0, "bonding": "frictionless"}, {"h": 0.2, "n": [3.0, 1.0],
         "profile": "linear"}], "micro": "smooth", "nu2": 0.4},
    ],
)  # fmt: skip
def test_results_have_what_the_bare_body_needs(inputs):
    layers = {"h", "n", "layers", "layer", "bonding", "E1", "nu1"}
    bare = {name: value for name, value in inputs.items() if name not in layers}
    if "cases" in bare:
        bare["cases"] = [{"P": case["P"]} for case in bare["cases"]]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        expected = study.solve(**bare, base="half_space")
        dataset = study.solve(**inputs)
        contacts = study.solve(**inputs_without_layer(dataset))
    assert_allclose(contacts.a.values.ravel(), expected.a.values.ravel(), rtol=1e-12)
    assert contacts.a.dims == expected.a.dims and (contacts.status == 0).all()


def test_results_without_a_layer_have_no_bare_body(capsys):
    Path("mine.toml").write_text(
        '[model]\nmicro = "smooth"\nbase = "half_space"\n[axes]\nP = [1e-5]\n', encoding="utf-8"
    )
    assert main(["table", "mine.toml", "--run", "--beside", "bare"]) == 2
    assert "--beside bare: there is no layer to leave out" in capsys.readouterr().err
