"""`roughcoat scan FILE --law OUT.csv`: a file that `point` takes."""

import numpy as np
import pytest

from study import roughness
from study.__main__ import main


@pytest.fixture
def scan(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    surface = roughness.self_affine((32, 32), "0.5 um", hurst=0.8, rms="20 nm", seed=1)
    np.save("scan.npy", surface.z * 1e9)
    return ["scan", "scan.npy", "height_unit=nm", "dx=0.5 um"]


def test_a_law_is_written_and_taken(scan, capsys):
    assert main([*scan, "form=mean", "periodic=given", "--law", "law.csv"]) == 0
    assert 'roughcoat point ... micro="table:law.csv"' in capsys.readouterr().out
    assert main(["point", "R=5 mm", "E2=5 GPa", "P=1 mN", "base=half_space", "micro=table:law.csv"]) == 0
    assert "table:law.csv" in capsys.readouterr().out


def test_a_law_on_a_coated_body_says_which(scan, capsys):
    body = ["h=2 um", "n=4", "nu1=0.3", "nu2=0.3", "bonding=bonded"]
    assert main([*scan, *body, "--law", "law.csv"]) == 0
    assert 'h="2 um" n="4.0" nu1="0.3"' in capsys.readouterr().out
    there = ["R=5 mm", "E2=5 GPa", "P=1 mN", *body, "micro=table:law.csv"]
    assert main(["point", *there]) == 0
    assert main(["point", *(word.replace("n=4", "n=5") for word in there)]) == 2
    assert "is the law of a scan on a body with n = 4, not 5" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["method=summits"], "`scan` does not take"),
        (["refine=x"], "whole number"),
        (["h=2 um"], "law: on: E1 is missing"),
    ],
)
def test_what_is_refused(scan, capsys, words, message):
    assert main([*scan, *words, "--law", "law.csv"]) == 2
    assert message in capsys.readouterr().err
