"""The ladder of meshes: each case starts on the mesh its tolerance is likely to need and climbs until its estimated
error meets it."""

import numpy as np

from .mesh import mesh, panel_mesh

LADDER = (6, 8, 12, 16, 24, 32, 48, 64, 96)
#: First mesh for rtol at least this: on a half-space or a thin layer, and on the exact layer, whose edge is sharper.
_START = ((1e-3, 6, 8), (1e-5, 8, 12), (3e-7, 12, 16), (3e-8, 16, 16), (1e-9, 24, 24))
#: The estimate is the distance to the next finer mesh times this: the finer one has an error too.
MARGIN = 2.0
#: Cases solved together: their matrices stay in the cache.
STACK = 1024


def start_nodes(rtol, layered=False):
    """Number of nodes (B,) on which to begin for `rtol` (B,)."""
    return np.select([rtol >= row[0] for row in _START], [row[2 if layered else 1] for row in _START], 32)


def next_rung(n):
    """The next finer mesh: of the ladder; beyond its end, half as many nodes again."""
    return next((m for m in LADDER if m > n), n + n // 2)


def finer_mesh(grid):
    """The next finer :class:`~solver.mesh.Mesh`: of the ladder, or of the same panels with a third more nodes."""
    if len(grid.breaks) == 2:
        return mesh(next_rung(grid.n))
    return panel_mesh(grid.order + grid.order // 3, grid.breaks)


def climb(rtol, nodes, solve_on, order=None, layered=False):
    """Let every case climb to the mesh that meets its tolerance.

    Parameters
    ----------
    rtol : (B,) float
    nodes : (B,) int
        A fixed mesh, or 0: chosen by rtol.
    solve_on : callable
        ``solve_on(index, n) -> error`` solves the cases `index` on n nodes, keeps their numbers, and returns their
        estimated errors (NaN: no use going on).
    order : (B,) int, optional
        Permutation of the cases; neighbours in it are solved together.
    layered : bool
        Whether the base is the exact layer.

    Returns
    -------
    (B,) bool
        The cases whose error still exceeds rtol on the last mesh.
    """
    rung = np.where(nodes > 0, nodes, start_nodes(rtol, layered))
    unmet = np.zeros(len(rtol), dtype=bool)
    order = np.arange(len(rtol)) if order is None else order
    while (rung > 0).any():
        n = int(rung[rung > 0].min())
        batch = order[rung[order] == n]
        for index in np.array_split(batch, -(-len(batch) // STACK)):
            missed = solve_on(index, n) > rtol[index]
            last = (nodes[index] > 0) | (n >= LADDER[-1])
            unmet[index] = missed & last
            rung[index] = np.where(missed & ~last, next_rung(n), 0)
    return unmet
