"""Power laws without B and beta are fitted to Nbar and Ra, and it is said that they are."""

import numpy as np
import pytest
import xarray as xr

import study
from solver import fit_power_law
from study.__main__ import main
from study.inputs.punch import micro_laws as laws
from study.inputs.reading import from_tables

LAYER = {"P": 1e-5, "h": 0.02, "n": 0.5, "micro": "power_law"}


def test_a_law_for_each_roughness():
    found = study.solve(**LAYER, Nbar=[250000, 62500], Ra=[0.004, 0.002], x=2)
    assert found.B.dims == found.beta.dims == ("Nbar", "Ra")
    for N, Ra in ((250000, 0.004), (62500, 0.002)):
        B, beta, _ = fit_power_law(N * Ra**2)
        one = found.sel(Nbar=N, Ra=Ra)
        np.testing.assert_allclose([one.B, one.beta], [B, beta], rtol=1e-9)  # ten digits are kept
        given = study.solve(**LAYER, Nbar=N, Ra=Ra, B=one.B.item(), beta=one.beta.item(), x=2)
        assert one.a.item() == pytest.approx(given.a.item(), rel=1e-11)  # another batch
        assert "comment" not in given.B.attrs
    assert found.B.attrs["comment"] == found.beta.attrs["comment"] == laws.COMMENT


def test_only_where_the_power_law_is_and_for_cases():
    found = study.solve(**LAYER | {"micro": ["smooth", "power_law"]}, Nbar=250000, Ra=0.004, x=2)
    assert found.B.dims == () and (found.status == 0).all()
    rows = [{"Nbar": 250000, "Ra": 0.004}, {"micro": "smooth"}]
    found = study.solve(**{name: value for name, value in LAYER.items() if name != "micro"},
                        cases=[{"micro": "power_law"} | row for row in rows], x=2)  # fmt: skip
    assert found.B.dims == ("case",) and np.isnan(found.B[1]) and (found.status == 0).all()


def test_it_is_said_in_words():
    found = study.solve(**LAYER, Nbar=250000, Ra=0.004, x=2)
    told = "B = 0.091924 Ra/E1*^beta (fitted to Nbar and Ra), beta = 0.49083 (fitted to Nbar and Ra)"
    assert told in study.summary(found)
    given = study.summary(study.solve(**LAYER, Nbar=250000, Ra=0.004, B=0.1, beta=0.5, x=2))
    assert "B = 0.1 Ra/E1*^beta, beta = 0.5" in given and "fitted" not in given
    assert "B =" not in study.summary(study.solve(**LAYER | {"micro": "disc_cell"}, Nbar=250000, Ra=0.004, x=2))


def test_in_physical_units():
    steel = {"R": "10 mm", "E1": "100 GPa", "E2": "200 GPa", "h": "0.2 mm", "P": "100 N", "micro": "power_law"}
    with pytest.warns(UserWarning, match="metals yield"):
        found = study.solve(**steel, Nbar="2500 1/mm^2", Ra="40 um", x=2)
    assert found.beta.item() == pytest.approx(fit_power_law(4.0).beta, rel=1e-9)


def test_without_roughness_both_ways_are_said():
    with pytest.raises(study.StudyError) as caught:
        study.solve(**LAYER)
    assert caught.value.messages == (
        'solve: Nbar is missing: micro = "power_law" needs it',
        'solve: Ra is missing: micro = "power_law" needs it',
        "solve: B and beta may be given; if neither is, they are fitted to Nbar and Ra",
    )


def test_one_of_the_two_is_not_fitted():
    for given in ({"B": 0.1}, {"beta": 0.5}):
        with pytest.raises(study.StudyError, match='is missing: micro = "power_law" needs it'):
            study.solve(**LAYER, Nbar=250000, Ra=0.004, **given)
    with pytest.raises(study.StudyError, match="Nbar is missing"):
        study.solve(**LAYER, Ra=0.004)


def test_too_many_and_too_extreme(monkeypatch):
    monkeypatch.setattr(laws, "MOST_FITS", 3)
    with pytest.raises(study.StudyError, match=r"at most 3 values of Nbar Ra\^2 are fitted, not 4"):
        study.solve(**LAYER, Nbar=xr.DataArray([1e5, 2e5, 3e5, 4e5], dims="i"), Ra=0.004)
    with pytest.raises(study.StudyError, match=r"B fitted to Nbar Ra\^2 = 1e-10 is .*: must be in \[1e-8, 1e4\]"):
        study.solve(**LAYER, Nbar=1e-2, Ra=1e-4)


def test_study_files_and_what_check_says(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = 'model = {micro = "power_law", n = 0.5, h = 0.02, P = 1e-5, Ra = 0.004}\naxes.Nbar = [62500, 250000]'
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    assert main(["check", "mine.toml"]) == 0
    told = "    power law fitted to Nbar and Ra: B = 0.09192 to 0.3157 (in Ra/E1*^beta), beta = 0.4908 to 0.5342"
    assert capsys.readouterr().out.splitlines()[1] == told
    (tmp_path / "one.toml").write_text(text.replace("[62500, 250000]", "[250000]"), encoding="utf-8")
    assert main(["check", "one.toml"]) == 0
    told = "    power law fitted to Nbar and Ra: B = 0.09192 (in Ra/E1*^beta), beta = 0.4908"
    assert capsys.readouterr().out.splitlines()[1] == told
    assert main(["run", "mine.toml"]) == 0
    found = study.load("mine.toml").open()
    assert found.B.attrs["comment"] == laws.COMMENT and found.B.dims == ("Nbar",)
    tables = {"model": {**LAYER, "Nbar": 250000, "Ra": 0.004}}
    given = from_tables(tables, "s", "", "s").grid.values
    same = {"model": tables["model"] | {name: given[name][1].item() for name in ("B", "beta")}}
    assert from_tables(same, "s", "", "s").digest == from_tables(tables, "s", "", "s").digest
