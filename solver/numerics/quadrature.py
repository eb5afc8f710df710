"""Nodes, weights and interpolation on [0, 1], and integrals with a singularity, on [0, 1] and over the panels of a mesh
for many targets at once.

Barycentric interpolation is that of Berrut & Trefethen, SIAM Review 46 (2004) 501.
"""

from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .special import radau_points

#: Number of subpanels towards a singularity, each a quarter as long as the one before. A last subpanel follows them, on
#: which the variable is x = t^_POWER: in t the integrand is smooth.
_PANELS, _POWER = 16, 8
#: Numbers of subpanels towards a singularity outside the panel. There are only a few of them, so that many pairs share
#: a rule.
_FEWER = (0, 1, 2, 3, 4, 6, 8, 11, _PANELS)
#: Points that the singularity needs on a subpanel. A polynomial factor needs more.
_LEAST = 14
#: Most numbers of a piece, points times nodes of a panel. They are 1 MB: enough that the time of numpy's calls does not
#: count.
_TOGETHER = 131_072


@lru_cache(maxsize=64)
def gauss_legendre(n):
    """Gauss-Legendre rule with `n` points on [0, 1]: nodes (n,) and weights (n,), exact to degree 2n - 1."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    return _frozen((nodes + 1) / 2), _frozen(weights / 2)


@lru_cache(maxsize=64)
def radau_nodes(n):
    """Gauss-Radau nodes (n,) on [0, 1], ascending; the last one is exactly 1. Their rule has the weight function 1 and
    is exact to degree 2n - 2."""
    return _frozen(np.append((radau_points(n) + 1) / 2, 1.0))


@lru_cache(maxsize=256)
def _barycentric_weights(nodes_bytes):
    """Barycentric weights (n,) of nodes (n,). Distances are divided by the capacity of [0, 1], 1/4, so that products of
    them neither overflow nor underflow."""
    nodes = np.frombuffer(nodes_bytes)
    difference = nodes[:, None] - nodes[None, :]
    np.fill_diagonal(difference, 1.0)
    scale = np.log(np.abs(difference) * 4.0)
    np.fill_diagonal(scale, 0.0)
    exponent = -scale.sum(axis=1)
    return _frozen(np.prod(np.sign(difference), axis=1) * np.exp(exponent - exponent.max()))


def lagrange(nodes, points):
    """Values (m, n) at `points` (m,) of the Lagrange polynomials of `nodes` (n,)."""
    values = np.asarray(points, dtype=float)[:, None] - nodes[None, :]  # in place from here on
    hit = None if values.all() else values == 0.0
    if hit is not None:
        values[hit] = 1.0
    np.divide(_barycentric_weights(np.ascontiguousarray(nodes, dtype=float).tobytes()), values, out=values)
    values /= values.sum(axis=1, keepdims=True)
    if hit is not None:
        on_node = hit.any(axis=1)
        values[on_node] = hit[on_node]
    return values


def panels_towards(gap, length):
    """The number (...) of subpanels of :func:`log_rule`, one of _FEWER, for an interval of `length` with the
    singularity at the distance `gap` before it. The last subpanel, like the others, is then at most three times as long
    as it is distant from the singularity."""
    with np.errstate(divide="ignore"):
        wanted = np.log(length / (3 * gap)) / np.log(4.0)
    return np.array(_FEWER)[np.minimum(np.searchsorted(_FEWER, wanted), len(_FEWER) - 1)]


@lru_cache(maxsize=64)
def log_rule(n, everywhere=False, panels=_PANELS):
    """Rule on [0, 1] for a logarithm or a root at 0 times a polynomial of degree 2 (n - _LEAST): distances from 0 and
    weights. Its relative error is below 3^(-2 _LEAST).

    Each subpanel is a quarter as long as the one before. The zeros of a polynomial lie densest at an end of its
    interval, so that it changes sign half as often from one subpanel to the next: each has fewer points than the one
    before. If another factor of the integrand varies near 0, as under a film, `everywhere` gives every subpanel `n`
    points. Fewer `panels` are enough if the singularity lies before 0, at a distance of at least a third of the last
    subpanel, [0, 4^-panels].
    """
    least = n if everywhere else min(n, _LEAST)
    distance, weight = [], []
    for j, (high, low) in enumerate(pairwise([*4.0 ** -np.arange(panels + 1), 0.0])):
        nodes, weights = gauss_legendre(least + (8 if j == _PANELS else -(-(n - least) // 2**j)))
        if j == _PANELS:
            nodes, weights = nodes**_POWER, _POWER * nodes ** (_POWER - 1) * weights
        distance.append(low + (high - low) * nodes)
        weight.append((high - low) * weights)
    return _frozen(np.concatenate(distance)), _frozen(np.concatenate(weight))


def _frozen(array):
    array.flags.writeable = False
    return array


class Piece(NamedTuple):
    """Rules of g points each, for r pairs of a target and a panel, on one side of the targets.

    row, panel : (r,), index of the target and of the panel of each pair; no pair occurs twice
    sign : +1 where s' > s, -1 where s' < s
    gap, weight : (r, g), |s' - s| to full relative precision, and the weights of ∫ · ds'
    local : places of the points on their panel, from 0 to 1; (r, g), or (1, g) if the targets are outside their panels
    """

    row: np.ndarray
    panel: np.ndarray
    sign: int
    gap: np.ndarray
    weight: np.ndarray
    local: np.ndarray

    def basis(self, nodes):
        """The Lagrange polynomials of a panel's `nodes` (n,) at the points: (r or 1, g, n)."""
        return lagrange(nodes, self.local.ravel()).reshape(*self.local.shape, len(nodes))


