"""Smooth punches on a thin layer: the numbers that solver/smooth/paraboloids.py rests on."""

import numpy as np
import pytest

from solver.numerics.mesh import mesh_of
from solver.smooth import paraboloids

#: Compliances of springs under contacts of radius 1: from a half-space alone to springs alone.
C, A = np.geomspace(1e-6, 1e6, 400), np.ones(400)


def test_the_modes_are_real_and_well_conditioned():
    for n in (6, 96, 200):
        kappa, V = np.linalg.eig(mesh_of(n).K)
        assert np.all(np.imag(kappa) == 0) and np.real(kappa).min() > 0 and np.linalg.cond(V) < 20


def test_the_first_guess_of_the_radius():
    """Under a load it is right to 0.3 %, and the second step is the last."""
    P = paraboloids._OF_SUMS["P"](A, paraboloids._sums(A, C, paraboloids.modes(100))[1])
    blend = paraboloids._BLEND
    guess = (np.cbrt(0.75 * P) ** blend + (4 / np.pi * C * P) ** (blend / 4)) ** (1 / blend)
    assert 0.002 < np.abs(guess - 1).max() < 0.003
    found, steps = paraboloids._radius("P", P, C, paraboloids.modes(100))
    np.testing.assert_allclose(found, A, rtol=1e-13, atol=0)
    assert steps.max() == 2


@pytest.mark.parametrize("control", ["P", "D"])
def test_a_step_leaves_a_small_part_of_its_square(control):
    value, of_control = (paraboloids._OF_SUMS[control], paraboloids._ROWS[control])
    given = value(A, paraboloids._sums(A, C, paraboloids.modes(12))[1])
    for away in (-0.1, -0.01, 0.01, 0.1):
        a = A * np.exp(away)
        _, S, slopes, _ = paraboloids._sums(a, C, paraboloids.modes(12))
        step = np.log(value(a, S) / given) / slopes[of_control]
        assert np.abs((away - step) / step**2).max() < 0.04
