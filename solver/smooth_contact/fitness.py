"""Which cases with a shape or with adhesion do not go together with the rest of what is asked."""

import numpy as np

from ..shapes import PARABOLOID, shape_of, shaped
from ..shapes.shape import column


def unfit(problem):
    """(B,) bool: cases of a problem in units R = E2* = 1 that have a shape or adhesion which does not go with the base,
    the asperities, the scheme or the control."""
    other, pulls = shaped(problem), problem.w_adhesion > 0
    if not (other | pulls).any():
        return np.zeros(len(problem), dtype=bool)
    out = (other | pulls) & np.isin(problem.base, ("thin_layer", "thin_stack"))
    out |= (other | pulls) & (problem.scheme == "picard")
    out |= pulls & problem.rough()
    if problem.control == "a":
        for word in np.unique(problem.shape[other]).tolist():
            index = np.flatnonzero(problem.shape == word)
            out[index] |= _no_radius(problem.take(index))
    return out | pulls & _unfit_law(problem)


def _no_radius(part):
    """(B,) bool: no contact of the one shape of the cases has the radius that is given. A flat punch has its own."""
    shape, a = shape_of(part), part.value
    poles = ~np.isfinite(shape.lifted(column(shape.most()))[:, 0])
    return (a <= shape.least()) | (a >= shape.most()) & (poles | (shape.least() == shape.most()))


def _unfit_law(problem):
    """(B,) bool: the law of adhesion has a number that it does not take, or lacks one; or a shape for which it does
    not stand. A flat punch is pinned at its edge: a ring beside it begins at a gap of 0."""
    jkr, dmt = problem.adhesion == "jkr", problem.adhesion == "dmt"
    numbers = np.isfinite(problem.sigma0).astype(int) + np.isfinite(problem.z0)
    wrong = np.where(dmt, numbers != 0, np.where(jkr, numbers == 2, numbers != 1))
    return wrong | dmt & (problem.shape != PARABOLOID) | ~jkr & (problem.shape == "flat")
