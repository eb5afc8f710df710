"""The commands that only read: pages, materials, scans."""

import inspect
import re
import shlex

import numpy as np
import pytest
from conftest import ROOT

from study import materials, pages, roughness
from study.__main__ import main
from study.commands import lookup
from study.specimen.quantities import quantity

SOURCES = [path for folder in ("roughcoat", "solver", "study") for path in (ROOT / folder).rglob("*") if path.is_file()]
PAGE = re.compile(r"docs/(\w+)\.md(?:, ([A-Z][\w -]*[\w]))?")


@pytest.fixture
def scan(tmp_path, monkeypatch):
    """A folder with a profile of 200 heights in µm, every 0.5 µm; the name of its file."""
    monkeypatch.chdir(tmp_path)
    heights = np.random.default_rng(3).normal(0, 0.05, 200).cumsum()
    (tmp_path / "scan.csv").write_text("\n".join(f"{0.5 * i};{z:.6f}" for i, z in enumerate(heights)))
    return "scan.csv"


def said(capsys, *words: str, code: int = 0) -> str:
    """What a command prints, or its message where it ends with another exit code."""
    assert main([*words]) == code
    printed = capsys.readouterr()
    assert (printed.err if code == 0 else printed.out) == ""
    return printed.out if code == 0 else printed.err


def test_pages_are_listed_with_their_titles(capsys):
    lines = said(capsys, "docs").splitlines()
    files = sorted(path.stem for path in (ROOT / "docs").glob("*.md") if path.read_text(encoding="utf-8")[0] == "#")
    assert [line.split()[0] for line in lines[: len(files)]] == files and lines[len(files)] == ""
    assert dict(line.split(None, 1) for line in lines[: len(files)])["model"] == pages.titles()["model"] != ""


@pytest.mark.parametrize("name", ["model", "model.md", "docs/model.md", "docs/model.md#four-answers"])
def test_a_page_is_shown_by_whatever_name_a_message_has(name, capsys):
    assert said(capsys, "docs", name) == (ROOT / "docs/model.md").read_text(encoding="utf-8")


def test_pages_that_are_none(capsys):
    assert said(capsys, "docs", "modle", code=2) == 'docs "modle" is not a page; did you mean model?\n'
    message = said(capsys, "docs", "../README.md", code=2)
    assert message.startswith('docs "../README.md" is not a page; there are accuracy, adhesion, afm, cite, cluster, ')


def test_each_page_that_a_text_of_ours_names_can_be_opened_and_has_the_heading():
    named = {}
    for path in SOURCES:
        if path.suffix in (".py", ".js", ".html", ".toml"):
            for page, heading in PAGE.findall(path.read_text(encoding="utf-8").replace("\n", " ")):
                named.setdefault(page, set()).add(heading)
    assert len(named) > 8 and set(named) <= set(pages.titles())
    for page, headings in named.items():
        heads = re.findall(r"^#+ (.*)$", pages.page(page), flags=re.MULTILINE)
        for heading in headings - {""}:
            assert any(heading.startswith(head.strip("`")) for head in heads), f"docs/{page}.md, {heading}"


def test_materials(capsys):
    table = said(capsys, "materials")
    assert all(name in table for name in materials.names())
    steel = materials.get("steel 52100")
    text = said(capsys, "materials", "Steel 52100")
    assert text.startswith("steel 52100\n") and steel.source in text and steel.strength_source in text
    assert re.search(r"^ +E +207 ± 3 GPa", text, flags=re.MULTILINE)
    assert "did you mean" in said(capsys, "materials", "steel 5210", code=2)


def test_a_scan_is_measured_as_python_does(scan, capsys):
    expected = roughness.measure(roughness.read(scan, unit="um"), method="summits")
    text = said(capsys, "scan", scan, "unit=um", "method=summits")
    sentences, _, words = text.rpartition("\n\n")
    assert sentences == str(expected)
    numbers = dict(word.split("=") for word in shlex.split(words)[4:] if "=" in word)
    exact = {"Nbar": expected.Nbar, "Ra": expected.Ra, "sigma": expected.sigma_summits, "cut": expected.cut}
    assert numbers.pop("micro") == "normal_heights"
    units = {"Nbar": "1/m^2", "Ra": "m", "sigma": "m", "cut": "1"}
    values = {name: quantity(name, number, units[name]).value for name, number in numbers.items()}
    assert values == pytest.approx(exact, rel=1e-6)


