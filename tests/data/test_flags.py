"""Flags by name, and what objects show of themselves."""

import numpy as np
import pytest
import xarray as xr

import study
from solver import Problem, Status, solve


def test_every_flag_of_a_dataset_has_its_name():
    grid = {"P": [1e-6, 1e-3], "bonding": ["frictionless", "bonded"], "nu1": 0.5, "n": 0.5, "h": 0.02}
    found = study.solve(**grid, Nbar=250000, Ra=0.004, base="thin_layer")
    status = study.decode(found.status)
    assert status.dims == found.status.dims and status.name == "status"
    assert set(status.sel(bonding="bonded").values) == {"thin_layer_not_applicable"}
    assert set(status.sel(bonding="frictionless").values) == {"converged"}
    assert (study.decode(found.model_used) == "thin_layer").all()
    words = study.decode(found.validity)
    for flags, text in zip(found.validity.values.ravel(), words.values.ravel(), strict=True):
        assert text.split() == [name for mask, name in study.derived.ASSUMPTIONS.items() if flags & mask]
    assert words.sel(P=1e-6, bonding="frictionless").item() == "layer_not_thin"


def test_names_survive_arithmetic_and_unknown_numbers_stay():
    bare = xr.DataArray(np.array([0, 5, 127, 99]), dims="case", name="status")
    assert study.decode(bare).values.tolist() == ["converged", "tolerance_not_met", "not_run", "99"]
    assert study.decode(xr.DataArray(6, name="validity")).item() == "few_spots spot_not_small_against_h"
    assert study.decode(xr.DataArray(0, name="validity")).item() == ""
    with pytest.raises(ValueError, match="P is none of status, model_used, validity"):
        study.decode(xr.DataArray([1.0], name="P"))
    with pytest.raises(ValueError, match="^a Dataset is none of status, model_used, validity"):
        study.decode(bare.to_dataset())


def test_flags_of_no_case_have_no_names():
    """The mean of the masks 0, 0 and 16, 5.3, was 5: layer_not_thin and spot_not_small_against_h."""
    found = study.solve(P=[1e-6, 1e-5, 1e-4], h=0.01, n=0.5, Nbar=250000, Ra=0.004, x=2)
    assert found.validity.values.tolist() == [0, 0, 16]
    for flags in (found.validity.mean("P", keep_attrs=True), found.validity.interp(P=5e-5), found.validity > 0):
        with pytest.raises(
            ValueError, match="flags belong to no case: they have been compared, averaged or interpolated"
        ):
            study.decode(flags.rename("validity"))
    with pytest.raises(ValueError, match="flags belong to no case"):
        study.summary(found.interp(P=5e-5))


def test_where_no_case_is_left_it_was_not_run():
    """The validity of such a case had the name of a good one, ""."""
    found = study.solve(P=[1e-6, 1e-5, 1e-4], h=0.01, n=0.5, Nbar=250000, Ra=0.004, x=2)
    for change in (lambda flags: flags.where(found.P > 5e-5), lambda flags: flags.reindex(P=[2.0, 3.0, 1e-4])):
        for name, word in (("status", "converged"), ("validity", "spots_merging")):
            assert study.decode(change(found[name])).values.tolist() == ["not_run", "not_run", word]
            assert study.decode(change(found[name]).drop_attrs()).values.tolist() == ["not_run", "not_run", word]
        assert study.decode(change(found.model_used)).values.tolist() == ["none", "none", "layered"]
    assert study.decode(found.validity.where(False).isel(P=0)).item() == "not_run"
    assert study.decode(xr.concat([found.validity, found.P.rename("validity") * np.nan], "q")).values[1, 0] == "not_run"


def test_objects_show_themselves_in_one_line(tmp_path):
    problem = Problem.of(P=[1e-6, 2e-5], micro="smooth", base="half_space")
    assert repr(problem) == "Problem(2 cases, P = 1e-06 ... 2e-05, base: half_space, micro: smooth)"
    solution = solve(problem, [0.0, 0.5, 1.0])
    solution.status[1] = Status.DIVERGED
    assert repr(solution) == "Solution(2 cases: 1 converged, 1 diverged; profiles at 3 radii)"
    file = tmp_path / "mine.toml"
    text = 'axes.P = [1e-6, 1e-5]\naxes.h = [0.01]\nmodel.n = 0.5\nmodel.micro = "smooth"'
    file.write_text(text, encoding="utf-8")
    loaded = study.load(file)
    assert repr(loaded) == 'Study("mine", 2 cases (P 2 x h 1), results/mine.nc)'
    assert repr(loaded.definition) == 'Definition("mine", 2 cases (P 2 x h 1))'
