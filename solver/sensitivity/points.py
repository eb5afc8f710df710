"""Pressure and λ between the nodes: for profiles, and for Ar/An if λ has a kink."""

import numpy as np

from ..numerics.mesh import gauss_rule
from ..rough.results import interpolate, off_edge, stiffness_between
from .step import moved_curve

#: Gauss points between neighbouring nodes for the integral of a λ with a kink. With 5 points the derivatives of Ar/An
#: are as accurate as the others (tests/sensitivity/test_sensitivities.py).
_FEW = 5


def between(start, contacts, s):
    """q and λ (m B, c) of moved cases at points s (c,) > 0.

    The equation of :func:`~solver.rough.results.interpolate` is solved for the contacts before the step, and one Newton
    step follows. Its right-hand side changes with the displacements of bodies and asperities at the nodes. That change
    is a polynomial, and is small at the edge like the right-hand side.
    """
    ev, now = start.at, contacts.at
    law, inside = now.cases.law, off_edge(s, now.cases.law.rough)
    blocks = len(now.state.eta) // len(ev.state.eta)
    y = interpolate(ev, inside)
    curve = ev.cases.law.evaluate(y)
    (linear, part), (moved_linear, moved_part) = _at(ev, inside), _at(now, inside)
    right = np.tile(linear * curve.q + ev.Z * curve.g - part, (blocks, 1)) + moved_part
    curve = moved_curve(law, ev.cases.law, y, curve)
    y = np.tile(y, (blocks, 1))
    missed = moved_linear * curve.q + now.Z * curve.g - right
    change = law.limit(y - missed / (moved_linear * curve.dq + now.Z * curve.dg), y) - y
    q, y = curve.q + curve.dq * change, y + change
    return q * (s / inside), law.area(y, q)


def _at(ev, s):
    """X κ + Y (B, c) at the points s (c,); and (X κ + Y) q + Z g there, (B, c), where q and g are the polynomials
    through their values at the nodes."""
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
    """Ar/An (m B,) of cases whose λ has a kink."""
    s, w = gauss_rule(_FEW, (0.0, *start.at.mesh.s.tolist()))
    return 2 * between(start, contacts, s)[1] @ (w * s)
