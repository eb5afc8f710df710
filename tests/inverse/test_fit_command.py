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


def test_several_curves_and_one_without_contact(folder, capsys):
    code, text, _ = run(capsys, "two.csv", *CALL, "free=E1", "--json")
    assert code == 1 and [curve["curve"] for curve in json.loads(text)] == ["left", "right"]
    code, words, _ = run(capsys, "noise.csv", *CALL, "free=E1")
    assert code == 1 and "there is no contact in it" in words
    code, text, _ = run(capsys, "noise.csv", *CALL, "free=E1", "--json")
    assert code == 1 and json.loads(text)["E1"]["value"] is None


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["none.csv", *CALL, "free=E1"], "none.csv: cannot be read"),
        ([*CALL, "free=E1"], "the file of the curve comes first"),
        (["curve.csv", *CALL], "name what is fitted, such as free=E1"),
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
