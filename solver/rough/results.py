"""The quantities of the paper from the unknowns of the equation: Eqs (5), (11)-(14), and the profiles."""

from collections import namedtuple
from functools import lru_cache

import numpy as np

from ..numerics.batch import march
from ..numerics.mesh import gauss_rule
from ..numerics.quadrature import gauss_legendre, lagrange
from ..solution import JUDGED

#: Most Newton steps for y between the nodes. A few are enough, except near full contact.
_STEPS = 40
#: Where s is below this, the pressure of a smooth punch is assumed to be proportional to s. Nearer to the edge, the
#: rounding error of the equation would be larger than this pressure.
_LINEAR = 1e-4
#: If λ has a kink: between two nodes y is interpolated to _FEW Gauss points, with the relative tolerance _NEAR, and λ
#: is evaluated at _MANY.
_FEW, _MANY, _NEAR = 5, 10, 1e-10
#: The judged quantities that do not depend on the pressure in the centre.
_AWAY_FROM_CENTRE = tuple(name for name in JUDGED if name not in ("p0", "p_max"))
#: Arrays (B,) in units R = E2* = 1, named as in :class:`~solver.solution.Solution`.
Quantities = namedtuple("Quantities", (*JUDGED, "A0"))


def quantities(ev):
    """:class:`Quantities` of an :class:`~solver.rough.equation.Evaluation`. D is by Eq. (3) at r = a. It equals that of
    Eq. (14), and does not depend on p at any single point."""
    law, y, q, a, w = ev.cases.law, ev.state.y, ev.curve.q, np.exp(ev.state.eta), ev.mesh.w
    centre = q[:, -1:]
    return Quantities(
        a=a,
        P=2 * np.pi * a**2 * law.p_star * (q @ w),  # (5)
        D=a**2 / 2 * (ev.cases.punch.depth(a) + ev.X[:, 0] * ev.edge_q),  # (14)
        p0=law.p_star * centre[:, 0],
        p_max=law.peak(y[:, -1:], centre)[:, 0],  # (13)
        Ar_An=2 * (law.area(y, q) @ w),  # (12)
        A0=law.A_star * ev.curve.g[:, -1],
    )


def difference(first, second, names=JUDGED):
    """Largest relative difference (B,) of two :class:`Quantities` among those with the `names`."""
    return np.max([np.abs(getattr(first, name) / getattr(second, name) - 1) for name in names], axis=0)


def pointed(cases):
    """(B,) bool: whether the punch has a point, f'(0+) > 0. The region near the axis that decides the pressure of the
    asperities under the point, of the size A' times the modulus, is too small for any mesh. So the pressure in the
    centre is neither judged nor reported."""
    return cases.shape.pointed


def judged_difference(cases, first, second):
    """:func:`difference` (B,) among the numbers that are reported for the `cases`."""
    change, without = difference(first, second), pointed(cases)
    return np.where(without, difference(first, second, _AWAY_FROM_CENTRE), change) if without.any() else change


@lru_cache(maxsize=32)
def _between(mesh, s_bytes):
    """Matrices and numbers for interpolation from a mesh to points s (m,) > 0: the Lagrange polynomials (m, n); the
    rows (m, n) of H - H(1); and κ (:func:`interpolate`) at the points (m,) and at the nodes (n,)."""
    s = np.frombuffer(s_bytes)
    return mesh.basis(s), mesh.rows(s), stiffness_between(mesh, s), stiffness_between(mesh, mesh.s)


def stiffness_between(mesh, s):
    """κ (m,) at the points s. H of a pressure that oscillates from node to node is about κ times this pressure."""
    ends = np.array(mesh.breaks)
    home = np.clip(np.searchsorted(ends, s) - 1, 0, len(ends) - 2)
    low, high = ends[home], ends[home + 1]
    gap = (high - low) / (4 * mesh.order**2)  # distance of the nodes at an end of a panel
    # half the distance of the nodes in x = sqrt(1 - s²), where |dx| = s ds/x
    spread = (s - low + gap * (low > 0)) * np.where(high < 1, (high - s + gap) / np.maximum(1 - s, 1e-300), 1.0)
    return np.pi / (2 * mesh.order) * s * np.sqrt(np.maximum(spread, 0.0) / (1 + s))


