"""Loads of curves that stick by the compiled core, against those by numpy (study/inverse/fits/tables/branch.py)."""

import numpy as np
import pytest
from both_paths import of_the_sources  # noqa: F401
from numpy.testing import assert_allclose

from solver.compiled.library import VARIABLE, available
from study.inverse.fits.tables.branch import branch
from study.inverse.fits.tables.term_table import LENGTH, STEP

pytestmark = pytest.mark.skipif(not available(), reason="no compiled core was built here")
#: Of loads, in units of the four parts of which they are made; of slopes, which near the turn of the depth are a
#: quotient of differences of such parts.
SAME, OF_SLOPES = 5e-14, 1e-8


def rows_of(curves: int, others: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows of paraboloids on half-spaces after Johnson, Kendall and Roberts, of works of adhesion over 8 decades, with
    two that never turn: without adhesion, and with parts that are no numbers. Other rows are of no meaning; depths
    (curves, 37) reach beyond the ends of the branches."""
    random = np.random.default_rng(curves)
    x = STEP * np.arange(LENGTH) - 12.0
    w = np.where(np.arange(curves) % 9 == 7, -700.0, random.uniform(-24, -6, curves))[:, None]
    values = [np.log(4 / 3) + 3 * x + 0 * w, 2 * x + 0 * w, (w + np.log(8 * np.pi)) / 2 + 1.5 * x, (w + x) / 2]
    slopes = [np.full((curves, LENGTH), slope) for slope in (3.0, 2.0, 1.5, 0.5)]
    first = np.stack([*values, *slopes], axis=1)
    first[::11, [2, 3]] = np.nan
    more = random.standard_normal((others, *first.shape))
    D = np.exp(random.uniform(-12, -3, (curves, 1))) * np.linspace(-0.5, 1, 37)
    return np.concatenate([first[None], more]), D


@pytest.mark.parametrize("variant", available())
@pytest.mark.parametrize("others", [0, 2])
def test_they_are_those_of_numpy(variant, others, monkeypatch):
    rows, depth = rows_of(70, others)
    monkeypatch.setenv(VARIABLE, "numpy")
    numpy = branch(rows, depth)
    monkeypatch.setenv(VARIABLE, variant)
    core = branch(rows, depth)
    assert_allclose(core.D_off, numpy.D_off, rtol=SAME * 10, atol=0)
    assert_allclose(core.D_least, numpy.D_least, rtol=1e-11, atol=0)
    assert np.isfinite(numpy.sticks.P).mean() > 0.8 and (numpy.sticks.P < 0).any()
    on_ramp = depth < numpy.D_off[:, None]
    assert 0.1 < on_ramp.mean() < 0.9
    for ours, theirs in ((core.sticks, numpy.sticks), (core.free, numpy.free)):
        size = np.abs(theirs.by_parts).sum(axis=0)
        there = np.isfinite(theirs.P)
        assert (np.isfinite(ours.P) == there).all()
        assert_allclose((ours.P - theirs.P)[there] / (size[there] + 1e-300), 0, rtol=0, atol=SAME)
        assert_allclose(ours.slope[there], theirs.slope[there], rtol=OF_SLOPES, atol=0)
        for array in ("by_rows", "by_parts"):
            a, b = (getattr(loads, array)[:, there] for loads in (ours, theirs))
            assert_allclose(a, b, rtol=OF_SLOPES, atol=OF_SLOPES * np.nanmax(size))


def test_a_curve_has_the_same_bits_in_any_company():
    rows, depth = rows_of(70, 2)
    whole = branch(rows, depth)
    for places in ([3], [3, 40, 41]):
        some = branch(rows[:, places], depth[places])
        assert (whole.sticks.P[places] == some.sticks.P).all() and (whole.free.P[places] == some.free.P).all()
        assert (some.sticks.by_rows == whole.sticks.by_rows[:, places]).all()
    one = branch(rows[:, :1], depth[:1, 5:6])
    assert one.free.P[0, 0] == whole.free.P[0, 5]
