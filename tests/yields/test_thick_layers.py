"""Largest stresses under thick and stiff layers, which are found at lengths of the layer and not of the contact."""

import numpy as np
import pytest
from yielding import first_yield as of_bodies
from yielding import largest

import study
from solver import Problem, solve
from solver.fields.contact import of_contacts as fields_of
from solver.fields.invariants import mises
from solver.fields.pressure import Pressure
from solver.kernels.two_layers import TwoLayers
from solver.numerics.mesh import mesh_of
from solver.yields.extremes import VALUES, coarsely, extremes
from solver.yields.first import first_yield
from solver.yields.loaded import Loaded

SLIDING = {"bonding": "frictionless", "micro": "smooth"}


def test_a_body_under_a_thick_layer_yields():
    """The stress is found nowhere near the contact; the numbers are those of a dense search."""
    found = of_bodies("body", h=0.1, n=20.0, nu2=0.5, Y2=1e-4, **SLIDING)
    assert found.found_Y2.item() == 0
    assert (found.P_Y2.item(), found.a_Y2.item()) == pytest.approx((2.4505e-5, 0.009728), rel=1e-4)
    contact = study.solve(a=0.001, h=0.1, n=20.0, nu2=0.5, **SLIDING)
    assert largest(contact, "mises2").mises2.item() == pytest.approx(1.092e-7, rel=1e-3)
    protected = study.h_protect(P=1e-5, Y2=1e-4, n=20.0, nu2=0.5, **SLIDING)
    assert protected.h_protect.item() == pytest.approx(0.063843, rel=1e-5)


def test_a_plate_of_steel_on_ptfe():
    steel = "steel 52100"
    scene = {"R": "50 mm", "punch": steel, "layer": steel, "h": "20 mm", "body": "PTFE"}
    assert of_bodies("body", **scene, **SLIDING).P_Y2.item() == pytest.approx(1.1087e6, rel=1e-4)


def test_all_bodies_yield_where_a_dense_grid_has_the_strength():
    n, nu2, Y = np.array([3.0, 20.0, 100.0]), np.array([0.5, 0.3, 0.5]), np.array([1e-5, 1e-3, 1e-4])
    case = {"h": 0.1, "nu1": 0.3, **SLIDING}
    found = first_yield(Problem.of(P=1.0, n=n, nu2=nu2, **case), "body", Y)
    assert found.crossed.all() and (0.1 / found.at > 4).all()
    for i in range(len(n)):
        at = Problem.of(a=found.at[i], n=n[i], nu2=nu2[i], **case)
        h = 0.1 / found.at[i]
        breadth = max(1.0, h * np.cbrt(n[i]))
        z = h + np.geomspace(0.02, 4 * breadth, 40) * (1 + 1e-9)
        fields = fields_of(at, solve(at), np.append(0.0, np.geomspace(0.05, 3 * breadth, 20)), z).inside
        values = mises(*(fields[name][0] for name in ("sr", "st", "sz", "trz"))) / Y[i]
        assert 0.98 < values.max() < 1 + 1e-6, (n[i], nu2[i], Y[i])


#: h/a, n, nu1, nu2, bonded, mu, and what was too small or not seen, when the grid had lengths of a alone.
MISSED = [
    (70.0, 0.003, 0.27, 0.26, False, 0.0, "mises2"),
    (3.8, 9400.0, 0.5, 0.5, True, 0.0, "mises2"),
    (29.0, 430.0, 0.5, 0.4, False, 0.9, "tresca2"),
    (3.8, 9400.0, 0.5, 0.5, True, 0.0, "s1_surface"),
    (11.0, 120.0, 0.2, 0.3, False, 0.0, "sz_interface_max"),
    (4.345, 4207.0, 0.185, 0.342, True, 0.0, "tau_interface"),
]


@pytest.mark.parametrize(("h", "n", "nu1", "nu2", "bonded", "mu", "name"), MISSED)
def test_no_point_of_a_wide_grid_has_more(h, n, nu1, nu2, bonded, mu, name):
    """Nor has the coarse search less than nine tenths of that, of what yields."""
    layers = TwoLayers(*(np.array([value]) for value in (n, nu1, nu2)), np.array([bonded]))
    mesh = mesh_of(6)
    loaded = Loaded(layers, np.array([h]), Pressure(mesh, mesh.s[None]), False, mu, np.zeros(1))
    breadth = h * max(1.0, np.cbrt(n))
    r, below = np.append(0.0, np.geomspace(0.1, 8 * breadth, 50)), np.append(0.0, np.geomspace(0.1, 4 * breadth, 40))
    body = name in ("mises2", "tresca2")
    z = h + below if body else np.array([0.0 if name == "s1_surface" else h])
    function = {"mises2": "mises", "tresca2": "tresca", "s1_surface": "s1", "tau_interface": "tau"}.get(name, "tension")
    dense = VALUES[function](*loaded.stresses(r, z, body)[:, 0]).max()
    value = extremes(loaded, (name,))[name][0, 0]
    assert dense * (1 - 1e-9) <= value <= 1.05 * dense
    assert not body or coarsely(loaded, (name,))[name][0, 0] > 0.9 * dense
