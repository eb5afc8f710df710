"""Graded layers: the answers with more and more uniform sublayers are extrapolated.

With m sublayers in each octave of the depth, the error of the answers is a series of even powers of 1/m. So two or
three answers, each with twice as many sublayers as the one before, are extrapolated (Romberg's scheme). The last change
is the error.
"""

from dataclasses import replace

import numpy as np

from ..solution import JUDGED, PULLS, Solution
from ..status import Status
from .named import solve_named

#: The numbers of sublayers in each octave, in turn.
_COUNTS = (2, 4, 8, 16, 32)
#: Number of powers of 1/m that are eliminated: 1/m² and 1/m⁴.
_ORDERS = 2
#: Numbers that are extrapolated; all others are those of the last solution.
_NUMBERS = (*JUDGED, "A0", "dP_dD", *PULLS, "p", "lam")
#: Numbers whose last change is the error; for cases with adhesion P_off and D_off are among them.
_JUDGED = (*JUDGED, "P_off", "D_off")
#: For contacts with adhesion, a change of p(0) is relative to at least this part of the pull-off load over the area.
_LEAST = 0.1
#: Statuses of cases that have numbers; those with the last status have only the numbers of pull-off and pull-in.
_SOLVED = (Status.CONVERGED, Status.TOLERANCE_NOT_MET, Status.PULLED_OFF)


def solve_graded(problem, x):
    """:class:`Solution` of cases of the base "stack" with graded layers, in the units of the problem. Their `error` is
    the sum of that of the last solution and the last change of the extrapolated numbers. x : (m,) radii."""
    size, left = (len(problem), len(x)), np.arange(len(problem))
    whole, rows = Solution.of(*size, status=Status.TOLERANCE_NOT_MET), []
    for count in _COUNTS:
        part = problem.take(left)
        solved = solve_named(part.but(sublayers=count), x)
        rows.append(solved)
        extrapolated = _extrapolated(rows, part.rtol)
        whole = Solution.join(*size, [(np.arange(size[0]), whole), (left, extrapolated)])
        has_numbers = np.isin(solved.status, _SOLVED)
        ended = ~has_numbers | (extrapolated.error <= part.rtol)
        left = left[~ended]
        rows = [row.take(np.flatnonzero(~ended)) for row in rows]
        if not len(left):
            break
    return replace(whole, error=np.where(whole.status == Status.PULLED_OFF, np.nan, whole.error))


def _extrapolated(rows, rtol):
    """The last of the solutions `rows`, extrapolated; its error is inf if there is only one."""
    last, change, of_profile = rows[-1], np.zeros(len(rtol)), np.zeros(len(rtol))
    numbers = {}
    for name in _NUMBERS:
        values, before = _limits([getattr(row, name) for row in rows])
        numbers[name] = np.clip(values, 0.0, 1.0) if name in ("lam", "Ar_An") else values
        if name in _JUDGED:
            change = np.maximum(change, _change(values, before, last, name))
        elif name == "p":
            finite = np.where(np.isfinite(values), values, 0.0)
            largest = np.fmax(np.abs(finite).max(axis=1, initial=0.0), np.where(np.isfinite(last.p0), last.p0, 0.0))
            of_profile = np.abs(np.where(finite == 0, 0.0, values - before)).max(axis=1, initial=0.0) / largest
    solved, pulled = np.isin(last.status, _SOLVED), last.status == Status.PULLED_OFF
    error = np.where(pulled, 0.0, last.error) + (change if len(rows) > 1 else np.inf)
    status = np.where(solved & ~pulled & ~(error <= rtol), Status.TOLERANCE_NOT_MET, last.status).astype(np.int8)
    for name, values in numbers.items():
        before = getattr(last, name)
        numbers[name] = np.where(_wide(solved, values) & np.isfinite(values), values, before)
    profile_error = np.maximum(last.profile_error + of_profile, error)
    return replace(last, **numbers, error=error, profile_error=profile_error, status=status)


def _change(values, before, last, name):
    """Relative change (B,) of extrapolated numbers; 0 where nothing changes or the `last` solution has no number. For
    contacts with adhesion the change of a load, a depth or a p(0) is relative to at least that of pull-off."""
    change = np.abs(values / before - 1)
    if name in ("P", "D", "p0", "p_max"):
        off = np.abs(last.D_off if name == "D" else last.P_off)
        off = _LEAST * off / (np.pi * last.a**2) if name in ("p0", "p_max") else off
        change = np.where(off > np.abs(before), np.abs(values - before) / off, change)
    change = np.where((values == before) | ~np.isfinite(getattr(last, name)), 0.0, change)
    return np.where(np.isnan(change), np.inf, change)


def _limits(values):
    """The extrapolated number of a sequence, and the extrapolated number without its last member."""
    columns = [values]
    for order in range(1, min(_ORDERS, len(values) - 1) + 1):
        before = columns[-1]
        columns.append([b + (b - a) / (4.0**order - 1) for a, b in zip(before, before[1:], strict=False)])
    best = np.where(np.isfinite(columns[-1][-1]), columns[-1][-1], values[-1])  # infinite numbers stay as they are
    if len(values) == 1:
        return best, best
    return best, columns[-1][-2] if len(columns[-1]) > 1 else columns[-2][-2]


def _wide(mask, values):
    return mask.reshape(-1, *[1] * (values.ndim - 1))
