"""The largest stresses below the central spot of asperities that feel the coated body: docs/stresses.md, Below a spot.

They are the sum of those of the waves of the cell and those of the nominal pressure, on the axis of the spot, which is
the axis of the contact too. At the interface, tension and shear are searched for up to half the distance of neighbours
from the axis.
"""

import numpy as np

from ...bases import is_stack
from ...fields.contact import have_fields, pressures_of
from ...fields.invariants import mises
from ...laws.cell.sums import LATTICES
from ...numerics.threads import one_blas_thread
from ...scaling import dimensionless_pair
from ..contact import alike
from ..extremes import farthest_of
from ..peaks import chebyshev_nodes, in_patch
from ..spots import with_elastic_spots
from .felt_cells import felt_cells

#: Name -> the function of sr, st, sz, trz whose largest value it is, and the place of the search: "layer" and "body",
#: on the axis; "above", on the axis just above the interface; "interface", at the interface.
SPOT_EXTREMES = {
    "mises1_spot": (mises, "layer"),
    "mises2_spot": (mises, "body"),
    "sr_interface1_spot": (lambda sr, st, sz, trz: sr, "above"),
    "sz_interface_spot_max": (lambda sr, st, sz, trz: sz, "interface"),
    "tau_interface_spot": (lambda sr, st, sz, trz: np.abs(trz), "interface"),
}
#: Those that may not exist: below _NOTHING of the largest pressure they are rounding, and 0.
_MAY_LACK, _NOTHING = ("sz_interface_spot_max", "tau_interface_spot"), 1e-11
#: Nodes of the polynomials on each panel; and width of the first panel, over the smallest length over which stresses
#: change. Each panel is twice as wide as the one before (tests/yields/test_central_spot.py has twice as many nodes).
_NODES, _FIRST = 10, 0.5
#: Number of pitches below the interface from which on the waves of the cell are rounding.
_DEPTH = 6.0


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN
def of_contacts(problem, solution, mu=0.0, residual=0.0):
    """Name of :data:`SPOT_EXTREMES` -> (2, B): the largest value in the unit of E2, and its depth in a. NaN where the
    asperities do not feel the layer, where the contact is not solved, and for rigid bodies. The depth of an extreme
    that does not exist is NaN.

    problem, solution : B cases, and their :class:`~solver.solution.Solution`. The spots are elastic, even if the law
        has spots that yield
    mu : >= 0, friction of the nominal pressure only; residual : (B,) or a number, biaxial stress of the layer, in the
        unit of E2
    """
    extremes = {name: np.full((2, len(problem)), np.nan) for name in SPOT_EXTREMES}
    for cells, loaded, (index, p_max) in _cells(problem, solution, mu, residual):
        for name, values in _largest(loaded, cells, p_max).items():
            extremes[name][:, index] = values
    for values in extremes.values():
        values[0] *= problem.E2
    return extremes


@one_blas_thread()
@np.errstate(all="ignore")
def section(problem, solution, r, z, body, residual=0.0):
    """sr, st, sz and trz (4, Z, R) below the central spot of one contact, in the unit of E2, including the nominal
    stresses; None if its asperities do not feel the layer.

    r : (R,), radii from the axis in the pitch l, less than the distance of neighbours less b; z : (Z,), depths in l
    body : bool, whether the depths are in the body; residual : biaxial stress of the layer, in the unit of E2
    """
    for cells, loaded, _ in _cells(problem, solution, 0.0, residual):
        cell = cells[0]
        whole = loaded.stresses(r * cell.pitch, z * cell.pitch, body)[:, 0, 0]
        return (whole + cell.unit * cell.stresses(cell.b[0], r, z, int(body))) * problem.E2[0] if cell else None
    return None


def spot_of(problem, solution):
    """Radius of the central spot, pitch, and thickness of the layer of one contact, in units of a, (3,); and half the
    distance of neighbours over the pitch. NaN if its asperities do not feel the layer."""
    for cells, loaded, _ in _cells(problem, solution, 0.0, 0.0) if not is_stack(problem.base).any() else ():
        if cells[0]:
            return np.array([cells[0].b[0] * cells[0].pitch, cells[0].pitch, loaded.h[0]]), half_way(cells[0])
    return np.full(3, np.nan), np.nan


def _cells(problem, solution, mu, residual):
    """Yield the cells of contacts, their :class:`~..loaded.Loaded`, and their indices and largest pressures in E2*."""
    index = np.flatnonzero(problem.feels_layer() & have_fields(problem, solution))
    if not len(index):
        return
    residual = np.broadcast_to(residual, len(problem)) / problem.E2
    scaled, ended = dimensionless_pair(problem.take(index), solution.take(index))
    a = ended.a
    elastic = with_elastic_spots(scaled, a, np.zeros(1))
    cells = felt_cells(scaled, a, elastic.lam, elastic.p0)
    for rows, pressure, _ in pressures_of(scaled, ended, a):
        for some, loaded in alike(scaled.take(rows), a[rows], pressure, mu, residual[index[rows]]):
            here = rows[some]
            yield [cells[j] for j in here], loaded, (index[here], elastic.p_max[here])


