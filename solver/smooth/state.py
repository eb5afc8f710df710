"""The state of a smooth contact at a radius, with and without adhesion, and its answers."""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..solution import Solution
from .galerkin import Response, respond
from .pressure import flat_pressure, pressure_changes, pressures_of
from .radius import NEAR
from .tension import PROBE_RADII, seen

#: If dD/da is below this part of the shape's share in it, D has its minimum, to rounding.
_FLAT = 1e-12
#: Rounding error of a pressure over the largest one: it is at most 3e-13 near kinks of the shape
#: (tools/errors/shape_errors.py).
_OF_PRESSURE = 5e-13
#: A contact whose relative distance from a corner is below _CORNER counts as that of a flat punch. At the distance
#: _AT_CORNER the rounding of a is still a small part of it.
_CORNER, _AT_CORNER = 1e-9, 64 * np.finfo(float).eps
#: The error of p(0) is the largest at the first _INNER radii of PROBE_RADII, which are below 0.45 a: a single one may
#: be small by chance. The error of the kernel is relative to the largest pressure at twice as many, below 0.87 a. Under
#: shapes with kinks or tips the series converges more slowly than its last step suggests, at most 2.9 times in
#: tools/errors/shape_errors.py: there the error is multiplied by _SLOW.
_INNER, _SLOW = 8, 4.0


@batch.of_cases
class State(NamedTuple):
    """The states of B contacts; arrays are (B,).

    a, P, D : radius, load, depth
    dP, dD : derivatives of load and depth by a
    P_error, D_error : absolute errors at the radius a
    A : the edge value, which together with `response` determines the pressure
    zone : c/a; 1 unless attraction acts in a ring
    """

    a: np.ndarray
    A: np.ndarray
    P: np.ndarray
    D: np.ndarray
    dP: np.ndarray
    dD: np.ndarray
    P_error: np.ndarray
    D_error: np.ndarray
    zone: np.ndarray
    response: Response

    def only(self, mask):
        """The states with NaN in place of all numbers of cases outside the `mask` (B,)."""
        return State(*(np.where(mask, v, np.nan) for v in self[:-1]), self.response.only(mask))

    @property
    def stiffness(self):
        """dP/dD (B,) along the curve of contacts; infinite where the depth has its minimum."""
        steep = np.abs(self.dD) < _FLAT * self.response.slope
        free = (self.A == 0) & (self.zone == 1) | np.isinf(self.response.slope)  # or at a corner
        return np.where(free, self.response.S, np.where(steep, np.inf, self.dP / self.dD))

    @classmethod
    def free(cls, response):
        """The states of contacts without adhesion."""
        r = response
        return cls(r.a, 0 * r.a, r.P, r.D, r.S * r.slope, r.slope, r.P_error, r.D_error, 1 + 0 * r.a, r)

    @classmethod
    def join(cls, size, pieces):
        """The states of `size` cases from pairs of places and their states. Cases without a state are NaN."""
        arrays = [np.full(size, np.nan) for _ in cls._fields[:-1]]
        for index, piece in pieces:
            for array, values in zip(arrays, piece, strict=False):
                array[index] = values
        return cls(*arrays, Response.join(size, [(index, piece.response) for index, piece in pieces]))


def pinned(part, shape, body):
    """:class:`State` of flat punches, whose contact radius is fixed. P gives D, or D gives P."""
    r = respond(shape, body, shape.least())
    unit, other = (r.flat_P, r.flat_D) if part.control == "P" else (r.flat_D, r.flat_P)
    A = part.value / unit
    error = np.abs(A) * other * (r.flat_P_error / r.flat_P + r.flat_D_error / r.flat_D)
    P_error, D_error = (0 * error, error) if part.control == "P" else (error, 0 * error)
    return State(r.a, A, A * r.flat_P, A * r.flat_D, r.flat_P, r.flat_D, P_error, D_error, 1 + 0 * A, r)


def at_corner(part, shape, body, state):
    """The states, and (B,) bool, whether a state is replaced by that of a flat punch with the radius b of the flat
    part: its radius exceeds b by very little, or by less than its digits can show. The relative error of its P and D is
    then a/b - 1."""
    least = shape.least()
    with np.errstate(invalid="ignore", divide="ignore"):
        over = state.a / least - 1
    corner = (least > 0) & (part.control != "a") & ~(over >= _CORNER)
    index = np.flatnonzero(corner & np.isnan(over))
    if len(index):  # there is no such radius; or the punch lifts off
        at = respond(shape.take(index), body.take(index), least[index] * (1 + _AT_CORNER))
        corner[index] = part.value[index] <= getattr(at, part.control)
    if not corner.any():
        return state, corner
    index = np.flatnonzero(corner)
    flat = pinned(part.take(index), shape.take(index), body.take(index))
    over = np.nan_to_num(over[index], nan=_AT_CORNER)
    flat = flat._replace(P_error=flat.P_error + over * flat.P, D_error=flat.D_error + over * flat.D)
    return State.join(len(part), [(np.flatnonzero(~corner), state.take(~corner)), (index, flat)]), corner


