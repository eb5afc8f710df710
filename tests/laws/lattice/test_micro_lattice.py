"""The disc cell against the lattice of asperities that it stands for, and where its spots count as merging."""

import numpy as np
import pytest

from solver.laws.cell.periodic import pressed
from solver.laws.disc_cell import contact_fraction, displacement, largest_pressure
from study.data.derived import MERGING

POINTS = 96


def lattice(p, hexagonal):
    """A, λ and p_max of paraboloids r²/2 on a lattice at the mean pressure p, E1* = 1; asperities 1 apart.

    Conjugate gradients of Polonsky and Keer (Wear 231, 1999, 206) on a grid that is periodic; the displacement by
    Fourier transform, 2 p̂/k, without its mean, as in the disc cell.
    """
    sides = np.array([1.0, np.sqrt(3) if hexagonal else 1.0])
    shape = tuple((POINTS * np.array([1, 1.75 if hexagonal else 1])).astype(int))
    x, y = np.meshgrid(*((np.arange(m) + 0.5) / m * side for m, side in zip(shape, sides, strict=True)), indexing="ij")
    tops = [(i, j * sides[1]) for i in (0, 1) for j in (0, 1)] + ([(0.5, sides[1] / 2)] if hexagonal else [])
    height = np.min([((x - u) ** 2 + (y - v) ** 2) / 2 for u, v in tops], axis=0)
    waves = [np.fft.fftfreq(shape[0], sides[0] / shape[0]), np.fft.rfftfreq(shape[1], sides[1] / shape[1])]
    k = 2 * np.pi * np.hypot(*np.meshgrid(*waves, indexing="ij"))
    compliance = np.divide(2.0, k, out=np.zeros_like(k), where=k > 0)

    q, approach, ended = pressed(height, compliance, p, np.full(shape, p))
    assert ended
    return approach, (q > 0).mean(), q.max()


def deviations(p, hexagonal):
    """λ of the disc cell, and A, λ, p_max of the disc cell over those of the lattice, less 1."""
    Nbar = 2 / np.sqrt(3) if hexagonal else 1.0
    cell = [function(p, 1.0, Nbar, 1.0) for function in (displacement, contact_fraction, largest_pressure)]
    return cell[1], np.array(cell) / lattice(p, hexagonal) - 1


@pytest.mark.parametrize(("hexagonal", "expected"), [(False, 0.10), (True, 0.11)])
def test_at_the_threshold_the_disc_cell_errs_as_documented(hexagonal, expected):
    pressures = np.array([0.06, 0.065, 0.07, 0.075])
    fraction, error = zip(*(deviations(p, hexagonal) for p in pressures), strict=True)
    assert fraction[0] < MERGING < fraction[-1]
    A, area, largest = (np.interp(MERGING, fraction, column) for column in np.transpose(error))
    assert pytest.approx(expected, abs=0.006) == A
    assert abs(area) < 0.03 and abs(largest) < 0.02


def test_spots_far_apart_agree_with_the_lattice():
    """The rest is the square root of λ: what the neighbours do to each other."""
    fraction, few = deviations(0.004, False)
    assert fraction < 0.08 and np.abs(few[0]) < 0.035 and np.abs(few[2]) < 0.01
    assert few[0] < deviations(0.03, False)[1][0] < deviations(0.2, False)[1][0]
