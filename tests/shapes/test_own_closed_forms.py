"""A shape of somebody else's with closed forms of all that a rough contact asks: f = c r^4. On a half-space Sneddon's
solution is known."""

from typing import NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem, Status
from solver.numerics.mesh import mesh_of
from solver.rough.adaptive import solve_newton
from solver.rough.equation import control_gradient, evaluate, jacobian
from solver.rough.punch import Shaped, punch_of
from solver.rough.start import first_guess
from solver.scaling import as_cases, dimensionless
from solver.shapes.shape import column, no_kinks

X = np.array([0.0, 0.5, 0.9])


class Quartic(NamedTuple):
    """f = c r^4, c (B,) in 1/R³. On a half-space p = (32 E c a³/(9 π)) s (1 + 2x²), P = (64/15) E c a^5, and
    D = (8/3) c a^4 (Sneddon 1965). With x² = 1 - s², f(a) - f(ax) = c a^4 s² (2 - s²)."""

    c: np.ndarray

    polynomial = True

    @property
    def pointed(self):
        return self.c < 0

    @property
    def even(self):
        return self.c > 0

    def take(self, index):
        return Quartic(self.c[index])

    def height(self, r):
        return column(self.c) * r**4

    def slope(self, r):
        return 4 * column(self.c) * r**3

    def lifted(self, t):
        return 8 / 3 * self.height(t)

    def lifted_slope(self, t):
        return 8 / 3 * self.slope(t)

    def lifted_load(self, a):
        return 32 / 15 * self.c * a**5

    def kinks(self):
        return no_kinks(self.c)

    def least(self):
        return 0 * self.c

    def most(self):
        return np.inf * self.c

    def drop(self, a, s):
        return 2 * (self.c * a**2)[:, None] * s**2 * (2 - s**2)

    def drop_slope(self, a, s):
        return 2 * self.drop(a, s)

    def depth(self, a):
        return 2 * self.c * a**2

    def depth_slope(self, a):
        return 4 * self.c * a**2

    def radius_at_depth(self, D):
        return (D / (2 * self.c)) ** 0.25

    def on_half_space(self, P, E, softness):
        return (15 / 64 * P * softness / (E * self.c)) ** 0.2

    def on_springs(self, P, C):
        """From p = c a^4 (1 - x^4)/C."""
        return (1.5 * C * P / (np.pi * self.c)) ** (1 / 6)

    def on_asperities(self, P, p_star, A_star, e):
        """As if f(a) - f(ax) were c a^4 s², which is enough for a first guess."""
        return (P * (e + 1) / (np.pi * p_star) * (A_star / self.c) ** e) ** (1 / (2 + 4 * e))

    def stiffness(self, a, s, half_space, springs):
        """On a half-space q = (32 E c a³/(9 π p*)) s (3 - 2s²) is (256/(9 π²)) c a² s (3 - 2s²)/X."""
        shape = 256 / (9 * np.pi**2) * (self.c * a**2)[:, None] * s * (3 - 2 * s**2)
        return half_space / shape + springs / self.drop(a, s)


def cases(c=1.0, **case):
    found = as_cases(dimensionless(Problem.of(**case)))
    return found._replace(shape=Quartic(np.full(len(found.value), c)))


@np.errstate(all="ignore")  # as in solver.solve: what goes wrong is a status
def solved(control, value, rtol=1e-10, c=1.0, **case):
    part = cases(c, **{control: value}, **case)
    size = len(part.value)
    return solve_newton(part, np.full(size, rtol), np.zeros(size, int), 0, X)


def test_its_closed_forms_are_those_of_any_shape():
    """Drop, depth and their slopes to rounding; the guesses of the radius to the 1e-3 to which these are searched."""
    own, a, s = Quartic(np.array([0.7, 2.0])), np.array([0.05, 0.3]), np.array([0.1, 0.5, 1.0])
    assert punch_of(own) is own
    other = Shaped(own)
    for name, arguments in {"drop": (a, s), "drop_slope": (a, s), "depth": (a,), "depth_slope": (a,)}.items():
        assert_allclose(getattr(own, name)(*arguments), getattr(other, name)(*arguments), rtol=1e-12, atol=0)
    P = 1e-5 * np.ones(2)
    for name, arguments in {"on_half_space": (P, 1.0, np.ones(2)), "on_springs": (P, 0.1 * np.ones(2))}.items():
        assert_allclose(getattr(own, name)(*arguments), getattr(other, name)(*arguments), rtol=2e-3, atol=0)


