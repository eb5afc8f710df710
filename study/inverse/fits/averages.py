"""Long curves: searches begin with averages of neighbouring points, and end with all points.

A search needs only some hundred points to come near the minimum. From there a step or two with all points complete it,
so that the unknowns are those of all points. Profiles use the averages too. For these the averages are corrected at the
minimum for the curvature of the model within a block, so that they have the same minimum and curvature.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from .curve import MeasuredCurves
from .least_squares import Data, Minimum

#: Largest number of points of a curve that is fitted as it is, and number of blocks of a longer curve.
LONG, _BLOCKS = 1024, 512


class Averages(NamedTuple):
    """Averages (B, _BLOCKS) of the points of B curves, and the number (B, n) of the block of each point, -1 for points
    without weight."""

    curve: MeasuredCurves
    data: Data
    blocks: np.ndarray

    def about(self, best: Minimum, curve: MeasuredCurves, data: Data) -> "Averages":
        """The averages, corrected so that their residuals are the averages of the residuals at `best`."""
        averages, _ = _averages(self.blocks, data.w**2, [data.y - best.model])
        model, _ = self.curve(best.p)
        return self._replace(data=self.data._replace(y=model + averages[0]))


def averages_of(curve: MeasuredCurves, data: Data) -> Averages:
    """The :class:`Averages` of curves with points in any order. Under Huber's loss a single point represents each
    block, since an average would spread an outlier."""
    n = curve.x.shape[1]
    blocks = np.full((len(curve.x), n), -1)
    for row, x, w in zip(blocks, curve.x, data.w, strict=True):
        weighted = np.flatnonzero(w > 0)
        order = weighted[np.argsort(x[weighted], kind="stable")]
        row[order] = np.arange(len(order)) * _BLOCKS // max(len(order), 1)
    if data.huber:
        some = np.array([[np.flatnonzero(row == block)[0] for block in range(_BLOCKS)] for row in blocks])
        x, y, w = (np.take_along_axis(array, some, axis=1) for array in (curve.x, data.y, data.w))
    else:
        (x, y), w = _averages(blocks, data.w**2, [curve.x, data.y])
    return Averages(replace(curve, x=x), data._replace(y=y, w=w), blocks)


def _averages(blocks: np.ndarray, weights: np.ndarray, arrays: list[np.ndarray]) -> tuple[list[np.ndarray], np.ndarray]:
    """Weighted averages (B, _BLOCKS) of arrays (B, n), and the roots of the summed weights."""
    flat = (blocks + _BLOCKS * np.arange(len(blocks))[:, None])[blocks >= 0]
    shape, size = (len(blocks), _BLOCKS), len(blocks) * _BLOCKS
    total = np.bincount(flat, weights[blocks >= 0], size)
    sums = (np.bincount(flat, (weights * array)[blocks >= 0], size) for array in arrays)
    return [(part / total).reshape(shape) for part in sums], np.sqrt(total).reshape(shape)
