"""A table of the :class:`.terms.Terms` of a model over the contact radius.

Along x, the logarithm of the radius, a tile of the lattice has _LATTICE points with values and slopes, joined by
cubics.
"""

import numpy as np

from ....inputs.punch.shapes import ANGLES
from ..model import CurveModel, is_ratio
from .ring_table import RingTable
from .terms import Terms, is_modulus
from .tiles import WIDE, WIDE_RATIO, Chebyshev, Lattice, Position

_LATTICE = 16
STEP = WIDE / _LATTICE
#: Number of tiles of a curve from that of its largest radius down, and of tiles below, on which the terms continue as
#: powers.
_TILES, _BELOW = 3, 3
#: Number of lattice points of a curve.
LENGTH = (_TILES + _BELOW) * _LATTICE
#: Number of coordinates of a table -> Chebyshev points of a tile along a modulus, and along another input; widths of
#: these tiles. Those of moduli are wide, since the cost of a tile hardly depends on its number of points. Loads are off
#: by some 2e-5 of the largest (tests/inverse/fits/test_sticking.py).
_OF_MODULI, _POINTS = {1: 18, 2: 16, 3: 12}, {1: 10, 2: 7, 3: 5}
_WIDE_MODULUS, _WIDE = np.log(1000.0), np.log(4.0)
#: Number of tiles, up or down, in the search for the largest radius of a curve.
_FAR = 16
#: Largest ratio of the pull of a ring on the depth to that of the edge of JKR.
_MORE = 1.5


def _width(name: str) -> float:
    return _WIDE_MODULUS if is_modulus(name) else WIDE_RATIO if is_ratio(name) else _WIDE


def _slopes(values: np.ndarray) -> np.ndarray:
    """Derivatives of functions (..., L) at the points of a lattice, by differences of fourth order, at its ends of
    second order."""
    slopes = np.gradient(values, STEP, axis=-1, edge_order=2)
    near, far = values[..., 3:-1] - values[..., 1:-3], values[..., 4:] - values[..., :-4]
    slopes[..., 2:-2] = (8 * near - far) / (12 * STEP)
    return slopes


