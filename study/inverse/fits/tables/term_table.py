"""A table of the :class:`.terms.Terms` of a model over the contact radius.

Along x, the logarithm of the radius, a tile of the lattice has _LATTICE points with values and slopes, between which a
cubic is drawn.
"""

import numpy as np

from ..model import CurveModel, is_ratio
from .terms import Terms, is_modulus
from .tiles import WIDE, WIDE_RATIO, Chebyshev, Lattice, Position

_LATTICE = 16
STEP = WIDE / _LATTICE
#: Tiles of a curve from that of its largest radius down, and tiles below, to which the terms go on as powers.
_TILES, _BELOW = 3, 3
#: Points of the lattice of a curve.
LENGTH = (_TILES + _BELOW) * _LATTICE
#: Chebyshev points of a tile along each coordinate, of tables with one, two and more coordinates, and its width: of
#: moduli, whose tiles are wide, as what a tile costs is hardly a matter of its points; and of other inputs. Loads are
#: off by some 2e-5 of the largest (tests/inverse/fits/test_sticking.py).
_OF_MODULI, _POINTS = {1: 18, 2: 16, 3: 12}, {1: 10, 2: 7, 3: 5}
_WIDE_MODULUS, _WIDE = np.log(1000.0), np.log(4.0)
#: So many tiles up or down the largest radius of a curve is searched.
_FAR = 16


def _width(name: str) -> float:
    return _WIDE_MODULUS if is_modulus(name) else WIDE_RATIO if is_ratio(name) else _WIDE


class TermTable:
    """The logarithms of the terms of a model and their slopes, on tiles that are solved on demand. Not for several
    threads."""

    def __init__(self, model: CurveModel):
        self.model, self.terms = model, Terms.of(model)
        self.axes = self.terms.axes
        count = min(len(self.axes), 3)
        points = [Chebyshev((_OF_MODULI if is_modulus(name) else _POINTS)[count]) for name in self.axes]
        self.lattice = Lattice(points, list(map(_width, self.axes)), 8, _LATTICE)

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
        still = np.swapaxes(self.lattice.made(self.tile, place)[0], 1, 2)
        changes = [self.terms.moved(name, values, x, still) for name in self.model.moved]
        return np.ascontiguousarray(np.swapaxes(np.array(changes), 2, 3))

    def rows(self, values: dict, deepest: np.ndarray, moved: bool = False) -> np.ndarray:
        """Rows (1 + axes + moved, B, 8, LENGTH) of B curves: the logarithms of the terms, with their factors, and
        slopes; their derivatives by the coordinates of unknown inputs and, without those of the factors, by the inputs
        `moved`.

        values : unknown input -> (B, 1)
        deepest : (B,) in m; the lattice reaches beyond it
        """
        both = np.column_stack([*(value[:, 0] for value in values.values()), deepest])
        _, first, same = np.unique(both, axis=0, return_index=True, return_inverse=True)
        alone = {name: value[first] for name, value in values.items()}
        return self._rows(alone, deepest[first], moved)[:, same.ravel()]

    def _rows(self, values: dict, deepest: np.ndarray, moved: bool) -> np.ndarray:
        """`rows` of curves of which no two are the same."""
        B = len(deepest)
        c = np.array([self.model.coordinate(name, values[name])[:, 0] for name in self.axes]).reshape(-1, B).T
        position = self.lattice.position(c)
        factors = np.broadcast_to(self.terms.factors(values).reshape(4, -1), (4, B)).T
        last = self._last(position, factors, deepest)
        count = len(self.model.moved) if moved else 0
        whole = self.lattice.read(self.tile, last - _TILES + 1, position, _TILES, count)
        whole[0, :, :4] += factors[:, :, None]
        below = STEP * np.arange(-_BELOW * _LATTICE, 0)
        first = (
            whole[..., :4, :1] + whole[..., 4:, :1] * below,
            np.broadcast_to(whole[..., 4:, :1], (*whole.shape[:2], 4, len(below))),
        )
        return np.concatenate([np.concatenate(first, axis=2), whole], axis=3)

    def _last(self, position: Position, factors: np.ndarray, deepest: np.ndarray) -> np.ndarray:
        """The tile (B,) in which each curve reaches its largest depth: at its end the depth is larger and rises."""
        last = np.floor(np.log(np.maximum(np.sqrt(deepest / self._depth()), 1e-9)) / WIDE).astype(int)
        up, down = np.ones(len(last), bool), np.ones(len(last), bool)
        for step in range(2 * _FAR):
            left = np.flatnonzero(up if step < _FAR else down & ~up)
            if not len(left):
                continue
            first = last[left] - (0 if step < _FAR else 1)
            rows = self.lattice.read(self.tile, first, position.values_of(left), 1)[0, :, :, -1]
            f = np.exp(rows[:, :4] + factors[left])
            depth, slope = f[:, 1] - f[:, 3], f[:, 1] * rows[:, 5] - f[:, 3] * rows[:, 7]
            beyond = (depth > deepest[left]) & (slope > 0)
            if step < _FAR:
                on = ~beyond & np.isfinite(depth)
                last[left[on]] += 1
                up[left[~on]] = False
                down[left[on]] = False  # it was looked for from below
            else:
                last[left[beyond]] -= 1
                down[left[~beyond]] = False
        return last

    def _depth(self) -> float:
        """The depth in m of a paraboloid whose radius of contact in a half-space is the unit of radii: D = a²/R."""
        scene = self.model.scene
        return float(np.mean(scene.values.get(self.terms.length, scene.R)) ** 2 / np.mean(scene.R))
