"""F of a table with many rows, as series: so the time for F and F' at a radius does not grow with the number of rows.

The slope of the table is a line from each r_j to r_(j+1). There F/t and F' are smooth functions of y,
t = r_j + (r_(j+1) - r_j) y².
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander

#: Number of terms of a series; and its largest error over the largest value, which is the rounding of a sum over 1,000
#: lines. A table that would need more terms has no series: its rows lie close together here and far apart there.
_TERMS, _OFF = 18, 1e-12
#: Tables of at most this many lines have no series: the sum over the lines is as fast.
FEW = 24


class Series(NamedTuple):
    """Radii of the rows (K,), and the coefficients of F/t (`over`) and F' (`slope`) on the lines, (_TERMS, K - 1)
    each."""

    knots: np.ndarray
    over: np.ndarray
    slope: np.ndarray

    def at(self, t, slope=False):
        """F/t at t (...), or F' if `slope`."""
        place = np.clip(np.searchsorted(self.knots, t, side="right") - 1, 0, len(self.knots) - 2)
        low, high = self.knots[place], self.knots[place + 1]
        x = 2 * np.sqrt(np.clip((t - low) / (high - low), 0.0, None)) - 1
        terms = self.slope if slope else self.over
        after, now = np.zeros_like(x), terms[-1][place]
        for row in terms[-2:0:-1]:
            after, now = now, row[place] + 2 * x * now - after
        return terms[0][place] + x * now - after


def series_of(knots, lifted):
    """The :class:`Series` on the lines between `knots` (K,), or None if the sum over lines is better.

    lifted : ``lifted(t) -> F/t, F'`` by the sum over lines
    """
    if len(knots) <= FEW:
        return None
    nodes = (1 - np.cos(np.pi * (np.arange(_TERMS) + 0.5) / _TERMS)) / 2
    matrix, between = np.linalg.inv(chebvander(2 * nodes - 1, _TERMS - 1)), (nodes[1:] + nodes[:-1]) / 2
    series = Series(knots, *(matrix @ values for values in lifted(_radii(knots, nodes))))
    t = _radii(knots, between)
    for exact, slope in zip(lifted(t), (False, True), strict=True):
        if np.abs(series.at(t, slope) - exact).max() > _OFF * np.abs(exact).max():
            return None
    return series


def _radii(knots, y):
    """t (M, K - 1) at y (M,) on each line."""
    return knots[:-1] + np.diff(knots) * y[:, None] ** 2