def against(values, basis):
    """Sums (r, n) over the points of `values` (r, g) times a `basis` (r or 1, g, n)."""
    return values @ basis[0] if len(basis) == 1 else np.matmul(values[:, None], basis)[:, 0]


def pieces(s, breaks, order, near=None, swings=None):
    """Yield each :class:`Piece` of targets s (m,) and polynomials of `order` nodes on the p panels between `breaks`.

    A panel farther from the target than its own length has a plain Gauss rule. A nearer panel is divided into subpanels
    that shrink towards the target (:func:`.quadrature.log_rule`); their number follows from the distance. So is each
    side of a panel that contains the target.

    near : (m, p) bool, the pairs that count; None: all
    swings : (m, p) bool, the pairs on whose panel another factor of the integrand oscillates, even far from the target.
        Such a panel has all subpanels. With `swings`, the subpanels of every pair have equally many points
    """
    low, high = np.array(breaks[:-1]), np.array(breaks[1:])
    length = high - low
    for sign in (-1, 1):
        ahead = (low - s[:, None]) if sign > 0 else (s[:, None] - high)  # negative inside
        far_end = (high - s[:, None]) if sign > 0 else (s[:, None] - low)
        start, there = np.maximum(ahead, 0.0), far_end > 0
        if near is not None:
            there &= near
        towards = panels_towards(start if swings is None else np.where(swings, 0.0, start), length)
        kinds = 2 * np.where(ahead >= length, -1, towards) + (ahead < 0)
        for kind in np.unique(kinds[there]).tolist():
            rows, panels = np.nonzero(there & (kinds == kind))
            count, inside = divmod(kind, 2)  # count: number of subpanels, -1 for a panel that is far
            # 12 or 14 points are for the singularity, the others for a polynomial of degree order - 1
            rule = (
                gauss_legendre(12 + order // 2) if count < 0 else log_rule(14 + order // 2, swings is not None, count)
            )
            (distance, weight), many = rule, max(1, _TOGETHER // (len(rule[0]) * order))
            for at in range(0, len(rows), many):
                row, panel = rows[at : at + many], panels[at : at + many]
                begin = start[row, panel, None]
                reach = far_end[row, panel, None] - begin
                gap = begin + reach * distance
                if inside:
                    local = ((s[row] - low[panel])[:, None] + sign * gap) / length[panel, None]
                else:
                    local = (distance if sign > 0 else 1 - distance)[None]
                yield Piece(row, panel, sign, gap, reach * weight, local)
