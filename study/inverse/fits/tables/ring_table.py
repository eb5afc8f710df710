"""A table of :mod:`solver.smooth.adhesion.rings` over the contact radius and the width of a ring.

It holds ratios: each part over that of a ring around a rigid paraboloid on a half-space, which is known in closed form.
The ring of a curve follows from its work of adhesion and its stress, so these are not coordinates of the table. For a
rigid paraboloid on a half-space all ratios are 1, and nothing is tabulated.

Along x, the variable of the radius, the tiles are those of :mod:`.term_table`. Along y, the logarithm of the width over
the unit of length, each tile has a separate lattice, and Chebyshev points. Along a curve c - a hardly changes.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from solver.shapes import PARABOLOID
from solver.smooth.adhesion.rings import rings

from ....inputs.punch.shapes import ANGLES
from ....inputs.scene.scene import with_unit
from ..model import is_ratio
from .terms import Terms, is_modulus
from .tiles import WIDE, Chebyshev, Lattice, Position

#: Powers of E, of the unit of lengths, of R and of the cotangent in the parts gap, opening, load and depth; and those
#: that differ for a paraboloid and a cone, under which lengths act only through a/h.
_POWERS = {"E": (0, -1, 0, -1), "length": (1, 1, 2, 1), **dict.fromkeys(("w", "R", "cotangent"), (0, 0, 0, 0))}
_SIMILAR, _CONE = {"length": (2, 1, 2, 1), "R": (-1, 0, 0, 0)}, {"cotangent": (1, 0, 0, 0)}
#: SI powers of the modulus and of R in the parts.
_OF_PARTS = ((0, 1), (-1, 1), (0, 2), (-1, 1))
#: Number of Chebyshev points of a tile along x and along y. Loads are off by some 6e-6 of the largest
#: (tests/inverse/fits/test_sticking.py).
_POINTS, _WIDTHS = 12, 10
#: Logarithm of the least width over the radius. Narrower rings have the same ratios, to about this relative width.
_NARROW = np.log(1e-5)
#: Largest number of steps of the search for y, first by rings in closed form, then by the table. The search ends with a
#: step below _NEAR, the first one below _CLOSE, after which the error is the square; and the longest step.
_STEPS, _CLOSE, _NEAR, _LONGEST = 12, 1e-4, 1e-11, 3.0
#: Number of curves that are searched together.
_TOGETHER = 128
#: Relative change of inputs for derivatives by their logarithms (ratios: change of the ratio).
_MOVE = 1e-5


class RingParts(NamedTuple):
    """The four parts at N points, (4, N) each: values, and their derivatives by x and y."""

    value: np.ndarray
    by_x: np.ndarray
    by_y: np.ndarray


class _Sought(NamedTuple):
    """B curves whose rings are searched.

    scale : of the parts, (4, B)
    sigma, wanted : σ₀, and w/σ₀, (B,)
    """

    scale: np.ndarray
    sigma: np.ndarray
    wanted: np.ndarray


class RingTable:
    """The parts of the rings of a model, on tiles that are solved on demand. Only one thread may use a table.

    axes, wide : Chebyshev points and width of a tile along each coordinate of `terms`
    points : of a tile along x
    """

    def __init__(self, terms: Terms, axes: list[Chebyshev], wide: list[float], points: int):
        similar = _CONE if terms.powers["cotangent"].any() else _SIMILAR if terms.powers["length"].any() else {}
        powers = {name: np.array(row, float) for name, row in (_POWERS | similar).items()}
        self.terms, self.model, self.points = terms._replace(powers=powers), terms.model, points
        self.axes, self.wide = axes, wide
        self.along_x, self.along_y = Chebyshev(_POINTS), Chebyshev(_WIDTHS)
        places = 2 * np.arange(points) / points - 1
        self.of_x = np.stack(self.along_x.lagrange(places)) * np.array([1.0, 2 / WIDE])[:, None, None]
        self.lattices: dict[int, Lattice] = {}
        scene = self.model.scene
        moduli = [scene.values[name] for name in scene.values if is_modulus(name) and name != self.model.modulus]
        usual = scene.parameters.get("shape", PARABOLOID) == PARABOLOID
        self.in_closed_form = (
            usual and scene.parameters.get("base", "layered") == "half_space" and bool(np.isinf(moduli).all())
        )

    def pulls(self, values: dict, position: Position, first: np.ndarray, x: np.ndarray, moved: bool = False) -> tuple:
        """The logarithms of the pulls of attraction on load and depth and their slopes by x, (B, 4, L), at x (B, L) of
        B curves; and their derivatives (names, B, 2, L) by the coordinates of all unknown inputs and, if `moved`, by
        the inputs `moved` of the model.

        first : (B,), the tile of the first point of each curve; the points are those of the lattice
        """
        rows, others = [], []
        for low in range(0, len(x), _TOGETHER):
            part = slice(low, low + _TOGETHER)
            few = {name: value[part] for name, value in values.items()}
            position_of_part = Position(position.numbers[part], position.weights[:, part])
            row, other = self._pulls(few, position_of_part, first[part], x[part], moved)
            rows.append(row)
            others.append(other)
        return np.concatenate(rows), np.concatenate(others, axis=1)

    def _pulls(self, values: dict, position: Position, first: np.ndarray, x: np.ndarray, moved: bool) -> tuple:
        B, sigma, w = len(x), *self._of_law(values, len(x))
        scale = np.exp(np.broadcast_to(self.terms.factors(values).reshape(4, -1), (4, B)))
        sought = _Sought(scale, sigma, w / sigma)
        read = _Closed(x) if self.in_closed_form else _Read(self, position, first, x, moved)
        y = self._searched(read, sought)
        parts, rows = read.parts(y), read.rows(y)
        value, by_x, by_y = (array * scale[:, :, None] for array in parts)
        s = sigma[:, None]
        G, G_x, G_y = (array[0] + s * array[1] for array in (value, by_x, by_y))
        follows = -G_x / G_y
        pull = value[2:]
        slopes = (by_x[2:] + by_y[2:] * follows) / pull
        names = (*self.model.unknowns, *(self.model.moved if moved else ()))
        others = np.empty((len(names), B, 2, x.shape[1]))
        for k, name in enumerate(names):
            of_scale = self._by(name, values)
            of_sigma, of_w = self._by_law(name)
            changes = value * of_scale + scale[:, :, None] * rows.get(name, 0.0)
            of_G = changes[0] + s * (changes[1] + of_sigma * value[1])
            of_y = (sought.wanted[:, None] * (of_w - of_sigma) - of_G) / G_y
            others[k] = np.moveaxis(of_sigma + (changes[2:] + by_y[2:] * of_y) / pull, 1, 0)
        taken = np.log(np.where(-pull > 0, -pull, np.nan)) + np.log(s)
        return np.moveaxis(np.concatenate([taken, slopes]), 1, 0), others

    def _searched(self, read: "_Read | _Closed", sought: _Sought) -> np.ndarray:
        """y (B, L) of the rings with the given work of adhesion, NaN where there is no such ring."""
        s, wanted = sought.sigma[:, None], np.log(sought.wanted)[:, None]
        near = np.log(np.pi / 4 * sought.wanted / (sought.sigma * sought.scale[1]))
        y = np.minimum(near, np.log(2 * sought.wanted / sought.scale[0]) / 2)[:, None] + 0 * read.x

        def step(parts: RingParts) -> np.ndarray:
            gap, opening = parts.value[:2] * sought.scale[:2, :, None]
            of_gap, of_opening = parts.by_y[:2] * sought.scale[:2, :, None]
            G = gap + s * opening
            return np.clip((wanted - np.log(G)) * G / (of_gap + s * of_opening), -_LONGEST, _LONGEST)

        for parts, last_step in ((_Closed(read.x).parts, _CLOSE), (read.parts, _NEAR)):
            left = np.ones(y.shape, bool)
            for _ in range(_STEPS):
                by = np.where(left, step(parts(y, left)), 0.0)
                y, left = y + by, left & (np.abs(by) >= last_step)
                if not left.any():
                    break
        return y

    def _of_law(self, values: dict, B: int) -> tuple[np.ndarray, np.ndarray]:
        """σ₀ and w (B,)."""
        every = {name: np.reshape(value, -1) for name, value in (self.model.scene.values | values).items()}
        w = every["w_adhesion"]
        sigma = every["sigma0"] if "sigma0" in every else w / (0.97 * every["z0"])
        return np.broadcast_to(sigma, B), np.broadcast_to(w, B)

    def _by_law(self, name: str) -> tuple[float, float]:
        """Derivatives of the logarithms of σ₀ and w by the coordinate of an input."""
        if "sigma0" in self.model.scene.values:
            return float(name == "sigma0"), float(name == "w_adhesion")
        return float(name == "w_adhesion") - float(name == "z0"), float(name == "w_adhesion")

    def _by(self, name: str, values: dict) -> np.ndarray:
        """Derivatives (4, B, 1) of the logarithms of the scales by the coordinate of an input."""
        by = np.asarray(self.terms.by(name, values), float)
        if name in ANGLES and name not in self.model.unknowns:  # by the logarithm of the angle, not of its tangent
            angle = np.radians(self.model.value(name))
            by = by * (2 * angle / np.sin(2 * angle))
        return by.reshape(4, -1, 1)

    def lattice(self, number: int) -> Lattice:
        """The lattice of a tile along y."""
        if number not in self.lattices:
            self.lattices[number] = Lattice(self.axes, self.wide, 8 * _WIDTHS, self.points)
        return self.lattices[number]

    def tile(self, number: int, place: tuple[int, ...], moved: bool) -> np.ndarray:
        """The tile `number` along y at a place: ratios of the four parts and their slopes by x, at the points along y,
        or their derivatives by the inputs `moved`, (1 or moved, 8 _WIDTHS, points, C)."""
        grid = np.meshgrid(*(axis.t for axis in self.axes), indexing="ij")
        values = {}
        for name, at, wide, t in zip(self.terms.axes, place[1:], self.wide, grid, strict=True):
            values[name] = self.model.of_coordinate(name, (at + 0.5 + t.ravel() / 2) * wide)
        values = self.model.within(values)
        middle = (np.array([place[0], number]) + 0.5) * WIDE
        x, y = (m + WIDE / 2 * axis.t for m, axis in zip(middle, (self.along_x, self.along_y), strict=True))
        still = self._ratios(values, x, y)
        changes = [still]
        if moved:
            changes = [self._moved(name, values, (x, y), still) for name in self.model.moved]
        rows = np.einsum("dlx,rfcxy->rfdylc", self.of_x, np.array(changes))
        return np.ascontiguousarray(rows.reshape(len(rows), 8 * _WIDTHS, self.points, -1))

    def _moved(self, name: str, values: dict, xy: tuple, still: np.ndarray) -> np.ndarray:
        """Derivatives of ratios by the logarithm of an input that is not unknown (by a Poisson ratio itself).

        still : the ratios without a change of the input
        """
        if name in ("k_machine", "w_adhesion", "sigma0", "z0"):
            return 0 * still
        value = np.full(still.shape[1], self.model.value(name))
        by = _MOVE * (-1.0 if is_ratio(name) else value)  # a ratio of 0.5 must not rise
        return (self._ratios(values | {name: value + by}, *xy) - still) / (-_MOVE if is_ratio(name) else _MOVE)

    def _ratios(self, values: dict[str, np.ndarray], x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """The parts over those in closed form, (4, C, X, Y), of contacts with values (C,) of inputs."""
        count = len(next(iter(values.values()), np.zeros(1)))
        changed, names = self.terms.numbers(values)
        problem = changed.lexicon.problem(names, a=np.full(count, 0.01))
        X, Y = (array.ravel() for array in np.meshgrid(x, y, indexing="ij"))
        shift = np.reshape(np.log(names["h"]) if self.terms.length == "h" else 0.0, (-1, 1))
        parts = rings(problem, np.broadcast_to(X + shift, (count, len(X))), np.exp(Y + shift) * np.ones((count, 1)))
        scale = np.exp(np.broadcast_to(self.terms.factors(values).reshape(4, -1), (4, count)))
        units = [np.broadcast_to(with_unit(1.0, powers, changed.unit, changed.R), (count,)) for powers in _OF_PARTS]
        unit = np.array(units) / scale
        ratios = np.array(parts) * unit[:, :, None] / closed(X[None], Y[None]).value
        return ratios.reshape(4, count, len(x), len(y))


class _Closed(NamedTuple):
    """The values of a :class:`RingTable` in closed form at x (B, L) of curves."""

    x: np.ndarray

    def parts(self, y: np.ndarray, wanted: np.ndarray | None = None) -> RingParts:
        """The :class:`RingParts` (4, B, L) without scales at y (B, L)."""
        return closed(self.x, y)

    def rows(self, y: np.ndarray) -> dict[str, np.ndarray]:
        """Derivatives of the parts without scales by inputs: none."""
        return {}


class _Read:
    """The values of a :class:`RingTable` at x (B, L) of curves, on the tiles that are needed."""

    def __init__(self, table: RingTable, position: Position, first: np.ndarray, x: np.ndarray, moved: bool):
        self.table, self.position, self.first, self.x = table, position, first, x
        self.moved = len(table.model.moved) if moved else 0
        self.names = (*table.terms.axes, *(table.model.moved if moved else ()))
        self.tiles: dict[tuple[int, int], tuple[np.ndarray, np.ndarray]] = {}

    def parts(self, y: np.ndarray, wanted: np.ndarray | None = None) -> RingParts:
        """The :class:`RingParts` (4, B, L) without scales at y (B, L), NaN where they are not `wanted`."""
        out = np.full((3, 4, *y.shape), np.nan)
        plain = closed(self.x, y)
        for points, coefficients, weights, by_weights, narrow in self._points(y, wanted):
            c = coefficients[0].reshape(len(weights), 4, 2, _WIDTHS)
            ratio, of_x = np.einsum("pfdn,pn->dfp", c, weights)
            of_y = np.einsum("pfn,pn->fp", c[:, :, 0], by_weights)
            of_x, of_y = of_x + np.where(narrow, of_y, 0.0), np.where(narrow, 0.0, of_y)
            value, by_x, by_y = (array[:, *points] for array in plain)
            out[:, :, *points] = value * ratio, by_x * ratio + value * of_x, by_y * ratio + value * of_y
        return RingParts(*out)

    def rows(self, y: np.ndarray) -> dict[str, np.ndarray]:
        """Derivatives (4, B, L) of the parts without scales by the coordinates of the table, and by `moved` inputs."""
        out = np.full((len(self.names), 4, *y.shape), np.nan)
        plain = closed(self.x, y).value
        for points, coefficients, weights, *_ in self._points(y, None):
            c = coefficients[1:].reshape(len(self.names), len(weights), 4, 2, _WIDTHS)[:, :, :, 0]
            out[:, :, *points] = np.einsum("kpfn,pn->kfp", c, weights) * plain[:, *points]
        return dict(zip(self.names, out, strict=True))

    def _points(self, y: np.ndarray, wanted: np.ndarray | None) -> Iterator[tuple]:
        """For each tile the N points in it: their curves and places along x, coefficients (rows, N, 8 _WIDTHS), weights
        and their derivatives (N, _WIDTHS), and whether rings are narrower than those of the table, (N,)."""
        low = self.x + _NARROW
        at = np.maximum(y, low)
        wanted = np.isfinite(at) if wanted is None else wanted & np.isfinite(at)
        number = np.floor(np.where(wanted, at, 0.0) / WIDE).astype(int)
        size = self.table.points
        for k in np.unique(number[wanted]).tolist():
            for tile in range(self.x.shape[1] // size):
                part = slice(tile * size, (tile + 1) * size)
                curve, place = np.nonzero(wanted[:, part] & (number[:, part] == k))
                if len(curve):
                    rows, row = self._tile(k, tile, np.unique(curve))
                    points = curve, place + tile * size
                    weights, by = self.table.along_y.lagrange(2 * (at[points] / WIDE - k) - 1)
                    coefficients = np.moveaxis(rows[:, row[curve], :, place], 0, 1)
                    yield points, coefficients, weights, by * (2 / WIDE), (y < low)[points]

    def _tile(self, number: int, along: int, curves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Rows (1 + axes + moved, some curves, 8 _WIDTHS, points) of a tile, and the place of each curve in them."""
        rows, places = self.tiles.get((number, along), (None, np.full(len(self.x), -1)))
        new = curves[places[curves] < 0]
        if len(new):
            table = self.table
            position = Position(self.position.numbers[new], self.position.weights[:, new])

            def tile(place: tuple[int, ...], moved: bool) -> np.ndarray:
                return table.tile(number, place, moved)

            more = table.lattice(number).read(tile, self.first[new] + along, position, 1, self.moved)
            places[new] = np.arange(len(new)) + (0 if rows is None else rows.shape[1])
            rows = more if rows is None else np.concatenate([rows, more], axis=1)
            self.tiles[number, along] = rows, places
        return rows, places


