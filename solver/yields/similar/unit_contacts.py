"""Smooth paraboloids on one layer with the radius a = R, at any h/a: of every other radius the stress is a/R times
theirs, the pressure too, the load (a/R)³ and the depth (a/R)² times.

They are solved in the basis of :mod:`~solver.smooth.galerkin`, of kernels that are tabulated once: an octave of h/a
that a process has not met takes some ten milliseconds, where tables of the mesh take .7 of a second.
"""

from typing import NamedTuple

import numpy as np

from ...bases import is_exact, is_stack
from ...body import BODIES
from ...fields.pressure import Pressure
from ...numerics import batch
from ...numerics.mesh import mesh_of
from ...numerics.threads import one_blas_thread
from ...scaling import dimensionless, refused
from ...shapes import shape_of, shaped
from ...smooth.galerkin import respond
from ...smooth.pressure import pressures_of, without_edge
from ...smooth.tabulated_body import Tabulated
from ...smooth.tension import is_tensile
from ..contact import alike
from ..extremes import coarsely, together

#: Nodes of the polynomial that is the pressure, where the coarse grid is enough and elsewhere
#: (tests/yields/similar/test_unit_contacts.py).
_ROUGHLY, _NODES = 22, 64
#: Contacts that are in memory together.
_TOGETHER = 64
#: Films thinner than this part of the radius at which a search ends are left to the mesh: the basis does not resolve
#: their edge.
THINNEST = 1e-4


@batch.of_cases
class UnitContacts(NamedTuple):
    """Contacts at a = R, (B,) each, in units R = E2* = 1; NaN where the punch would lift off.

    P, D, p0 : load, depth and pressure in the centre
    mises, r, z : the largest von Mises stress, and its place in a; NaN where it is not asked for
    """

    P: np.ndarray
    D: np.ndarray
    p0: np.ndarray
    mises: np.ndarray
    r: np.ndarray
    z: np.ndarray


class Sought(NamedTuple):
    """Whose stress is sought: the "layer", the "body" or the "punch", and the friction mu."""

    body: str
    mu: float


def are_similar(problem, farthest):
    """(B,) bool: the cases of which this room has the stresses up to the radius `farthest` (B,), in R."""
    one_layer = is_exact(problem.base) & ~is_stack(problem.base) & (problem.scheme == "newton")
    some = one_layer & ~problem.rough() & ~shaped(problem) & ~(problem.w_adhesion > 0)
    index = np.flatnonzero(some)
    if len(index):
        scaled = dimensionless(problem.take(index))
        some[index] = ~refused(problem.take(index), scaled) & (scaled.h > THINNEST * farthest[index])
    return some


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN
def unit_contacts(scaled, t, sought=None, punch=None, coarse=False):
    """:class:`UnitContacts` of cases with h/a = t (B,).

    scaled : B cases for which :func:`are_similar`, in units R = E2* = 1; neither the control nor h counts
    sought : :class:`Sought`, or None: no stress is
    punch : (B,), Poisson ratios of the punches, where the stress is theirs
    coarse : the stress is that of the coarse grid, up to 10 % too small, without its place
    """
    made = UnitContacts(*np.full((6, len(t)), np.nan))
    for some in np.array_split(np.arange(len(t)), -(-len(t) // _TOGETHER)):
        part, a, none = scaled.take(some).but(h=t[some]), np.ones(len(some)), np.zeros(len(some))
        shape, body = shape_of(part), Tabulated.of(BODIES["layered"](part))
        response = respond(shape, body, a, by_recurrence=True)
        numbers = response.P, response.D, pressures_of(shape, response, none, np.zeros(1))[:, 0]
        for values, column in zip(made, numbers, strict=False):
            values[some] = column
        if sought is not None:
            mesh = mesh_of(_ROUGHLY if coarse else _NODES)
            pressure = Pressure(mesh, without_edge(shape, response, none, mesh.x))
            nu = punch[some] if sought.body == "punch" else None
            made.mises[some], made.r[some], made.z[some] = _largest(part, pressure, sought, nu, coarse)
        tensile = some[is_tensile(shape, body, response)]
        for values in made:
            values[tensile] = np.nan
    return made


def _largest(part, pressure, sought, punch, coarse):
    """The largest stress and its place, (3, B), under pressures at a = R."""
    name, none = "mises1" if sought.body == "layer" else "mises2", np.zeros(len(part))
    groups = [*alike(part, none + 1, pressure, sought.mu, none, punch)]
    batches = [loaded for _, loaded in groups]
    answers = [coarsely(loaded, (name,)) for loaded in batches] if coarse else together(batches, (name,))
    made = np.full((3, len(part)), np.nan)
    for (rows, _), answer in zip(groups, answers, strict=True):
        made[:, rows] = answer[name]
    return made
