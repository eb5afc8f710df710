"""Derivatives of a solution by inputs, at its state: the implicit function theorem on the system that Newton solves.

The unknowns are q at the nodes and η = ln a. An input θ changes the residual F of the equation at the same q and η, and
the logarithms of load and depth, by explicit functions. So dq/dθ at a fixed radius solves

    X (K + diag) dq/dθ = -dF/dθ,

with the matrix of Newton's last step, for all inputs at once, and the control then gives dη/dθ. A law is taken as g, λ
and p_max over q: where an input changes the law's own numbers, these are moved at the same y, and the change of q is
taken out.
"""

from typing import NamedTuple

import numpy as np

from ..body.operator import Operator
from ..numerics.linalg import solve_stack
from ..rough.equation import control_gradient, jacobian
from ..rough.results import quantities
from .changes import STEP


class LawSlopes(NamedTuple):
    """Derivatives of a law at points (B, m), three of each: of g, λ and p_max/p*. `by_q`: along its curve; `by_own`:
    index of one of the law's own numbers -> by its logarithm at the same q."""

    by_q: tuple
    by_own: dict


def of_law(law, y, curve, moving):
    """:class:`LawSlopes` at y (B, m) with its `curve`; `moving`: indices of the law's own numbers that move."""
    up, down = (_three(law, y * (1 + sign * STEP)) for sign in (1, -1))
    dq = up[0] - down[0]
    by_q = tuple(_over(high - low, dq) for high, low in zip(up[1:], down[1:], strict=True))
    by_q = (_over(curve.dg, curve.dq), *by_q[1:])
    by_own = {}
    for i in moving:
        up, down = (_three(_with(law, i, 1 + sign * STEP), y) for sign in (1, -1))
        q, *rest = ((high - low) / (2 * STEP) for high, low in zip(up, down, strict=True))
        by_own[i] = tuple(change - slope * q for change, slope in zip(rest, by_q, strict=True))
    return LawSlopes(by_q, by_own)


def _three(law, y):
    """q, g, λ and p_max/p* at y."""
    curve = law.evaluate(y)
    return curve.q, curve.g, law.area(y, curve.q), law.peak(y, curve.q) / law.p_star[:, None]


def _with(law, i, factor):
    return law._replace(own=tuple(v * factor if j == i else v for j, v in enumerate(law.own)))


def _over(change, dq):
    """change/dq; 0 where nothing changes, of a law that is constant."""
    return np.where(change == 0, 0.0, change / np.where(dq == 0, np.nan, dq))


class Explicit(NamedTuple):
    """Derivatives by k inputs at the same q and η: of F over X, (k, B, n), and of ln P and ln D (k, B)."""

    F: np.ndarray
    P: np.ndarray
    D: np.ndarray


class OperatorChange(NamedTuple):
    """Derivative by an input of the operators of B cases, from the operators `up` and `down` of the moved bodies. Like
    them it is linear in q."""

    up: Operator
    down: Operator

    def products(self, q):
        """Derivatives of K q (B, n) and edge @ q (B,)."""
        return self._slope(self.up.products(q), self.down.products(q))

    def slopes(self, q):
        """Derivatives by ln a of these :meth:`products`."""
        return self._slope(self.up.slopes(q), self.down.slopes(q))

    def _slope(self, up, down):
        return tuple((high - low) / (2 * STEP) for high, low in zip(up, down, strict=True))


def operators_of(ev, changes):
    """Input -> :class:`OperatorChange` at the radii of `ev`, of the inputs that change the operator otherwise than by
    h/a."""
    size, mesh, a = len(ev.state.eta), ev.mesh, np.exp(ev.state.eta)

    def at(row):
        return changes.cases.body.take(np.arange(size) + row * size).at(a, mesh)

    return {i: OperatorChange(at(2 * i), at(2 * i + 1)) for i in changes.on_body}


