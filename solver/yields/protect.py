"""The thickness above which a layer protects the body below: docs/stresses.md, First yield."""

from typing import NamedTuple

import numpy as np

from ..solve import solve
from .contact import of_contacts
from .crossing import Crossing, first_crossing

#: The stress of the body is below some 0.5 P/h²: it yields below no layer thicker than _THICK sqrt(P/strength).
_THICK = 4.0
#: Thinner layers than this part of a, over n, are not looked at, nor those that take seconds each. a is that of the
#: bare body.
_THIN, _THINNEST, _THICKEST = 0.05, 5e-4, 5e-3


class Protection(NamedTuple):
    """Thicknesses (B,) in the unit of R.

    protects : above it the body yields for no larger thickness; 0: for none. NaN: not found
    yields : the least at which the body yields where a bare one would not; NaN: there is none
    unsolved : bool, some contacts on the way have no solution, and nothing was found
    """

    protects: np.ndarray
    yields: np.ndarray
    unsolved: np.ndarray


def protection(problem, strength, mu=0.0):
    """:class:`Protection` of bodies with the yield `strength` (B,), in the unit of E2, by layers of any thickness.

    problem : B cases on layers whose load is given; `h` counts for nothing
    mu : >= 0, friction
    """

    def largest(part, index, coarse):
        solution = solve(part)
        value, r, z = of_contacts(part, solution, mu, names=("mises2",), coarse=coarse)["mises2"]
        return value / strength[index], r, z, solution

    bare, _, _, alone = largest(problem.but(base="half_space", asperities_on="auto"), slice(None), False)
    thick = _THICK * (1 + mu) * np.sqrt(problem.value / strength)
    thin = np.clip(_THIN / problem.n, _THINNEST, _THICKEST) * alone.a
    some = ~np.isnan(bare) & (thin < thick)  # infinite under a sharp tip, until there is a layer

    def thinner(index, at, coarse):
        return largest(problem.take(index).but(h=thick[index] / at), index, coarse)

    def thicker(index, at, coarse):
        return largest(problem.take(index).but(h=thin[index] * at), index, coarse)

    down = first_crossing(thinner, np.where(some, 1.0, np.nan), thick / thin)
    safe = down.crossed & (bare < 1)
    up = first_crossing(thicker, np.where(safe, 1.0, np.nan), thick / thin) if safe.any() else Crossing.none(len(bare))
    never = ~down.crossed & ~down.unsolved & (bare < 1)
    unsolved = down.unsolved | up.unsolved | np.isnan(bare)
    return Protection(np.where(never, 0.0, thick / down.at), thin * up.at, unsolved)
