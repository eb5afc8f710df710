"""The share of the nominal contact area on which the asperities have yielded."""

import numpy as np

from ..scaling import dimensionless, law_of, of_one_law
from .law_error import RADII, has_yield

#: The places s² = 1 - (r/a)² of the profile, ascending from the edge.
_S2 = (1 - RADII) * (1 + RADII)
#: Between two radii ln s² is a polynomial of ln λ through this many of the radii. All of them are on the elastic side
#: of the bound, where λ has a kink. In 40 random contacts the largest error was 9e-7; with two radii on each side,
#: 4e-6.
_POINTS = 4


def plastic_share(problem, lam):
    """(B,): the share of pi a² on which the spots have yielded; NaN for a law whose spots do not yield, and where λ is
    NaN.

    lam : (B, m), λ at the radii RADII. Under a point λ on the axis is unknown: if the spots at the next radius have
        yielded, those on the axis have too
    """
    share = np.full(len(problem), np.nan)
    yielding = np.flatnonzero(has_yield(problem))
    for some in of_one_law(problem.take(yielding)):
        index = yielding[some]
        law = law_of(dimensionless(problem.take(index)))
        level = np.log(lam[index] / law.law.yielded(*law.own))
        level[:, -1] = np.where(np.isnan(level[:, -1]) & (level[:, -2] > 0), level[:, -2], level[:, -1])
        share[index] = _share_above(level)
    return share


def _share_above(level):
    """Share (B,) of s² from 0 to 1 on which `level` (B, m), at the places _S2, is above 0."""
    size, m = level.shape
    above = np.concatenate([np.zeros((size, 1), bool), level > 0], axis=1)  # at the edge, s = 0, nothing yields
    share = np.where(above[:, -1], 1.0, 0.0)
    rows, after = np.nonzero(above[:, 1:] != above[:, :-1])
    rises = above[rows, after + 1]
    first = np.clip(np.where(rises, after - _POINTS, after), 0, m - _POINTS)
    places = first[:, None] + np.arange(_POINTS)
    x, others = level[rows[:, None], places], ~np.eye(_POINTS, dtype=bool)
    weights = [np.prod(x[:, rest] / (x[:, rest] - x[:, i, None]), axis=1) for i, rest in enumerate(others)]
    crossing = np.exp((np.stack(weights, axis=1) * np.log(_S2[places])).sum(axis=1))
    crossing = np.clip(crossing, np.append(0.0, _S2)[after], _S2[after])
    np.subtract.at(share, rows, np.where(rises, crossing, -crossing))
    return np.where(np.isnan(level).any(axis=1), np.nan, share)
