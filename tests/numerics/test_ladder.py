"""The ladder of meshes: the next mesh is a finer one, and a case ends on the first that will do."""

import numpy as np
import pytest

from solver.numerics.ladder import LADDER, climb, finer_mesh, next_rung
from solver.numerics.mesh import mesh_of, panel_mesh


def test_the_next_rung_has_more_nodes_also_beyond_the_ladder():
    for n in range(2, 400):
        assert n < next_rung(n) <= max(2 * n, LADDER[0])
    assert [next_rung(n) for n in LADDER[:-1]] == list(LADDER[1:])


@pytest.mark.parametrize("breaks", [(0.0, 1.0), (0.0, 0.1, 1.0), (0.0, 0.01, 0.02, 0.5, 1.0)])
@pytest.mark.parametrize("order", [6, 12, 16, 32])
def test_the_finer_mesh_has_more_nodes_on_the_same_panels(breaks, order):
    """By a fifth at least: the error is estimated by the distance to its solution."""
    mesh = mesh_of(order) if len(breaks) == 2 else panel_mesh(order, breaks)
    finer = finer_mesh(mesh)
    assert 1.2 * mesh.n <= finer.n <= 2 * mesh.n and tuple(finer.breaks) == tuple(mesh.breaks)


def test_a_case_climbs_until_its_error_is_below_its_tolerance():
    """An error of 10^(-n/4): each case ends on the first mesh where that is below its rtol, or on the last; on a fixed
    mesh it stays."""
    rtol = np.array([1e-2, 1e-4, 1e-6, 1e-30, 1e-30])
    nodes, seen = np.array([0, 0, 0, 0, 8]), [[] for _ in rtol]

    def solve_on(index, n, start):
        for i in index.tolist():
            seen[i].append(n)
        return np.full(len(index), 10 ** (-n / 4)), None, n

    pieces = climb(rtol, nodes, solve_on, np.full(5, 6))
    ends = [next((n for n in LADDER if 10 ** (-n / 4) <= one), LADDER[-1]) for one in rtol[:4]] + [8]
    assert [on[-1] for on in seen] == ends == [8, 16, 32, 96, 8]
    assert seen[3] == list(LADDER) and seen[4] == [8], "no mesh is left out"
    last = {i: n for index, n in pieces for i in index.tolist()}
    assert last == dict(enumerate(ends))
