"""Curves in closed form: turns, gaps, crossings, and the ends of a solution on its own branch."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from study.inverse.design_cases import Wanted
from study.inverse.design_curves import crossings, ends, scanned

LOW, HIGH, RTOL = 0.3, 11.0, 1e-6
FINE = np.linspace(LOW, HIGH, 200_001)


def wave(t: np.ndarray, row: np.ndarray) -> np.ndarray:
    """Row 0 has a maximum, a minimum and a maximum; rows 1, 2 lack what is above, or below, some t."""
    gap = ((row == 1) & (t > 6.1)) | ((row == 2) & (t < 2.2))
    return np.where(gap, np.nan, 2 + np.sin(t) + 0.1 * t)


def fine_crossings(level: float, row: int) -> np.ndarray:
    y = wave(FINE, np.full(len(FINE), row))
    above = np.where(np.isnan(y), np.nan, y > level)
    return FINE[np.flatnonzero(np.abs(np.diff(above)) == 1)]


@pytest.mark.parametrize("row", [0, 1, 2])
def test_crossings_at_any_level(row):
    rows = np.array([row])
    curves = scanned(wave, rows, LOW, HIGH)
    least, _, largest, _ = (number.item() for number in curves.reach())
    y = wave(FINE, np.full(len(FINE), row))
    assert_allclose([least, largest], [np.nanmin(y), np.nanmax(y)], rtol=1e-4)  # of a gap the last 1/4096 is missing
    for level in np.linspace(1.2, 4.0, 57):
        found = crossings(wave, curves, rows, np.array([level]), RTOL)[0]
        assert_allclose(found[np.isfinite(found)], fine_crossings(level, row), atol=1e-4)


def test_rows_keep_apart():
    rows = np.array([2, 0, 1])
    curves = scanned(wave, rows, LOW, HIGH)
    found = crossings(wave, curves, rows, np.full(3, 2.4), RTOL)
    for row, mine in zip(rows.tolist(), found, strict=True):
        assert_allclose(mine[np.isfinite(mine)], fine_crossings(2.4, row), atol=1e-4)


def test_a_touch_at_the_bounds():
    """Within rtol beyond what a bound has, the bound is the place; farther there is none."""
    rows = np.array([0])
    curves = scanned(wave, rows, LOW, HIGH)
    for bound, outwards in ((LOW, -1), (HIGH, 1)):
        value = wave(np.array([bound]), rows).item()
        falls = wave(np.array([bound + 1e-3 * outwards]), rows).item() < value
        for part, there in ((0.5 * RTOL, True), (2 * RTOL, False)):
            level = value * (1 - part if falls else 1 + part)
            found = crossings(wave, curves, rows, np.array([level]), RTOL)[0]
            assert np.isclose(found, bound, rtol=0, atol=1e-9).any() == there


def test_ends_stay_on_the_branch_of_their_solution():
    """Solutions at level 2.5 rise, fall, rise, fall. The ends are the next places of the other level, on the side where
    the curve goes there, and before the next solution; else there is none."""
    level, rows = 2.5, np.array([0])
    curves = scanned(wave, rows, LOW, HIGH)
    t = crossings(wave, curves, rows, np.array([level]), RTOL)
    assert np.isfinite(t).sum() == 4
    for spread in (0.0, 0.1, 0.6, 0.75, 1.0):
        low, high = ends(wave, curves, rows, t, level, np.full_like(t, spread), RTOL)
        for number, at in enumerate(t[0]):
            rises = wave(np.array([at + 1e-3]), rows) > level
            for found, sign in ((low[0, number], -1), (high[0, number], 1)):
                off = level + (spread if rises == (sign > 0) else -spread)
                places = sign * fine_crossings(off, 0)
                neighbour = sign * t[0, number + sign] if 0 <= number + sign < 4 else np.inf
                mine = places[(places > sign * at) & (places < neighbour)]
                expected = at if spread == 0 else sign * mine.min() if len(mine) else np.nan
                assert_allclose(found, expected, atol=1e-4)
    assert np.isnan(high[0, 0]) and np.isnan(low[0, 0])  # 1 below: nowhere before the bound; 1 above: nowhere at all


def test_values_stay_within_their_bounds():
    """exp(ln x) may be above x, and x the largest that the solver takes."""
    bounds = [10.0**power for power in range(-12, 10)]
    assert any(np.exp(np.log(bound)) > bound for bound in bounds)
    for high in bounds:
        want = Wanted(None, "p0", 1.0, "h", high / 2, high)
        assert want.low <= want.x_of(want.t_of(want.low)) <= want.x_of(want.t_of(want.high)) <= high
