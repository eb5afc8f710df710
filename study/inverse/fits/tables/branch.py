"""Loads of B curves at n depths on the stable branch of a :class:`.term_table.TermTable`, and their derivatives.

The branch goes from large radii down to the last radius at which the depth turns. There a depth-controlled punch is
pulled off; others come off before. After that end the load goes to 0 within _RAMP of the pull of adhesion on the depth.
No contact has these loads; they show a search its direction.

The compiled core (solver/compiled/sticking.h) does the same, and is some 10 times faster.
"""

from typing import NamedTuple

import numpy as np

from solver.compiled.sticking_loads import loads_in_c

from ..model import CurveModel
from .term_table import LENGTH, STEP, TermTable

_RAMP, _LEAST_RAMP = 0.25, 0.01
_NEWTON, _TURN = 5, 12  # number of steps of the searches for a depth and for the turn
#: dD/dx, which is 0 at the turn, counts as at least this share of the pull of adhesion on the depth.
_STEEP = 0.02


class Loads(NamedTuple):
    """Loads P (B, n) in N, and dP/dD, at depths; derivatives of P by unknown inputs (axes, B, n) and by other inputs
    (moved, B, n), and by the logarithms of the four parts (4, B, n)."""

    P: np.ndarray
    slope: np.ndarray
    by_rows: np.ndarray
    by_parts: np.ndarray


class Branch(NamedTuple):
    """Loads with adhesion, and without it, 0 above the surface; the depth of the end of the branch, and that of its
    least load, (B,)."""

    sticks: Loads
    free: Loads
    D_off: np.ndarray
    D_least: np.ndarray


class _End(NamedTuple):
    """The end of the branch of B curves: its cell (B,) and place t (B, 1) in it; depth, load, and the depth that
    adhesion takes there, (B,)."""

    turn: np.ndarray
    t: np.ndarray
    D: np.ndarray
    P: np.ndarray
    pull: np.ndarray


class _Cells:
    """Cubics in 0 <= t <= 1 in the cells (B, n) of rows (B, 8, LENGTH) of logarithms and slopes."""

    def __init__(self, cells: np.ndarray):
        self.flat = cells + LENGTH * 8 * np.arange(len(cells))[:, None]

    def of(self, rows: np.ndarray, i: int) -> tuple[np.ndarray, ...]:
        """The coefficients of row i, from the constant on."""
        flat, value, slope = rows.reshape(-1), self.flat + LENGTH * i, self.flat + LENGTH * (4 + i)
        a, b = flat.take(value), flat.take(value + 1)
        p, q = STEP * flat.take(slope), STEP * flat.take(slope + 1)
        return a, p, 3 * (b - a) - 2 * p - q, 2 * (a - b) + p + q


def _value(c: tuple, t: np.ndarray) -> np.ndarray:
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]))


def _slope(c: tuple, t: np.ndarray) -> np.ndarray:
    """The slope by x."""
    return (c[1] + t * (2 * c[2] + 3 * t * c[3])) / STEP


def _pair(c: list, t: np.ndarray) -> tuple[np.ndarray, ...]:
    """The difference of two parts, its slope by x, and the parts."""
    more, less = np.exp(_value(c[0], t)), np.exp(_value(c[1], t))
    return more - less, more * _slope(c[0], t) - less * _slope(c[1], t), more, less


def branch(rows: np.ndarray, depth: np.ndarray) -> Branch:
    """The :class:`Branch` at depths (B, n) in m.

    rows : (1 + others, B, 8, LENGTH), the first with the parts
    """
    if computed := loads_in_c(rows, depth, STEP):
        sticks, free, *ends = computed
        return Branch(Loads(*sticks), Loads(*free), *ends)
    return _branch(rows, depth)


def _branch(rows: np.ndarray, depth: np.ndarray) -> Branch:
    """The same by numpy."""
    with np.errstate(all="ignore"):
        end, cell = _placed(rows[0], depth)
        loads, least = _loads(rows, depth, cell, end), _least(rows[0], np.exp(rows[0][:, :4]))
        return Branch(loads, _free(rows, depth), end.D, np.maximum(end.D, least))


