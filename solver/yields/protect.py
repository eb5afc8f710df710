"""The thickness above which a layer protects the body below: docs/stresses.md, First yield."""

from typing import NamedTuple

import numpy as np

from ..bases import is_stack
from ..layers import numbers_of
from ..solve import solve
from .crossing import Crossing, first_crossing
from .similar.thickness import Ends, put_thicknesses
from .similar.unit_contacts import are_similar
from .stacked.largest import mises_in

#: The stress of the body is below some 0.5 P/h²: no body yields below a layer thicker than _THICK sqrt(P/strength).
_THICK = 4.0
#: The thinnest layer of the search: this part of a, over n, within two limits, of which the lower one leaves out layers
#: that take seconds each. a is that of the bare body.
_THIN, _THINNEST, _THICKEST = 0.05, 5e-4, 5e-3


class Protection(NamedTuple):
    """Thicknesses (B,) in the unit of R.

    protects : the thickness above which the body never yields; 0 if it does not yield at any thickness; NaN if the
        search fails
    yields : the smallest thickness at which the body yields although a bare one would not; NaN if there is none
    unsolved : bool, whether there is no answer because some contacts on the way have no solution
    """

    protects: np.ndarray
    yields: np.ndarray
    unsolved: np.ndarray


def protection(problem, strength, mu=0.0, by="h"):
    """:class:`Protection` of bodies with the yield `strength` (B,), in the unit of E2, by layers of any thickness.

    problem : B cases on layers whose load is given; their thickness `by` does not count
    mu : >= 0, friction
    by : the parameter that is the thickness, "h", or one like "layers.2.h" of a stack, whose other layers stay the
        same: a bare body is then one without this layer
    """
    none = np.zeros((len(problem), max(1, numbers_of(problem.parameters))))

    def largest(part, index, coarse):
        solution = solve(part)
        value, r, z = mises_in(part, solution, "body", 0, mu, none[index], None, coarse)
        return value / strength[index], r, z, solution

    bare, _, _, alone = largest(problem.but(base="half_space", asperities_on="auto"), slice(None), False)
    thick = _THICK * (1 + mu) * np.sqrt(problem.value / strength)
    thin = np.clip(_THIN / problem.n, _THINNEST, _THICKEST) * alone.a
    stacked = np.flatnonzero(is_stack(problem.base))
    if len(stacked):
        part = problem.take(stacked).but(**{by: thin[stacked]})
        bare[stacked] = largest(part, stacked, False)[0]
    some = ~np.isnan(bare) & (thin < thick)  # infinite under a sharp tip, until there is a layer

    def thinner(index, at, coarse):
        return largest(problem.take(index).but(**{by: thick[index] / at}), index, coarse)

    def thicker(index, at, coarse):
        return largest(problem.take(index).but(**{by: thin[index] * at}), index, coarse)

    tabled = some & (by == "h") & are_similar(problem.but(h=thin), alone.a / problem.R)
    ends = Ends(thin, thick, alone.a)
    down = first_crossing(thinner, np.where(some & ~tabled, 1.0, np.nan), thick / thin)
    down.at[:] = thick / down.at
    put_thicknesses(down, problem, np.flatnonzero(tabled), strength, mu, ends)
    safe = down.crossed & (bare < 1)
    up = Crossing.none(len(bare))
    if (safe & ~tabled).any():
        up = first_crossing(thicker, np.where(safe & ~tabled, 1.0, np.nan), thick / thin)
        up.at[:] = thin * up.at
    put_thicknesses(up, problem, np.flatnonzero(safe & tabled), strength, mu, ends.upwards())
    never = ~down.crossed & ~down.unsolved & (bare < 1)
    unsolved = down.unsolved | up.unsolved | np.isnan(bare)
    return Protection(np.where(never, 0.0, down.at), up.at, unsolved)