def interpolate(ev, s, tolerance=1e-13, rows=slice(None)):
    """The unknown y (B, m) at points s (m,) > 0 between the nodes of the mesh, for all cases or only for the cases
    `rows`.

    Let q_L be the polynomial through the pressures at the nodes. The difference q - q_L oscillates from node to node,
    and its displacement of the half-space is about κ (q - q_L). So the equation at a point between the nodes is

        (X κ + Y) q + Z g(q) = drop - X (K[q_L] - κ q_L).

    Near the edge, where asperities or springs are more compliant than the body, its solution is far more accurate than
    q_L. Where they are rigid, its solution is q_L. Newton's method solves it to the relative `tolerance`, a number or
    (B, 1). It starts from a closed form for two terms, times a correction: the ratio of y to this form at the nodes,
    interpolated.
    """
    s = np.ascontiguousarray(s, dtype=float)
    L, H, kappa, node_kappa = _between(ev.mesh, s.tobytes())
    Kq = ev.operator.between(ev.curve.q, s, ev.curve.q @ H.T)[rows]
    X, Y, Z, law = ev.X[rows], ev.Y[rows], ev.Z[rows], ev.cases.law.take(rows)
    q, g = ev.curve.q[rows], ev.curve.g[rows]
    drop = ev.cases.punch.take(rows).drop(np.exp(ev.state.eta[rows]), s)
    stiff, q_L = X * kappa, q @ L.T
    # The least value keeps the right-hand side positive. It is far below κ q_L, which is small under a stiff film.
    least = np.clip(1e-3 * stiff * np.abs(q_L), 1e-16 * drop, 1e-9 * drop)
    right = np.maximum(drop - X * Kq + stiff * q_L, least)
    linear, node_linear = stiff + Y, X * node_kappa + Y

    def guess(linear, right):
        return law.guess(1 / (linear / right + 1 / law.sparse(right / Z)))

    correction = np.nan_to_num(ev.state.y[rows] / guess(node_linear, node_linear * q + Z * g), nan=1.0)
    correction = np.clip(correction, 0.5, 2.0) @ L.T
    y = guess(linear, right) * np.clip(correction, 0.7, 1.4)
    tolerance = np.broadcast_to(tolerance, (len(y), 1))

    def step(active):
        old, slope, weight = y[active], linear[active], Z[active]
        curve = law.take(active).evaluate(old)
        f = slope * curve.q + weight * curve.g - right[active]
        new = law.limit(old - f / (slope * curve.dq + weight * curve.dg), old)
        y[active] = new
        # the error after a step is about the square of its relative size
        return ~np.any((new - old) ** 2 > tolerance[active] * new**2, axis=1)

    march(step, np.arange(len(y)), most=_STEPS)
    return y


def cornered(ev, rows):
    """Four numbers (b,) for the cases `rows`, whose λ has a kink: Ar/An; its relative error; the part of the load that
    the polynomial through the nodes misses between them; the largest part that it misses from the edge to any radius.

    At a corner of λ the error of a quadrature is about the cube of the distance of its points, and the nodes are too
    far apart. So y is interpolated to _FEW points between neighbouring nodes, and from these by a polynomial to _MANY
    points, where λ is evaluated. The difference between the quadratures with _FEW and with _MANY points is the error:
    it is far larger than the true error of the latter.
    """
    law, pieces = ev.cases.law.take(rows), (0.0, *ev.mesh.s.tolist())
    (s, w), (fine_s, fine_w) = gauss_rule(_FEW, pieces), gauss_rule(_MANY, pieces)
    to_fine = lagrange(gauss_legendre(_FEW)[0], gauss_legendre(_MANY)[0]).T

    def between(values):
        ratio = np.log(values / s).reshape(len(rows), -1, _FEW)
        return np.exp(ratio @ to_fine).reshape(len(rows), -1) * fine_s

    y = interpolate(ev, s, _NEAR, rows)
    q, at_nodes = law.evaluate(y).q, ev.curve.q[rows]
    few, many = law.area(y, q) * (2 * w * s), law.area(between(y), between(q)) * (2 * fine_w * fine_s)
    few, many = few.reshape(len(rows), -1, _FEW).sum(axis=2), many.reshape(len(rows), -1, _MANY).sum(axis=2)
    missed = np.cumsum((q - at_nodes @ ev.mesh.basis(s).T) * (w * s), axis=1) / (at_nodes @ ev.mesh.w)[:, None]
    area, missed = many.sum(axis=1), np.abs(missed)
    return area, np.abs(few - many).sum(axis=1) / area, missed[:, -1], missed.max(axis=1)


def off_edge(s, rough):
    """The points (m,) at which the pressure for s (m,) > 0 is solved for: under a smooth punch they keep away from the
    edge."""
    return s if rough else np.maximum(s, _LINEAR)


def profiles(ev, x, rows):
    """p (b, m) in E2* and λ (b, m) of the cases `rows` (b,) at the radii x (m,); 0 at the edge."""
    s = np.sqrt((1 - x) * (1 + x))
    inner, law = s > 0, ev.cases.law.take(rows)
    solved_at = off_edge(s[inner], law.rough)
    y = interpolate(ev, solved_at, rows=rows)
    q = law.evaluate(y).q * (s[inner] / solved_at)
    p, lam = np.zeros((2, len(q), len(s)))
    p[:, inner] = law.p_star[:, None] * q
    lam[:, inner] = law.area(y, q)
    return p, lam
