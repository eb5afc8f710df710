"""Contacts side by side: with a layer and without one in a study, results of two layers joined."""

import tomllib

import numpy as np
import pytest
import xarray as xr
from test_study_files import TEXT, of

import study

pytest.importorskip("pint")


def test_a_case_without_a_layer_shows_none_of_another_case(tmp_path):
    """And is found again in the results."""
    rows = '[[cases]]\nbase = "half_space"\n[[cases]]\nlayer = "TiN"\nh = "2 um"\nbonding = "bonded"\n'
    text = f'[model]\nR = "5 mm"\nbody = "steel 52100"\nmicro = "smooth"\n{rows}[axes]\nP = ["1 N", "2 N"]\n'
    of(text, tmp_path, "bare").run(workers=1)
    found = of(text, tmp_path, "bare").open()
    for name in ("h", "E1", "nu1", "n", "E1_spread", "nu1_spread"):
        assert np.isnan(found[name]).values.tolist() == [True, False], name
    assert found.layer.values.tolist() == ["", "TiN"]
    assert ["TiN" in str(study.summary(found.isel(case=case, P=0))) for case in (0, 1)] == [False, True]
    assert "Not used" not in study.summary(found)
    grown = of(text.replace("2 N", "3 N").replace('["1 N"', '["1 N", "2 N"'), tmp_path, "bare")
    assert grown.dry_run().present >= 4
    grown.run(workers=1)
    np.testing.assert_array_equal(grown.open().sel(P=[1, 2]).a, found.a)


def test_results_of_two_layers_are_joined_in_both_orders(tmp_path):
    """With the materials of each: `xr.concat` compared no coordinate behind the first that one of them had alone."""
    given = tomllib.loads(TEXT)["model"] | {"E2": ["210 GPa"], "h": ["2 um"], "P": ["10 N"], "x": 3}
    other = study.solve(**given | {"nu1": 0.1})
    of(TEXT, tmp_path).run(workers=1)
    opened = of(TEXT, tmp_path).open().sel(E2=other.E2, h=other.h, P=other.P)
    for both in ([opened, other], [other, opened]):
        joined = xr.concat(both, "layer")
        assert joined.nu1.values.tolist() == [one.nu1.item() for one in both]
