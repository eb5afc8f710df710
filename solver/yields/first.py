"""The load at which a body or the asperities first yield: docs/stresses.md, First yield.

The largest stress does not scale with the load, nor does it always grow with it. So the search goes up in the radius,
step by step, from a radius at which nothing can yield.
"""

from dataclasses import replace

import numpy as np

from ..bases import is_bare
from ..kernels.two_layers import layer_modulus
from ..layers import numbers_of
from ..shapes import ROUND
from ..solve import solve
from . import spots
from .crossing import NUMBERS, first_crossing
from .reach import NARROWEST, WIDEST, reach_of, stiffest
from .similar.first_load import put_first_loads
from .similar.unit_contacts import Sought, are_similar
from .stacked.largest import mises_in

#: No body yields if (a/R) E*/strength is below _NEVER/(1 + _BY_FRICTION mu), with the larger E* of layer and body.
_NEVER, _BY_FRICTION = 0.3, 4.0
#: No asperity yields if (a/R) E/strength is below this times sqrt(Ra/R), because p0s < 0.46 E a/sqrt(R Ra).
_NO_SPOT = 0.7
#: Asperities that feel the layer have a higher pressure on a soft layer, and a higher stress in a layer that bends: the
#: search starts at this part of the radius. In 400 random contacts the radius at first yield was larger
#: (tests/yields/test_felt_spots.py).
_FELT = 0.2


def first_yield(problem, body, strength, mu=0.0, residual=0.0, punch=None, slopes=False, layer=0):
    """:class:`~.crossing.Crossing` of the "layer", the "body", the "punch" or the "asperities"; `at` is a/R, less the
    radius of a flat end. Under a sharp tip or corner, the layer or body that it touches yields under any load: all
    numbers are 0.

    problem : B cases; the value of their control does not count
    strength : (B,), yield strength by von Mises, in the unit of E2; NaN: no search
    mu : >= 0, friction
    residual : biaxial stress of the layer, or (B, N) of each layer of stacks, in the unit of E2
    punch : (B,), Poisson ratios of the punches, if `body` is "punch"
    slopes : whether the derivatives by the strength are wanted
    layer : number of the layer of a stack; 0 is the one at the surface
    """
    felt = body in ("layer", "asperities")
    layers = max(1, numbers_of(problem.parameters))
    residual = np.reshape(residual, (-1, 1)) if np.ndim(residual) == 1 else residual
    residual = np.broadcast_to(residual, (len(problem), layers)) * float(felt)
    if body == "asperities":
        problem = problem.but(micro=np.where(problem.micro == "elastic_plastic", "disc_cell", problem.micro))
    at_radius = replace(problem, control="a", value=problem.R)
    left = strength - np.where(is_bare(problem.base), 0.0, np.abs(residual[:, layer]))
    reach = reach_of(problem, left / problem.E2, mu, _touched(problem, body, punch) & (layer == 0))

    def stress(index, at, coarse):
        part = replace(at_radius.take(index), value=(reach.flat[index] + at) * problem.R[index])
        solution = solve(part)
        if body == "asperities":
            value, r, z = spots.of_contacts(part, solution, mu, residual[index, 0])
        else:
            nu = punch[index] if body == "punch" else None
            value, r, z = mises_in(part, solution, body, layer, mu, residual[index], nu, coarse)
        return value / strength[index], r, z, solution

    def same_grid(index, at):
        """The largest radius up to which contacts share a coarse grid, h/a being in one octave; asperities share
        none."""
        a = reach.flat[index] + at
        h = np.where(is_bare(problem.base[index]), a, problem.h[index] / problem.R[index])
        edge = h / 2.0 ** np.floor(np.log2(h / a) + 1e-12)
        edge = np.where(is_bare(problem.base[index]) | (body == "punch"), 2 * a, edge)
        return at if body == "asperities" else np.maximum(edge - reach.flat[index], at)

    start, round_ = _start(problem, body, left / problem.E2, mu), np.isin(problem.shape, ROUND)
    start = np.where(round_, np.maximum(start, NARROWEST), np.where(reach.sharp, np.nan, reach.start))
    last = np.where(round_, WIDEST, reach.last)
    tabled = are_similar(problem, last) & np.all(residual == 0, axis=1) & (body != "asperities") & (layer == 0)
    crossing = first_crossing(stress, np.where((left > 0) & ~tabled, start, np.nan), last, slopes, same_grid)
    sought = Sought(body, float(mu)), punch, slopes
    put_first_loads(crossing, problem, np.flatnonzero(tabled & (left > 0)), strength, sought, (start, last))
    # the residual stress alone is as large as the strength, or there is a tip or corner below which it is infinite
    rest = (left <= 0) | reach.sharp & (left > 0)
    crossing.crossed[rest], crossing.at[rest] = True, 0.0
    for number in NUMBERS:
        crossing.numbers[number][rest] = reach.flat[rest] * problem.R[rest] if number == "a" else 0.0
    return crossing


def _touched(problem, body, punch):
    """(B,) bool: whether the punch touches the body, or the body is the punch itself; False if it is
    incompressible."""
    bare = is_bare(problem.base)
    if body == "punch":
        return punch < 0.5
    return np.where(bare, (body == "body") & (problem.nu2 < 0.5), (body == "layer") & (problem.nu1 < 0.5))


def _start(problem, body, strength, mu):
    """A radius (B,), over R, below which nothing yields."""
    n = np.where(is_bare(problem.base), 1.0, problem.n)
    if body == "asperities":
        least = _NO_SPOT * strength / layer_modulus(n) * np.sqrt(problem.Ra / problem.R)
        soft = np.where(n > 0, np.minimum(n, 1.0), 0.1)
        return np.where(problem.feels_layer(), _FELT * soft / np.maximum(n, 1.0) ** (2 / 3), 1.0) * least
    return _NEVER / (1 + _BY_FRICTION * mu) * strength / stiffest(problem)
