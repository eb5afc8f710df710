"""A smooth contact at a radius, with and without adhesion, and its answers."""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..solution import Solution
from .galerkin import Response, respond
from .pressure import flat_pressure, pressure_changes, pressures_of
from .radius import NEAR
from .tension import LOOKED_AT, seen

#: Where dD/da is below this part of what the shape adds to it, D has its minimum, to rounding.
_FLAT = 1e-12
#: Rounding of a pressure over the largest one: 3e-13 at most beside kinks of the shape (tools/errors/shape_errors.py).
_OF_PRESSURE = 5e-13
#: Nearer to a corner than this, relative, a contact is taken for that of a flat punch; at the second the rounding of a
#: is a small part of the distance still.
_CORNER, _AT_CORNER = 1e-9, 64 * np.finfo(float).eps
#: The error of p(0) is the largest at so many of these radii, those below 0.45 a: one may be small by chance. The
#: kernel is off by a part of what presses at twice as many, below 0.87 a. Under shapes with kinks or tips the series
#: ends more slowly than its last step says: 2.9 times at most was seen (tools/errors/shape_errors.py).
_INNER, _SLOW = 8, 4.0


@batch.of_cases
class State(NamedTuple):
    """Contacts, (B,) each: load and depth at the radius `a`, their derivatives dP, dD by a, and their errors. `A`, the
    edge value, and `response` say what the pressure is. `zone` is c/a, 1 unless attraction acts in a ring."""

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
        """NaN in place of all numbers of cases that are not in the `mask` (B,)."""
        return State(*(np.where(mask, v, np.nan) for v in self[:-1]), self.response.only(mask))

    @property
    def stiffness(self):
        """dP/dD along the curve, (B,): infinite where the depth has its minimum."""
        steep = np.abs(self.dD) < _FLAT * self.response.slope
        free = (self.A == 0) & (self.zone == 1) | np.isinf(self.response.slope)  # or at a corner
        return np.where(free, self.response.S, np.where(steep, np.inf, self.dP / self.dD))

    @classmethod
    def free(cls, response):
        """The contacts without adhesion."""
        r = response
        return cls(r.a, 0 * r.a, r.P, r.D, r.S * r.slope, r.slope, r.P_error, r.D_error, 1 + 0 * r.a, r)

    @classmethod
    def join(cls, size, pieces):
        """The states of `size` cases from pairs of places and the states there; what is in none is NaN."""
        arrays = [np.full(size, np.nan) for _ in cls._fields[:-1]]
        for index, piece in pieces:
            for array, values in zip(arrays, piece, strict=False):
                array[index] = values
        return cls(*arrays, Response.join(size, [(index, piece.response) for index, piece in pieces]))


def pinned(part, shape, body):
    """:class:`State` of flat punches, whose edge holds what they bear: either P or D follows from the other."""
    r = respond(shape, body, shape.least())
    unit, other = (r.flat_P, r.flat_D) if part.control == "P" else (r.flat_D, r.flat_P)
    A = part.value / unit
    error = np.abs(A) * other * (r.flat_P_error / r.flat_P + r.flat_D_error / r.flat_D)
    P_error, D_error = (0 * error, error) if part.control == "P" else (error, 0 * error)
    return State(r.a, A, A * r.flat_P, A * r.flat_D, r.flat_P, r.flat_D, P_error, D_error, 1 + 0 * A, r)


def at_corner(part, shape, body, state):
    """The states, and which of them (B,) touch so little beyond what is flat, or less than can be told from its radius
    b, that they are better taken for those of a flat punch of that radius. By the part by which a is larger than b, P
    and D are off then."""
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
    """(B,) bool: the contact is larger than the profile, which ends where its slope is finite, as a table does.

    at : ``at(index, a)`` gives the :class:`State` of the cases `index` at the radii a
    """
    most, outside = shape.most(), np.zeros(len(part), dtype=bool)
    index = np.flatnonzero(np.isfinite(shape.lifted(most[:, None])[:, 0]) & (most > shape.least()))
    if len(index):
        largest = most[index] if part.control == "a" else getattr(at(index, most[index]), part.control)
        outside[index] = part.value[index] > largest
    return outside


