"""Loads of first yield and largest stresses under shapes: scaling laws, balls, and fields on a fine grid."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from yielding import largest

import study
from solver import Problem, solve
from solver.fields.contact import of_contacts as fields_of
from solver.fields.invariants import invariants
from solver.yields.contact import of_contacts

BARE = {"base": "half_space", "micro": "smooth"}


def test_powers_scale():
    """On a half-space f = c r^k makes stresses like a^(k - 1) and loads like a^(k + 1); r²/(2R) is Hertz's."""
    k, Y = np.array([1.5, 2.0, 4.0]), np.array([0.002, 0.004])
    shape = {"shape": "power", "shape_coefficient": 0.5, "shape_power": k.tolist()}
    yielding = study.first_yield(Y2=Y.tolist(), **shape, nu2=0.3, **BARE)
    assert (yielding.found_Y2 == 0).all() and "message" not in yielding.P_Y2.attrs
    ratios = {
        name: yielding[f"{name}_Y2"].sel(Y2=Y[1]) / yielding[f"{name}_Y2"].sel(Y2=Y[0]) for name in ("P", "a", "z")
    }
    assert_allclose(ratios["P"], 2 ** ((k + 1) / (k - 1)), rtol=1e-5)  # P is known to 1e-7 (k + 1)/(k - 1)
    assert_allclose(ratios["a"], 2 ** (1 / (k - 1)), rtol=1e-5)
    assert_allclose(ratios["z"], 1.0, rtol=1e-3)
    ball = study.first_yield(Y2=Y.tolist(), nu2=0.3, **BARE)
    assert_allclose(yielding.P_Y2.sel(shape_power=2.0), ball.P_Y2, rtol=1e-6)


def test_a_blunt_cone_yields_as_its_tip():
    """Where the contact is on the round tip: R is then the radius of the tip. Below a layer too."""
    tip = {"shape": "blunt_cone", "half_angle": 60, "tip_radius": 0.1}
    yielding, ball = (study.first_yield(Y2=0.01, nu2=0.3, **shape, **BARE) for shape in (tip, {}))
    assert_allclose(yielding.P_Y2, 0.01 * ball.P_Y2, rtol=1e-6)
    assert_allclose(yielding.a_Y2, 0.1 * ball.a_Y2, rtol=1e-6)
    coated = study.first_yield(Y1=0.05, h=0.002, n=3.0, nu1=0.2, bonding="bonded", micro="smooth", **tip)
    scaled = study.first_yield(Y1=0.05, h=0.02, n=3.0, nu1=0.2, bonding="bonded", micro="smooth")
    assert_allclose(coated.P_Y1, 0.01 * scaled.P_Y1, rtol=1e-6)


def test_what_a_sharp_tip_touches_yields_under_any_load():
    """Not so what is below a layer, nor a body that keeps its volume."""
    tip = {"shape": "cone", "half_angle": 80}
    yielding = study.first_yield(Y1=0.05, Y2=0.01, h=0.1, n=3.0, bonding="bonded", micro="smooth", **tip)
    assert yielding.P_Y1 == 0 and yielding.found_Y1 == 0 and "yields under any load" in yielding.P_Y1.attrs["comment"]
    at = study.solve(a=float(yielding.a_Y2), h=0.1, n=3.0, bonding="bonded", micro="smooth", **tip)
    assert largest(at, "mises2").mises2.item() == pytest.approx(0.01, rel=1e-6)
    corner = study.first_yield(Y2=0.01, flat_radius=0.1, half_angle=80, shape="frustum", **BARE)
    assert corner.P_Y2 == 0 and corner.a_Y2 == 0.1
    rubber = study.first_yield(Y2=5.0, nu2=0.5, **tip, **BARE)
    assert rubber.found_Y2 == 1 and "up to a slope of the shape of 0.4" in rubber.P_Y2.attrs["message"]
    assert rubber.found_Y2.attrs["flag_meanings"].split()[1] == "none_up_to_a_slope_of_0.4"


def test_next_to_a_flat_end_the_largest_stress_is_in_a_narrow_ring():
    """It is at r = 0.996 a, 0.005 a deep, where fields on a fine grid have it; the coarse grid alone misses it."""
    problem = Problem.of(a=0.101, shape="rounded_flat", flat_radius=0.1, edge_radius=0.05, **BARE)
    solution = solve(problem)
    largest, r, z = of_contacts(problem, solution, names=("mises2",))["mises2"][:, 0]
    place = r * np.linspace(0.9995, 1.0005, 11), z * np.linspace(0.9, 1.1, 11)
    fields = fields_of(problem, solution, *place).inside
    around = invariants(*(fields[name][0] for name in ("sr", "st", "sz", "trz"))).mises
    assert around.max() == pytest.approx(largest, rel=1e-6) and around[5, 5] == around.max()
    assert 0.99 < r < 0.999 and 0.003 < z < 0.007
    coarse = of_contacts(problem, solution, names=("mises2",), coarse=True)["mises2"][0, 0]
    assert 0.85 < coarse / largest <= 1 + 1e-9


def test_what_protects_the_body_from_a_sharp_tip():
    """A bare body yields at once; below a layer of this thickness its largest stress is the strength."""
    scene = {"P": 1e-4, "shape": "berkovich", "n": 2.0, "bonding": "bonded", "micro": "smooth"}
    yielding = study.h_protect(Y2=0.01, **scene)
    h = yielding.h_protect.item()
    stress = largest(study.solve(h=[h, 1.05 * h, 3 * h], **scene), "mises2").mises2.values / 0.01
    assert stress[0] == pytest.approx(1.0, rel=1e-6) and (stress[1:] < 1).all() and np.isnan(yielding.h_yields)
