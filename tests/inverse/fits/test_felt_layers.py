"""Fits and designs of contacts whose asperities feel the layer."""

import warnings

import numpy as np
import pytest

import study

BALL = {"R": "5 mm", "punch": "rigid", "nu1": 0.25, "E2": "70 GPa", "nu2": 0.3, "bonding": "bonded", "h": "1 um"}
BALL |= {"Nbar": "0.01 1/um^2", "Ra": "20 um"}  # a pitch of 10 h
DEPTHS = np.linspace(0.05, 0.8, 12)


@pytest.fixture(scope="module")
def curve():
    """The load over the depth, of a layer of 300 GPa, without noise."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made = study.solve(**BALL, E1="300 GPa", D=[f"{D:.6f} um" for D in DEPTHS], profiles=False, x=2)
    assert (made.asperities_used == 2).all() and (made.status == 0).all()
    return {"D": (DEPTHS, "um"), "P": (made.P.values, "N")}


def fitted(curve, **more):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        free = {"E1": ("100 GPa", "900 GPa")}
        return study.fit(curve, free=free, contact_point=False, baseline=False, sigma="1 mN", **BALL, **more)


def test_a_fit_finds_the_layer_again(curve):
    """To the tables' error, 1e-4; with asperities on a half-space it is off by more than ten times its interval."""
    felt, alone = fitted(curve), fitted(curve, asperities_on="half_space")
    assert float(felt.E1[0]) == pytest.approx(300e9, rel=1e-3)
    assert abs(float(alone.E1[0]) / 300e9 - 1) > 0.02
    assert felt.residual.std() < 0.1 * alone.residual.std()


def test_a_design_finds_the_pitch():
    """Among loads, and across a pitch of h."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        wanted = study.solve(**BALL, E1="300 GPa", P="1 N", x=2).p_max.item()
        given = {name: value for name, value in BALL.items() if name != "Nbar"}
        found = study.design({"p_max": f"{wanted} Pa"}, by={"Nbar": ("0.001 1/um^2", "10 1/um^2")}, P="1 N",
                             E1="300 GPa", **given)  # fmt: skip
    assert np.nanmin(np.abs(found.Nbar.values / 1e10 - 1)) < 1e-5
