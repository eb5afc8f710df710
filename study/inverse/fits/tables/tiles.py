"""A fixed lattice of tiles, computed where a table needs them: polynomials through Chebyshev points.

The first coordinate of a table is its abscissa, a logarithm, along which a tile has evenly spaced points. Along the
other coordinates, those of unknown inputs, it has Chebyshev points. The lattice is fixed, so that the numbers of a
curve do not depend on other curves.
"""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

#: Width of a tile along the abscissa, and along a Poisson ratio.
WIDE, WIDE_RATIO = np.log(16.0), 0.25


class Chebyshev:
    """Polynomials through Chebyshev points `t` of the first kind."""

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


Tile = Callable[[tuple[int, ...], bool], np.ndarray]


class Position(NamedTuple):
    """The places of B curves among the tiles.

    numbers : (B, axes), number of the tile along each coordinate of the unknown inputs
    weights : (1 + axes, B, C), weights of the C points of that tile, for a value and its derivative by each coordinate
    """

    numbers: np.ndarray
    weights: np.ndarray

    def values_of(self, index: np.ndarray) -> "Position":
        """Some of the curves, without the weights for derivatives."""
        return Position(self.numbers[index], self.weights[:1, index])


class Lattice:
    """The tiles of one table. Only one thread may use a lattice.

    axes, wide : Chebyshev points and width of a tile along each coordinate of the unknown inputs
    parts, points : number of tabulated functions, and of points of a tile along the abscissa

    The table computes the tiles. The argument `tile` of the methods is its function of a place, whole numbers along the
    abscissa and each coordinate, and of `moved`. It returns the tile, (rows, parts, points, C). A single row has the
    values. With `moved` each row has their derivatives by one of the moved inputs. The lattice does not keep the
    function, which belongs to the table: so the tiles are freed as soon as the table is.
    """

    def __init__(self, axes: list[Chebyshev], wide: list[float], parts: int, points: int):
        self.axes, self.wide, self.parts, self.points = axes, np.array(wide, float), parts, points
        self.tiles: dict[tuple, np.ndarray] = {}
        self.stacks: dict[tuple, np.ndarray] = {}

    def position(self, coordinates: np.ndarray) -> Position:
        """The position of curves with coordinates (B, axes)."""
        numbers = np.floor(coordinates / self.wide).astype(int)
        s, by = 2 * (coordinates / self.wide - numbers) - 1, 2 / self.wide
        both = [axis.lagrange(column) for axis, column in zip(self.axes, s.T, strict=True)]
        factors = [
            [slopes * by[i] if i == j else values for i, (values, slopes) in enumerate(both)]
            for j in range(-1, len(both))
        ]
        return Position(numbers, np.array([_products(factor, len(s)) for factor in factors]))

    def read(self, tile: Tile, first: np.ndarray, position: Position, count: int, moved: int = 0) -> np.ndarray:
        """Rows (weights + moved, B, parts, points) of B curves along `count` tiles: values, their derivatives by the
        coordinates and, if there are `moved` inputs, by these.

        first : (B,), the first tile along the abscissa
        """
        weights = position.weights
        rows = np.empty((len(weights) + moved, len(first), self.parts, count * self.points))
        for place, curves in _groups(first, position):
            # einsum, not BLAS: the sums of a curve must not depend on the number of other curves
            values = self._stack(tile, place, count, False)[0]
            rows[: len(weights), curves] = np.einsum("wbc,ilc->wbil", weights[:, curves], values)
            if moved:
                changes = self._stack(tile, place, count, True)
                rows[len(weights) :, curves] = np.einsum("bc,kilc->kbil", weights[0, curves], changes)
        return rows

    def read_end(self, tile: Tile, first: np.ndarray, position: Position) -> np.ndarray:
        """The values (B, parts) of B curves at the last point of the tile `first` (B,) along the abscissa."""
        values = np.empty((len(first), self.parts))
        for place, curves in _groups(first, position):
            values[curves] = np.einsum("bc,ic->bi", position.weights[0, curves], self.tile_at(tile, place)[0, :, -1])
        return values

    def tile_at(self, tile: Tile, place: tuple[int, ...], moved: bool = False) -> np.ndarray:
        """The tile at a place."""
        if (moved, *place) not in self.tiles:
            self.tiles[moved, *place] = tile(place, moved)
        return self.tiles[moved, *place]

    def _stack(self, tile: Tile, place: tuple[int, ...], count: int, moved: bool) -> np.ndarray:
        """Consecutive tiles along the abscissa."""
        key = (moved, count, *place)
        if key not in self.stacks:
            tiles = [self.tile_at(tile, (place[0] + k, *place[1:]), moved) for k in range(count)]
            self.stacks[key] = np.concatenate(tiles, axis=2) if count > 1 else tiles[0]
        return self.stacks[key]


def _groups(first: np.ndarray, position: Position) -> Iterator[tuple[tuple[int, ...], Any]]:
    """Each place of a tile, and the curves (m,) there, or a slice of all: by the tile `first` (B,) of B curves."""
    key = np.column_stack([first, position.numbers])
    alike = bool((key == key[:1]).all())  # most often: and to sort rows takes longer than all else
    for place in map(tuple, (key[:1] if alike else np.unique(key, axis=0)).tolist()):
        yield place, slice(None) if alike else np.flatnonzero((key == place).all(axis=1))


def _products(factors: list[np.ndarray], B: int) -> np.ndarray:
    """The outer product of factors (B, n1), (B, n2) ... of each row: (B, n1 n2 ...)."""
    whole = np.ones((B, 1))
    for factor in factors:
        whole = (whole[:, :, None] * factor[:, None, :]).reshape(B, -1)
    return whole
