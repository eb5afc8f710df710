"""What docs/extending.md says of figures, tables and output quantities, done as it stands there."""

import csv
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pages
import pytest

import study
from study import catalogue, open_results
from study.__main__ import main
from study.data import derived
from study.figures.registry import FIGURES, TABLES
from study.inputs import vocabulary
from study.inputs.lexicon import PACKAGE

pytestmark = pytest.mark.usefixtures("forgetful")

SECTIONS = dict(part.split("\n", 1) for part in pages.read("docs/extending.md").split("\n## ")[1:])


def code(heading: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", SECTIONS[heading], flags=re.DOTALL | re.MULTILINE)


(FIGURE,), (TABLE,), (FORMULA,) = map(code, ("A figure", "A table", "An output quantity"))
(ROW,) = pages.blocks("docs/extending.md", "toml")[-1:]


@pytest.fixture(autouse=True)
def registers_as_they_were():
    before = dict(FIGURES), dict(TABLES)
    yield
    for register, entries in zip((FIGURES, TABLES), before, strict=True):
        register.clear()
        register.update(entries)


def numbers(path) -> tuple[list[str], np.ndarray]:
    with open(path, encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    return head, np.array(rows, dtype=float)


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """The working folder of a user, with `figures.py` of the page beside his studies."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "studies").mkdir()
    (tmp_path / "studies/figures.py").write_text(FIGURE, encoding="utf-8")
    return tmp_path


def test_a_figure_is_one_function_in_one_new_file(results, folder):
    assert main(["plot", "stiffness", "--results", str(results)]) == 0
    assert sorted(path.suffix for path in (folder / "figures").iterdir()) == [".csv", ".pdf", ".png"]
    head, columns = numbers(folder / "figures/stiffness.csv")
    sweep = open_results(results / "load_sweep.nc")
    assert head == ["P/(E2* R^2)", *sweep["label"].values]
    np.testing.assert_array_equal(columns[:, 0], sweep["P"])
    np.testing.assert_array_equal(columns[:, 1:], sweep["dP_dD"].transpose("P", "case"))
    assert {"stiffness", "fig03"} <= set(catalogue.usual("figure"))
    assert "**stiffness.** dP/dD of every case of the study load_sweep." in catalogue.captions(results)


def test_a_figure_of_a_script_is_among_those_of_all(results, tmp_path):
    exec(FIGURE, {})
    assert "stiffness" in catalogue.usual("figure")
    assert [path.name for path in catalogue.draw("stiffness", results, tmp_path)][0] == "stiffness.csv"


def test_a_table_is_one_function(results, tmp_path):
    exec(TABLE, {})
    text, comma, latex = (
        path.read_text(encoding="utf-8") for path in catalogue.tabulate("stiffest", results, tmp_path)
    )
    main = open_results(results / "main_case.nc")
    assert text.splitlines()[0] == "Contact stiffness under the load of the main case."
    assert re.search(rf"^rough, layered +{float(main['dP_dD'][0]):.3f}$", text, flags=re.MULTILINE)
    assert [float(row[1]) for row in list(csv.reader(comma.splitlines()))[1:]] == main["dP_dD"].values.tolist()
    assert r"contact & $(dP/dD)/(E_2^* R)$ \\" in latex


@pytest.fixture
def row() -> Iterator[vocabulary.Entry]:
    """The row of the page, as if it stood in the file."""
    (row,) = vocabulary.entries(tomllib.loads(ROW)).values()
    for table in (vocabulary.VOCABULARY, PACKAGE.rows):
        dict.__setitem__(table, row.name, row)
    yield row
    for table in (vocabulary.VOCABULARY, PACKAGE.rows):
        dict.__delitem__(table, row.name)


def test_an_output_quantity_is_one_row_and_its_formula(results, row, monkeypatch):
    monkeypatch.setitem(derived.QUANTITIES, row.name, None)  # and not there any more after the test
    found = vars(derived) | {}
    exec(FORMULA, found)
    main = open_results(results / "main_case.nc")
    made = main.assign(P_spot=found["spot_load"])
    expected = (main["P"] / (main["Nbar"] * np.pi * main["a"] ** 2)).where(main["micro"] != "smooth")
    np.testing.assert_allclose(made["P_spot"], expected, rtol=1e-14)  # the same arithmetic
    assert made["P_spot"].attrs == {
        "long_name": "mean load of a contact spot, (P/(N̄ An))/(E2* R^2)", "symbol": "P/(N̄ An)", "scale": "E2* R^2"
    }  # fmt: skip
    pyplot = pytest.importorskip("matplotlib.pyplot")
    axes = study.plot(open_results(results / "load_sweep.nc"), "P", "P_spot", hue="case").axes[0]
    assert axes.get_ylabel() == r"$(P/(\bar N A_n))/(E_2^*\,R^2)$"
    pyplot.close("all")
    physical = study.to_physical(made, R=0.01, E2_star=2e11)
    assert physical["P_spot"].units == "N"
    np.testing.assert_allclose(physical["P_spot"], expected * 2e7, rtol=1e-12)  # two products