def half_way(cell):
    """Half the distance of neighbours, in l."""
    lattice = cell.member.cell.lattice
    return LATTICES["hex" if lattice == "disc" else lattice] / 2


def _largest(loaded, cells, p_max):
    """As :func:`of_contacts`, (2, B), in units of the pressure. loaded : :class:`~..loaded.Loaded`; cells : by
    :func:`~.felt_cells.felt_cells`; p_max : (B,)"""
    extremes = {name: np.full((2, len(cells)), np.nan) for name in SPOT_EXTREMES}
    for i, cell in enumerate(cells):
        if cell is None:
            continue
        case = _Case(loaded.take([i]), cell)
        for where in dict.fromkeys(place for _, place in SPOT_EXTREMES.values()):
            panels = case.panels(where)
            for name in [name for name, (_, place) in SPOT_EXTREMES.items() if place == where] if panels else ():
                value, z = _best(panels, SPOT_EXTREMES[name][0])
                lacks = name in _MAY_LACK and value <= _NOTHING * p_max[i]
                extremes[name][:, i] = (0.0, np.nan) if lacks else (value, z)
    return extremes


def _best(panels, value):
    """The largest value of a function of stresses, which are polynomials on panels of depths or radii, and its
    depth."""
    best = -np.inf, np.nan
    for low, high, z, stresses in panels:
        largest, (_, v) = in_patch(stresses[..., None], value)
        if not largest <= best[0]:
            best = largest, low + (high - low) * (1 + v) / 2 if z is None else z
    return best


class _Case:
    """One case: the stresses of its cell and of its nominal pressure, at places in a."""

    def __init__(self, loaded, cell):
        self.loaded, self.cell, self.h = loaded, cell, loaded.h[0]

    def panels(self, where):
        """(low, high, depth, stresses (4, nodes)) of each panel. At "interface" it is a panel of radii, at that depth;
        elsewhere a panel of depths, and `depth` is None. A rigid body has no panels."""
        least = _FIRST * min(self.cell.b[0] * self.cell.pitch, self.h, 1.0)
        if where == "above":
            return [(self.h, self.h, None, self._on_axis(np.array([self.h]), False))]
        if where == "layer":
            edges = _doubling(0.0, least, self.h)
        elif where == "body":
            if self.loaded.layers.rigid[0]:
                return []
            top = self.cell.bottom[1] * self.cell.pitch
            edges = _doubling(top, least, top + farthest_of(self.loaded).max())
        else:
            edges = _doubling(0.0, least, half_way(self.cell) * self.cell.pitch)
        at = edges[:-1, None] + np.diff(edges)[:, None] * (1 + chebyshev_nodes(_NODES)) / 2
        if where == "interface":
            stresses, depth = self._at_interface(at.ravel()), self.h
        else:
            stresses, depth = self._on_axis(at.ravel(), where == "body"), None
        stresses = stresses.reshape(4, len(at), _NODES)
        return [(*ends, depth, stresses[:, j]) for j, ends in enumerate(zip(edges[:-1], edges[1:], strict=True))]

    def _on_axis(self, z, body):
        """Stresses (4, Z) on the axis at depths z (Z,)."""
        cell, whole = self.cell, self.loaded.stresses(np.zeros(1), z, body)[:, 0, 0, :, 0]
        number, top = cell.bottom if body else (0, cell.h)
        near = z <= (top + _DEPTH) * cell.pitch if body else z <= self.h + _DEPTH * cell.pitch
        at = np.clip(z[near] / cell.pitch, *((top, None) if body else (None, cell.h)))
        whole[:, near] += cell.unit * cell.stresses(cell.b[0], np.zeros(1), at, number)[..., 0]
        return whole

    def _at_interface(self, r):
        """Stresses (4, R) at the interface at radii r (R,)."""
        cell, whole = self.cell, self.loaded.stresses(r, np.array([self.h]), False)[:, 0, 0, 0]
        # the stresses in the body: only sz and trz count, which are continuous, and need fewer waves there
        return whole + cell.unit * cell.stresses(cell.b[0], r / cell.pitch, np.array([cell.h]), cell.below)[:, 0]


def _doubling(start, first, last):
    """Edges of panels from `start` to `last`. The first panel has the width `first`, and each further one is twice as
    wide."""
    count = max(int(np.ceil(np.log2(1 + (last - start) / first))), 1)
    return np.minimum(start + first * (2.0 ** np.arange(count + 1) - 1), last)
