"""`validity` 32 of hard films on soft bodies, which the punch stretches."""

import numpy as np
import pytest

import study

SMOOTH = {"micro": "smooth", "x": 2}
METAL_ON_RUBBER = {"R": "50 um", "E1": "70 GPa", "nu1": 0.35, "E2": "1 MPa", "nu2": 0.49, "micro": "smooth", "x": 2}


def tension_share(found, R=50e-6):
    """Pressure that the membrane forces of a film bear in the centre, over p(0), if it has the slope r/R up to a free
    edge at a: from Föppl's r d(N_r + N_θ)/dr = -E h (slope)²/2, N_θ = d(r N_r)/dr, by steps from r = 0 to a."""
    a, h, E = found.a.item(), found.h.item(), 70e9 / (1 - 0.35**2)
    r = np.linspace(0, a, 2001)
    both = np.append(0, np.cumsum(-E * h / 2 * np.diff(r**2) / 2 / R**2))  # N_r + N_θ less its value in the centre
    radial = np.append(0, np.cumsum(np.diff(r**2) / 2 * (both[1:] + both[:-1]) / 2))[1:] / r[1:] ** 2  # less half of it
    centre = -radial[-1]  # N_r = 0 at the edge
    return 2 * centre / R / found.p0.item()


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("h", ["100 nm", "500 nm"])
@pytest.mark.parametrize("a", ["0.5 um", "1 um", "2 um", "4 um", "8 um"])
def test_where_the_tension_bears_a_tenth(h, a):
    found = study.solve(**METAL_ON_RUBBER, h=h, a=a)
    share = tension_share(found)
    assert abs(share - 0.1) > 0.005, "no case of these is at the limit"
    assert (found.validity.item() & 32 > 0) == (share > 0.1)


def test_both_occur():
    with pytest.warns(UserWarning, match="or stretched like a membrane"):
        found = study.solve(**METAL_ON_RUBBER, h="100 nm", a=["0.5 um", "8 um"])
    assert (found.validity & 32 > 0).values.tolist() == [False, True]


def test_coatings_on_metals_are_not():
    hard = {"R": "5 mm", "E1": "400 GPa", "E2": "70 GPa", "h": ["1 um", "5 um"], "a": "100 um", "micro": "smooth"}
    assert not (study.solve(**hard, x=2).validity & 32).any()


@pytest.mark.filterwarnings("ignore")
def test_a_ball_is_a_paraboloid_there():
    """Its slope at the edge is that of a paraboloid to some percent."""
    places = {"h": "100 nm", "a": ["0.5 um", "2 um", "4 um"]}
    paraboloid, ball = (study.solve(**METAL_ON_RUBBER, **places, shape=name) for name in ("paraboloid", "sphere"))
    assert (paraboloid.validity & 32 > 0).values.tolist() == [False, True, True]
    assert (ball.validity & 32 > 0).values.tolist() == [False, True, True]


@pytest.mark.parametrize(("half_angle", "strained"), [(89.5, False), (70.0, True)])
def test_under_a_sharp_tip_the_mean_pressure_compresses(half_angle, strained):
    """p(0) is infinite; the mean pressure E cot(α)/2 is 0.004 E and 0.18 E, and both depths are above h/10."""
    cone = study.solve(a=0.2, h=0.01, n=1.0, nu1=0.3, bonding="bonded", shape="cone", half_angle=half_angle, **SMOOTH)
    assert np.isinf(cone.p0) and 0.1 * cone.h < cone.D
    assert (cone.validity.item() & 32 > 0) == strained