def test_numbers_of_a_scan_are_as_people_write_them(scan, capsys):
    words = shlex.split(said(capsys, "scan", scan, "unit=um").rpartition("\n\n")[2])
    numbers = {name: value for name, _, value in (word.partition("=") for word in words if "=" in word)}
    for name, units in (("Nbar", "1/um^2|1/mm^2"), ("Ra", "um|mm"), ("sigma", "um|nm")):
        number, unit = numbers[name].split(" ")
        assert unit in units.split("|") and len(number.strip("0.").replace(".", "")) <= 7 and "e" not in number
    assert numbers["cut"] == "3" or len(numbers["cut"]) <= 8


def test_what_a_scan_prints_is_what_point_takes(scan, capsys):
    words = shlex.split(said(capsys, "scan", scan, "unit=um").rpartition("\n\n")[2])
    given = [word for word in words[words.index("point") + 1 :] if "=" in word]
    ball = ["R=5 mm", "E2=210 GPa", "nu2=0.3", "base=half_space", "P=10 N"]
    assert "Nbar = " in said(capsys, "point", *ball, *given)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["unit=um", "speed=3"], 'scan: `scan` does not take "speed"; it takes unit, height_unit, '),
        (["unit=um", "spacing=3"], 'scan: `scan` does not take "spacing"; did you mean dx?'),
        (["units=um", "dx=1"], 'scan: `scan` does not take "units"; did you mean unit?'),
        (["unit"], 'scan: "unit": must be NAME=VALUE'),
        (["unit=um", "unit=nm"], "scan: unit is given twice"),
        (["unit=um", "dx=one"], 'scan: dx = "one": must be a number, in `unit`, or a length such as "0.4 um"'),
        (["unit=um", "columns=0,x"], 'scan: columns = "0,x": must be columns, counted from 0, such as '),
        (["unit=um", "steep=perhaps"], 'scan: steep = "perhaps": must be steep=true or steep=false'),
        (["unit=um", "despike=some"], 'scan: despike = "some": must be a number of robust deviations, such as 5'),
        (["unit=um", "despike=-1"], "scan: scan.csv: despike = -1.0: must be a positive number of robust deviations"),
        (["unit=um", "cutoff=5"], 'scan: cutoff = "5" has no unit: must be a length, such as '),
        (["unit=um", "method=guess"], "scan: scan.csv: method = 'guess'; allowed are "),
        ([], "scan: scan.csv"),
    ],
)
def test_what_a_scan_refuses(words, message, scan, capsys):
    text = said(capsys, "scan", scan, *words, code=2)
    assert text.startswith(message) and text.count("\n") == 1


def test_a_scan_that_is_not_there(capsys):
    assert said(capsys, "scan", "nowhere.csv", code=2) == "scan: nowhere.csv: No such file or directory\n"


def test_a_scan_takes_what_read_and_measure_take():
    taken = {name: [*inspect.signature(getattr(roughness, name)).parameters][1:] for name in ("read", "measure")}
    assert taken == {"read": [*lookup.READING], "measure": [*lookup.MEASURING]}


def test_words_of_a_scan_reach_read_and_measure_as_python_has_them(scan, monkeypatch, capsys):
    seen = {}
    for name in ("read", "measure"):
        monkeypatch.setattr(roughness, name, lambda _, found=seen, **given: found.update(given))
    monkeypatch.setattr(lookup, "answer", lambda *_: 0)
    words = "unit=um dx=0.5 columns=1 crop=1,20um missing=fill huge=true form=2 cutoff=2.5um,0.8um"
    with pytest.raises(AttributeError):  # what measures gives nothing here
        main(["scan", scan, *words.split()])
    expected = {"unit": "um", "dx": 0.5, "columns": [1], "crop": [1.0, "20um"], "missing": "fill", "huge": True}
    assert seen == expected | {"form": 2.0, "cutoff": pytest.approx([2.5e-6, 0.8e-6])}
