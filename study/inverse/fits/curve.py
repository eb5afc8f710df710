"""The model of measured curves: y = F(x - D0; inputs) + P0 + tilt x, and its derivatives by the unknowns."""

from dataclasses import dataclass

import numpy as np

from solver.numerics import batch

from .model import HERTZ
from .tables.branch import Loads, branch
from .tables.ratio_table import STEP, Cubics, RatioTable
from .tables.sticking_points import StickingPoints
from .tables.term_table import TermTable
from .tables.tiles import WIDE

_TILES = 4  # number of tiles along ln u, from the largest depth down; they cover more than _REACH
_REACH = np.log(800.0)  # below 1/800 of twice the range of x the curve continues as a power of x


@batch.of_cases
@dataclass
class MeasuredCurves:
    """B curves of n points. Their unknowns are the inputs of the model, then D0/wide, P0/high and tilt wide/high.

    table : of the model
    x : (B, n), SI
    wide, high : units of x and y of each curve, (B,)
    shifts : those of "D0", "P0", "tilt" that are unknown
    points : for curves with adhesion, the choice of points in contact; None: the loads of the branch at all depths
    ends : whether retractions have no load after the end of the branch; otherwise a ramp guides the search
    """

    table: RatioTable | TermTable
    x: np.ndarray
    wide: np.ndarray
    high: np.ndarray
    shifts: tuple[str, ...]
    points: StickingPoints | None = None
    ends: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        return (*self.table.model.unknowns, *self.shifts)

    def values(self, p: np.ndarray) -> dict[str, np.ndarray]:
        """Input -> its SI values (B, 1)."""
        model = self.table.model
        return {name: model.of_coordinate(name, p[:, i : i + 1]) for i, name in enumerate(model.unknowns)}

    def __call__(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """y/high (B, n), and derivatives (B, n, k)."""
        F, by, _ = self.contact(p)
        J = np.zeros((*self.x.shape, len(self.names)))
        model = self.table.model
        for i, name in enumerate(model.unknowns):
            J[:, :, i] = by[name]
        total = F
        for name, column in zip(self.shifts, range(len(model.unknowns), len(self.names)), strict=True):
            if name == "D0":
                J[:, :, column] = -by["x"] * self.wide[:, None]
            elif name == "P0":
                J[:, :, column] = 1.0
                total = total + p[:, column : column + 1]
            else:
                J[:, :, column] = self.x / self.wide[:, None]
                total = total + p[:, column : column + 1] * J[:, :, column]
        return total, J

    def contact(self, p: np.ndarray, moved: bool = False) -> tuple[np.ndarray, dict, np.ndarray]:
        """F/high (B, n), 0 outside the contact, and its derivatives by x and the unknown inputs (name -> (B, n)).

        The third value has its derivatives by the inputs `moved` of the model, (moved, B, n), if `moved` is true.
        """
        model, values = self.table.model, self.values(p)
        if isinstance(self.table, TermTable):
            return self._sticking(self.table, p, values, moved)
        depth = self.x - (p[:, [self.names.index("D0")]] * self.wide[:, None] if "D0" in self.shifts else 0.0)
        inside = depth > 0
        depth = np.where(inside, depth, 1e-12 * self.wide[:, None])
        shift = np.broadcast_to(model.shift(values), (len(p), 1))
        deepest = np.log(2 * self.wide)[:, None] + shift
        u = np.log(depth) + shift
        above = np.maximum(u, deepest - _REACH)
        last = np.floor(deepest[:, 0] / WIDE).astype(int)
        first = last - (_TILES - 1)
        coordinates = p[:, [model.unknowns.index(name) for name in model.axes]]
        rows = self.table.rows(coordinates, first, _TILES, moved)
        cubics = Cubics((above - first[:, None] * WIDE) / STEP, rows.shape[2])
        g, slope = cubics.read(rows[0], slope=True)
        slope = slope / STEP
        power, (_, *of_u) = HERTZ[model.x, model.y]
        with np.errstate(over="ignore", invalid="ignore"):
            F = model.hertz(values, depth, power) * np.exp(g + slope * (u - above)) / self.high[:, None]
        F = np.where(inside, F, 0.0)
        by = {"x": F * (power[0] + slope) / depth}
        for name in model.unknowns:
            by[name] = F * self._log_slope(name, values, power, of_u, slope, rows[1:], cubics)
        others = [F * cubics.read(row)[0] for row in rows[1 + len(model.axes) :]]
        return F, by, np.array(others)

    def _sticking(
        self, table: TermTable, p: np.ndarray, values: dict, moved: bool
    ) -> tuple[np.ndarray, dict, np.ndarray]:
        """`contact` with adhesion; without adhesion at points that do not adhere."""
        model = table.model
        shift = {name: p[:, [self.names.index(name)]] for name in self.shifts}
        depth = self.x - shift.get("D0", 0.0) * self.wide[:, None]
        loads = branch(table.rows(values, depth.max(axis=1), moved), depth)
        base = shift.get("P0", 0.0) + shift.get("tilt", 0.0) * self.x / self.wide[:, None]
        high, contact = self.high[:, None], np.ones(depth.shape, bool)
        if self.points is not None:
            deep = depth > np.maximum(loads.D_least, 0.0)[:, None]
            contact = self.points.in_contact(loads.sticks.P / high, loads.free.P / high, base, deep)
            contact |= self.points.retracts[:, None]
            if self.ends:
                off = self.points.retracts[:, None] & (depth < loads.D_off[:, None])
                loads = loads._replace(sticks=Loads(*(np.where(off, 0.0, array) for array in loads.sticks)))
        P, slope, by_rows, by_parts = (
            np.where(contact, *pair) / high for pair in zip(loads.sticks, loads.free, strict=True)
        )
        by = {"x": slope}
        rows = dict(zip((*table.names, *(model.moved if moved else ())), by_rows, strict=True))
        for name in (*model.unknowns, *(model.moved if moved else ())):
            factors = table.by(name, values)
            by[name] = rows.get(name, 0.0) + sum(factors[i] * by_parts[i] for i in range(4))
        others = [by[name] for name in model.moved] if moved else []
        return P, by, np.array(others)

    def _log_slope(self, name, values, power, of_u, slope, by_axis, cubics):
        """d ln F by the coordinate of an input."""
        model = self.table.model
        E = {model.modulus: 1.0}
        nu = {"E1": "nu1", "E2": "nu2"}[model.modulus]
        if name == nu:
            E[nu] = 2 * values[nu] / (1 - values[nu] ** 2)
        total = power[1] * E.get(name, 0.0) + power[2] * (name == "R")
        if model.is_similar:
            total = total + slope * (of_u[0] * (name == "h") + of_u[1] * (name == "R") + of_u[2] * E.get(name, 0.0))
        if name in model.axes:
            total = total + cubics.read(by_axis[model.axes.index(name)])[0]
        return total