def explicit(ev, changes, moving, operators):
    """:class:`Explicit` at the state of `ev`. `moving`: own number of the law -> derivative of g by its logarithm, (B,
    n); `operators`: input -> derivatives of K q (B, n) and edge @ q (B,)."""
    X, q, g = ev.X, ev.curve.q, ev.curve.g
    F = changes.X[..., None] * ev.Kq + changes.Y[..., None] * q + changes.Z[..., None] * g - changes.drop(ev.mesh.s)
    edge = changes.X * ev.edge_q + changes.depth
    slopes = ev.slopes if changes.h.any() else (0 * q, 0 * q[:, 0])
    F = F - changes.h[..., None] * (X * slopes[0])
    edge = edge - changes.h * X[:, 0] * slopes[1]
    for i, g_own in moving.items():
        F += _relative(changes, ev, i)[..., None] * (ev.Z * g_own)
    for i, (Kq, edge_q) in operators.items():
        F[i] += X * Kq
        edge[i] += X[:, 0] * edge_q
    depth = ev.cases.punch.depth(np.exp(ev.state.eta)) + X[:, 0] * ev.edge_q
    return Explicit(F / X, changes.p_star, edge / depth)


def _relative(changes, ev, i):
    """Derivatives (k, B) of the logarithm of the law's own number i."""
    number = ev.cases.law.own[i][:, 0]
    return np.where(number == 0, 0.0, changes.own[i] / np.where(number == 0, 1.0, number))


class Implicit(NamedTuple):
    """Derivatives of B solutions by k inputs under their control: of q at the nodes (k, B, n), of η (k, B); `logs`:
    quantity -> derivatives of its logarithm (k, B). Besides, `tangent` is dq/dη (B, n) along the branch, and `law` has
    the derivatives of the law at the nodes."""

    q: np.ndarray
    eta: np.ndarray
    tangent: np.ndarray
    law: LawSlopes
    at_fixed_state: Explicit
    logs: dict


def moving_numbers(changes):
    """Indices of the law's own numbers that some input changes."""
    return [i for i, change in enumerate(changes.own) if np.any(change != 0)]


def implicit(ev, changes, operators):
    """:class:`Implicit` of the solutions `ev`; `operators`: input -> :class:`OperatorChange`."""
    operators = {i: change.products(ev.curve.q) for i, change in operators.items()}
    law = of_law(ev.cases.law, ev.state.y, ev.curve, moving_numbers(changes))
    fixed = explicit(ev, changes, {i: own[0] for i, own in law.by_own.items()}, operators)
    diagonal, dF_deta = jacobian(ev)
    right = np.concatenate([-dF_deta[None], -fixed.F])
    solved = np.moveaxis(solve_stack(ev.operator.K, diagonal, np.moveaxis(right, 0, -1)), -1, 0)
    tangent, q = solved[0], solved[1:]
    control = ev.cases.control
    by_q, by_eta = control_gradient(control, ev)
    given = (0.0 if control == "a" else getattr(fixed, control)) - changes.value
    eta = -(given + np.einsum("bn,kbn->kb", by_q, q)) / (by_eta + (by_q * tangent).sum(axis=1))
    q = q + eta[..., None] * tangent
    logs = {"a": eta}
    for name in ("P", "D"):
        by_q, by_eta = control_gradient(name, ev)
        logs[name] = getattr(fixed, name) + np.einsum("bn,kbn->kb", by_q, q) + by_eta * eta
    return Implicit(q, eta, tangent, law, fixed, logs | _of_spots(ev, changes, law, q))


def _of_spots(ev, changes, law, q):
    """Quantity -> derivatives of its logarithm (k, B), of the quantities that the law makes of q."""
    results = quantities(ev)
    change = along(ev, changes, law, q)
    centre = [part[..., -1] for part in change]
    with np.errstate(all="ignore"):
        peak = results.p_max / ev.cases.law.p_star
        A0 = np.where(results.A0 == 0, 0.0, changes.A_star + centre[0] / ev.curve.g[:, -1])
    p0 = changes.p_star + q[..., -1] / ev.curve.q[:, -1]
    area = 2 * (change[1] @ ev.mesh.w) / results.Ar_An
    return {"p0": p0, "p_max": changes.p_star + centre[2] / peak, "Ar_An": area, "A0": A0}


def along(ev, changes, law, q):
    """Derivatives (k, B, m) of g, λ and p_max/p* at points where q has the derivatives `q` (k, B, m)."""
    changed = [slope * q for slope in law.by_q]
    for i, slopes in law.by_own.items():
        relative = _relative(changes, ev, i)[..., None]
        changed = [change + relative * more for change, more in zip(changed, slopes, strict=True)]
    return changed
