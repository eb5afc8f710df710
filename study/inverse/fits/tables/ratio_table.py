"""A table of y(x; unknown inputs) that is read a million times: polynomials on tiles, made where they are needed.

What is tabulated is g = ln(y/Hertz's y) over ln u and the coordinates of the unknown inputs (`CurveModel`). Tiles lie
on a fixed lattice, so that the numbers of a curve do not depend on which other curves there are. Along ln u a tile has
_LATTICE points, between which a cubic is drawn; along the others it has Chebyshev points.
"""

import numpy as np

from ..model import HERTZ, CurveModel, is_ratio

WIDE = np.log(16.0)  # of a tile, of a logarithm; of a Poisson ratio:
_WIDE_RATIO = 0.25
_LATTICE = 32
STEP = WIDE / _LATTICE
#: Chebyshev points of a tile along each coordinate, of tables with one, two and more coordinates: g is within 5e-6 of
#: solutions, with three 1e-3, which its steepest tiles have (tests/inverse/fits/test_table_of_curves.py).
_POINTS = {1: 16, 2: 14, 3: 8, 4: 6}
_MARGIN = 2.5 * STEP  # beyond the ends of a tile: the cubic takes points on both sides
_MOVE = 1e-4  # of inputs by which derivatives are wanted


def width(name: str) -> float:
    """The width of a tile along the coordinate of an input."""
    return _WIDE_RATIO if is_ratio(name) else WIDE


