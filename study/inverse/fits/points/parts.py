"""The first unknown of a fit by parts of the contact, the others as they are fitted to all points."""

import numpy as np

from ..curve import MeasuredCurves
from ..least_squares import Data, Minimum, minimise
from .worth import Worth

#: Parts of the depth below the contact point, of equal width.
PARTS = 4
_STEPS, _ENOUGH = 12, 3  # steps of the search, and points without which a part says nothing


def parts_of(curve: MeasuredCurves, data: Data, best: Minimum, share: np.ndarray, worth: Worth) -> np.ndarray:
    """The first unknown (B, PARTS) of points from each part of the depth, for fits whose points do not agree: those
    whose intervals are wider for it, or in which it changes with the depth. NaN elsewhere, and at a bound.

    share : (B, n) of the depth, 0 before the contact
    """
    value = np.full((len(best.p), PARTS), np.nan)
    rows = np.flatnonzero((worth.factors > 1).any(axis=1) | worth.changes)
    if not len(rows):
        return value
    every, part = np.repeat(rows, PARTS), np.tile(np.arange(PARTS), len(rows))
    inside = (share[every] > part[:, None] / PARTS) & (share[every] <= (part[:, None] + 1) / PARTS)
    some = data.take(every)
    some = some._replace(w=np.where(inside, some.w, 0.0), stiffness=0 * some.stiffness)
    held = np.ones((len(every), best.p.shape[1]), bool)
    held[:, 0] = False
    fit = minimise(curve.take(every), some, best.p[every], held, _STEPS)
    p = fit.p[:, 0]
    good = ((some.w > 0).sum(axis=1) >= _ENOUGH) & (p > some.low[:, 0]) & (p < some.high[:, 0]) & np.isfinite(fit.cost)
    value[every, part] = np.where(good, p, np.nan)
    return value
