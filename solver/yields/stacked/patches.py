"""The largest value of a function of the stresses of one case, near a point: patches that shrink about it."""

import numpy as np

from ..peaks import chebyshev_nodes, in_patch

#: Nodes of a patch in each direction, Chebyshev's, with both ends.
_NODES = 7
#: A patch shrinks so much once the largest value is inside it, until that has changed by less than _SAME of itself,
#: which is far below the 1e-6 that is promised; or until a patch is smaller than _SMALLEST. It moves or shrinks at most
#: _MOST times (tests/yields/test_largest_stresses.py).
_SHRINK, _SAME, _SMALLEST, _MOST = 5.0, 1e-9, 1e-7, 40


def climbed(stresses, value, start, half, region):
    """The largest value, and its place (u, v).

    stresses : ``stresses(u, v)`` at u (U,) and v (V,), (4, V, U)
    value : ``value(sr, st, sz, trz)``, elementwise
    start, half : (u, v), the centre of the first patch and half of its widths
    region : ((least u, largest u), (least v, largest v)); the same twice is a line
    """
    centre, half, (low, high) = np.array(start, dtype=float), np.array(half, dtype=float), np.array(region).T
    before = np.nan
    for _ in range(_MOST):
        ends = np.maximum(centre - half, low), np.minimum(centre + half, high)
        axes = [_on(*end, chebyshev_nodes(_NODES)) if end[1] > end[0] else end[:1] for end in zip(*ends, strict=True)]
        largest, place = in_patch(stresses(*axes), value)
        centre = np.array([_on(*end, p) for *end, p in zip(*ends, place, strict=True)])
        outside = (np.abs(place) == 1) & (centre > low) & (centre < high)
        if not np.isfinite(largest) or (not outside.any() and abs(largest - before) <= _SAME * abs(largest)):
            break
        before = largest
        if not outside.any():
            half = half / _SHRINK
        if np.all(half < _SMALLEST):
            break
    return largest, centre


def _on(low, high, place):
    """What is at `place` in [-1, 1] of an interval."""
    return np.where(place == 1, high, low + (high - low) * (1 + place) / 2)
