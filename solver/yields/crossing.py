"""The first place at which a stress exceeds a strength, for many cases: by steps, then by false position."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..numerics.batch import march

#: A step is a factor of the place. Where the stress is near the strength it is at most _STEP. Farther away it is the
#: power _SLOWEST of the missing factor of the stress, _NEAR strength/stress, and at most _LARGEST: the stress of films,
#: and of asperities that have only begun to touch, grows like a^4 or less.
_STEP, _SLOWEST, _LARGEST, _NEAR = 1.1, 0.2, 1.5, 0.7
#: A stress on the coarse grid is too small by at most this part. If it may exceed the strength, the stress itself is
#: computed.
_MISSED = 0.15
#: Largest number of steps that are taken at once where contacts are alike. If a stress allows only shorter steps, the
#: places behind it do not count.
_TOGETHER = 8
#: A place is accepted when the stress agrees with the strength to _SAME, and abandoned after _MOST steps.
_SAME, _MOST = 1e-7, 40
#: By which part of the place a contact beside the crossing is away: slopes then have an error of about as much.
ASIDE = 1e-3
#: Numbers of the contact that a crossing has.
NUMBERS = ("P", "a", "D", "p0")


class Crossing(NamedTuple):
    """The contacts in which the stress first exceeds the strength, arrays (B,); NaN where it does not.

    crossed : bool, whether it does
    at : the variable of the march, such as the radius
    numbers : P, a, D, p0 of the contact there, in the units of the problem
    r, z : the place in the contact, in a
    unsolved : bool, whether there is no answer, because some contacts on the way have no solution, or because the
        crossing is before `start`
    by_strength : derivatives of ln of the numbers by ln strength, if the caller wants them
    """

    crossed: np.ndarray
    at: np.ndarray
    numbers: dict
    r: np.ndarray
    z: np.ndarray
    unsolved: np.ndarray
    by_strength: dict

    @classmethod
    def none(cls, count):
        at, r, z = np.full((3, count), np.nan)
        numbers, slopes = ({name: np.full(count, np.nan) for name in NUMBERS} for _ in range(2))
        return cls(np.zeros(count, bool), at, numbers, r, z, np.zeros(count, bool), slopes)


def first_crossing(
    stress: Callable, start: np.ndarray, last: np.ndarray, slopes: bool = False, same_grid: Callable | None = None
) -> Crossing:
    """The :class:`Crossing` between `start` (B,) and `last` (B,). With NaN, or start > last, there is no search.

    stress : ``stress(index, at, coarse)`` returns, for the cases `index` at the places `at` (b,), the stress over the
        strength, its r and z, and the :class:`~solver.solution.Solution`. With `coarse` the stress may be a little too
        small
    slopes : whether `by_strength` is wanted
    same_grid : ``same_grid(index, at)`` returns the places (b,) up to which, from `at` on, contacts are so alike that
        several cost as much as one; None: there are none
    """
    same_grid = (lambda index, at: at) if same_grid is None else same_grid
    crossing = Crossing.none(len(start))
    index = np.flatnonzero(start <= last)
    places, values, failed = _bracketed(stress, index, start[index], np.log(last[index]), same_grid)
    there = np.isfinite(places).all(axis=0)
    crossing.unsolved[index] = ~there & (failed | np.isfinite(places[1]))
    _searched(crossing, stress, index[there], places[:, there], values[:, there])
    if slopes:
        _sloped(crossing, stress, np.flatnonzero(crossing.crossed))
    return crossing


def _sloped(crossing, stress, index):
    """Put `by_strength` into `crossing`, by a contact a little beyond the crossing."""
    if len(index):
        value, _, _, solution = stress(index, crossing.at[index] * (1 + ASIDE), False)
        for number in NUMBERS:
            change = np.log(getattr(solution, number) / crossing.numbers[number][index])
            crossing.by_strength[number][index] = change / np.log(value)


def _bracketed(stress, index, start, last, same_grid):
    """ln of the places just before and just after the first crossing, and ln of the stress over the strength there, (2,
    b) each, NaN where there is none; and (b,) bool, whether some contact has no solution."""
    places, values = np.full((2, 2, len(index)), np.nan)
    failed, at, far = np.zeros(len(index), dtype=bool), np.log(start), np.full(len(index), np.log(_LARGEST))

    def step(active):
        rows, there = _steps(
            at[active], far[active], last[active], np.log(same_grid(index[active], np.exp(at[active])))
        )
        value = stress(index[active[rows]], np.exp(there), True)[0]
        near = _near(value, rows)
        if near.any():
            value[near] = stress(index[active[rows[near]]], np.exp(there[near]), False)[0]
        unknown, tiny = np.isnan(value), np.finfo(float).tiny
        sizes = np.maximum(value, tiny)
        allowed = np.log(np.where(unknown, _STEP, np.clip((_NEAR / sizes) ** _SLOWEST, _STEP, _LARGEST)))
        done, left = np.zeros(len(active), dtype=bool), np.ones(len(active), dtype=bool)
        for j, row in enumerate(rows):
            case = active[row]
            if not left[row]:
                continue
            failed[case] |= unknown[j]
            if not unknown[j]:
                side = int(value[j] >= 1)
                places[side, case], values[side, case] = there[j], np.log(sizes[j])
            done[row] = value[j] >= 1 or there[j] >= last[case]
            left[row] = not done[row] and allowed[j] >= far[case] * (1 - 1e-9)
            at[case] = min(there[j] + allowed[j], last[case])
            shorter[case] = allowed[j]
        far[active] = shorter[active]
        return done

    shorter = far.copy()
    march(step, np.arange(len(index)))
    return places, values, failed


def _steps(at, far, last, end):
    """Places (m,) of several cases, and (m,) the case of each, ascending. They go from `at` by steps `far` up to `last`
    and `end`; `at` is always one of them."""
    counts = np.clip(np.floor((np.minimum(end, last) - at) / far + 1e-9), 0, _TOGETHER - 1).astype(int) + 1
    rows = np.repeat(np.arange(len(at)), counts)
    number = np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)
    return rows, np.minimum(at[rows] + number * far[rows], last[rows])


def _near(value, rows):
    """(m,) bool: whether a coarse value (m,) may be that of a crossing, up to the first of each case that is one.
    `rows` (m,) is the case of each, ascending."""
    over = np.cumsum(value >= 1)
    starts = np.searchsorted(rows, rows)
    before = over - (value >= 1) - np.where(starts > 0, over[starts - 1], 0)
    return (value >= 1 - _MISSED) & (before == 0)


def _searched(crossing, stress, index, places, values):
    """Put the crossings between two places into `crossing`: by false position, where the value at an end that stays is
    halved."""
    (below, above), (left, right) = places, values
    stays = np.zeros(len(index))

    def step(active):
        at = (below * right - above * left)[active] / (right - left)[active]
        at = np.where(np.isfinite(at), np.clip(at, below[active], above[active]), (below + above)[active] / 2)
        value, r, z, solution = stress(index[active], np.exp(at), False)
        f = np.log(value)
        done, over = np.abs(f) <= _SAME, f > 0
        rows = index[active[done]]
        crossing.crossed[rows], crossing.at[rows] = True, np.exp(at[done])
        crossing.r[rows], crossing.z[rows] = r[done], z[done]
        for number in NUMBERS:
            crossing.numbers[number][rows] = getattr(solution, number)[done]
        some = active[over]
        left[some] = np.where(stays[some] > 0, left[some] / 2, left[some])
        above[some], right[some], stays[some] = at[over], f[over], 1
        some = active[~over]
        right[some] = np.where(stays[some] < 0, right[some] / 2, right[some])
        below[some], left[some], stays[some] = at[~over], np.nan_to_num(f[~over], nan=-1.0), -1
        return done

    crossing.unsolved[index[march(step, np.arange(len(index)), most=_MOST)]] = True
