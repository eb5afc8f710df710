"""The discrete equation: dimensionless groups, residual, Jacobian, first guess; for a batch of cases of one micro law.

With p = p* q(y), A = A* g(y) and s = sqrt(1 - x²), Eq. (4) divided by a²/2 is

    X K[q] + Y q + Z g - s² = 0,    X = 8 p*/(pi a E),  Y = 2 C p*/a²,  Z = 2 A*/a²        (R = E2* = 1)

at the nodes of the mesh; the control (load, radius or depth) is one more equation for η = ln a. K is the half-space
operator and E = E2* on a half-space and, with the springs C, on a thin layer; on the exact layered base E = E1*, C =
0, and K depends on h/a (:mod:`.layered`).
"""

from typing import NamedTuple

import numpy as np

from ..body.kernel import whole
from ..body.layered import (
    Layer,
    half_space_share,
    layer_displacement,
    layer_edge,
    layer_matrix,
    layer_products,
    layer_weights,
    take_weights,
)
from ..laws import Bound, Curve
from ..numerics.linalg import solve_stack
from ..numerics.mesh import HERTZ

#: Pressure, over the largest, that counts as none, and the least to begin with.
_NOTHING, _LEAST = 1e-16, 1e-12


class Cases(NamedTuple):
    """A batch of B cases of one base and micro law in units R = 1, E2* = 1; arrays (B,).

    `control` is "P", "a" or "D" for the whole batch; `law` is the micro law with the numbers of these cases; `layer`
    is None but on the exact layered base. `reach` is the change of ln a over which the
    layer's operator need not be formed anew, and `coarse` says where its quadrature may be the coarse one.
    """

    control: str
    law: Bound
    layer: Layer | None
    value: np.ndarray
    E: np.ndarray
    C: np.ndarray
    reach: np.ndarray
    coarse: np.ndarray

    def take(self, index):
        """The sub-batch at `index`."""
        layer = None if self.layer is None else self.layer.take(index)
        return Cases(self.control, self.law.take(index), layer, *(field[index] for field in self[3:]))


class State(NamedTuple):
    """Unknowns: y (B, n) of the micro law at the nodes, and η = ln a (B,)."""

    y: np.ndarray
    eta: np.ndarray

    def take(self, index):
        """The sub-batch at `index`."""
        return State(self.y[index], self.eta[index])


class Operator(NamedTuple):
    """The base at a state: the products K q (B, n) and edge q (B,) and their derivatives by η, all with a row for each
    case; of the exact layer the weights as well. Other bases have one matrix for all cases."""

    Kq: np.ndarray
    edge_q: np.ndarray
    d_Kq: np.ndarray
    d_edge_q: np.ndarray
    weights: list

    def take(self, index):
        """The sub-batch at `index`."""
        return Operator(*(v[index] for v in self[:-1]), take_weights(self.weights, index))

    def edge(self, mesh):
        """The row (B or 1, n) of the edge."""
        if not self.weights:
            return mesh.edge[None]
        return half_space_share(self.weights)[:, None] * mesh.edge + (np.pi / 2) * layer_edge(self.weights, mesh)

    def matrix(self, mesh):
        """K (B or 1, n, n); of the exact layer a new array."""
        if not self.weights:
            return mesh.K[None]
        K, share = layer_matrix(self.weights, mesh), half_space_share(self.weights)
        K *= np.pi / 2
        K += mesh.K if np.all(share == 1) else share[:, None, None] * mesh.K
        return K


