"""The two scales against one: a rough sphere on a half-space with every asperity resolved."""

import numpy as np
from rough_sphere import Punch, cell_means, real_area, resolved, width

from solver import Problem, solve

PITCH, RA, P = 0.008, 0.004, 2e-5
HALF, POINTS = 0.045, 384


def test_a_sphere_with_sixty_spots():
    """D and p_max of the lattice are those of the whole, as well as its grid tells; the disc cell is 6e-3 high in D.

    On 1024 points a side the lattice is off by -3e-4 in D and by 8e-4 in p_max."""
    found = resolved(Punch(PITCH, RA), P, HALF, POINTS)
    D, p_max = found.D, found.p.max()
    s = solve(Problem.of(P=P, base="half_space", micro=["square_lattice", "disc_cell"], Nbar=PITCH**-2, Ra=RA))
    assert abs(s.D[0] / D - 1) < 1.5e-3 and 4e-3 < s.D[1] / D - 1 < 8e-3
    assert abs(s.p_max[0] / p_max - 1) < 8e-3
    # 3.1 % too large by the correction for the edges, whose spots have few elements here; 3.9 % too small without it
    assert 0 < s.Ar_An[0] * np.pi * s.a[0] ** 2 / real_area(found) - 1 < 0.037


def test_means_of_cells():
    """They carry the load, and are the nominal pressure of the lattice law; so is their width."""
    found = resolved(Punch(PITCH, RA), P, 4.5 * PITCH, 9 * 24)
    r, mean = cell_means(found, PITCH)
    assert abs(mean.sum() * PITCH**2 / P - 1) < 1e-12 and (np.diff(r) >= 0).all()
    x = np.linspace(0, 1, 401)
    s = solve(Problem.of(P=P, base="half_space", micro="square_lattice", Nbar=PITCH**-2, Ra=RA), x)
    inside = r < s.a[0] - PITCH
    assert inside.sum() > 15
    assert np.abs(np.interp(r[inside], x * s.a[0], s.p[0]) - mean[inside]).max() < 6e-3 * s.p0[0]
    across = np.hypot(found.middle[:, None], found.middle[None, :])
    assert abs(width(across, found.p, 1.0) / (width(x, s.p[0], x) * s.a[0]) - 1) < 2e-3
