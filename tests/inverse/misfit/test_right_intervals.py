"""Intervals beside right values: of one modulus that is a factor of the load they follow in closed form."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import norm, t

import study

BARE = {"R": "5 um", "punch": "rigid", "nu2": 0.3, "micro": "smooth", "base": "half_space", "progress": False}
DEPTHS = np.linspace(0.02, 1, 40) * 1e-6
#: P = E SHAPE, by Hertz.
SHAPE = 4 / 3 / (1 - 0.3**2) * np.sqrt(5e-6) * DEPTHS**1.5


def right(P, level, sigma=None):
    """E, its standard deviation and the half of its interval, of P = E SHAPE + noise by linear regression."""
    E = (P @ SHAPE) / (SHAPE @ SHAPE)
    scatter = np.sqrt(((P - E * SHAPE) ** 2).sum() / (len(P) - 1)) if sigma is None else sigma
    sd = scatter / np.sqrt(SHAPE @ SHAPE)
    return E, sd, sd * (t.ppf((1 + level) / 2, len(P) - 1) if sigma is None else norm.ppf((1 + level) / 2))


@pytest.mark.parametrize("sigma", [None, 4e-10])
@pytest.mark.parametrize("level", [0.5, 0.95])
def test_ends_of_intervals(level, sigma):
    """Of a profile E ± t sd, to 0.5 %; by the curvature exp(ln E ± t sd/E)."""
    P = 5e3 * SHAPE + 4e-10 * np.random.default_rng(8).standard_normal(len(DEPTHS))
    E, sd, half = right(P, level, sigma)
    options = {"contact_point": False, "baseline": False, "level": level, "sigma": sigma}
    data = {"D": (DEPTHS, "m"), "P": (P, "N")}
    for way in ("profile", "fisher"):
        fit = study.fit(data, free=["E2"], intervals=way, **options, **BARE)
        assert_allclose([fit.E2.item(), fit.E2_spread.item()], [E, sd], rtol=1e-6)
        ends = E + np.array([-half, half]) if way == "profile" else E * np.exp(np.array([-half, half]) / E)
        assert_allclose([fit.E2_low.item(), fit.E2_high.item()], ends, rtol=0, atol=5e-3 * half)
    assert fit.effective_points == len(DEPTHS)


STACK = {"R": "5 um", "punch": "rigid", "E2": "rigid", "micro": "smooth", "progress": False}
LAYERS = [{"h": "1 um", "E1": "20 kPa", "nu": 0.45, "bonding": "bonded"},
          {"h": "4 um", "E1": "5 kPa", "nu": 0.45, "bonding": "bonded"}]  # fmt: skip


def test_the_first_layer_of_a_stack_is_fitted_and_summarised():
    """By its name in the list, from the value there; with ± there it is a prior if it is free."""
    depths = np.linspace(-0.2, 1, 50) * 2e-7
    pressed = [f"{float(depth)!r} m" for depth in depths[depths > 0]]
    P = np.zeros(len(depths))
    P[depths > 0] = study.solve(**STACK, layers=LAYERS, D=pressed, x=2, profiles=False).P.values
    data, off = {"D": (depths, "m"), "P": (P, "N")}, [LAYERS[0] | {"E1": "30 kPa"}, LAYERS[1]]
    fit = study.fit(data, free=["layers.1.E1"], layers=off, intervals="fisher", **STACK)
    assert fit["layers.1.E1"].item() == pytest.approx(2e4, rel=1e-4)
    assert {"layers.1.E1_low", "layers.1.E1_spread"} <= {*fit.data_vars} and fit.cov_i.values[0] == "layers.1.E1"
    assert "Young's modulus of layer 1  layers.1.E1 = 20" in str(study.summary(fit))
    noisy = {"D": (depths, "m"), "P": (P + 0.05 * P.max() * np.random.default_rng(1).standard_normal(len(P)), "N")}
    sure = [LAYERS[0] | {"E1": "20 ± 0.2 kPa"}, LAYERS[1]]
    prior = study.fit(noisy, free=["layers.1.E1"], layers=sure, intervals="fisher", **STACK)
    assert prior["layers.1.E1_spread"].item() == pytest.approx(200, rel=0.05)
