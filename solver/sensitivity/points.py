"""Pressure and λ between the nodes: of profiles, and of Ar/An where λ bends."""

import numpy as np

from ..numerics.mesh import gauss_rule
from ..rough.results import interpolate, off_edge, stiffness_between
from .step import moved_curve

#: Gauss points between any two nodes at which a λ that bends is summed. With 5 points the derivatives of Ar/An are as
#: right as the other ones (tests/sensitivity/test_sensitivities.py).
_FEW = 5


def between(start, contacts, s):
    """q and λ (m B, c) of moved cases at points s (c,) > 0.

    The equation of :func:`~solver.rough.results.interpolate` is solved for the contacts before the step, and there
    one Newton step is taken. Its right-hand side changes as bodies and asperities yield at the nodes: that change is a
    polynomial, and small at the edge as the right-hand side is.
    """
    ev, now = start.at, contacts.at
    law, inside = now.cases.law, off_edge(s, now.cases.law.rough)
    blocks = len(now.state.eta) // len(ev.state.eta)
    y = interpolate(ev, inside)
    curve = ev.cases.law.evaluate(y)
    (linear, yields), (moved_linear, moved_yields) = _at(ev, inside), _at(now, inside)
    right = np.tile(linear * curve.q + ev.Z * curve.g - yields, (blocks, 1)) + moved_yields
    curve = moved_curve(law, ev.cases.law, y, curve)
    y = np.tile(y, (blocks, 1))
    missed = moved_linear * curve.q + now.Z * curve.g - right
    change = law.limit(y - missed / (moved_linear * curve.dq + now.Z * curve.dg), y) - y
    q, y = curve.q + curve.dq * change, y + change
    return q * (s / inside), law.area(y, q)


def _at(ev, s):
    """X κ + Y (B, c) at the points s (c,); and there the polynomial (B, c) through what this and asperities make of the
    pressures at the nodes."""
    stiff, basis, curve = ev.X * stiffness_between(ev.mesh, s), ev.mesh.basis(s).T, ev.curve
    return stiff + ev.Y, (ev.Y * curve.q + ev.Z * curve.g) @ basis + stiff * (curve.q @ basis)


def profiles(start, contacts, x):
    """q and λ (m B, c) at the radii x (c,); 0 at the edge."""
    s = np.sqrt((1 - x) * (1 + x))
    inner = s > 0
    both = np.zeros((2, len(contacts.at.state.eta), len(x)))
    both[:, :, inner] = between(start, contacts, s[inner])
    return both


def area_of_corners(start, contacts):
    """Ar/An (m B,) of cases whose λ bends."""
    s, w = gauss_rule(_FEW, (0.0, *start.at.mesh.s.tolist()))
    return 2 * between(start, contacts, s)[1] @ (w * s)
