"""The published laws of one sphere that yields, as the figure has them: what their papers say of them in words."""

import numpy as np
import pytest

from study.studies.literature import yielding


@pytest.mark.parametrize("law", yielding.LAWS)
def test_before_it_yields_a_sphere_is_hertz(law):
    """The area is π R w, and the mean pressure 4/(3π) E* sqrt(w/R), which is 2/3 of the largest."""
    w = np.linspace(0.3, 0.95, 20)
    pressure, area = yielding.LAWS[law][0](w)
    np.testing.assert_allclose(area, 1.0, rtol=1e-4)
    np.testing.assert_allclose(pressure / np.sqrt(w), pressure[-1] / np.sqrt(w[-1]), rtol=1e-4)


def test_of_chang_etsion_and_bogy_the_pressure_jumps_to_a_constant():
    """To the largest pressure at yield, K H; the volume of the sphere stays, so that the area is π R (2 w - w_c)."""
    w = np.array([1.0, 2.0, 10.0, 100.0])
    before = yielding.ceb(np.array([1 - 1e-12]))[0].item()
    pressure, area = yielding.ceb(w)
    np.testing.assert_allclose(pressure, 1.5 * before, rtol=1e-9)
    np.testing.assert_allclose(pressure, 2.8 * (0.454 + 0.41 * yielding.NU), rtol=1e-12)
    np.testing.assert_allclose(area * w, 2 * w - 1, rtol=1e-12)


def test_of_kogut_and_etsion_the_loads_of_the_pieces_meet_to_a_few_percent():
    for place in (1.0, 6.0, 110.0):
        below, above = (np.prod(yielding.ke(np.array([place * factor]))) for factor in (1 - 1e-9, 1 + 1e-9))
        assert below == pytest.approx(above, rel=0.1)
    pressure, area = yielding.ke(np.array([110.0, 500.0]))
    assert pressure.tolist() == [2.8, 2.8] and area.tolist() == [2.0, 2.0]


def test_of_jackson_and_green_the_pressure_has_a_peak():
    """The hardness falls as the spot grows to the size of the sphere."""
    pressure, area = yielding.jg(yielding.W)
    peak = pressure.argmax()
    assert (np.diff(pressure[:peak]) > 0).all() and (np.diff(pressure[peak:]) < 0).all()
    assert 0.02 < 1 - pressure[-1] / pressure[peak] < 0.05 and (np.diff(area) >= 0).all()
