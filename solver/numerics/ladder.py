"""The ladder of meshes: each case starts on the mesh its tolerance is likely to need and climbs until its estimated
error meets it."""

import numpy as np

from .batch import join
from .mesh import mesh_of, panel_mesh

LADDER = (6, 8, 12, 16, 22, 32, 48, 64, 96)
#: (rtol, nodes): the mesh to begin on for this rtol and larger ones, where nothing else is known. Below the smallest
#: rtol it is 32 nodes.
_START = ((1e-3, 6), (1e-5, 8), (3e-7, 12), (3e-8, 16), (1e-9, 22))
#: The estimated error is this times the distance to the next finer mesh, since the finer mesh has an error too
#: ("margin" of tests/rough/errors/test_error_bars.py).
MARGIN = 2.0
#: Number of unknowns that are solved together. More of them would not fit into the processor's cache. With fewer, the
#: time of numpy's calls would count.
STACK = 40_000


def start_nodes(rtol):
    """Number of nodes (B,) on which to begin for `rtol` (B,)."""
    return np.select([rtol >= least for least, _ in _START], [n for _, n in _START], 32)


def first_rung(wanted):
    """The coarsest mesh of the ladder, up to 32 nodes, with at least `wanted` (B,) nodes."""
    steps = np.array([n for n in LADDER if n <= 32])
    return steps[np.minimum(np.searchsorted(steps, wanted), len(steps) - 1)]


def next_rung(n):
    """Number of nodes of the next finer mesh: the next rung of the ladder, and beyond its end half as many nodes
    again."""
    return next((m for m in LADDER if m > n), n + n // 2)


def finer_mesh(mesh):
    """The next finer :class:`.mesh.Mesh`: for one panel the next rung of the ladder, for several the same panels with a
    third more nodes."""
    if len(mesh.breaks) == 2:
        return mesh_of(next_rung(mesh.n))
    return panel_mesh(mesh.order + mesh.order // 3, mesh.breaks)


def climb(rtol, nodes, solve_on, first=None, order=None):
    """Let every case climb to the mesh that meets its tolerance rtol (B,).

    Returns a list of (index, answer), one for each stack that was solved. A case may occur in several stacks: the
    answer of the last of them counts.

    nodes : (B,) int, the number of nodes of a fixed mesh, or 0: begin on `first`, and climb
    solve_on : ``solve_on(index, n, start) -> error, finer, answer`` solves the cases `index` on n nodes. `start` is the
        `finer` of the coarser mesh before, and None on the first mesh. error (b,): estimated errors, NaN where a finer
        mesh would be of no use. finer: the batch from which the next finer mesh starts, or None. answer: returned
        unchanged
    first : (B,) int, number of nodes of the first mesh; None: chosen by rtol
    order : (B,) int, permutation of the cases; neighbours in it are solved together
    """
    rung = np.where(nodes > 0, nodes, start_nodes(rtol) if first is None else first)
    order = np.arange(len(rtol)) if order is None else order
    batches = [(order[rung[order] == n], n) for n in np.unique(rung).tolist()]
    waiting = {n: [(index, None) for index in _stacks(batch, n)] for batch, n in batches}
    pieces = []
    while waiting:
        n, climbing = min(waiting), []
        for index, start in waiting.pop(n):
            error, finer, answer = solve_on(index, n, start)
            pieces.append((index, answer))
            rows = np.flatnonzero((error > rtol[index]) & (nodes[index] == 0))
            if len(rows) and n < LADDER[-1]:
                climbing.append((index[rows], None if finer is None else finer.take(rows)))
        if climbing:
            waiting.setdefault(next_rung(n), []).extend(_together(climbing, next_rung(n)))
    return pieces


def _together(climbing, n):
    """The stacks, (index, start), on n nodes. `climbing` has the cases that come from the coarser mesh, pairs of the
    same kind."""
    index, start = np.concatenate([rows for rows, _ in climbing]), climbing[0][1]
    if start is not None:
        start = join([begin for _, begin in climbing])
    return [(index[rows], None if start is None else start.take(rows)) for rows in _stacks(np.arange(len(index)), n)]


def _stacks(batch, n):
    return np.array_split(batch, -(-len(batch) * n // STACK))
