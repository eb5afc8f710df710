"""Tension inside a contact without adhesion, where the punch lifts off.

Under a tip or a kink a thin layer on a softer body bends, and the pressure may be tensile in a ring about as wide as
the layer is thick. Tension counts only if it is larger than the error of the pressure.
"""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ..status import Status
from .pressure import pressure_changes, pressures_of

#: Radii at which the pressure is evaluated, for tension and for its error; denser towards the edge.
PROBE_RADII = np.sin(np.pi / 2 * np.arange(24) / 24)
#: Largest stiffness of a kernel with which no layer bends so; number of functions of the basis up to which these radii
#: are dense enough, since a thinner layer has more functions; and the number of radii for each function otherwise.
_SOFT, _FEW, _DENSER = 2.0, 40, 3
_ROUNDING = 64 * np.finfo(float).eps


def is_tensile(shape, body, response):
    """(B,) bool: whether there is tension in contacts of shapes on a body, at the radius of their `response`."""
    none, steep = np.zeros(len(response.a)), response.slope <= 0
    out = steep | seen(pressures_of(shape, response, none, PROBE_RADII), pressure_changes(response, none, PROBE_RADII))
    return out | in_a_ring(shape, body, response, ~out)[0]


def seen(p, changes):
    """(B,) bool: whether among the pressures (B, m) at PROBE_RADII there is tension larger than their `changes` by the
    last functions of the basis. On the axis, the first of the radii, any tension counts."""
    return (p[:, 0] < 0) | (p < -np.abs(changes)).any(axis=1)


def in_a_ring(shape, body, response, wanted):
    """(B,) bool: whether there is tension in a ring that PROBE_RADII may miss, in the contacts `wanted` (B,) bool. It
    must exceed all changes nearby by the last functions of the basis, of which a single one may be small by chance. And
    (B,) bool: whether there may be such tension."""
    there, doubtful = np.zeros((2, len(response.a)), dtype=bool)
    if body.kernel is None:
        return there, doubtful
    thin = wanted & ~shape.even & (body.kernel.stiffness > _SOFT) & (response.size > _FEW)
    for size in np.unique(response.size[thin]).astype(int).tolist():
        x = np.sin(np.pi / 2 * (np.arange(_DENSER * size) + 0.5) / (_DENSER * size))
        for i in np.flatnonzero(thin & (response.size == size)):
            case, none = response.take([i]), np.zeros(1)
            p, changes = pressures_of(shape.take([i]), case, none, x)[0], np.abs(pressure_changes(case, none, x)[0])
            nearby = sliding_window_view(np.pad(changes, 2 * _DENSER, mode="edge"), 4 * _DENSER + 1).max(axis=1)
            there[i], doubtful[i] = (p < -nearby).any(), (p < 0).any()
    return there, doubtful


def judged(solution, tensile, shape, body, state, x):
    """The solution of contacts without adhesion, with LIFT_OFF where they are `tensile` (B,) bool or there is tension
    elsewhere: in a narrow ring, at the radii x (m,), or at the edge, where D then does not rise with a. Tension at x
    that does not exceed the error becomes 0. And (B,) bool: whether there is, or may be, tension."""
    response = state.response
    tensile = tensile | (state.dD <= 0) | ~np.isfinite(state.P)
    there, doubtful = in_a_ring(shape, body, response, ~tensile)
    tensile |= there
    rows = np.flatnonzero((solution.p < 0).any(axis=1) & ~tensile)
    if len(rows):
        p, inside = solution.p[rows], x < 1
        changes = np.zeros(p.shape)
        changes[:, inside] = np.abs(pressure_changes(response.take(rows), state.A[rows], x[inside]))
        largest = np.max(np.where(np.isfinite(p), np.abs(p), 0.0), axis=1, initial=0.0)
        largest = np.maximum(largest, solution.P[rows] / (np.pi * solution.a[rows] ** 2))
        off = np.where(p < 0, changes - p, 0.0).max(axis=1) / largest
        tensile[rows] = ~doubtful[rows] & (p < -changes - _ROUNDING * largest[:, None]).any(axis=1)
        solution.p[rows] = np.maximum(p, 0.0)
        solution.profile_error[rows] = np.maximum(solution.profile_error[rows], off)
    return solution.refused(tensile, Status.LIFT_OFF), tensile | doubtful
