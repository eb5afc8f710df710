"""Smooth paraboloids on one layer with the radius a = R, at any h/a: of every other radius the stress is a/R times
theirs, the pressure too, the load (a/R)³ and the depth (a/R)² times.

They are solved in the basis of :mod:`~solver.smooth.galerkin`, of kernels that are tabulated once: an octave of h/a
that a process has not met takes some ten milliseconds, where tables of the mesh take .7 of a second.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...bases import is_exact, is_stack
from ...body import BODIES
from ...fields.pressure import Pressure
from ...numerics import batch
from ...numerics.mesh import WHOLE, Mesh, on_panels
from ...numerics.quadrature import radau_nodes
from ...numerics.threads import one_blas_thread
from ...problem import Problem
from ...scaling import dimensionless, refused
from ...shapes import shape_of, shaped
from ...smooth.galerkin import Response, respond
from ...smooth.pressure import pressures_of, without_edge
from ...smooth.tabulated_body import Tabulated
from ...smooth.tension import is_tensile
from ..contact import alike
from ..extremes import coarsely, together

#: Nodes of the polynomial that is the pressure, where the coarse grid is enough and elsewhere: the most that tables of
#: 16 and of 48 polynomials serve (tests/yields/similar/test_unit_contacts.py).
_ROUGHLY, _NODES = 16, 48
#: Contacts that are in memory together.
_TOGETHER = 64
#: Films thinner than this part of the radius at which a search ends are left to the mesh: the basis does not resolve
#: their edge.
THINNEST = 1e-4


@batch.of_cases
class UnitContacts(NamedTuple):
    """Contacts at a = R, (B,) each, in units R = E2* = 1; NaN where the punch would lift off.

    P, D, p0 : load, depth and pressure in the centre
    growth : d ln P/d ln a
    mises, r, z : the largest von Mises stress, and its place in a; NaN where it is not asked for
    """

    P: np.ndarray
    D: np.ndarray
    p0: np.ndarray
    growth: np.ndarray
    mises: np.ndarray
    r: np.ndarray
    z: np.ndarray


class Sought(NamedTuple):
    """Whose von Mises stress is sought: that of the "layer", the "body" or the "punch"; and the friction mu."""

    body: str
    mu: float

    @property
    def name(self):
        """Its name among :data:`~..extremes.EXTREMES`: a punch is a half-space."""
        return "mises1" if self.body == "layer" else "mises2"


def are_similar(problem, radius):
    """(B,) bool: the cases of which this room has the stresses up to a contact radius (B,), in R."""
    one_layer = is_exact(problem.base) & ~is_stack(problem.base) & (problem.scheme == "newton")
    some = one_layer & ~problem.rough() & ~shaped(problem) & ~(problem.w_adhesion > 0)
    index = np.flatnonzero(some)
    if len(index):
        scaled = dimensionless(problem.take(index))
        some[index] = ~refused(problem.take(index), scaled) & (scaled.h > THINNEST * radius[index])
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
    contacts = UnitContacts(*np.full((7, len(t)), np.nan))
    for first in range(0, len(t), _TOGETHER):
        some = np.arange(first, min(first + _TOGETHER, len(t)))
        contact = AtUnitRadius.of(scaled.take(some).but(h=t[some]))
        for values, column in zip(contacts, contact.numbers(), strict=False):
            values[some] = column
        if sought is not None:
            nu = punch[some] if sought.body == "punch" else None
            largest = contact.largest((sought.name,), sought.mu, nu, coarse)[sought.name]
            contacts.mises[some], contacts.r[some], contacts.z[some] = largest
        for values in contacts:
            values[some[contact.tensile()]] = np.nan
    return contacts


class AtUnitRadius(NamedTuple):
    """Contacts at a = R, in units R = E2* = 1, with their :class:`~solver.smooth.galerkin.Response`."""

    problem: Problem
    body: Tabulated
    response: Response

    @classmethod
    def of(cls, problem):
        """The contacts of cases for which :func:`are_similar`, h in a."""
        body = Tabulated.of(BODIES["layered"](problem))
        return cls(problem, body, respond(shape_of(problem), body, np.ones(len(problem)), by_recurrence=True))

    def numbers(self):
        """P, D, p0 and d ln P/d ln a, (B,) each."""
        response, none = self.response, np.zeros(len(self.problem))
        p0 = pressures_of(shape_of(self.problem), response, none, np.zeros(1))[:, 0]
        return response.P, response.D, p0, response.S * response.slope / response.P

    def tensile(self):
        """(B,) bool: the punch would lift off somewhere."""
        return is_tensile(shape_of(self.problem), self.body, self.response)

    def largest(self, names, mu=0.0, punch=None, coarse=False):
        """Name of :data:`~..extremes.EXTREMES` -> the largest value and its place, (3, B)."""
        size = len(self.problem)
        none, mesh = np.zeros(size), _mesh(_ROUGHLY if coarse else _NODES)
        pressure = Pressure(mesh, without_edge(shape_of(self.problem), self.response, none, mesh.x))
        groups = [*alike(self.problem, none + 1, pressure, mu, none, punch)]
        batches = [loaded for _, loaded in groups]
        answers = [coarsely(loaded, names) for loaded in batches] if coarse else together(batches, names)
        extremes = {name: np.full((3, size), np.nan) for name in names}
        for (rows, _), answer in zip(groups, answers, strict=True):
            for name in names:
                extremes[name][:, rows] = answer[name]
        return extremes


@lru_cache(maxsize=4)
def _mesh(n):
    """The mesh of one panel with n nodes, without its operator, which takes the most time and no pressure needs."""
    s, none = on_panels(radau_nodes(n), WHOLE), np.zeros(0)
    s[-1] = 1.0
    return Mesh(n, WHOLE, s, np.sqrt((1 - s) * (1 + s)), none, none, none)
