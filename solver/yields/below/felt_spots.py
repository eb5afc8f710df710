"""The largest stress below asperities that feel the coated body: docs/stresses.md, Asperities.

The stresses are the sum, as tensors, of those of the waves of the cell below a spot, on its axis and off it, and those
of the nominal pressure, in the plane of the axes of spot and contact. For the spot in the centre this plane is enough:
the nominal stresses are the same in all directions about the axis.
"""

from functools import partial
from itertools import product

import numpy as np

from ...fields.invariants import mises
from ..peaks import between, chebyshev_nodes
from .spot_table import deepest, table_of

#: Nodes of the nominal stress over the depth, which is a polynomial.
_NODES = 8
#: Number of points in each direction among which the largest stress is searched for, and number of rounds, each around
#: the best of them.
_POINTS, _ROUNDS = 17, 5


def largest_stress(loaded, cells, radii):
    """(3, B): the largest von Mises stress below spots, in units of the pressure; and, in a, the radius of the axis of
    the spot (signed if mu > 0) and the depth of its place. NaN for a cell that is None.

    loaded : :class:`~..loaded.Loaded` of the cases
    cells : their :class:`~.felt_cells.FeltCell`, with spots at `radii`, or only in the centre
    radii : (R,), in a, nodes of the angle arcsin(r/a); the first is 0
    """
    largest = np.full((3, len(cells)), np.nan)
    for i, cell in enumerate(cells):
        if cell is None:
            continue
        below = _Below(cell, loaded.take([i]), radii[: len(cell.b)])
        for sign, side in product(range(len(loaded.signs)), (1.0, -1.0)[: 2 if below.shape[2] > 1 else 1]):
            value, (u, v, _) = _in_box(partial(below.mises, sign=sign, side=side), below.shape)
            if not value <= largest[0, i]:
                r = np.sin(np.pi / 4 * (1 + u)) if len(cell.b) > 1 else 0.0
                depth = (1 + v) / 2 * deepest(below.radius(np.array([u])), cell.h)[0]
                largest[:, i] = value, loaded.signs[sign] * r + 0.0, depth * cell.pitch
    return largest


class _Below:
    """The stresses of one case below spots, as polynomials in three variables, each in [-1, 1]: u for the place of the
    axis, arcsin(r/a); v for the depth, z over the largest; w for the radius from the axis, arcsin(r/b)."""

    def __init__(self, cell, loaded, radii):
        self.cell, self.table = cell, table_of(cell)
        self.deep = deepest(cell.b, cell.h).max()
        z = cell.pitch * self.deep * (1 + chebyshev_nodes(_NODES)) / 2
        self.whole = loaded.stresses(radii, z, False)[:, 0]  # (4, S, nodes, R)
        self.shape = (len(cell.b), *self.table.shape)

    def radius(self, u):
        """b (U,) of the spots at u (U,)."""
        return np.maximum(_on_nodes(u, len(self.cell.b)) @ self.cell.b, 0.0)

    def mises(self, u, v, w, sign, side):
        """The stress of von Mises (U, V, W). sign : index of the side of the contact; side : the side of the spot, 1
        away from the axis of the contact, or -1"""
        b = self.radius(u)
        spot = np.tensordot(self.table.at(b), _on_nodes(v, self.shape[1]), (2, 1))
        spot = self.cell.unit * np.tensordot(spot, _on_nodes(w, self.shape[2]), (2, 1))  # (U, 4, V, W)
        spot[:, 3] *= side
        z = deepest(b, self.cell.h)[:, None] * (1 + v) / self.deep - 1
        over = between(z.ravel(), _NODES).reshape(*z.shape, _NODES)
        nominal = np.einsum("fnr,ur,uvn->ufv", self.whole[:, sign], _on_nodes(u, self.shape[0]), over)
        return mises(*(spot + nominal[..., None]).swapaxes(0, 1))


def _on_nodes(points, count):
    """The matrix (P, count) that makes values at points (P,) from values at `count` nodes."""
    return between(points, count) if count > 1 else np.ones((len(points), 1))


def _in_box(value, shape):
    """The largest value, and its place in [-1, 1]³, of a function of points (U,), (V,), (W,). `shape`: (3,); in a
    direction with 1 node the function is constant."""
    centre, half = np.zeros(3), 1.0
    for _ in range(_ROUNDS):
        points = [np.clip(c + half * np.linspace(-1, 1, _POINTS), -1, 1) for c in centre]
        points = [p if n > 1 else np.zeros(1) for p, n in zip(points, shape, strict=True)]
        on_grid = value(*points)
        if not np.all(np.isfinite(on_grid)):
            return np.nan, centre
        best = np.unravel_index(np.argmax(on_grid), on_grid.shape)
        centre = np.array([p[i] for p, i in zip(points, best, strict=True)])
        half = half * 4 / _POINTS
    return on_grid[best], centre
