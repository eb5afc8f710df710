"""Rules of ∫ · ds' over the panels of a mesh for integrands with one singularity, at the target s' = s, of many targets
and panels at once; nothing about contact."""

from typing import NamedTuple

import numpy as np

from .quadrature import gauss_legendre, log_rule, panels_towards

#: Numbers of a piece, points times nodes of a panel: some MB, in which the calls of numpy no longer count.
_TOGETHER = 131_072


class Piece(NamedTuple):
    """Points of rules of one shape, over r pairs of a target and a panel.

    `row`, `panel` (r,): the pairs, each once; `sign`: +1 where s' > s, -1 where s' < s; `gap` and `weight` (r, g):
    |s' - s| to full relative precision, and the weights of ∫ · ds'; `local` (r, g): where the points are on their
    panel, from 0 to 1.
    """

    row: np.ndarray
    panel: np.ndarray
    sign: int
    gap: np.ndarray
    weight: np.ndarray
    local: np.ndarray


def pieces(s, breaks, order, near=None, rough=None):
    """Yield the :class:`Piece` of targets s (m,) and polynomials of `order` nodes on the panels between `breaks`.

    A panel farther from the target than its own length has a plain Gauss rule. One that is nearer, and each side of
    one that contains the target, has panels of its own towards the target (:func:`.quadrature.log_rule`), no more of
    them than its distance asks for. `near` (m, p) bool: the pairs that count; all if None. `rough` (m, p) bool: those
    where another factor of the integrand is not smooth away from the target, and all these panels are needed; with it,
    they have as many points each.
    """
    low, high = np.array(breaks[:-1]), np.array(breaks[1:])
    length = high - low
    for sign in (-1, 1):
        ahead = (low - s[:, None]) if sign > 0 else (s[:, None] - high)  # negative inside
        far_end = (high - s[:, None]) if sign > 0 else (s[:, None] - low)
        start, there = np.maximum(ahead, 0.0), far_end > 0
        if near is not None:
            there &= near
        is_far = ahead >= length
        level = np.where(is_far, -1, panels_towards(start if rough is None else np.where(rough, 0.0, start), length))
        for one in np.unique(level[there]).tolist():
            row, panel = np.nonzero(there & (level == one))
            rule = gauss_legendre(12 + order // 2) if one < 0 else log_rule(14 + order // 2, rough is not None, one)
            many = max(1, _TOGETHER // (len(rule[0]) * order))
            for at in range(0, len(row), many):
                yield _piece(s, low, length, sign, start, far_end, row[at : at + many], panel[at : at + many], *rule)


def _piece(s, low, length, sign, start, far_end, row, panel, distance, weight):
    """The :class:`Piece` of the pairs `row`, `panel` for a rule on [0, 1]."""
    begin, whole = start[row, panel, None], length[panel, None]
    reach = far_end[row, panel, None] - begin
    gap = begin + reach * distance
    local = ((s[row] - low[panel])[:, None] + sign * gap) / whole
    return Piece(row, panel, sign, gap, reach * weight, local)
