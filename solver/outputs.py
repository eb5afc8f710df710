"""From the solved unknowns to the quantities of the paper: Eqs (5), (11)-(14) and the profiles."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .equation import displacement_between


def quantities(cases, state, curve, X, edge_q, law, mesh):
    """a, P, D, p0, A0, p_max, Ar_An as a dict of (B,) arrays in units R = E2* = 1.

    curve: the law at `state`; X, edge_q (B,): the group and the displacement of the edge there. D is taken from Eq.
    (3) at r = a, where p = 0; it equals Eq. (14) and needs p at no point.
    """
    q, a = curve.q, np.exp(state.eta)
    y = law.spot(state.y, (cases.p_star / cases.spot_scale)[:, None] * q)
    p0 = cases.p_star * q[:, -1]
    return {
        "a": a,
        "P": 2 * np.pi * a**2 * cases.p_star * (q @ mesh.w),  # (5)
        "D": a**2 / 2 * (1 + X * edge_q),  # (14)
        "p0": p0,
        "A0": cases.A_star * curve.g[:, -1],
        "p_max": spot_pressure(y[:, -1], p0, cases.spot_scale),
        "Ar_An": 2 * (spot_area(y) @ mesh.w),  # (12)
    }


def spot_area(y):
    """λ = (b/B̄)² (11) of y = cot θ, 0 to inf."""
    return 1 / (1 + y**-2.0)


def spot_pressure(y, p, spot_scale):
    """Largest real pressure (13) at nominal pressure p and y = cot θ."""
    return 3 / np.pi * spot_scale / np.sqrt(1 + y**-2.0) + 2 / np.pi * p * np.arctan(y)


#: Newton steps between the nodes; a few do but near full contact.
_STEPS = 40


class Between(NamedTuple):
    """To interpolate from a mesh to other points s (m,) > 0: Lagrange and H - H(1) rows (m, n), and κ (m,)."""

    s: np.ndarray
    L: np.ndarray
    H: np.ndarray
    kappa: np.ndarray


@lru_cache(maxsize=32)
def _between(mesh, s_bytes):
    s, ends = np.frombuffer(s_bytes), np.array(mesh.breaks)
    home = np.clip(np.searchsorted(ends, s) - 1, 0, len(ends) - 2)
    low, high = ends[home], ends[home + 1]
    gap = (high - low) / (4 * mesh.order**2)  # of the nodes at an end of a panel
    # half the distance of the nodes in x = sqrt(1 - s²), where |dx| = s ds/x
    spread = (s - low + gap * (low > 0)) * np.where(high < 1, (high - s + gap) / np.maximum(1 - s, 1e-300), 1.0)
    kappa = np.pi / (2 * mesh.order) * s * np.sqrt(np.maximum(spread, 0.0) / (1 + s))
    return Between(s, mesh.basis(s), mesh.rows(s), kappa)


def interpolate(cases, ev, law, mesh, s, tolerance=1e-11):
    """The unknown y (B, m) at points s (m,) > 0 between the nodes of the mesh.

    The pressure there satisfies the equation itself: (X κ + Y) q + Z g(q) = s² - X (H[q] - κ q_L), with q_L the
    interpolating polynomial and κ about what the half-space makes of an oscillation between the nodes; where the
    asperities or the layer yield most, near the edge, this is far more accurate than q_L, and where they yield
    nothing it is q_L. Newton from a two-term guess until the steps are below the relative `tolerance`.
    """
    rows = _between(mesh, np.ascontiguousarray(s, dtype=float).tobytes())
    gamma, beta = law.power(cases.exponent)
    stiff = ev.X * rows.kappa
    x = np.sqrt((1 - rows.s) * (1 + rows.s))
    Kq = displacement_between(ev, rows.H, x, mesh)
    q_L = ev.curve.q @ rows.L.T
    right = rows.s**2 - ev.X * Kq + stiff * q_L
    # positive, but by no more than κ q_L is: under a stiff film that is small
    right = np.maximum(right, np.clip(1e-3 * stiff * np.abs(q_L), 1e-16 * rows.s**2, 1e-9 * rows.s**2))
    linear = stiff + ev.Y
    inverse = (ev.Z * gamma[:, None] / right) ** (1 / beta[:, None])  # 0 for a smooth punch
    y = law.guess(1 / (linear / right + inverse), cases.exponent)
    for _ in range(_STEPS):
        curve = law.evaluate(y, cases.exponent)
        f = linear * curve.q + ev.Z * curve.g - right
        old, y = y, law.limit(y - f / (linear * curve.dq + ev.Z * curve.dg), y)
        if not np.any(np.abs(y - old) > tolerance * y):
            break
    return y


def profiles(cases, ev, mesh, law, x):
    """p (B, m) in E2* and λ (B, m) at the radii x (m,) from the solution on a mesh; both 0 at the edge."""
    s = np.sqrt((1 - x) * (1 + x))
    inner = s > 0
    y = interpolate(cases, ev, law, mesh, s[inner])
    q = law.evaluate(y, cases.exponent).q
    p, lam = np.zeros((len(q), len(s))), np.zeros((len(q), len(s)))
    p[:, inner] = cases.p_star[:, None] * q
    lam[:, inner] = spot_area(law.spot(y, (cases.p_star / cases.spot_scale)[:, None] * q))
    return p, lam