def closed(x: np.ndarray, y: np.ndarray) -> RingParts:
    """The :class:`RingParts` (4, ...) of rings around a paraboloid r²/2 on a half-space with E = 1, of radius a = e^x
    and width c - a = e^y (Maugis, J. Colloid Interface Sci. 150, 1992). With m = c/a = 1/cos t

        gap = a² [tan t + (m² - 2) t]/π,    opening = 4a (t tan t - m + 1)/π,    load = -2 a² (tan t + m² t),
        depth = -2 a tan t.
    """
    a, over = np.exp(x), np.exp(y - x)
    m, tan = 1 + over, np.sqrt(over * (2 + over))
    t = np.arctan(tan)
    gap, opening = a**2 / np.pi * (tan - t + t * tan**2), 4 * a / np.pi * (t * tan - over)
    load, depth = -2 * a**2 * (tan + m**2 * t), -2 * a * tan
    # dt/dm = 1/(m tan t), d tan t/dm = m/tan t
    of_gap = a**2 / np.pi * (m / tan + (m**2 - 2) / (m * tan) + 2 * m * t)
    of_opening = 4 * a / np.pi * (1 / m + t * m / tan - 1)
    of_load, of_depth = -2 * a**2 * (2 * m / tan + 2 * m * t), -2 * a * m / tan
    by_y = np.array([of_gap, of_opening, of_load, of_depth]) * over
    value = np.array([gap, opening, load, depth])
    powers = np.array([2.0, 1.0, 2.0, 1.0]).reshape(4, *[1] * value[0].ndim)
    return RingParts(value, powers * value - by_y, by_y)
