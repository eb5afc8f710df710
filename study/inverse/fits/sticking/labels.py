"""Which points of a curve stick: read from the points, not from the model.

A punch comes off where the depth, or what holds it, turns, but also before; and on approach it touches only at depth 0.
So for any unknowns all points above some depth stick and those below do not, with the split that fits best. What does
not stick has the load without adhesion: 0 above the surface, and below it what presses there. The sum of squares is
then a continuous function of the unknowns, and a point has no say in where the branch ends.
"""

from typing import NamedTuple

import numpy as np

#: At least this part of the points is in contact.
_LEAST = 0.1


class Points(NamedTuple):
    """y and weights w (B, n) of curves, the order (B, n) of their depths, how many of the deepest are in contact (B,),
    and whether errors count by themselves, (B,), or by their squares."""

    y: np.ndarray
    w: np.ndarray
    order: np.ndarray
    least: np.ndarray
    robust: np.ndarray

    @classmethod
    def of(cls, x: np.ndarray, y: np.ndarray, w: np.ndarray, unknowns: int, robust: bool) -> "Points":
        there = w > 0
        order = np.argsort(np.where(there, x, np.inf), axis=1, kind="stable")
        count = there.sum(axis=1)
        least = np.maximum((_LEAST * count).astype(int), np.minimum(unknowns + 1, count))
        return cls(y, w, order, count - least, np.full(len(x), robust))

    def take(self, index: np.ndarray) -> "Points":
        return Points(*(array[index] for array in self))

    def in_contact(self, load: np.ndarray, free: np.ndarray, base: np.ndarray) -> np.ndarray:
        """(B, n) bool, points that stick, for loads (B, n) with and without adhesion, and the baseline under both."""
        rows = np.arange(len(load))[:, None]
        on, off = (self.w * (self.y - base - part) for part in (load, free))
        more = np.where(self.robust[:, None], np.abs(on) - np.abs(off), on**2 - off**2)
        # what is saved by the first m points, m = 0 ... n, being off
        saved = np.concatenate([np.zeros((len(load), 1)), np.cumsum(more[rows, self.order], axis=1)], axis=1)
        saved[np.arange(saved.shape[1]) > self.least[:, None]] = -np.inf
        first = np.nan_to_num(saved, nan=-np.inf).argmax(axis=1)
        contact = np.empty(load.shape, bool)
        contact[rows, self.order] = np.arange(load.shape[1]) >= first[:, None]
        return contact
