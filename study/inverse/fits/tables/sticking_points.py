"""The points of a curve that are in contact with adhesion, as decided by the points and not by the model.

The punch comes off at a depth that depends on the stiffness of its machine: with the softest spring at the least load.
On approach it touches only at depth 0. So for any unknowns all points above some depth adhere, and the others do not,
with the split that fits best; points deeper than that of the least load adhere in any case. Points that do not adhere
have the load without adhesion: 0 above the surface, and below it the load of the contact. The sum of squares is then a
continuous function of the unknowns, except where a point passes that depth, and no point decides where the branch ends.

For a retraction, whose points come with falling depths, there is no choice: all points adhere down to the end of the
branch, and later ones have no load. Otherwise a fit could choose a far stronger pull that only the deepest points feel.
"""

from typing import NamedTuple

import numpy as np

from solver.numerics import batch

#: Least share of the points that are in contact.
_LEAST = 0.1


@batch.of_cases
class StickingPoints(NamedTuple):
    """The points of B curves.

    y, w : values and weights, (B, n)
    order, rank : of the depths, and the place of each point in it, (B, n)
    least : largest number of points, in this order, that may be out of contact, (B,)
    robust : whether errors count linearly, not by their squares, (B,)
    retracts : whether the curve is a retraction, (B,)
    """

    y: np.ndarray
    w: np.ndarray
    order: np.ndarray
    rank: np.ndarray
    least: np.ndarray
    robust: np.ndarray
    retracts: np.ndarray

    @classmethod
    def of(cls, x: np.ndarray, y: np.ndarray, w: np.ndarray, unknowns: int, robust: bool) -> "StickingPoints":
        is_point = w > 0
        order = np.argsort(np.where(is_point, x, np.inf), axis=1, kind="stable")
        count = is_point.sum(axis=1)
        least = np.maximum((_LEAST * count).astype(int), np.minimum(unknowns + 1, count))
        rank = np.argsort(order, axis=1)
        return cls(y, w, order, rank, count - least, np.full(len(x), robust), retractions(x, w))

    def in_contact(
        self, load: np.ndarray, free: np.ndarray, base: np.ndarray, must: np.ndarray | None = None
    ) -> np.ndarray:
        """(B, n) bool, whether points adhere, for loads (B, n) with and without adhesion, and the baseline under both.

        must : (B, n) bool, whether points are so deep that the punch cannot come off: from some depth on
        """
        on, off = (self.w * (self.y - base - part) for part in (load, free))
        more = np.where(self.robust[:, None], np.abs(on) - np.abs(off), on**2 - off**2)
        # the cost that the first m points save if they do not adhere, m = 0 ... n
        saved = np.zeros((len(load), load.shape[1] + 1))
        np.cumsum(np.take_along_axis(more, self.order, axis=1), axis=1, out=saved[:, 1:])
        least = self.least
        if must is not None:
            shallow = ((self.w > 0) & ~must).sum(axis=1)
            least = np.minimum(least, np.where(((self.w > 0) & must).any(axis=1), shallow, least))
        saved[np.arange(saved.shape[1]) > least[:, None]] = -np.inf
        first = np.nan_to_num(saved, nan=-np.inf).argmax(axis=1)
        return self.rank >= first[:, None]


def retractions(x: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Whether curves (B,) are retractions: x (B, n) falls in the order of the points; w is 0 where there is no
    point."""
    is_point = w > 0
    place = np.cumsum(is_point, axis=1)
    count = np.maximum(is_point.sum(axis=1), 1)
    means = [np.where(is_point, A, 0.0).sum(axis=1) / count for A in (x, place)]
    products = np.where(is_point, (x - means[0][:, None]) * (place - means[1][:, None]), 0.0).sum(axis=1)
    return products < 0
