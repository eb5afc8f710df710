"""The ways to solve cases whose base is named, in one table. The first row whose condition a case meets solves it; some
cases have no way."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .bases import is_bare, is_thin_layer, on_springs
from .numerics.batch import alike
from .rough.flat_punch import solve_flat
from .scaling import as_cases, kinds_of_laws
from .schemes import SCHEMES
from .shapes import is_flat, shape_of, shaped
from .shapes.shape import column
from .smooth import paraboloids
from .smooth.contact import not_sticking, sticking


class Way(NamedTuple):
    """One way to solve cases.

    name : name of the way
    has : ``has(problem, smooth)``, with `smooth` (B,) bool, returns (B,) bool: the cases of this way, unless an earlier
        row has them
    alike : ``alike(problem)`` returns arrays (B,): cases that agree in all of them are solved together
    solve : ``solve(part, x) -> Solution`` of such cases, in units R = E2* = 1, at the radii x (m,)
    equation : the equation that a solved case satisfies: "nodes", :mod:`.rough.equation`; "flat",
        :mod:`.rough.flat_punch`; "basis", :mod:`.smooth.galerkin`
    """

    name: str
    has: Callable
    alike: Callable
    solve: Callable
    equation: str


def _hertz(part, x):
    return paraboloids.on_half_space(part.control, part.value, x)


def _on_springs(part, x):
    return paraboloids.on_thin_layer(part.control, part.value, as_cases(part).body.C, part.rtol, part.nodes, x)


def _flat(part, x):
    return solve_flat(as_cases(part), part.rtol, part.nodes, int(part.max_iterations[0]), x)


def _by_scheme(part, x):
    return SCHEMES[str(part.scheme[0])](part, x)


def _of_equation(part):
    return part.micro, part.base, part.scheme, part.shape, kinds_of_laws(part), part.max_iterations


#: The table. No rough case has adhesion (:func:`unfit`), and graded layers are already cut into uniform ones
#: (:mod:`.models.sublayers`).
WAYS = (
    Way("sticking", lambda p, smooth: p.w_adhesion > 0, lambda p: (p.base, p.shape, p.adhesion), sticking, "basis"),
    Way("shaped", lambda p, smooth: smooth & shaped(p), lambda p: (p.base, p.shape), not_sticking, "basis"),
    Way("hertz", lambda p, smooth: smooth & is_bare(p.base), lambda p: (), _hertz, "nodes"),
    Way("springs", lambda p, smooth: smooth & is_thin_layer(p.base), lambda p: (), _on_springs, "nodes"),
    Way("flat", lambda p, smooth: is_flat(p) & (p.scheme == "newton"), _of_equation, _flat, "flat"),
    Way("by_scheme", lambda p, smooth: np.ones(len(p), dtype=bool), _of_equation, _by_scheme, "nodes"),
)


def way_of(problem):
    """(B,) int8: the index in WAYS of the way of each case."""
    place = np.full(len(problem), len(WAYS) - 1, dtype=np.int8)
    left, smooth = np.ones(len(problem), dtype=bool), ~problem.rough()
    for number, way in enumerate(WAYS[:-1]):
        cases = left & way.has(problem, smooth)
        place[cases], left[cases] = number, False
        if not left.any():
            break
    return place


def by_equation(problem, equation):
    """(B,) bool: the cases whose :class:`Way` has this `equation`."""
    return np.array([way.equation == equation for way in WAYS])[way_of(problem)]


def solved(problem, solvable, x):
    """A list of pairs, an index (b,) and the :class:`~solver.solution.Solution` of these cases, for the cases
    `solvable` (B,) bool of a problem in units R = E2* = 1; x : (m,) radii."""
    places, pieces = way_of(problem), []
    for number in np.unique(places[solvable]).tolist():
        way, index = WAYS[number], np.flatnonzero(solvable & (places == number))
        part = _at(problem, index)
        for rows in alike(np.zeros(len(index)), *way.alike(part)):
            pieces.append((index[rows], way.solve(_at(part, rows), x)))
    return pieces


def _at(problem, index):
    return problem if len(index) == len(problem) else problem.take(index)


def unfit(problem):
    """(B,) bool: cases of a problem in units R = E2* = 1 that no way solves, because their shape or adhesion does not
    go with the base, the asperities, the scheme or the control."""
    other, pulls = shaped(problem), problem.w_adhesion > 0
    if not (other | pulls).any():
        return np.zeros(len(problem), dtype=bool)
    out = (other | pulls) & on_springs(problem.base)
    out |= (other | pulls) & (problem.scheme == "picard")
    out |= pulls & problem.rough()
    if problem.control == "a":
        for word in np.unique(problem.shape[other]).tolist():
            index = np.flatnonzero(problem.shape == word)
            out[index] |= _no_radius(problem.take(index))
    return out | pulls & _unfit_law(problem)


def _no_radius(part):
    """(B,) bool: whether no contact has the given radius. All cases share the shape. A flat punch has its own
    radius."""
    shape, a = shape_of(part), part.value
    poles = ~np.isfinite(shape.lifted(column(shape.most()))[:, 0])
    return (a <= shape.least()) | (a >= shape.most()) & (poles | (shape.least() == shape.most()))


def _unfit_law(problem):
    """(B,) bool: whether the law of adhesion has a number that it does not take, or lacks one, or does not hold for the
    shape. The contact of a flat punch ends at its edge, and the gap outside it begins at 0."""
    jkr, dmt = problem.adhesion == "jkr", problem.adhesion == "dmt"
    numbers = np.isfinite(problem.sigma0).astype(int) + np.isfinite(problem.z0)
    wrong = np.where(dmt, numbers != 0, np.where(jkr, numbers == 2, numbers != 1))
    return wrong | dmt & shaped(problem) | ~jkr & is_flat(problem)
