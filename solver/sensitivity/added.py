"""Derivatives of what asperities make of a smooth solution, to which the base "auto" adds them afterwards."""

import numpy as np

from ..models.auto import area_rule, spots_under
from ..scaling import law_of
from .changes import moved_along, slope_of
from .points import at_points


def added_slopes(ev, changes, derivatives, problem, unit, x):
    """Quantity -> (k, B), derivatives of ln A0, ln p_max and ln Ar/An; and of λ at the radii x (m,), (k, B, m).

    derivatives : :class:`.state.Implicit` of the smooth solutions `ev`; problem : the 2 k B moved cases with their
    asperities, in units R = E2* = 1; unit : (2, ...), the modulus E2 (B,) that is 1 for `ev`, and the derivatives (k,
    B) of its logarithm
    """
    E2, d_E2 = unit
    law, (s, _) = law_of(problem), area_rule()
    points = np.concatenate([s, np.sqrt((1 - x) * (1 + x)), [1.0]])
    inner = points > 0
    at = at_points(ev, changes, derivatives, points[inner])
    p, d_p = np.zeros((len(E2), len(points))), np.zeros((*d_E2.shape, len(points)))
    p[:, inner] = E2[:, None] * at.p
    d_p[..., inner] = E2[:, None] * (at.d_p + d_E2[..., None] * at.p)
    p = moved_along(p, d_p)
    spots = spots_under(law, p[:, -1], p[:, : len(s)])
    k = len(d_E2)
    lam = law.at(p[:, len(s) : -1]).lam
    return {name: slope_of(np.log(values), k) for name, values in spots.items()}, slope_of(lam, k)