class TermTable:
    """The logarithms of the terms of a model and their slopes, on tiles that are solved on demand. Only one thread may
    use a table."""

    def __init__(self, model: CurveModel):
        self.model, self.terms = model, Terms.of(model)
        self.axes = self.terms.axes
        count = min(len(self.axes), 3)
        points = [Chebyshev((_OF_MODULI if is_modulus(name) else _POINTS)[count]) for name in self.axes]
        self.lattice = Lattice(points, list(map(_width, self.axes)), 8, _LATTICE)
        rings = model.scene.parameters.get("adhesion") == "maugis"
        self.rings = RingTable(self.terms, points, list(map(_width, self.axes)), _LATTICE) if rings else None

    @property
    def names(self) -> tuple[str, ...]:
        """The unknown inputs by which :meth:`rows` has derivatives."""
        return self.model.unknowns if self.rings else self.axes

    def by(self, name: str, values: dict) -> np.ndarray:
        """Derivatives (4,) or (4, B, 1) of the logarithms of the terms by the coordinate of an input, that are not in
        :meth:`rows`."""
        factors = self.terms.by(name, values)
        if name in ANGLES and name not in self.model.unknowns:  # by the logarithm of the angle, not of its tangent
            angle = np.radians(self.model.value(name))
            factors = factors * (2 * angle / np.sin(2 * angle))
        if self.rings:
            factors[2:] = 0.0
        return factors

    def tile(self, place: tuple[int, ...], moved: bool) -> np.ndarray:
        """A tile: 8 logarithms and slopes, or their derivatives by the inputs `moved` of the model, (1 or moved, 8,
        _LATTICE, C) at C points of the other coordinates."""
        grid = np.meshgrid(*(axis.t for axis in self.lattice.axes), indexing="ij")
        values = {}
        for name, number, wide, t in zip(self.axes, place[1:], self.lattice.wide, grid, strict=True):
            values[name] = self.model.of_coordinate(name, (number + 0.5 + t.ravel() / 2) * wide)
        values = self.model.within(values)
        x = place[0] * WIDE + STEP * np.arange(_LATTICE)
        if not moved:
            return np.ascontiguousarray(np.swapaxes(self.terms.logarithms(values, x), 1, 2))[None]
        still = np.swapaxes(self.lattice.tile_at(self.tile, place)[0], 1, 2)
        changes = [self.terms.moved(name, values, x, still) for name in self.model.moved]
        return np.ascontiguousarray(np.swapaxes(np.array(changes), 2, 3))

    def rows(self, values: dict, deepest: np.ndarray, moved: bool = False) -> np.ndarray:
        """Rows (1 + names + moved, B, 8, LENGTH) of B curves: the logarithms of the terms, with their factors, and
        slopes; then their derivatives, without those of :meth:`by`, by the coordinates of the unknown inputs `names`,
        and by the inputs `moved`.

        values : unknown input -> (B, 1)
        deepest : largest depth in m, (B,); the lattice extends past it
        """
        both = np.column_stack([*(value[:, 0] for value in values.values()), deepest])
        if len(both) % 2 == 0 and (both[::2] == both[1::2]).all():  # a lone curve and the copy that fills up its batch
            alone = {name: value[::2] for name, value in values.items()}
            return np.repeat(self._rows(alone, deepest[::2], moved), 2, axis=1)
        return self._rows(values, deepest, moved)

    def begin(self, values: dict, deepest: np.ndarray) -> np.ndarray:
        """x (B,) at the first point of the lattice of each curve of :meth:`rows`."""
        last = self._last(self._position(values), self._factors(values), deepest)
        return WIDE * (last - _TILES + 1 - _BELOW)

    def _position(self, values: dict) -> Position:
        """The position of B curves among the tiles."""
        B = len(next(iter(values.values())))
        c = np.array([self.model.coordinate(name, values[name])[:, 0] for name in self.axes]).reshape(-1, B).T
        return self.lattice.position(c)

    def _factors(self, values: dict) -> np.ndarray:
        """The logarithms (B, 4) of the factors of B curves."""
        B = len(next(iter(values.values())))
        return np.broadcast_to(self.terms.factors(values).reshape(4, -1), (4, B)).T

    def _rows(self, values: dict, deepest: np.ndarray, moved: bool) -> np.ndarray:
        """As :meth:`rows`."""
        position, factors = self._position(values), self._factors(values)
        last = self._last(position, factors, deepest)
        count = len(self.model.moved) if moved else 0
        whole = self.lattice.read(self.tile, last - _TILES + 1, position, _TILES, count)
        whole[0, :, :4] += factors[:, :, None]
        if self.rings:
            whole = self._with_rings(self.rings, whole, values, position, last - _TILES + 1, moved)
        rows, below = np.empty((*whole.shape[:3], LENGTH)), _BELOW * _LATTICE
        rows[..., below:], rows[..., 4:, :below] = whole, whole[..., 4:, :1]
        rows[..., :4, :below] = whole[..., :4, :1] + whole[..., 4:, :1] * (STEP * np.arange(-below, 0))
        return rows

    def _with_rings(
        self, rings: RingTable, whole: np.ndarray, values: dict, position: Position, first: np.ndarray, moved: bool
    ) -> np.ndarray:
        """Rows with the pulls of rings.

        whole : rows of the table
        first : first tile of the lattice of each curve
        """
        x = WIDE * first[:, None] + STEP * np.arange(whole.shape[3])
        pulls, others = rings.pulls(values, position, first, x, moved)
        names = (*self.names, *(self.model.moved if moved else ()))
        rows = np.zeros((1 + len(names), *whole.shape[1:]))
        rows[0, :, [0, 1, 4, 5]] = whole[0, :, [0, 1, 4, 5]]
        rows[0, :, [2, 3, 6, 7]] = np.moveaxis(pulls, 1, 0)
        tabulated = dict(zip((*self.axes, *(self.model.moved if moved else ())), whole[1:], strict=True))
        for row, name, other in zip(rows[1:], names, others, strict=True):
            if name in tabulated:
                row[:, [0, 1, 4, 5]] = tabulated[name][:, [0, 1, 4, 5]]
            row[:, 2:4], row[:, 6:] = other, _slopes(other)
        return rows

    def _last(self, position: Position, factors: np.ndarray, deepest: np.ndarray) -> np.ndarray:
        """The tile (B,) in which each curve reaches its largest depth. At the end of the tile the depth is larger, and
        rises."""
        last = np.floor(np.log(np.maximum(np.sqrt(deepest / self._depth()), 1e-9)) / WIDE).astype(int)

        def reached(index: np.ndarray, tile: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            """Whether the depth at the end of a tile exceeds the largest one and rises, and whether there is one."""
            rows = self.lattice.read_end(self.tile, tile, position.values_of(index))
            f = np.exp(rows[:, :4] + factors[index])
            f[:, 3] *= _MORE if self.rings else 1.0
            depth, slope = f[:, 1] - f[:, 3], f[:, 1] * rows[:, 5] - f[:, 3] * rows[:, 7]
            return (depth > deepest[index]) & (slope > 0), np.isfinite(depth)

        is_first, left = np.ones(len(last), bool), np.arange(len(last))
        for _ in range(_FAR):
            if len(left):
                is_past, usable = reached(left, last[left])
                left = left[~is_past & usable]
                last[left] += 1
                is_first[left] = False
        left = np.flatnonzero(is_first)  # for others the search came from below
        for _ in range(_FAR):
            if len(left):
                left = left[reached(left, last[left] - 1)[0]]
                last[left] -= 1
        return last

    def _depth(self) -> float:
        """The depth in m of a paraboloid whose radius of contact in a half-space is the unit of radii: D = a²/R."""
        scene = self.model.scene
        return float(np.mean(scene.values.get(self.terms.length, scene.R)) ** 2 / np.mean(scene.R))
