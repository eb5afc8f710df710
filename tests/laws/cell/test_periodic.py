"""Cells with every point resolved, by conjugate gradients, beside the equation of one spot: another formulation."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver.kernels.two_layers import TwoLayers
from solver.laws import cell_rows, lattice, periodic_rows
from solver.laws.cell.periodic import pressed, response_of, waves_times

#: Points along a period of the square cell. The spots are 10 to 45 of them wide: A and the pressure in the middle have
#: an error below 1e-3, the number of points in contact one of a few hundredths.
N = 96
SQUARE = np.linspace(-0.5, 0.5, N, endpoint=False)
HEIGHTS = -(SQUARE**2 + SQUARE[:, None] ** 2) / 2


def kernel(pitch, n, nu1, bonding):
    layer = TwoLayers(*(np.array([v]) for v in (n, nu1, 0.3, bonding == "bonded")))
    return lambda k: layer.whole((k / pitch)[None])[0]


@pytest.mark.parametrize("bonding", ["bonded", "frictionless"])
@pytest.mark.parametrize(("n", "pitch"), [(0.05, 6.0), (0.3, 1.5), (2.0, 3.0), (5.0, 9.0), (20.0, 2.0), (20.0, 6.0)])
@pytest.mark.parametrize("lam", [0.08, 0.3])
def test_a_spot_and_its_cell(lam, n, pitch, bonding):
    """Within 1 %, of which the resolved cell has a tenth and the mean over the angle 0.3 % at this lambda."""
    p, A, p_max = cell_rows("square", lam, pitch, n, 0.25, 0.3, bonding)
    response = response_of(HEIGHTS.shape, 1 / N, 1 / N, kernel(pitch, n, 0.25, bonding))
    pressures, approach, closed = pressed(-HEIGHTS, response, p, np.full(HEIGHTS.shape, p))
    assert closed
    assert_allclose([approach, pressures[N // 2, N // 2]], [A, p_max], rtol=4e-3)
    assert_allclose(np.mean(pressures > 0), lam, rtol=0.03)


def test_what_the_mean_over_the_angle_leaves_out_is_what_model_error_says():
    """The worst of random cells up to a pitch of 12 h, n = 30 at 7 h: 2.7 % in A where half of the area touches."""
    for lam, most in (0.4, 0.03 * 0.8**3.5), (0.5, 0.03):
        p, A, p_max = cell_rows("square", lam, 7.0, 30.0, 0.25, 0.3, "bonded")
        response = response_of(HEIGHTS.shape, 1 / N, 1 / N, kernel(7.0, 30.0, 0.25, "bonded"))
        pressures, approach, _ = pressed(-HEIGHTS, response, p, np.full(HEIGHTS.shape, p))
        errors = abs(approach / A - 1), abs(pressures[N // 2, N // 2] / p_max - 1)
        assert 0.3 * most < max(errors) < most


def test_on_a_half_space_it_is_the_table_of_the_square_lattice():
    law = lattice.SQUARE.at(np.array([0.003, 0.03, 0.12]), 1.0, Nbar=1.0, Ra=1.0)
    A, lam, p_max = periodic_rows(HEIGHTS, 1 / N, [0.003, 0.03, 0.12])
    assert_allclose([A, p_max], [law.A, law.p_max], rtol=3e-3)
    assert_allclose(lam, law.lam, rtol=0.03)


@pytest.mark.parametrize(("n", "pitch"), [(12.0, 4.0), (60.0, 5.0)])
def test_summits_under_a_hard_layer_come_to_rest(n, pitch):
    """A period of 16 summits of random heights, where points that joined the contact under one pressure for all came
    and went for ever. At rest there is no gap where there is pressure, and no overlap where there is none."""
    at = (np.arange(64) + 0.5) / 16
    of, away = np.floor(at).astype(int), at % 1 - 0.5
    heights = np.random.default_rng(1).uniform(0, 0.1, (4, 4))
    depths = (away[:, None] ** 2 + away**2) / 2 + heights[of][:, of]
    response = response_of(depths.shape, 1 / 16, 1 / 16, kernel(pitch, n, 0.3, "bonded"))
    pressures, A, closed = pressed(depths, response, 0.05, np.full(depths.shape, 0.05))
    gap = np.fft.irfft2(np.fft.rfft2(pressures) * response, s=depths.shape) + depths - A
    assert closed and 0.4 < np.mean(pressures > 0) < 0.7
    assert_allclose(gap[pressures > 0], 0, atol=1e-9)
    assert gap.min() > -1e-9 and pressures.mean() == pytest.approx(0.05)


def test_two_steps_and_two_sides():
    """The cell twice, with half as many points along one side; pressures in any order."""
    fine = -(np.tile(SQUARE, 2) ** 2 + SQUARE[::2, None] ** 2) / 2
    twice = periodic_rows(fine, 1 / N, [0.05, 0.01], dy=2 / N)
    once = periodic_rows(HEIGHTS, 1 / N, [0.01, 0.05])
    assert_allclose(np.array(twice)[:, ::-1], once, rtol=0.02)


@pytest.mark.parametrize("share", [0.04, 0.3, 0.8])
def test_a_wave_pressed_flat_in_part(share):
    """Westergaard (1939): under p = sin²(πa/λ) p*, p* = π Δ/λ, the pressure in the middle is 2 √(p p*)."""
    points, most = 512, np.pi * 0.01
    wave = np.tile(0.01 * np.cos(2 * np.pi * np.arange(points) / points), (4, 1))
    _, lam, p_max = periodic_rows(wave, 1 / points, [share * most])
    assert_allclose(lam, 2 / np.pi * np.arcsin(np.sqrt(share)), atol=3 / points)
    assert_allclose(p_max, 2 * most * np.sqrt(share), rtol=2e-3)


def test_a_wave_along_both_axes_is_flat_where_the_amplitudes_of_its_pressure_are_below_the_mean():
    """Johnson, Greenwood and Higginson (1985): Δ cos cos is flat from p* = √2 π Δ/λ on, where it is half as high."""
    angle = 2 * np.pi * np.arange(32) / 32
    heights = 0.01 * np.cos(angle) * np.cos(angle[:, None])
    most = np.sqrt(2) * np.pi * 0.01
    A, lam, p_max = periodic_rows(heights, 1 / 32, [0.97 * most, 1.01 * most])
    assert lam[0] < 1 == lam[1]
    assert_allclose([A[1], p_max[1]], [0.01, 2.01 * most], rtol=1e-9)


@pytest.mark.parametrize("n", [None, 6.0])
def test_a_patch_beside_its_mirror_images(n):
    patch = np.random.default_rng(2).normal(size=(12, 10)).cumsum(axis=0).cumsum(axis=1) * 1e-3
    period = np.concatenate([patch, patch[:, ::-1]], axis=1)
    period = np.concatenate([period, period[::-1]])
    there = None if n is None else kernel(0.7, n, 0.3, "bonded")
    of_period = periodic_rows(period, 0.1, [0.004], there, dy=0.2)
    response = response_of(patch.shape, 0.1, 0.2, there, mirrored=True)
    pressures, A, ended = pressed(patch.max() - patch, response, 0.004, np.full(patch.shape, 0.004), mirrored=True)
    assert ended and 0.1 < np.mean(pressures > 0) < 0.9
    assert_allclose([A, np.mean(pressures > 0), pressures.max()], np.ravel(of_period), rtol=1e-6)
    gap = waves_times(pressures, response, True) + patch.max() - patch - A
    assert_allclose(gap[pressures > 0], 0, atol=1e-9)


def test_a_flat_surface_is_in_full_contact():
    assert_allclose(np.ravel(periodic_rows(np.zeros((4, 4)), 1.0, [0.1])), [0, 1, 0.1])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((np.zeros(4), 1.0, [0.1]), "heights: must be a table"),
        ((np.full((4, 4), np.nan), 1.0, [0.1]), "heights"),
        ((np.zeros((4, 4)), 0.0, [0.1]), "dx = 0.0"),
        ((np.zeros((4, 4)), 1.0, [-0.1]), "pressures"),
        ((np.zeros((4, 4)), 1.0, [0.1], lambda k: -k), "kernel"),
    ],
)
def test_bad_arguments_are_named(arguments, words):
    with pytest.raises(ValueError, match=words):
        periodic_rows(*arguments)