class Scales(NamedTuple):
    """What a load, a depth and a p(0) that may be 0 count as at least, where their errors are relative, (B,) each."""

    P: np.ndarray | float = 0.0
    D: np.ndarray | float = 0.0
    p0: np.ndarray | float = 0.0


#: Of contacts that do not stick, where nothing is 0.
NOT_STICKING = Scales()


def answer(part, shape, state, counts, x, ring=None, scales=NOT_STICKING):
    """:class:`~..solution.Solution` of the states of a problem, and whether there is tension inside (B,). Its error is
    that of a, P and D under the control, and of p(0) where that is finite. ``ring(x)`` is what is added to p."""
    response, A = state.response, state.A
    radii = np.concatenate([x, [0.0], LOOKED_AT])
    p = pressures_of(shape, response, A, radii)
    if ring is not None:
        p = p + ring(radii)
    p_x, p0, looked_at = np.split(p, [len(x), len(x) + 1], axis=1)
    p0 = p0[:, 0]
    moved, error = _error(part.control, state, scales)
    of_p = np.abs(pressure_changes(response, A, LOOKED_AT))
    along = np.where(moved > 0, np.abs(flat_pressure(response) * state.dD) * moved, 0.0)
    largest = np.max(np.where(np.isfinite(looked_at), np.abs(looked_at), 0.0), axis=1)
    over = np.where(state.a > shape.least(), state.a - shape.least(), state.a)
    rounding = _OF_PRESSURE * np.sqrt(state.a / over)  # more next to a corner
    off = np.nan_to_num(
        np.where(response.P > 0, response.P_error / response.P, response.flat_P_error / response.flat_P)
    )
    # what waves miss is felt all over a contact, but the pull of an edge, which is exact
    of_waves = off * np.where(A == 0, largest, np.abs(looked_at[:, : 2 * _INNER]).max(axis=1))
    terms = np.abs(p0) + np.abs(A) * response.E / (np.pi * state.a)  # what the shape presses, and what the edge pulls
    of_p0 = np.where(shape.even, 1.0, _SLOW) * of_p[:, :_INNER].max(axis=1) + rounding * terms + along + of_waves
    error = error + np.where(np.isfinite(p0), _over(of_p0, p0, scales.p0), 0.0)
    numbers = {"a": state.a, "P": state.P, "D": state.D, part.control: part.value}
    between = np.maximum(_over(of_p.max(axis=1), largest) + rounding, error)
    solution = Solution.of(
        *p_x.shape, **numbers, p0=p0, p_max=p0, Ar_An=1.0, A0=0.0, dP_dD=state.stiffness, residual=0.0,
        error=error, profile_error=between, p=p_x, lam=1.0, iterations=counts, nodes=np.nan_to_num(response.size),
    )  # fmt: skip
    return solution, seen(looked_at, of_p)


def _error(control, state, scales):
    """By how much the radius may be off (B,), where it is not given, and the sum of the relative errors of a, P, D."""
    if control == "a":
        return 0 * state.a, _over(state.P_error, state.P, scales.P) + _over(state.D_error, state.D, scales.D)
    off, slope = (state.P_error, state.dP) if control == "P" else (state.D_error, state.dD)
    moved = _over(off + NEAR * _size(control, state), slope)
    other, growth, error = (state.D, state.dD, state.D_error) if control == "P" else (state.P, state.dP, state.P_error)
    along = np.where(moved > 0, np.abs(growth) * moved, 0.0)
    return moved, _over(moved, state.a) + _over(error + along, other, scales.D if control == "P" else scales.P)


def _size(control, state):
    """What the shape and the edge add to the load, or depth, (B,): it is 0 nowhere."""
    r = state.response
    number, flat = (state.P, r.flat_P) if control == "P" else (state.D, r.flat_D)
    return np.abs(number) + np.abs(state.A) * flat


def _over(error, value, least=0.0):
    """error/|value|, or over `least` where that is more; 0 where there is no error."""
    return np.where(error == 0, 0.0, error / np.maximum(np.abs(value), least))
