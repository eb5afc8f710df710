"""The largest stress below asperities that feel the coated body: docs/stresses.md, Asperities.

The stresses of the waves of the cell below a spot, beside its axis too, and those of the nominal pressure are added as
tensors, in the plane of both axes: in the centre of the contact, where the nominal stresses are the same in all
directions about the axis, that is all there is.
"""

from functools import partial
from itertools import product

import numpy as np

from ...fields.invariants import mises
from ..peaks import between, chebyshev_nodes
from .spot_table import deepest, table_of

#: Nodes of the nominal stress over the depth, a polynomial.
_NODES = 8
#: Points of each direction among which the largest stress is looked for, and how often around the best of them.
_POINTS, _ROUNDS = 17, 5


def largest_stress(loaded, cells, radii):
    """(3, B): the largest von Mises stress below spots, in units of the pressure, and the radius of the axis of the
    spot (signed if mu > 0) and the depth in a of its place; NaN of a cell that is None.

    loaded : :class:`~..loaded.Loaded` of the cases; cells : their :class:`~.felt_cells.FeltCell`, with spots at `radii`
        (R,) in a, which are nodes of the angle arcsin(r/a), the first 0, or in the centre alone
    """
    made = np.full((3, len(cells)), np.nan)
    for i, cell in enumerate(cells):
        if cell is None:
            continue
        below = _Below(cell, loaded.take([i]), radii[: len(cell.b)])
        for sign, side in product(range(len(loaded.signs)), (1.0, -1.0)[: 2 if below.shape[2] > 1 else 1]):
            value, (u, v, _) = _in_box(partial(below.mises, sign=sign, side=side), below.shape)
            if not value <= made[0, i]:
                r = np.sin(np.pi / 4 * (1 + u)) if len(cell.b) > 1 else 0.0
                depth = (1 + v) / 2 * deepest(below.radius(np.array([u])), cell.h)[0]
                made[:, i] = value, loaded.signs[sign] * r + 0.0, depth * cell.pitch
    return made


class _Below:
    """The stresses of one case below spots, as polynomials of the place of their axis, the depth and the radius from
    the axis, each in [-1, 1]: u of arcsin(r/a), v of z over the deepest, w of arcsin(r/b)."""

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
        """von Mises' stress (U, V, W). sign : which side of the contact; side : of the spot, 1 or -1, where 1 is away
        from the axis of the contact"""
        b = self.radius(u)
        own = np.tensordot(self.table.at(b), _on_nodes(v, self.shape[1]), (2, 1))
        own = self.cell.unit * np.tensordot(own, _on_nodes(w, self.shape[2]), (2, 1))  # (U, 4, V, W)
        own[:, 3] *= side
        z = deepest(b, self.cell.h)[:, None] * (1 + v) / self.deep - 1
        over = between(z.ravel(), _NODES).reshape(*z.shape, _NODES)
        nominal = np.einsum("fnr,ur,uvn->ufv", self.whole[:, sign], _on_nodes(u, self.shape[0]), over)
        return mises(*(own + nominal[..., None]).swapaxes(0, 1))


def _on_nodes(points, count):
    """From values at `count` nodes to those at points (P,): (P, count)."""
    return between(points, count) if count > 1 else np.ones((len(points), 1))


def _in_box(value, shape):
    """The largest value, and its place in [-1, 1]³, of a function of points (U,), (V,), (W,); `shape` : (3,), in
    directions with 1 it does not change."""
    centre, half = np.zeros(3), 1.0
    for _ in range(_ROUNDS):
        points = [np.clip(c + half * np.linspace(-1, 1, _POINTS), -1, 1) for c in centre]
        points = [p if n > 1 else np.zeros(1) for p, n in zip(points, shape, strict=True)]
        made = value(*points)
        if not np.all(np.isfinite(made)):
            return np.nan, centre
        best = np.unravel_index(np.argmax(made), made.shape)
        centre = np.array([p[i] for p, i in zip(points, best, strict=True)])
        half = half * 4 / _POINTS
    return made[best], centre
