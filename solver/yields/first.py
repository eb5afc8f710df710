"""At which load a body or the asperities first yield: docs/stresses.md, First yield.

The largest stress neither scales with the load nor grows with it everywhere: so the radius rises step by step from
where nothing can yield.
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

#: No body yields where (a/R) E*/strength is below _NEVER, E* the larger of layer and body; sliding adds so much.
_NEVER, _BY_FRICTION = 0.3, 4.0
#: No asperity yields where (a/R) E/strength is below this times sqrt(Ra/R), for p0s < 0.46 E a/sqrt(R Ra).
_NO_SPOT = 0.7
#: Asperities that feel the layer have more pressure on a soft one, as on what lies below, and more stress in one that
#: bends, as of bodies that bend: so much less is looked at. In 400 random contacts the radius at first yield was above
#: (tests/yields/test_felt_spots.py).
_FELT = 0.2


def first_yield(problem, body, strength, mu=0.0, residual=0.0, punch=None, slopes=False, layer=0):
    """:class:`~.crossing.Crossing` of the "layer", the "body", the "punch" or the "asperities"; `at` is a/R, less the
    radius of a flat end. Under a sharp tip or corner what is touched yields under any load: all is 0.

    problem : B cases, whatever controls them
    strength : (B,), yield strength by von Mises, in the unit of E2; NaN: nothing is looked for
    mu : >= 0, friction
    residual : biaxial stress of the layer, or (B, N) of each layer of stacks, in the unit of E2
    punch : (B,), Poisson ratios of the punches, where these are looked at
    slopes : whether the derivatives by the strength are wanted
    layer : which layer of a stack, from 0, the one at the surface
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
        """Up to where contacts have one coarse grid: h/a is in one octave; of spots it is each its own."""
        a = reach.flat[index] + at
        h = np.where(is_bare(problem.base[index]), a, problem.h[index] / problem.R[index])
        edge = h / 2.0 ** np.floor(np.log2(h / a) + 1e-12)
        edge = np.where(is_bare(problem.base[index]) | (body == "punch"), 2 * a, edge)
        return at if body == "asperities" else np.maximum(edge - reach.flat[index], at)

    start, round_ = _start(problem, body, left / problem.E2, mu), np.isin(problem.shape, ROUND)
    start = np.where(round_, np.maximum(start, NARROWEST), np.where(reach.sharp, np.nan, reach.start))
    last = np.where(round_, WIDEST, reach.last)
    tabled = are_similar(problem, last) & np.all(residual == 0, axis=1) & (body != "asperities") & (layer == 0)
    made = first_crossing(stress, np.where((left > 0) & ~tabled, start, np.nan), last, slopes, same_grid)
    sought = Sought(body, float(mu)), punch, slopes
    put_first_loads(made, problem, np.flatnonzero(tabled & (left > 0)), strength, sought, (start, last))
    # the residual stress alone is as large as the strength, or there is a tip or corner below which it is infinite
    rest = (left <= 0) | reach.sharp & (left > 0)
    made.crossed[rest], made.at[rest] = True, 0.0
    for number in NUMBERS:
        made.numbers[number][rest] = reach.flat[rest] * problem.R[rest] if number == "a" else 0.0
    return made


def _touched(problem, body, punch):
    """(B,) bool: the punch touches the body, which is not incompressible; or it is the punch itself."""
    bare = is_bare(problem.base)
    if body == "punch":
        return punch < 0.5
    return np.where(bare, (body == "body") & (problem.nu2 < 0.5), (body == "layer") & (problem.nu1 < 0.5))


def _start(problem, body, strength, mu):
    """A radius over R below which nothing yields."""
    n = np.where(is_bare(problem.base), 1.0, problem.n)
    if body == "asperities":
        least = _NO_SPOT * strength / layer_modulus(n) * np.sqrt(problem.Ra / problem.R)
        soft = np.where(n > 0, np.minimum(n, 1.0), 0.1)
        return np.where(problem.feels_layer(), _FELT * soft / np.maximum(n, 1.0) ** (2 / 3), 1.0) * least
    return _NEVER / (1 + _BY_FRICTION * mu) * strength / stiffest(problem)
