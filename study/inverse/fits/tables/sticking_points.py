"""Which points of a curve are in contact with adhesion: the points say it, not the model.

A punch comes off where the depth, or what holds it, turns, the softest spring at the least load; and on approach it
touches only at depth 0. So for any unknowns all points above some depth stick and those below do not, with the split
that fits best; those deeper than that of the least load stick in any case. What does not stick has the load without
adhesion: 0 above the surface, and below it what presses there. The sum of squares is then a continuous function of the
unknowns, except where a point passes that depth, and a point has no say in where the branch ends.

Of a retraction, whose points come with falling depths, nothing is chosen: all points stick down to the end of the
branch, and those beyond it have no load. Else a fit could take a far stronger pull, of which no point but the deepest
ones has anything.
"""

from typing import NamedTuple

import numpy as np

from solver.numerics import batch

#: At least this part of the points is in contact.
_LEAST = 0.1


@batch.of_cases
class StickingPoints(NamedTuple):
    """y and weights w (B, n) of curves, the order (B, n) of their depths, how many of the deepest are in contact (B,),
    and whether errors count by themselves, (B,), or by their squares."""

    y: np.ndarray
    w: np.ndarray
    order: np.ndarray
    least: np.ndarray
    robust: np.ndarray
    retracts: np.ndarray

    @classmethod
    def of(cls, x: np.ndarray, y: np.ndarray, w: np.ndarray, unknowns: int, robust: bool) -> "StickingPoints":
        there = w > 0
        order = np.argsort(np.where(there, x, np.inf), axis=1, kind="stable")
        count = there.sum(axis=1)
        least = np.maximum((_LEAST * count).astype(int), np.minimum(unknowns + 1, count))
        return cls(y, w, order, count - least, np.full(len(x), robust), retractions(x, w))

    def in_contact(
        self, load: np.ndarray, free: np.ndarray, base: np.ndarray, must: np.ndarray | None = None
    ) -> np.ndarray:
        """(B, n) bool, points that stick, for loads (B, n) with and without adhesion, and the baseline under both.

        must : (B, n) bool, points that are so deep that nothing comes off there
        """
        rows = np.arange(len(load))[:, None]
        on, off = (self.w * (self.y - base - part) for part in (load, free))
        more = np.where(self.robust[:, None], np.abs(on) - np.abs(off), on**2 - off**2)
        # the cost that the first m points save if they are off, m = 0 ... n
        saved = np.concatenate([np.zeros((len(load), 1)), np.cumsum(more[rows, self.order], axis=1)], axis=1)
        least = self.least
        if must is not None:
            there = np.take_along_axis(self.w > 0, self.order, axis=1)
            deep = np.take_along_axis(must, self.order, axis=1) & there
            least = np.where(deep.any(axis=1), np.minimum(least, deep.argmax(axis=1)), least)
        saved[np.arange(saved.shape[1]) > least[:, None]] = -np.inf
        first = np.nan_to_num(saved, nan=-np.inf).argmax(axis=1)
        contact = np.empty(load.shape, bool)
        contact[rows, self.order] = np.arange(load.shape[1]) >= first[:, None]
        return contact


def retractions(x: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Which curves (B,) are retractions: x (B, n) falls in the order of the points; w is 0 where there is no point."""
    there = w > 0
    place = np.cumsum(there, axis=1)
    count = np.maximum(there.sum(axis=1), 1)
    means = [np.where(there, A, 0.0).sum(axis=1) / count for A in (x, place)]
    both = np.where(there, (x - means[0][:, None]) * (place - means[1][:, None]), 0.0).sum(axis=1)
    return both < 0