class Chebyshev:
    """Polynomials through so many Chebyshev points of the first kind, `t`, along each of several coordinates."""

    def __init__(self, points: int):
        angles = np.pi * (np.arange(points) + 0.5) / points
        self.points, self.t = points, np.cos(angles)
        self.of_points = (-1.0) ** np.arange(points) * np.sin(angles)

    def lagrange(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lagrange polynomials of the points at s (B,), and their derivatives: (B, points) each."""
        away = s[:, None] - self.t
        away = np.where(np.abs(away) < 1e-13, 1e-13, away)
        part = self.of_points / away
        total = part.sum(axis=1, keepdims=True)
        values = part / total
        slopes = -part / away / total + values * (part / away).sum(axis=1, keepdims=True) / total
        return values, slopes


def weights_of(axes: list[Chebyshev], s: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Weights of the values at the points of a tile, (1 + axes, B, C): of the polynomial at s (B, axes), and of its
    derivatives by coordinates of which s goes `by` (axes,) as fast."""
    both = [axis.lagrange(column) for axis, column in zip(axes, s.T, strict=True)]
    factors = [
        [slopes * by[i] if i == j else values for i, (values, slopes) in enumerate(both)] for j in range(-1, len(both))
    ]
    return np.array([_products(factor, len(s)) for factor in factors])


class RatioTable:
    """Tiles of a model, made on demand. Not for several threads."""

    def __init__(self, model: CurveModel):
        self.model, self.tiles, self.stacks = model, {}, {}
        axes = 1 + len(model.axes)
        self.chebyshev = Chebyshev(_POINTS[min(axes, 4)])
        self.axes = [self.chebyshev] * len(model.axes)
        lattice = (np.arange(_LATTICE) / _LATTICE * WIDE - WIDE / 2) / (WIDE / 2 + _MARGIN)
        self.along_u = self.chebyshev.lagrange(lattice)[0]

    def make(self, place: tuple[int, ...]) -> None:
        """Solve the contacts of a tile. It holds g and its derivatives by the inputs `moved` of the model, (1 + moved,
        _LATTICE, points of the other coordinates), NaN where a contact has no solution.

        Each tile is a batch of its own: the last digits of a solution depend on what is solved with it.
        """
        model, names = self.model, self.model.axes
        middle = (np.array(place) + 0.5) * [WIDE, *map(width, names)]
        half = [WIDE / 2 + _MARGIN, *(width(name) / 2 for name in names)]
        parts = np.stack(
            [grid.ravel() for grid in np.meshgrid(*([self.chebyshev.t] * len(half)), indexing="ij")], axis=-1
        )
        u, *coordinates = (middle + half * parts).T
        values = {name: model.of_coordinate(name, c) for name, c in zip(names, coordinates, strict=True)}
        values = model.within(values)
        x = np.exp(u - model.shift(values))
        hertz = model.hertz(values, x, HERTZ[model.x, model.y][0])
        with np.errstate(all="ignore"):
            rows = [np.log(model.solved(values, x) / hertz)]
            for name in model.moved:
                value = np.broadcast_to(values.get(name, model.value(name)), x.shape)
                by = _MOVE * (1.0 if is_ratio(name) else value)
                ends = [np.log(model.solved(values | {name: value + sign * by}, x)) for sign in (1, -1)]
                rows.append((ends[0] - ends[1]) / (2 * _MOVE))
        g = np.array(rows).reshape(len(rows), self.chebyshev.points, -1)
        self.tiles[place] = np.einsum("lp,rpc->rlc", self.along_u, g)

    def _stack(self, place: tuple[int, ...], count: int) -> np.ndarray:
        """Tiles one after another along ln u."""
        key = (count, *place)
        if key not in self.stacks:
            several = [(place[0] + k, *place[1:]) for k in range(count)]
            for tile in several:
                if tile not in self.tiles:
                    self.make(tile)
            tiles = [self.tiles[tile] for tile in several]
            self.stacks[key] = np.concatenate(tiles, axis=1)
        return self.stacks[key]

    def rows(
        self, coordinates: np.ndarray, first: np.ndarray, count: int, moved: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """g along ln u for B curves, and its derivatives by each coordinate, (axes, B, count * _LATTICE).

        The first array is (1 + moved, B, count * _LATTICE): g, and its derivatives by the inputs `moved` of the model,
        which are numbers only if `moved` is true.

        coordinates : (B, axes)
        first : (B,) the first tile of each curve along ln u
        count : of tiles
        """
        B, names = len(coordinates), self.model.axes
        wide = np.array([width(name) for name in names])
        places = np.floor(coordinates / wide).astype(int)
        weights = weights_of(self.axes, 2 * (coordinates / wide - places) - 1, 2 / wide)
        key = np.column_stack([first, places])
        several = [tuple(place) for place in np.unique(key, axis=0).tolist()]
        rows = np.empty((1 + len(self.model.moved), B, count * _LATTICE))
        by = np.empty((len(names), B, count * _LATTICE))
        for place in several:
            here = (key == place).all(axis=1)
            stack = self._stack(place, count)
            # einsum, not BLAS: the sums of a curve do not depend on how many others stand here
            both = np.einsum("wbc,lc->wbl", weights[:, here], stack[0])
            rows[0, here], by[:, here] = both[0], both[1:]
            if moved and len(stack) > 1:
                rows[1:, here] = np.einsum("bc,rlc->rbl", weights[0, here], stack[1:])
        return rows, by


def _products(factors: list[np.ndarray], B: int) -> np.ndarray:
    """The outer product of factors (B, n1), (B, n2) ... of each row: (B, n1 n2 ...)."""
    whole = np.ones((B, 1))
    for factor in factors:
        whole = (whole[:, :, None] * factor[:, None, :]).reshape(B, -1)
    return whole


class Places:
    """Places (B, n) between the L points of B rows, counted in points. A cubic through four points is read there; from
    1 to L - 3 it is the middle one."""

    def __init__(self, place: np.ndarray, length: int):
        i = np.clip(place.astype(int), 1, length - 3)  # truncation is the floor, as none is below 0
        self.t = place - i
        self.flat = i + length * np.arange(len(place))[:, None] - 1

    def read(self, rows: np.ndarray, slope: bool = False) -> tuple:
        """Values (B, n) of rows (B, L), and their derivatives by the place, or None."""
        t, flat = self.t, rows.reshape(-1)
        a, b, c, d = (flat.take(self.flat + k) for k in range(4))
        second, third = (a + c) / 2 - b, (d - a) / 6 + (b - c) / 2
        first = c - b - second - third
        value = b + t * (first + t * (second + t * third))
        return value, first + t * (2 * second + 3 * t * third) if slope else None
