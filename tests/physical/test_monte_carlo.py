"""Spreads to first order against draws: a small sample of `python tools/errors/monte_carlo.py`. What has none."""

import numpy as np
import pytest
from monte_carlo import SYSTEMS, compared

import study

pytest.importorskip("pint")


@pytest.mark.parametrize("system", SYSTEMS)
def test_spreads_are_those_of_draws(system):
    """300 draws of the same means, spreads and no correlation: what bends is left, seen to 2.5 % with 1,000 of them."""
    for name, (first, sampled) in compared(SYSTEMS[system], 300).items():
        assert first == pytest.approx(sampled, rel=0.04), name


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_a_case_without_a_solution_has_no_spread():
    """Nor one of which a moved input has none; its neighbour has both. The estimates of error have none at all."""
    thin = {"R": "5 mm", "E1": "1 GPa ± 0.1 GPa", "E2": "200 GPa", "nu2": 0.3, "h": "2 um", "P": "1 N", "x": 2}
    thin |= {"base": "thin_layer", "micro": "smooth", "bonding": "bonded"}
    found = study.solve(**thin, nu1=[0.3, 0.5])
    assert found.status.values.tolist() == [0, 4]
    for name in ("a", "D", "p0", "p"):
        assert np.isfinite(found[f"{name}_spread"].isel(nu1=0)).all()
        assert np.isnan(found[name].isel(nu1=1)).all() and np.isnan(found[f"{name}_spread"].isel(nu1=1)).all()
    judged = {"error", "profile_error", "model_error", "residual", "status", "validity", "iterations", "nodes_used"}
    assert not {f"{name}_spread" for name in judged} & set(found.variables)
