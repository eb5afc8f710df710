"""± of results, made of their derivatives, beside that of moved inputs, and under correlations."""

import csv
import warnings
from pathlib import Path

import numpy as np
import pytest
from spread_contacts import AT, CONTACTS

import study
from study.inputs import identity

TABLE = Path(__file__).parents[1] / "references/moved_spreads.csv"


def quiet(**given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of validity, which is not the question here
        return study.solve(**given)


@pytest.mark.parametrize("name", CONTACTS)
def test_as_those_of_moved_inputs(name):
    """To 2e-4: that much the curvature over a tenth of the spreads changed the former ones, README's the most."""
    found = quiet(**CONTACTS[name], x=[*AT, 1.0], workers=1)
    rows = [row for row in csv.DictReader(TABLE.read_text().splitlines()) if row["contact"] == name]
    assert len(rows) > 11
    for row in rows:
        mine = np.ravel(found[f"{row['result']}_spread"])[int(row["point"])]
        np.testing.assert_allclose(mine, float(row["spread"]), rtol=2e-4, err_msg=f"{row['result']}[{row['point']}]")


RESULTS = ("a", "P", "p0", "dP_dD", "p")


def test_correlated_inputs():
    """± of independent inputs that change a result by s and t is the root of s² + t²; of those with the correlation c,
    of s² + t² + 2 c s t. With c = 1 they are off together, with -1 one against the other."""
    ball = {"R": "10 mm", "E_punch": "207 GPa", "E2": "210 GPa", "nu1": 0.4, "D": "20 um", "micro": "smooth", "x": 2}
    spread = {"E1": "1.0 ± 0.05 GPa", "h": "100 ± 5 um"}
    exact = {"E1": "1.0 GPa", "h": "100 um"}
    apart = quiet(**ball | spread)
    signs = quiet(**ball | exact, sensitivities=True)
    alone = [quiet(**ball | exact | {name: text}) for name, text in spread.items()]
    for correlation in (-1.0, -0.3, 0.0, 0.5, 1.0):
        found = quiet(**ball | spread, correlations={("E1", "h"): correlation})
        for name in RESULTS:
            s, t = (one[f"{name}_spread"] for one in alone)
            by = signs[f"{'p0' if name == 'p' else name}_sensitivity"]
            sign = np.sign(by.sel(input="E1").item() * by.sel(input="h").item())
            wanted = np.sqrt(np.maximum(s**2 + t**2 + 2 * correlation * sign * s * t, 0.0))
            np.testing.assert_allclose(found[f"{name}_spread"], wanted, rtol=1e-6, atol=1e-9 * apart[name].max())
        assert bool((found.p0_spread == apart.p0_spread).all()) == (correlation == 0)


def test_one_piece_is_a_correlation_of_one():
    given = CONTACTS["one_piece"] | {"x": 3, "workers": 1}
    one = quiet(**given)
    pairs = {("E_punch", "E2"): 1.0, ("nu2", "nu_punch"): 1}
    same = quiet(**given | {"same_piece": False}, correlations=pairs)
    for name in ("a", "D", "p0", "p"):
        np.testing.assert_allclose(same[f"{name}_spread"], one[f"{name}_spread"], rtol=1e-12)


def test_study_files_have_them_in_a_section(tmp_path):
    text = (
        "[model]\nR = '5 mm'\nE2 = '210 ± 5 GPa'\nh = '100 ± 5 um'\nmicro = 'smooth'\n[axes]\nE1 = ['1.0 ± 0.1 GPa']\n"
    )
    text += "P = ['1 N', '2 N']\n[output]\nx = 3\n"
    (tmp_path / "film.toml").write_text(text)
    apart = study.load(tmp_path / "film.toml", tmp_path)
    apart.run(workers=1, progress=False)
    (tmp_path / "film.toml").write_text(text + "[correlations]\nE1.h = -0.5\nE1.E2 = 0.2\n")
    loaded = study.load(tmp_path / "film.toml", tmp_path)
    assert loaded.status()["state"] == "outdated" and loaded.run(workers=1, progress=False).computed == 0
    given = {"R": "5 mm", "E2": "210 ± 5 GPa", "h": "100 ± 5 um", "micro": "smooth", "P": ["1 N", "2 N"], "x": 3}
    pairs = {("h", "E1"): -0.5, ("E1", "E2"): 0.2}
    alone = quiet(**given, E1=["1.0 ± 0.1 GPa"], correlations=pairs)
    with loaded.open() as found:
        np.testing.assert_allclose(found.p_spread, alone.p_spread.transpose(*found.p_spread.dims), rtol=1e-9)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({("E1", "E2"): 0.5}, "correlations: E1 and E2: E2 has no spread; E1, nu1, h has one"),
        ({("E1", "h"): 1.5}, "correlations: E1 and h = 1.5: must be a number from -1 to 1"),
        ({("E1", "h"): "much"}, 'correlations: E1 and h = "much": must be a number from -1 to 1'),
        ({("E1", "E1"): 1.0}, "correlations: E1 and E1: are one input"),
        ({("E1", "h"): 0.5, ("h", "E1"): 0.5}, "correlations: h and E1: have a correlation already"),
        ({("E1", "h"): 1, ("h", "nu1"): 1, ("E1", "nu1"): -1}, "their matrix has a negative eigenvalue"),
        ({"E1": 0.5}, r"correlations = .*: must be a number from -1 to 1 for each pair of inputs, such as"),
        (0.5, "correlations = 0.5: must be a number from -1 to 1 for each pair"),
    ],
)
def test_what_cannot_be_is_refused(given, message):
    film = {"R": "5 mm", "E2": "210 GPa", "E1": "1.0 ± 0.1 GPa", "nu1": "0.4 ± 0.01", "h": "100 ± 5 um", "P": "1 N"}
    with pytest.raises(study.StudyError, match=message):
        study.solve(**film, micro="smooth", correlations=given)


