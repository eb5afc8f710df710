"""Cases whose pressures a micro law does not know."""

import numpy as np

from ..body.springs import layer_modulus
from ..laws import LAWS


def outside_law(problem, solution):
    """(B,) bool: p(0) is below the range of the law, or p(0) or a pressure of the profile is above it.

    `solution` is in the units of `problem`. NaN counts as within the range.
    """
    outside = np.zeros(len(problem), dtype=bool)
    present = set(problem.micro.tolist())
    for law in LAWS.values():
        if law.name in present and (law.least > 0 or law.most < np.inf):
            index = np.flatnonzero(problem.micro == law.name)
            part, p0 = problem.take(index), solution.p0[index]
            E = part.E2 * np.where(part.base == "half_space", 1.0, layer_modulus(part.n)) / (1 + part.m)
            largest = np.maximum(p0, solution.p[index].max(axis=1, initial=0.0))
            outside[index] = (p0 < law.least * E) | (largest > law.most * E)
    return outside
