"""Derivatives by moved inputs: each case is solved again with each input a little larger and a little smaller.

This takes 2 k solutions, which have errors. It is for cases whose equation :mod:`.same_mesh` does not reproduce, such
as those whose panels would be chosen differently, and for cases that :mod:`.step` does not cover: smooth punches that
are not paraboloids, contacts with adhesion, and flat punches.
"""

import numpy as np

from ..solve import solve
from .inputs import moved_cases, slope_of

#: The step of an input, and the rtol of the moved cases. The error is about the sum of _RTOL/_STEP and _STEP². With
#: `fine` the inputs are also moved by twice the step, which leaves _STEP⁴: the results of a cone, for example, change
#: ten times as fast as its angle.
_STEP, _RTOL = 1e-3, 1e-9
#: Numbers that pass through 0 under adhesion, and the powers of E2* and R in their units. Near 0 a step may change the
#: sign, and the logarithm is meaningless.
SIGNED = {"P": (1, 2), "D": (0, 1), "p0": (1, 0), "p_max": (1, 0)}


def by_differences(problem, inputs, quantities, x, fine=False):
    """Quantity -> (k, B), derivatives of ln |quantity|; derivatives of p and λ at the radii x, (2, k, B, m); and
    quantity -> (k, B), derivatives of the :data:`SIGNED` numbers themselves. They are NaN where a moved case has no
    numbers, or infinite ones. `problem` is in units R = E2* = 1."""
    logs, profiles, slopes = _by_step(problem, inputs, quantities, x, _STEP)
    if fine:
        wide, wide_profiles, wide_slopes = _by_step(problem, inputs, quantities, x, 2 * _STEP)
        logs = {name: (4 * values - wide[name]) / 3 for name, values in logs.items()}
        slopes = {name: (4 * values - wide_slopes[name]) / 3 for name, values in slopes.items()}
        profiles = (4 * profiles - wide_profiles) / 3
    return logs, profiles, slopes


def _by_step(problem, inputs, quantities, x, step):
    cases = moved_cases(problem, inputs, step)
    solution = solve(cases.but(rtol=np.minimum(cases.rtol, _RTOL)), x)
    k = len(inputs)
    logs = {name: slope_of(np.log(np.abs(getattr(solution, name))), k, step) for name in quantities}
    slopes = {name: slope_of(_finite(getattr(solution, name)), k, step) for name in SIGNED}
    return logs, np.stack([slope_of(_finite(values), k, step) for values in (solution.p, solution.lam)]), slopes


def _finite(values):
    return np.where(np.isfinite(values), values, np.nan)
