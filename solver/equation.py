"""The discrete equation: dimensionless groups, residual, Jacobian, first guess; for a batch of cases of one micro law.

With p = p* q(y), A = A* g(y) and s = sqrt(1 - x²), Eq. (4) divided by a²/2 is

    X K[q] + Y q + Z g - s² = 0,    X = 8 p*/(pi a),  Y = 2 C p*/a²,  Z = 2 A*/a²        (R = E2* = 1)

at the nodes of the mesh; the control (load, radius or depth) is one more equation for η = ln a.
"""

from typing import NamedTuple

import numpy as np

from .mesh import HERTZ
from .micro import Curve

CONTROLS = ("P", "a", "D")


class Cases(NamedTuple):
    """A batch of B rough cases in units R = 1, E2* = 1; arrays (B,). `control` is one of CONTROLS for the whole
    batch."""

    control: str
    value: np.ndarray
    p_star: np.ndarray
    A_star: np.ndarray
    C: np.ndarray
    exponent: np.ndarray

    def take(self, index):
        """The sub-batch at `index`."""
        return Cases(self.control, *(field[index] for field in self[1:]))


class State(NamedTuple):
    """Unknowns: y (B, n) of the micro law at the nodes, and η = ln a (B,)."""

    y: np.ndarray
    eta: np.ndarray

    def take(self, index):
        """The sub-batch at `index`."""
        return State(self.y[index], self.eta[index])


class Evaluation(NamedTuple):
    """The equation at a state: groups X, Y, Z (B, 1), the law, H-differences Kq (B, n), residuals F (B, n) and G
    (B,)."""

    X: np.ndarray
    Y: np.ndarray
    Z: np.ndarray
    curve: Curve
    Kq: np.ndarray
    F: np.ndarray
    G: np.ndarray

    @property
    def residual(self):
        """Largest residual of a case (B,), relative to the right-hand side (s² <= 1) and to the controlled value."""
        return np.maximum(np.abs(self.F).max(axis=1), np.abs(self.G))

    def take(self, index):
        """The sub-batch at `index`."""
        return Evaluation(
            *(v[index] for v in self[:3]), Curve(*(v[index] for v in self.curve)), *(v[index] for v in self[4:])
        )


def groups(cases, eta):
    """X, Y, Z (B, 1) at η = ln a (B,)."""
    a = np.exp(eta)
    return (
        ((8 / np.pi) * cases.p_star / a)[:, None],
        (2 * cases.C * cases.p_star / a**2)[:, None],
        (2 * cases.A_star / a**2)[:, None],
    )


def evaluate(cases, state, law, mesh):
    """:class:`Evaluation` of `cases` at `state`."""
    X, Y, Z = groups(cases, state.eta)
    curve = law.evaluate(state.y, cases.exponent)
    Kq = curve.q @ mesh.K.T
    F = X * Kq + Y * curve.q + Z * curve.g - mesh.s**2
    return Evaluation(X, Y, Z, curve, Kq, F, control_residual(cases, state.eta, X, curve.q, mesh))


def control_residual(cases, eta, X, q, mesh):
    """Logarithm of (controlled quantity/given value), (B,): Eq. (5) for the load, Eq. (3) at r = a for the depth."""
    if cases.control == "a":
        return eta - np.log(cases.value)
    if cases.control == "P":
        return np.log(2 * np.pi * cases.p_star * (q @ mesh.w) / cases.value) + 2 * eta
    return np.log((1 + X[:, 0] * (q @ mesh.edge)) / (2 * cases.value)) + 2 * eta


def control_gradient(control, ev, mesh):
    """Derivatives of the logarithm of `control` by q (B, n) and by η (B,)."""
    q, X = ev.curve.q, ev.X[:, 0]
    if control == "P":
        return mesh.w / (q @ mesh.w)[:, None], np.full(len(q), 2.0)
    if control == "a":
        return np.zeros_like(q), np.ones(len(q))
    edge = X * (q @ mesh.edge)
    return ev.X * mesh.edge / (1 + edge)[:, None], 2 - edge / (1 + edge)


def jacobian(ev, mesh):
    """dF/dq (B, n, n) at fixed η, and dF/dη (B, n) at fixed q. In q, not y: the operator is linear in it."""
    matrix = ev.X[:, :, None] * mesh.K
    diagonal = np.arange(mesh.n)
    matrix[:, diagonal, diagonal] += ev.Y + ev.Z * (ev.curve.dg / ev.curve.dq)
    return matrix, -(ev.X * ev.Kq + 2 * (ev.Y * ev.curve.q + ev.Z * ev.curve.g))


def first_guess(cases, law, mesh):
    """State from the three one-term solutions (half-space, springs, asperities alone) added as compliances."""
    a = _guess_radius(cases, *law.power(cases.exponent))
    q = guess_pressure(cases, law, *groups(cases, np.log(a)), mesh.s)
    return State(law.guess(q, cases.exponent), np.log(a))


def guess_pressure(cases, law, X, Y, Z, s):
    """q (B, m) at s (m,) > 0 for groups (B, 1): each of the three terms of the equation is exact where it matters
    alone."""
    gamma, beta = law.power(cases.exponent)
    s2 = s**2
    alone = (s2 / (Z * gamma[:, None])) ** (1 / beta[:, None])
    return 1 / ((X * HERTZ * s + Y) / s2 + 1 / alone)


def _guess_radius(cases, gamma, beta):
    if cases.control == "a":
        return cases.value
    if cases.control == "D":  # a² is D for a half-space and 2 D where the displacement is local
        return np.sqrt(1.5 * cases.value)
    hertz, springs, spots = one_term_radii(cases, gamma, beta)
    return (hertz**4 + springs**4 + spots**4) ** 0.25


def one_term_radii(cases, gamma, beta):
    """Radii (B,) under the load of a half-space, of springs of compliance C, and of asperities of A ~ p^β alone."""
    e = 1 / beta
    hertz = np.cbrt(0.75 * cases.value)
    springs = (4 * cases.C * cases.value / np.pi) ** 0.25
    spots = (cases.value / (2 * np.pi * cases.p_star) * (2 * cases.A_star * gamma) ** e * (2 * e + 2)) ** (
        1 / (2 + 2 * e)
    )
    return hertz, springs, spots