def test_without_units_there_is_none():
    with pytest.raises(study.StudyError, match="correlations: no input has a spread here"):
        study.solve(P=1e-5, base="half_space", micro="smooth", correlations={("E1", "h"): 0.5})


def test_only_the_unit_is_off():
    """At a given radius only the modulus of a smooth half-space is not known: pressures follow it, lengths do not."""
    found = quiet(R="5 mm", E2="210.0 ± 2.1 GPa", a="50 um", base="half_space", micro="smooth", x=3)
    np.testing.assert_allclose(
        [found.P_spread / found.P, found.p0_spread / found.p0], 0.01, rtol=1e-8
    )  # the step², 1e-4²
    assert found.D_spread == 0 and (found.p_spread[:2] > 0).all()


def test_a_spread_of_an_input_that_has_its_default_value(tmp_path, monkeypatch):
    """nu1 = 0.3 ± 0.01 counts as 0.31 ± 0.01 does; a file of a version that left it out is made anew."""
    film = {"R": "5 mm", "E2": "210 GPa", "E1": "1 GPa", "h": "100 um", "P": "1 N", "micro": "smooth"}
    film |= {"bonding": "bonded"}
    at, beside = (float(quiet(**film, nu1=f"{nu} ± 0.01").D_spread) for nu in (0.3, 0.3001))
    assert at == pytest.approx(beside, rel=2e-3)
    moved = [float(quiet(**film, nu1=nu).D) for nu in (0.299, 0.301)]
    assert at == pytest.approx(10 * abs(moved[1] - moved[0]) / 2, rel=1e-4)
    text = "[model]\nnu1 = '0.3 ± 0.01'\n" + "".join(f"{name} = {value!r}\n" for name, value in film.items())
    (tmp_path / "film.toml").write_text(text)
    with monkeypatch.context() as before:
        before.setattr("study.inputs.scene.changes.acts", identity.counts)
        study.load(tmp_path / "film.toml", tmp_path).run(workers=1, progress=False)
    loaded = study.load(tmp_path / "film.toml", tmp_path)
    assert loaded.status()["state"] == "outdated" and loaded.run(workers=1, progress=False).computed == 1
    with loaded.open() as again:
        assert float(again.D_spread) == pytest.approx(at, rel=1e-9)
