"""Smooth contacts of every shape without adhesion: the answers of a batch."""

import numpy as np

from ..body import BODIES
from ..shapes import PARABOLOID, shape_of
from ..shapes.power import Power
from ..solution import Solution
from ..status import Status
from .equation import respond
from .pressure import pressure_changes, pressures
from .radius import touching

#: Radii at which the pressure is looked at, for tension and for its error; denser towards the edge.
_LOOKED_AT = np.sin(np.pi / 2 * np.arange(24) / 24)


def solve(part, x):
    """:class:`~..solution.Solution` of cases of one base and one shape in units R = E2* = 1, at the radii x (m,)."""
    shape, body = shape_in(part), BODIES[str(part.base[0])](part)
    if str(part.shape[0]) == "flat":
        response, counts = respond(shape, body, shape.b), np.ones(len(part), dtype=np.int32)
        A = part.value / (response.flat_P if part.control == "P" else response.flat_D)
        return answer(part, shape, response, A, counts, x)
    response, counts = touching(part.control, part.value, shape, body)
    return answer(part, shape, response, np.zeros(len(part)), counts, x)


def kinds_of(problem):
    """Masks (B,) of the cases that :func:`solve` takes together."""
    kinds = np.char.add(np.char.add(problem.base, "|"), problem.shape)
    return [kinds == kind for kind in np.unique(kinds)]


def shape_in(part):
    """The :class:`~..shapes.Shape` of cases that have one `shape`."""
    half, two = np.full(len(part), 0.5), np.full(len(part), 2.0)
    return Power(half, two, two) if str(part.shape[0]) == PARABOLOID else shape_of(part)


def answer(part, shape, response, A, counts, x):
    """:class:`~..solution.Solution` of responses with edge values A (B,)."""
    radii = np.concatenate([x, [0.0], _LOOKED_AT])
    p = pressures(shape, response, A, radii)
    changes = pressure_changes(response, A, _LOOKED_AT)
    p_x, p0, looked_at = p[:, : len(x)], p[:, len(x)], p[:, len(x) + 1 :]
    P, D = response.P + A * response.flat_P, response.D + A * response.flat_D
    largest = np.max(np.where(np.isfinite(looked_at), np.abs(looked_at), 0.0), axis=1)
    profile_error = np.abs(changes).max(axis=1) / largest
    parts = (
        (response.P_error + np.abs(A) * response.flat_P_error) / np.abs(P),
        (response.D_error + np.abs(A) * response.flat_D_error) / np.abs(D),
        np.where(np.isfinite(p0), np.abs(changes[:, 0] / p0), 0.0),
    )
    error = sum(parts)
    lifts = ~np.isfinite(P) | (looked_at < 0).any(axis=1)
    arrays = {"a": response.a, "P": P, "D": D, part.control: part.value} | {"p0": p0, "p_max": p0, "p": p_x}
    solution = Solution.of(
        *p_x.shape, **arrays, Ar_An=1.0, A0=0.0, lam=1.0, dP_dD=response.S, residual=0.0, error=error,
        profile_error=np.maximum(profile_error, error), iterations=counts, nodes=np.nan_to_num(response.size),
    )  # fmt: skip
    return solution.refused(lifts, Status.LIFT_OFF)