@pytest.mark.parametrize("control", ["a", "P", "D"])
def test_half_space(control):
    """1e-10, what the polynomials of the mesh hold of p: it is s times a polynomial in s², so no mesh misses any."""
    a, c = np.array([0.01, 0.1, 0.3]), 0.7
    exact = {"a": a, "P": 64 / 15 * c * a**5, "D": 8 / 3 * c * a**4}
    found = solved(control, exact[control], c=c, base="half_space", micro="smooth")
    assert found.status.tolist() == [Status.CONVERGED] * 3
    for name, values in exact.items():
        assert_allclose(getattr(found, name), values, rtol=1e-10, atol=0)
    p = 32 / (9 * np.pi) * c * (a**3)[:, None] * np.sqrt(1 - X**2) * (1 + 2 * X**2)
    assert_allclose(found.p, p, rtol=1e-10, atol=0)
    assert_allclose(found.dP_dD, 2 * a, rtol=1e-10, atol=0)


#: Rows n, nu1, nu2, bonding, h, P, D, p at X for c = 1, a = 0.1 (R = E2* = 1), by a Fredholm equation of the second
#: kind in long double, on two resolutions that agree to 8e-15: another formulation, another code.
LAYERED = [
    (0.01, 0.45, 0.3, "bonded", 0.2, 4.548137869761709e-07, 1.784151530183779e-04)
    + (1.275243735340508e-05, 1.589382078058322e-05, 1.347235301378044e-05),
    (0.5, 0.3, 0.3, "bonded", 0.02, 3.158002614291433e-05, 2.259168484022190e-04)
    + (9.894629133535447e-04, 1.177436653715824e-03, 8.371125212585822e-04),
    (100, 0.3, 0.3, "frictionless", 1, 4.254990781125000e-03, 9.015543241366760e-04)
    + (1.126186049609794e-01, 1.465379982170220e-01, 1.290088669453256e-01),
]


@pytest.mark.parametrize("control", ["a", "P", "D"])
@pytest.mark.parametrize("row", LAYERED)
def test_layers(row, control):
    n, nu1, nu2, bonding, h, P, D, *p = row
    exact = {"a": 0.1, "P": P, "D": D}
    layer = {"n": n, "nu1": nu1, "nu2": nu2, "bonding": bonding, "h": h, "micro": "smooth"}
    found = solved(control, exact[control], rtol=1e-9, **layer)
    assert found.status.item() == Status.CONVERGED
    for name, value in exact.items():
        assert_allclose(getattr(found, name).item(), value, rtol=1e-9, atol=0)  # what was asked for
    assert_allclose(found.p[0], p, rtol=0, atol=1e-8 * max(p))  # a tenth of it is reached; profiles have no rtol


@pytest.mark.parametrize("base", ["half_space", "thin_layer", "layered"])
def test_rough_stiffness_is_the_slope_of_the_load(base):
    """dP/dD of the solution against a central difference of P by D; h² of it is 1e-8."""
    case = {"base": base, "h": 0.02, "n": 0.5, "Nbar": 250000.0, "Ra": 0.004}
    D = 1e-4 * np.array([1 - 1e-4, 1, 1 + 1e-4])
    found = solved("D", D, rtol=1e-11, **case)
    assert found.status.tolist() == [Status.CONVERGED] * 3
    assert_allclose((found.P[2] - found.P[0]) / (D[2] - D[0]), found.dP_dD[1], rtol=1e-7, atol=0)


@pytest.mark.parametrize("control", ["P", "D"])
def test_the_slopes_by_the_radius_are_those_of_the_equation(control):
    """Derivatives of F and of the control by ln a at fixed q against central differences; their h² is 1e-10."""
    part, mesh, h = cases(Nbar=250000.0, Ra=0.004, h=0.02, n=0.5, **{control: 1e-4}), mesh_of(8), 1e-5
    state = first_guess(part, mesh, np.array([0.1]))
    at = evaluate(part, state, mesh)
    low, high = (evaluate(part, state._replace(eta=state.eta + step), mesh) for step in (-h, h))
    assert_allclose(at.X * jacobian(at)[1], (high.F - low.F) / (2 * h), rtol=0, atol=1e-8 * np.abs(at.F).max())
    assert_allclose(control_gradient(control, at)[1], (high.G - low.G) / (2 * h), rtol=1e-8, atol=0)
