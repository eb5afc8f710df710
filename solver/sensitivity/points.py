"""Derivatives of pressure and λ between the nodes: of profiles, and of Ar/An where λ bends."""

from typing import NamedTuple

import numpy as np

from ..numerics.mesh import gauss_rule
from ..rough.results import interpolate, stiffness_between
from .state import along, moving_numbers, of_law

#: Gauss points between any two nodes at which a λ that bends is differentiated. With 5 points the derivatives of
#: Ar/An are as right as the other ones (tests/sensitivity/test_sensitivities.py).
_FEW = 5


class Points(NamedTuple):
    """Pressure and λ (B, m) at points, in units R = E2* = 1; and their derivatives (k, B, m) by k inputs."""

    p: np.ndarray
    lam: np.ndarray
    d_p: np.ndarray
    d_lam: np.ndarray


def at_points(ev, changes, derivatives, s):
    """:class:`Points` at s (m,) > 0. `derivatives`: :class:`.state.Implicit` of the solutions `ev`.

    Without asperities q is a polynomial in s, and so is its change. With them it is not one next to the edge, but what
    bodies and asperities make of q is: so the equation of :func:`~solver.rough.results.interpolate` is
    differentiated.
    """
    law, s = ev.cases.law, np.asarray(s, dtype=float)
    basis, y = ev.mesh.basis(s).T, interpolate(ev, s)
    curve = law.evaluate(y)
    at_s = of_law(law, y, curve, moving_numbers(changes))
    if law.rough:
        q = _between_nodes(ev, changes, derivatives, s, curve, at_s)
    else:
        q = s * ((derivatives.q / ev.mesh.s) @ basis)
    d_lam = along(ev, changes, at_s, q)[1]
    p_star = law.p_star[:, None]
    return Points(p_star * curve.q, law.area(y, curve.q), p_star * (q + changes.p_star[..., None] * curve.q), d_lam)


def _between_nodes(ev, changes, derivatives, s, curve, at_s):
    """Derivatives (k, B, m) of q at s, where the asperities have the `curve` and the derivatives `at_s`."""
    basis, stiff = ev.mesh.basis(s).T, ev.X * stiffness_between(ev.mesh, s)

    def explicit(curve):
        return changes.Y[..., None] * curve.q + changes.Z[..., None] * curve.g

    dq = derivatives.q
    yields = explicit(ev.curve) + ev.Y * dq + ev.Z * along(ev, changes, derivatives.law, dq)[0]
    at_same_q = explicit(curve) + ev.Z * along(ev, changes, at_s, 0 * (dq @ basis))[0]
    return (yields @ basis - at_same_q + stiff * (dq @ basis)) / (stiff + ev.Y + ev.Z * at_s.by_q[0])


def of_corners(ev, changes, derivatives):
    """Derivatives (k, B) of ln Ar/An of cases whose λ bends."""
    s, w = gauss_rule(_FEW, (0.0, *ev.mesh.s.tolist()))
    at = at_points(ev, changes, derivatives, s)
    return (at.d_lam @ (w * s)) / (at.lam @ (w * s))


def profiles(ev, changes, derivatives, x):
    """:class:`Points` at the radii x (m,); 0 at the edge."""
    s = np.sqrt((1 - x) * (1 + x))
    inner = s > 0
    return Points(*(_with_edge(values, inner) for values in at_points(ev, changes, derivatives, s[inner])))


def _with_edge(values, inner):
    whole = np.zeros((*values.shape[:-1], len(inner)))
    whole[..., inner] = values
    return whole
