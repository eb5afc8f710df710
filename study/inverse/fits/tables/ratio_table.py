"""A table of y(x; unknown inputs) that is read a million times.

It holds g = ln(y/Hertz's y) over ln u and the coordinates of the unknown inputs (`CurveModel`). Along ln u a tile of
the lattice has _LATTICE points, joined by cubics.
"""

import numpy as np

from ..model import HERTZ, CurveModel, is_ratio
from .tiles import WIDE, WIDE_RATIO, Chebyshev, Lattice

_LATTICE = 32
STEP = WIDE / _LATTICE
#: Number of coordinates of a table -> Chebyshev points of a tile along each. g is within 5e-6 of solutions; with three
#: coordinates within 1e-3, in the steepest tiles (tests/inverse/fits/test_table_of_curves.py).
_POINTS = {1: 16, 2: 14, 3: 8, 4: 6}
_MARGIN = 2.5 * STEP  # outside the ends of a tile, since a cubic needs points on both sides
_MOVE = 1e-4  # relative change of inputs for derivatives


class RatioTable:
    """g of a model, on tiles that are solved on demand. Only one thread may use a table."""

    def __init__(self, model: CurveModel):
        self.model = model
        wide = [WIDE_RATIO if is_ratio(name) else WIDE for name in model.axes]
        self.chebyshev = Chebyshev(_POINTS[min(1 + len(model.axes), 4)])
        self.lattice = Lattice([self.chebyshev] * len(wide), wide, 1, _LATTICE)
        points = (np.arange(_LATTICE) / _LATTICE * WIDE - WIDE / 2) / (WIDE / 2 + _MARGIN)
        self.along_u = self.chebyshev.lagrange(points)[0]

    def tile(self, place: tuple[int, ...], moved: bool) -> np.ndarray:
        """g of the contacts of a tile, or its derivatives by the inputs `moved` of the model, (1 or moved, 1, _LATTICE,
        C), NaN where a contact has no solution.

        Each tile is a batch: the last digits of a solution depend on the other contacts in its batch.
        """
        model = self.model
        values, x = self._contacts(place)
        with np.errstate(all="ignore"):
            if moved:
                rows = [self._slope(name, values, x) for name in model.moved]
            else:
                rows = [np.log(model.solved(values, x) / model.hertz(values, x, HERTZ[model.x, model.y][0]))]
        g = np.array(rows).reshape(len(rows), self.chebyshev.points, -1)
        return np.einsum("lp,rpc->rlc", self.along_u, g)[:, None]

    def _contacts(self, place: tuple[int, ...]) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """The values of the unknown inputs and x of the contacts of a tile."""
        model, names = self.model, self.model.axes
        middle = (np.array(place) + 0.5) * [WIDE, *self.lattice.wide]
        half = [WIDE / 2 + _MARGIN, *(self.lattice.wide / 2)]
        grid = np.meshgrid(*([self.chebyshev.t] * len(half)), indexing="ij")
        u, *coordinates = (middle + half * np.stack([t.ravel() for t in grid], axis=-1)).T
        values = model.within({name: model.of_coordinate(name, c) for name, c in zip(names, coordinates, strict=True)})
        return values, np.exp(u - model.shift(values))

    def _slope(self, name: str, values: dict[str, np.ndarray], x: np.ndarray) -> np.ndarray:
        """d ln y by the logarithm of an input, or by a ratio, by central differences."""
        model = self.model
        value = np.broadcast_to(values.get(name, model.value(name)), x.shape)
        by = _MOVE * (1.0 if is_ratio(name) else value)
        above, below = (np.log(model.solved(values | {name: value + sign * by}, x)) for sign in (1, -1))
        return (above - below) / (2 * _MOVE)

    def rows(self, coordinates: np.ndarray, first: np.ndarray, count: int, moved: bool = False) -> np.ndarray:
        """Rows (1 + axes, B, count * _LATTICE) along ln u of B curves: g and its derivatives by each coordinate. With
        `moved` its derivatives by the inputs `moved` of the model follow.

        coordinates : (B, axes)
        first : (B,), the first tile of each curve along ln u
        count : of tiles
        """
        position = self.lattice.position(coordinates)
        return self.lattice.read(self.tile, first, position, count, len(self.model.moved) if moved else 0)[:, :, 0]


class Cubics:
    """Cubics at places (B, n) between the L points of B rows, counted in points. Each cubic passes through four points;
    from 1 to L - 3 the place is between the middle two."""

    def __init__(self, place: np.ndarray, length: int):
        i = np.clip(place.astype(int), 1, length - 3)  # truncation is the floor, since no place is below 0
        self.t = place - i
        self.flat = i + length * np.arange(len(place))[:, None] - 1

    def read(self, rows: np.ndarray, slope: bool = False) -> tuple:
        """Values (B, n) of rows (B, L), and their derivatives by the place, or None."""
        t, flat = self.t, rows.reshape(-1)
        a, b, c, d = (flat.take(self.flat + k) for k in range(4))
        quadratic, cubic = (a + c) / 2 - b, (d - a) / 6 + (b - c) / 2
        linear = c - b - quadratic - cubic
        value = b + t * (linear + t * (quadratic + t * cubic))
        return value, linear + t * (2 * quadratic + 3 * t * cubic) if slope else None
