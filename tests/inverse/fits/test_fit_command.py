"""`roughcoat fit FILE NAME=VALUE ...`: answers, exit codes and messages."""

import json

import numpy as np
import pytest
from measured_curves import DEPTHS, gel

from study.__main__ import main

CALL = ["R=5um", "nu1=0.49", "h=1.5um", "E2=70GPa", "nu2=0.2", "bonding=bonded", "micro=smooth"]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    P, sigma = gel()
    noise = sigma * np.random.default_rng(0).standard_normal(len(P))
    for name, loads in {"curve.csv": P, "noise.csv": noise}.items():
        rows = [f"{1e9 * d!r},{1e9 * p!r}" for d, p in zip(DEPTHS.tolist(), loads.tolist(), strict=True)]
        (tmp_path / name).write_text("\n".join(["D [nm],P [nN]", *rows]), encoding="utf-8")
    rows = [f"{name},{row}" for name in ("left", "right") for row in rows]
    (tmp_path / "two.csv").write_text("\n".join(["curve,D [nm],P [nN]", *rows]), encoding="utf-8")
    return tmp_path


def run(capsys, *words):
    code = main(["fit", *words])
    said = capsys.readouterr()
    return code, said.out, said.err


def test_words_json_and_a_figure(folder, capsys):
    code, words, _ = run(capsys, "curve.csv", *CALL, "free=E1")
    assert code == 0 and "E1 = 5.0" in words and "contact point" in words
    code, text, said = run(capsys, "curve.csv", *CALL, "E1=1 kPa .. 1 MPa", "--json", "--plot", "fit.png")
    numbers = json.loads(text)
    assert code == 0 and numbers["fit_status"] == "converged"
    assert "fit.png" in said and (folder / "fit.png").stat().st_size
    assert numbers["E1"]["low"] < 5e3 < numbers["E1"]["high"] and numbers["E1"]["unit"] == "Pa"


def test_what_was_given_and_what_was_assumed(folder, capsys):
    """A default that changes the answer is said: without `bonding` and `nu1` E1 is twice as large."""
    _, words, _ = run(capsys, "curve.csv", "R=5um", "h=1.5um", "E2=70GPa", "micro=smooth", "free=E1")
    first, *rest = words.splitlines()
    assert first.startswith("Given: a rigid punch (assumed), R = 5 µm, nu1 = 0.3 (assumed), E2 = 70 GPa")
    assert first.endswith("h = 1.5 µm, frictionless (assumed)")
    assert sum(line.startswith("Assumed: ") for line in rest) == 2
    call = ["R=5um", "nu1=0.49", "h=1.5 ± 0.1 um", "E2=70GPa", "bonding=bonded", "micro=smooth", "Ra=1um"]
    _, words, _ = run(capsys, "curve.csv", *call, "free=E1")
    assert "h = 1.50 ± 0.10 µm" in words and "\nNot used: Ra = 1 µm\n" in words and "Assumed" not in words
    assert "of the range of P." in words and "At the deepest point: The strain is not small" in words


def test_a_figure_in_a_folder_that_is_not_there(folder, capsys):
    code, _, said = run(capsys, "curve.csv", *CALL, "free=E1", "--plot", "new/fit.pdf")
    assert code == 0 and said == "figure: new/fit.pdf\n" and (folder / "new" / "fit.pdf").stat().st_size
    (folder / "new" / "fit.pdf").rename("file")
    code, _, said = run(capsys, "curve.csv", *CALL, "free=E1", "--plot", "file/fit.pdf")
    assert code == 1 and said.startswith("fit: ") and "file" in said and "curve.csv" not in said


def test_several_curves_and_one_without_contact(folder, capsys):
    code, text, _ = run(capsys, "two.csv", *CALL, "free=E1", "--json")
    assert code == 1 and [curve["curve"] for curve in json.loads(text)] == ["left", "right"]
    code, words, _ = run(capsys, "noise.csv", *CALL, "free=E1")
    assert code == 1 and "it contains no contact" in words
    code, text, _ = run(capsys, "noise.csv", *CALL, "free=E1", "--json")
    assert code == 1 and json.loads(text)["E1"]["value"] is None


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["none.csv", *CALL, "free=E1"], "none.csv: there is no such file"),
        (["none.csv"], "none.csv: there is no such file"),
        (["none.csv", "part=retraction"], "none.csv: there is no such file"),
        (["curve.csv", *CALL, "free=e1"], 'did you mean "E1"?'),
        (["curve.csv", *CALL, "free=E1", "contactpoint=false"], 'did you mean "contact_point"?'),
        (["curve.csv", *CALL, "free=E1", "plan=true"], "plan is an option of study.fit in Python alone"),
        (["curve.csv", *CALL, "free=E1", "progress=true"], "progress is an option of study.fit in Python alone"),
        ([*CALL, "free=E1"], "the file of the curve comes first"),
        (["curve.csv", *CALL], "name the inputs to fit, such as free=E1"),
        (["curve.csv", *CALL, "free=E1", "free=h"], "free is given twice"),
        (["curve.csv", *CALL, "E1=1 MPa .. 1 kPa"], "E1 = (1 MPa, 1 kPa)"),
        (["curve.csv", *CALL, "free=E1,nu1"], "E1 and nu1: a curve cannot tell them apart"),
        (["curve.csv", *CALL, "free=E1", "level=2"], "level = 2.0"),
        (["curve.csv", *CALL, "free=E1", "tilt=maybe"], "tilt=maybe: must be true or false"),
        (["curve.csv", *CALL, "free=E1", "sigma=1"], "has no unit"),
        (["curve.csv", *CALL, "free=E1", "D=1um"], "leave out D"),
        (["curve.csv", *CALL, "free=E1", "--plot", "fit.txt"], "must end with one of .png"),
        (["curve.csv", *CALL, "free=E1", "x=P", "y=a"], "a is not there"),
    ],
)
def test_refused_with_exit_code_2(folder, capsys, words, message):
    code, words, said = run(capsys, *words)
    assert (code, words) == (2, "") and message in said