class Evaluation(NamedTuple):
    """The equation at a state: y (B, n), groups X, Y, Z (B, 1), the law, the base, residuals F (B, n) and G (B,)."""

    y: np.ndarray
    X: np.ndarray
    Y: np.ndarray
    Z: np.ndarray
    curve: Curve
    base: Operator
    F: np.ndarray
    G: np.ndarray

    @property
    def residual(self):
        """Largest residual of a case (B,), relative to the right-hand side (s² <= 1) and to the controlled value.

        Where asperities hang over the surface without pressure, none is asked for.
        """
        F = np.abs(self.F)
        if self.base.weights:
            F[self.gap > 0] = 0.0
        return np.maximum(F.max(axis=1), np.abs(self.G))

    @property
    def gap(self):
        """Height (B, n) over a²/2 at which asperities hang over the surface that the others press down; else 0."""
        q = self.curve.q
        bare = (q >= 0) & (q < _NOTHING * q.max(axis=1, keepdims=True))
        return np.where(bare, np.maximum(self.F - self.Z * self.curve.g, 0.0), 0.0)

    def take(self, index):
        """The sub-batch at `index`."""
        y, X, Y, Z, curve, base, F, G = self
        curve, base = Curve(*(v[index] for v in curve)), base.take(index)
        return Evaluation(y[index], X[index], Y[index], Z[index], curve, base, F[index], G[index])


def groups(cases, eta):
    """X, Y, Z (B, 1) at η = ln a (B,)."""
    a = np.exp(eta)
    p_star, A_star = cases.law.p_star, cases.law.A_star
    X = (8 / np.pi) * p_star / (a * cases.E)
    return X[:, None], (2 * cases.C * p_star / a**2)[:, None], (2 * A_star / a**2)[:, None]


def operate(cases, eta, q, mesh, known=()):
    """:class:`Operator` of the base of `cases` at η = ln a (B,) and q (B, n); `known` weights of the layer of the same
    cases near this η."""
    if cases.layer is None:
        none = np.broadcast_to(0.0, q.shape)  # no case depends on η; takes no memory
        return Operator(q @ mesh.K.T, q @ mesh.edge, none, none[:, 0], [])
    weights = layer_weights(cases.layer, np.exp(eta), known, cases.reach, cases.coarse)
    share, products = half_space_share(weights), layer_products(weights, q, mesh)
    rows_q, edge_q, *slopes = ((np.pi / 2) * product for product in products)
    return Operator(share[:, None] * (q @ mesh.K.T) + rows_q, share * (q @ mesh.edge) + edge_q, *slopes, weights)


def displacement_between(ev, H, x, mesh):
    """K[q] (B, m) at radii x (m,) between the nodes of the mesh, from the half-space rows H (m, n) there."""
    q = ev.curve.q
    half_space = q @ H.T
    if not ev.base.weights:
        return half_space
    return layer_displacement(ev.base.weights, q, mesh, x, half_space)


def evaluate(cases, state, mesh, known=()):
    """:class:`Evaluation` of `cases` at `state`; `known` as in :func:`operate`."""
    X, Y, Z = groups(cases, state.eta)
    curve = cases.law.evaluate(state.y)
    base = operate(cases, state.eta, curve.q, mesh, known)
    F = X * base.Kq + Y * curve.q + Z * curve.g - mesh.s**2
    G = control_residual(cases, state.eta, X, curve.q, base.edge_q, mesh)
    return Evaluation(state.y, X, Y, Z, curve, base, F, G)


def control_residual(cases, eta, X, q, edge_q, mesh):
    """Logarithm of (controlled quantity/given value), (B,): Eq. (5) for the load, Eq. (3) at r = a for the depth."""
    if cases.control == "a":
        return eta - np.log(cases.value)
    if cases.control == "P":
        load = np.einsum("bj,j->b", q, mesh.w)  # not BLAS, whose rounding would depend on the number of cases
        return np.log(2 * np.pi * cases.law.p_star * load / cases.value) + 2 * eta
    return np.log((1 + X[:, 0] * edge_q) / (2 * cases.value)) + 2 * eta