def radii(table: TermTable, values: dict[str, np.ndarray], depth: np.ndarray) -> np.ndarray:
    """The contact radii (B, n) in m at depths (B, n) on the branch, NaN beyond its end; for values (B, 1) of the
    unknown inputs."""
    deepest = depth.max(axis=1)
    parts = table.rows(values, deepest)[0]
    with np.errstate(all="ignore"):
        end, cell = _placed(parts, depth)
        cells = _Cells(cell)
        t, outside = _place_in_cells([cells.of(parts, 1), cells.of(parts, 3)], depth, cell, end)
        x = table.begin(values, deepest)[:, None] + STEP * np.where(outside, np.nan, cell + t)
        return table.terms.radii({name: value[:, 0] for name, value in values.items()}, x)


def _placed(parts: np.ndarray, depth: np.ndarray) -> tuple[_End, np.ndarray]:
    """The end of the branch of the first of the rows, and the cells (B, n) in which depths lie."""
    f = np.exp(parts[:, :4])
    D, slope = f[:, 1] - f[:, 3], f[:, 1] * parts[:, 5] - f[:, 3] * parts[:, 7]
    turns = (slope[:, :-1] < 0) & (slope[:, 1:] >= 0)
    turn = np.where(turns.any(axis=1), LENGTH - 2 - turns[:, ::-1].argmax(axis=1), 0)
    cells = _Cells(turn[:, None])
    t_off = np.where(turns.any(axis=1)[:, None], _turn([cells.of(parts, i) for i in (1, 3)]), 0.0)
    ends = [_pair([cells.of(parts, i), cells.of(parts, i + 2)], t_off) for i in (0, 1)]
    rising = np.where(np.isnan(D), np.inf, D)
    rising[np.arange(LENGTH) <= turn[:, None]] = -np.inf
    cell = np.clip((rising[:, None, :] <= depth[:, :, None]).sum(axis=2) - 1, turn[:, None], LENGTH - 2)
    return _End(turn, t_off, ends[1][0][:, 0], ends[0][0][:, 0], ends[1][3][:, 0]), cell


def _least(parts: np.ndarray, f: np.ndarray) -> np.ndarray:
    """The depth (B,) of the least load, to some percent of the pull of adhesion on the depth; -inf without a least
    load, where the load falls up to the end."""
    slope = f[:, 0] * parts[:, 4] - f[:, 2] * parts[:, 6]
    turns = (slope[:, :-1] < 0) & (slope[:, 1:] >= 0)
    cell, rows = LENGTH - 2 - turns[:, ::-1].argmax(axis=1), np.arange(len(f))
    low, high = slope[rows, cell], slope[rows, cell + 1]
    cells, t = _Cells(cell[:, None]), (low / (low - high))[:, None]
    return np.where(turns.any(axis=1), _pair([cells.of(parts, 1), cells.of(parts, 3)], t)[0][:, 0], -np.inf)


def _turn(c: list) -> np.ndarray:
    """t (B, 1) at which the depth has its minimum, by false position."""
    low, high = np.zeros_like(c[0][0]), np.ones_like(c[0][0])
    s_low, s_high = _pair(c, low)[1], _pair(c, high)[1]
    t = high
    for _ in range(_TURN):
        t = np.clip(low + (high - low) * s_low / (s_low - s_high), low, high)
        s = _pair(c, t)[1]
        falls = s < 0
        # the value of the end that stays is halved (Illinois)
        s_low, s_high = np.where(falls, s, s_low / 2), np.where(falls, s_high / 2, s)
        low, high = np.where(falls, t, low), np.where(falls, high, t)
    return t


def _free(rows: np.ndarray, depth: np.ndarray) -> Loads:
    """Loads at depths without adhesion."""
    wanted = np.log(np.maximum(depth, 0.0))
    cell = np.clip((rows[0][:, None, 1] <= wanted[:, :, None]).sum(axis=2) - 1, 0, LENGTH - 2)
    cells = _Cells(cell)
    of_load, of_depth, t = cells.of(rows[0], 0), cells.of(rows[0], 1), np.full(depth.shape, 0.5)
    for _ in range(_NEWTON):
        step = (_value(of_depth, t) - wanted) / (_slope(of_depth, t) * STEP)
        t = np.clip(t - np.where(np.isfinite(step), step, 0.0), 0.0, 1.0)
    P = np.where(depth > 0, np.exp(_value(of_load, t)), 0.0)
    growth = _slope(of_load, t) / _slope(of_depth, t)  # d ln P/d ln D
    slope = np.where(depth > 0, P * growth / np.where(depth > 0, depth, 1.0), 0.0)
    of_parts = np.stack([P, -growth * P, 0 * P, 0 * P])
    return Loads(P, slope, _by_rows(rows, cells, t, of_parts[:2]), of_parts)