def beyond_profile(part, shape, at):
    """(B,) bool: whether the contact is larger than the profile, for profiles that end with a finite slope, as a table
    does.

    at : ``at(index, a)`` returns the :class:`State` of the cases `index` at the radii a
    """
    most, outside = shape.most(), np.zeros(len(part), dtype=bool)
    index = np.flatnonzero(np.isfinite(shape.lifted(most[:, None])[:, 0]) & (most > shape.least()))
    if len(index):
        largest = most[index] if part.control == "a" else getattr(at(index, most[index]), part.control)
        outside[index] = part.value[index] > largest
    return outside


class Scales(NamedTuple):
    """Lower bounds (B,) of the sizes to which errors of a load, a depth and a p(0) are relative, since all three may be
    0."""

    P: np.ndarray | float = 0.0
    D: np.ndarray | float = 0.0
    p0: np.ndarray | float = 0.0


#: For contacts without adhesion, in which nothing is 0.
NOT_STICKING = Scales()


def answer(part, shape, state, counts, x, ring=None, scales=NOT_STICKING):
    """:class:`~..solution.Solution` of the states of a problem, and (B,) bool, whether there is tension inside. The
    error includes those of a, P and D under the control, and that of p(0) if it is finite. ``ring(x)`` is added to
    p."""
    response, A = state.response, state.A
    radii = np.concatenate([x, [0.0], PROBE_RADII])
    p = pressures_of(shape, response, A, radii)
    if ring is not None:
        p = p + ring(radii)
    p_x, p0, p_probes = np.split(p, [len(x), len(x) + 1], axis=1)
    p0 = p0[:, 0]
    moved, error = _error(part.control, state, scales)
    of_p = np.abs(pressure_changes(response, A, PROBE_RADII))
    along = np.where(moved > 0, np.abs(flat_pressure(response) * state.dD) * moved, 0.0)
    largest = np.max(np.where(np.isfinite(p_probes), np.abs(p_probes), 0.0), axis=1)
    over = np.where(state.a > shape.least(), state.a - shape.least(), state.a)
    rounding = _OF_PRESSURE * np.sqrt(state.a / over)  # larger near a corner
    off = np.nan_to_num(
        np.where(response.P > 0, response.P_error / response.P, response.flat_P_error / response.flat_P)
    )
    # the error of the waves acts all over the contact, except in the pull of the edge, which is exact
    of_waves = off * np.where(A == 0, largest, np.abs(p_probes[:, : 2 * _INNER]).max(axis=1))
    terms = np.abs(p0) + np.abs(A) * response.E / (np.pi * state.a)  # the parts of the shape and of the edge
    of_p0 = np.where(shape.even, 1.0, _SLOW) * of_p[:, :_INNER].max(axis=1) + rounding * terms + along + of_waves
    error = error + np.where(np.isfinite(p0), _over(of_p0, p0, scales.p0), 0.0)
    numbers = {"a": state.a, "P": state.P, "D": state.D, part.control: part.value}
    between = np.maximum(_over(of_p.max(axis=1), largest) + rounding, error)
    solution = Solution.of(
        *p_x.shape, **numbers, p0=p0, p_max=p0, Ar_An=1.0, A0=0.0, dP_dD=state.stiffness, residual=0.0,
        error=error, profile_error=between, p=p_x, lam=1.0, iterations=counts, nodes=np.nan_to_num(response.size),
    )  # fmt: skip
    return solution, seen(p_probes, of_p)


def _error(control, state, scales):
    """The error (B,) of the radius, 0 if it is the control, and the sum (B,) of the relative errors of a, P and D."""
    if control == "a":
        return 0 * state.a, _over(state.P_error, state.P, scales.P) + _over(state.D_error, state.D, scales.D)
    off, slope = (state.P_error, state.dP) if control == "P" else (state.D_error, state.dD)
    moved = _over(off + NEAR * _size(control, state), slope)
    other, growth, error = (state.D, state.dD, state.D_error) if control == "P" else (state.P, state.dP, state.P_error)
    along = np.where(moved > 0, np.abs(growth) * moved, 0.0)
    return moved, _over(moved, state.a) + _over(error + along, other, scales.D if control == "P" else scales.P)


def _size(control, state):
    """The sum (B,) of the absolute values of the parts of shape and edge in the load or depth, which is never 0."""
    r = state.response
    number, flat = (state.P, r.flat_P) if control == "P" else (state.D, r.flat_D)
    return np.abs(number) + np.abs(state.A) * flat


def _over(error, value, least=0.0):
    """The error over the larger of |value| and `least`; 0 where the error is 0."""
    return np.where(error == 0, 0.0, error / np.maximum(np.abs(value), least))