def control_gradient(control, ev, mesh):
    """Derivatives of the logarithm of `control` by q (B, n) and by η (B,)."""
    q, X = ev.curve.q, ev.X[:, 0]
    if control == "P":
        return mesh.w / (q @ mesh.w)[:, None], np.full(len(q), 2.0)
    if control == "a":
        return np.zeros_like(q), np.ones(len(q))
    edge = X * ev.base.edge_q
    return ev.X * ev.base.edge(mesh) / (1 + edge)[:, None], 2 + (X * ev.base.d_edge_q - edge) / (1 + edge)


def jacobian(ev, mesh, K=None):
    """dF/dq at fixed η, X (K + diag(d)), as K (B or 1, n, n) and d (B, n), and dF/dη at fixed q, over X (B, n). In q,
    not y: the operator is linear in it. K is the matrix of the operator, if it is at hand."""
    own = ev.Y + ev.Z * (ev.curve.dg / ev.curve.dq)
    dF_deta = ev.base.d_Kq - ev.base.Kq - 2 * (ev.Y * ev.curve.q + ev.Z * ev.curve.g) / ev.X
    return ev.base.matrix(mesh) if K is None else K, own / ev.X, dF_deta


def first_guess(cases, mesh):
    """State from the three one-term solutions (half-space, springs, asperities alone) added as compliances."""
    a = guess_radius(cases)
    X, Y, Z = groups(cases, np.log(a))
    q = guess_pressure(cases, X * softness(cases, a)[:, None], Y, Z, mesh.s)
    return State(cases.law.guess(q), np.log(a))


def smooth_start(cases, mesh):
    """State at given radii (control a) from the smooth contact there and the asperities alone, added as compliances."""
    X, Y, Z = groups(cases, np.log(cases.value))
    s2 = mesh.s**2
    K = operate(cases, np.log(cases.value), np.zeros((len(X), mesh.n)), mesh).matrix(mesh)
    smooth = solve_stack(K, Y / X * np.ones(mesh.n), (s2 / X)[..., None])[..., 0]
    smooth = np.maximum(smooth, _LEAST * smooth.max(axis=1, keepdims=True))
    alone = cases.law.sparse(s2 / Z)
    return State(cases.law.guess(1 / (1 / smooth + 1 / alone)), np.log(cases.value))


def guess_pressure(cases, X, Y, Z, s):
    """q (B, m) at s (m,) > 0 for groups (B, 1): each of the three terms of the equation is exact where it matters
    alone."""
    s2 = s**2
    return 1 / ((X * HERTZ * s + Y) / s2 + 1 / cases.law.sparse(s2 / Z))


def softness(cases, a):
    """Compliance of the base over that of a half-space of E, about L at the wave number 1.5/a."""
    if cases.layer is None:
        return np.ones_like(a)
    h, *material = cases.layer
    return whole(1.5 * h / a, *material)


def guess_radius(cases):
    """Contact radius (B,) of the first guess."""
    if cases.control == "a":
        return cases.value
    if cases.control == "D":  # a² is D for a half-space and 2 D where the displacement is local
        return np.sqrt(1.5 * cases.value)
    hertz, springs, spots = _one_term_radii(cases)
    if cases.layer is None:
        return (hertz**4 + springs**4 + spots**4) ** 0.25
    a = (hertz**4 + spots**4) ** 0.25
    for _ in range(6):  # the modulus the contact feels depends on its radius
        a = ((hertz * np.cbrt(softness(cases, a))) ** 4 + spots**4) ** 0.25
    return a


def _one_term_radii(cases):
    """Radii (B,) under the load of a half-space, of springs of compliance C, and of asperities of A ~ p^β alone."""
    gamma, beta = cases.law.edge()
    e = 1 / beta
    hertz = np.cbrt(0.75 * cases.value / cases.E)
    springs = (4 * cases.C * cases.value / np.pi) ** 0.25
    alone = cases.value / (2 * np.pi * cases.law.p_star) * (2 * cases.law.A_star * gamma) ** e * (2 * e + 2)
    spots = alone ** (1 / (2 + 2 * e))
    return hertz, springs, spots