def _by_rows(rows: np.ndarray, cells: _Cells, t: np.ndarray, of_parts: np.ndarray) -> np.ndarray:
    """Derivatives (others, B, n) of the loads by the variables of the rows after the first, from those `of_parts`, the
    first of the four or all of them (parts, B, n)."""
    derivatives = np.empty((len(rows) - 1, *t.shape))
    for k, row in enumerate(rows[1:]):
        derivatives[k] = sum(_value(cells.of(row, i), t) * part for i, part in enumerate(of_parts))
    return derivatives


def _place_in_cells(of_depth: list, depth: np.ndarray, cell: np.ndarray, end: _End) -> tuple[np.ndarray, np.ndarray]:
    """t (B, n) in the cells at which the depth is reached, and which depths are past the end of the branch: these are
    at the end."""
    least = np.where(cell == end.turn[:, None], end.t, 0.0)
    is_past_end = depth < end.D[:, None]
    low, high = (_pair(of_depth, place)[0] for place in (least, np.ones_like(least)))
    share = np.clip((depth - low) / (high - low), 0.0, 1.0)
    # the depth is a parabola at its minimum
    t = least + (1 - least) * np.where(least > 0, np.sqrt(share), share)
    for _ in range(_NEWTON):
        value, slope, _, _ = _pair(of_depth, t)
        step = (value - depth) / (np.maximum(slope, 1e-300) * STEP)
        t = np.clip(t - np.where(np.isfinite(step), step, 0.0), least, 1.0)
    return np.where(is_past_end, least, t), is_past_end


def _loads(rows: np.ndarray, depth: np.ndarray, cell: np.ndarray, end: _End) -> Loads:
    """Loads on the branch at depths in the cells (B, n); those past its end count as the end."""
    cells = _Cells(cell)
    of_load, of_depth = ([cells.of(rows[0], i), cells.of(rows[0], i + 2)] for i in (0, 1))
    t, is_past_end = _place_in_cells(of_depth, depth, cell, end)
    D, D_x, *of_D = _pair(of_depth, t)
    P, P_x, *of_P = _pair(of_load, t)
    slope = P_x / np.maximum(D_x, _STEEP * of_D[1] + 1e-300)
    ramp = np.maximum.reduce([_RAMP * end.pull, _LEAST_RAMP * np.abs(end.D), _LEAST_RAMP * depth.max(axis=1)])
    part = np.clip(1 - (end.D[:, None] - depth) / ramp[:, None], 0.0, 1.0)
    falls = np.where(part > 0, (end.P / ramp)[:, None], 0.0)
    slope, part = np.where(is_past_end, falls, slope), np.where(is_past_end, part, 1.0)
    of_parts = np.stack([part * of_P[0], -slope * of_D[0], -part * of_P[1], slope * of_D[1]])
    return Loads(np.where(np.isfinite(D), part * P, np.nan), slope, _by_rows(rows, cells, t, of_parts), of_parts)


def planned(model: CurveModel, values: dict[str, np.ndarray], depth: np.ndarray) -> np.ndarray:
    """Loads (B, n) at depths (B, n) for values (1, 1) of the unknown inputs; 0 past the end of the branch."""
    table, out = TermTable(model), np.full(depth.shape, np.nan)
    for number, row in enumerate(depth):
        x = np.where(np.isfinite(row), row, np.nanmax(row))[None]
        loads = branch(table.rows(values, x.max(axis=1)), x)
        out[number] = np.where(np.isfinite(row), np.where(x[0] < loads.D_off, 0.0, loads.sticks.P[0]), np.nan)
    return out
