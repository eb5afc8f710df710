"""Quadrature rules of ∫ · ds' over the panels of a mesh, for integrands with one singularity at a target s' = s; for
many targets and panels at once. Nothing about contact."""

from typing import NamedTuple

import numpy as np

from .quadrature import gauss_legendre, lagrange, log_rule, panels_towards

#: Most numbers of a piece, points times nodes of a panel: 1 MB, enough that the time of numpy's calls does not count.
_TOGETHER = 131_072


class Piece(NamedTuple):
    """Rules of g points each, for r pairs of a target and a panel, on one side of the targets.

    `row`, `panel` (r,): the pairs, each once
    `sign`: +1 where s' > s, -1 where s' < s
    `gap`, `weight` (r, g): |s' - s| to full relative precision, and the weights of ∫ · ds'
    `local`: where the points are on their panel, from 0 to 1: (r, g), or (1, g) if the targets are outside their panels
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

    A panel farther from the target than its own length has a plain Gauss rule. A nearer one, and each side of one that
    contains the target, is divided into subpanels towards the target (:func:`.quadrature.log_rule`), as many as the
    distance asks for.

    near : (m, p) bool, the pairs that count; None: all
    swings : (m, p) bool, the pairs on whose panel another factor of the integrand swings, even far from the target.
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
            count, inside = divmod(kind, 2)  # of subpanels; -1 of a panel that is far
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
