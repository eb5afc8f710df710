"""From the solved unknowns to the quantities of the paper: Eqs (5), (11)-(14) and the profiles."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .mesh import half_space_rows
from .mesh import mesh as mesh_of
from .micro import spot_from_pressure
from .quadrature import lagrange


def quantities(cases, spot_scale, state, ev, mesh):
    """a, P, D, p0, A0, p_max, Ar_An as a dict of (B,) arrays in units R = E2* = 1.

    spot_scale : (B,) float, p* of the exact law; D from Eq. (3) at r = a, where p = 0, which equals Eq. (14) and
    needs p at no point.
    """
    q, a = ev.curve.q, np.exp(state.eta)
    y = _spot(cases, spot_scale, q, state.y)
    p0 = cases.p_star * q[:, -1]
    return {
        "a": a,
        "P": 2 * np.pi * a**2 * cases.p_star * (q @ mesh.w),  # (5)
        "D": a**2 / 2 * (1 + ev.X[:, 0] * (q @ mesh.edge)),  # (14)
        "p0": p0,
        "A0": cases.A_star * ev.curve.g[:, -1],
        "p_max": spot_pressure(y[:, -1], p0, spot_scale),
        "Ar_An": 2 * (spot_area(y) @ mesh.w),  # (12)
    }


def spot_area(y):
    """λ = (b/B̄)² (11) of y = cot θ."""
    return y * y / (1 + y * y)


def spot_pressure(y, p, spot_scale):
    """Largest real pressure (13) at nominal pressure p and y = cot θ."""
    return 3 / np.pi * spot_scale * y / np.sqrt(1 + y * y) + 2 / np.pi * p * np.arctan(y)


def _spot(cases, spot_scale, q, y):
    """y = cot θ of the exact law at pressures p* q: the unknown itself where the law is the exact one."""
    exact = spot_scale == cases.p_star
    return y if exact.all() else spot_from_pressure((cases.p_star / spot_scale)[:, None] * q)


class Between(NamedTuple):
    """What it takes to interpolate from a mesh to other points s (m,) > 0: Lagrange and H - H(1) rows (m, n), and κ
    (m,)."""

    s: np.ndarray
    L: np.ndarray
    H: np.ndarray
    kappa: np.ndarray


@lru_cache(maxsize=128)
def _between(n, s_bytes):
    nodes, s = mesh_of(n).s, np.frombuffer(s_bytes)
    H = half_space_rows(nodes, s) - mesh_of(n).edge
    return Between(s, lagrange(nodes, s), H, np.pi / (2 * n) * s * np.sqrt(s / (1 + s)))


def interpolate(cases, ev, law, n, s, steps=4):
    """The unknown y (B, m) at points s (m,) > 0 between the n nodes.

    The pressure there satisfies the equation itself: (X κ + Y) q + Z g(q) = s² - X (H[q] - κ q_L), with q_L the
    interpolating polynomial and κ about what the half-space makes of an oscillation between the nodes; where the
    asperities or the layer yield most, near the edge, this is far more accurate than q_L, and where they yield
    nothing it is q_L. `steps` of Newton from a two-term guess.
    """
    rows = _between(n, np.ascontiguousarray(s, dtype=float).tobytes())
    gamma, beta = law.power(cases.exponent)
    stiff = ev.X * rows.kappa
    right = rows.s**2 - ev.X * (ev.curve.q @ rows.H.T) + stiff * (ev.curve.q @ rows.L.T)
    right = np.maximum(right, 1e-9 * rows.s**2)
    linear = stiff + ev.Y
    alone = (right / (ev.Z * gamma[:, None])) ** (1 / beta[:, None])
    y = law.guess(1 / (linear / right + 1 / alone), cases.exponent)
    for _ in range(steps):
        curve = law.evaluate(y, cases.exponent)
        f = linear * curve.q + ev.Z * curve.g - right
        y = np.clip(y - f / (linear * curve.dq + ev.Z * curve.dg), 0.2 * y, 5 * y)
    return y


def profiles(cases, spot_scale, ev, n, law, x):
    """p (B, m) in E2* and λ (B, m) at the radii x (m,) from the solution on n nodes; both 0 at the edge."""
    s = np.sqrt((1 - x) * (1 + x))
    inner = s > 0
    y = interpolate(cases, ev, law, n, s[inner])
    q = law.evaluate(y, cases.exponent).q
    p, lam = np.zeros((len(q), len(s))), np.zeros((len(q), len(s)))
    p[:, inner] = cases.p_star[:, None] * q
    lam[:, inner] = spot_area(_spot(cases, spot_scale, q, y))
    return p, lam
