"""The largest stresses in each layer of a stack, at each interface and in the body, with their places.

Each of these regions is searched separately: the inside of each layer, its lower side, the body, and the surface inside
and outside of the contact. A search evaluates a coarse grid of radii and depths, then refines its peaks with patches
that shrink (:mod:`.patches`). The spacings of the grid follow the lengths over which stresses change
(:func:`lengths_of`).
"""

from typing import NamedTuple

import numpy as np

from ...bases import is_stack
from ...fields.contact import are_infinite, have_fields, pressures_of
from ...fields.shaped import corners
from ...fields.stacks.section import Section
from ...layers import numbers_of
from ...numerics.threads import one_blas_thread
from ...scaling import dimensionless_pair
from ..contact import of_contacts as of_one_layer
from ..extremes import VALUES
from .patches import climbed

#: Name -> the function of the stresses whose largest value it is, and the place that is searched: each "layer", the
#: "lower" side of each, the "surface", or the "body".
EXTREMES = {
    "mises_layer": ("mises", "layer"),
    "tresca_layer": ("tresca", "layer"),
    "s1_layer": ("s1", "layer"),
    "sr_interface": ("sr", "lower"),
    "tau_interface": ("tau", "lower"),
    "sz_interface_max": ("tension", "lower"),
    "sz_interface_min": ("compression", "lower"),
    "s1_surface": ("s1", "surface"),
    "mises2": ("mises", "body"),
    "tresca2": ("tresca", "body"),
}
#: Place -> the dimension over which its names have values, or None.
DIMENSION = {"layer": "layer", "lower": "interface", "surface": None, "body": None}
#: Names of extremes that need not exist: a value below _NOTHING of the largest pressure is rounding and becomes 0.
_MAY_LACK, _NOTHING = ("s1_surface", "s1_layer", "sr_interface", "tau_interface", "sz_interface_max"), 1e-11
#: A further peak of the coarse grid is refined if it has at least this part of the largest value.
_RIVAL = 0.85
#: The coarse grid: radii in a; distances beyond the edge, in each length; depths below the top of a layer, in its
#: thickness and in each length; depths below the last interface, in each length.
_RADII = np.array([0, 0.2, 0.4, 0.6, 0.75, 0.85, 0.93, 0.98, 1, 1.04, 1.12, 1.25, 1.5])
_BEYOND = np.array([0.15, 0.3, 0.6, 1, 1.6, 2.5, 4, 6])
_OF_LAYER, _OF_LENGTH = np.array([0, 0.12, 0.3, 0.5, 0.7, 0.88, 1]), np.array([0.1, 0.2, 0.35, 0.5, 0.7, 1])
_BELOW = np.array([0, 0.08, 0.2, 0.35, 0.5, 0.7, 1, 1.4])
#: A length is dropped unless it exceeds the last one kept by the factor _ALIKE. The regions end at _FARTHEST (a + the
#: longest length).
_ALIKE, _FARTHEST = 2.0, 10.0


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN
def of_contacts(problem, solution, mu=0.0, residual=0.0, names=tuple(EXTREMES), coarse=False, only=None):
    """Extremes of solved contacts on stacks: name -> (3, B, N), or (3, B) for the surface and the body. The three are
    the value in the unit of E2 and its place, r (signed if mu > 0) and z in a. NaN for contacts that are not solved or
    not on a stack.

    problem, solution : B cases and their :class:`~solver.solution.Solution`; only a, status and model_used are used
    mu : >= 0, friction; residual : (B, N) or a number, biaxial stress of each layer, in the unit of E2
    names : some of :data:`EXTREMES`
    coarse : whether to return only the values of the coarse grid, which are up to about 10 % too small, without places
    only : number of the only layer or interface to search, from 0; the others are NaN
    """
    N = max(1, numbers_of(problem.parameters))
    made = {name: np.full((3, len(problem), N), np.nan) for name in names}
    index = np.flatnonzero(have_fields(problem, solution) & ~are_infinite(problem) & is_stack(problem.base))
    if len(index):
        part = problem.take(index)
        scaled, ended = dimensionless_pair(part, solution.take(index))
        a = ended.a
        sharp = np.isfinite(corners(scaled, a))
        residual = np.broadcast_to(residual, (len(problem), N))[index] / part.E2[:, None]
        for rows, pressure, _ in pressures_of(scaled, ended, a):
            for i, row in enumerate(rows):
                case = Section.of(scaled.take([row]), a[[row]], pressure.take([i]), mu, residual[row])
                for name, values in _of_section(case, names, coarse, only).items():
                    made[name][:, index[row]] = values * np.array([part.E2[row], 1, 1])[:, None]
                if sharp[row] and part.nu1[row] < 0.5:
                    _at_tip(made, index[row], corners(scaled.take([row]), a[[row]])[0])
    return {name: values if DIMENSION[EXTREMES[name][1]] else values[..., 0] for name, values in made.items()}


def mises_in(problem, solution, body, layer, mu, residual, punch=None, coarse=False):
    """The largest von Mises stress and its place, (3, B), of contacts on stacks and on other bodies.

    body : "layer", the one with the number `layer`, from 0; "body"; or "punch"
    residual : (B, N); further arguments as in :func:`of_contacts` here and in :func:`~..contact.of_contacts`
    """
    if body == "punch":
        return of_one_layer(problem, solution, mu, 0.0, ("mises2",), punch, coarse)["mises2"]
    name = "mises1" if body == "layer" else "mises2"
    made = of_one_layer(problem, solution, mu, residual[:, 0], (name,), None, coarse)[name]
    stacked = is_stack(problem.base)
    made = np.full_like(made, np.nan) if body == "layer" and layer else made
    if stacked.any():
        name = "mises_layer" if body == "layer" else "mises2"
        only = layer if body == "layer" else None
        values = of_contacts(
            problem.take(stacked), solution.take(stacked), mu, residual[stacked], (name,), coarse, only
        )
        made[:, stacked] = values[name][..., layer] if body == "layer" else values[name]
    return made


def _at_tip(made, case, radius):
    """Write the infinite stresses below a sharp tip or corner into `made`."""
    for name in {"mises_layer", "tresca_layer"} & {*made}:
        made[name][:, case, 0] = np.inf, radius, 0.0


class StackGrid(NamedTuple):
    """The coarse grid of a region.

    u, v : (U,) and (V,); v is the depth
    bounds : ((least u, largest u), (least v, largest v))
    number : of the layer, from 0; N for the body
    root : whether the radius is sqrt(1 - u |u|) rather than u: on the surface stresses are smooth in this u up to the
        edge
    """

    u: np.ndarray
    v: np.ndarray
    bounds: tuple
    number: int
    root: bool = False

    def radius(self, u):
        return np.sqrt(np.maximum(1 - u * np.abs(u), 0.0)) if self.root else u

    def stresses(self, case, u, v, roughly=False):
        """sr, st, sz, trz (4, S, V, U) at u (U,) and v (V,)."""
        return case.stresses(self.radius(u), v, np.full(len(v), self.number), roughly)


def _of_section(case, names, coarse, only):
    """Name -> value and place in each layer, (3, N), of one case; NaN where nothing was searched."""
    N, largest = len(case.ends), np.abs(case.pressure.values).max()
    made = {name: np.full((3, N), np.nan) for name in names}
    if not np.isfinite(case.pressure.values).all():
        return made
    lengths = lengths_of(case)
    for place in dict.fromkeys(EXTREMES[name][1] for name in names):
        for j in range(N) if DIMENSION[place] else (0,):
            if only is not None and DIMENSION[place] and j != only:
                continue
            wanted = [name for name in names if EXTREMES[name][1] == place]
            for name, values in _in_grids(case, _grids(case, place, j, lengths), wanted, coarse).items():
                lacks = name in _MAY_LACK and values[0] <= _NOTHING * largest
                made[name][:, j] = (0.0, np.nan, np.nan) if lacks else values
    return made


def _in_grids(case, grids, names, coarse):
    """Name -> the largest value in the regions of `grids` and its place, (3,); NaN if there are none."""
    made, fine = {}, [_Fine(case, grid) for grid in grids]
    on_grid = [grid.stresses(case, grid.u, grid.v, roughly=True) for grid in grids]
    for name in names:
        value, best = VALUES[EXTREMES[name][0]], np.full(3, np.nan)
        values = [value(*stresses) for stresses in on_grid]
        top = max((v.max() for v in values), default=np.nan)
        if coarse:
            best[0] = top
        for grid, patches, here in zip(grids, fine, values, strict=True) if not coarse else ():
            for side, row, column in _peaks(here, top):
                found = _refined(grid, patches, value, side, row, column)
                if not found[0] <= best[0]:
                    best = found
        if EXTREMES[name][0] == "compression":
            best[0] *= -1
        made[name] = best
    return made


def lengths_of(case):
    """Lengths over which stresses change, ascending: a, the thickness h of each layer, the depths of interfaces, and
    the length h (E/E_below)^(1/3) over which a stiff layer spreads the pressure."""
    ends, G = case.ends, case.stack.shear[0]
    of_layers = np.append(case.last, -1)
    below = np.inf if case.rigid else G[-1]
    stiff = np.array([np.cbrt(max(G[of_layers[j]] / min(below, G[case.last].min()), 1.0)) for j in range(len(ends))])
    thickness = np.diff(np.append(0.0, ends))
    wanted = np.sort(np.concatenate([[1.0], thickness, ends, thickness * stiff]))
    chosen = [wanted[0]]
    for length in wanted[1:]:
        if length > _ALIKE * chosen[-1]:
            chosen.append(length)
    return np.array(chosen)


def farthest_of(lengths):
    return _FARTHEST * (1 + lengths[-1])


def _grids(case, place, j, lengths):
    """The coarse grids of a place."""
    far = farthest_of(lengths)
    beyond = 1 + np.outer(lengths, _BEYOND).ravel()
    radii = _unlike(np.concatenate([_RADII, beyond[beyond < far]]))
    tops = np.append(0.0, case.ends)
    surface = np.zeros(1)
    if place == "surface" or place == "layer" and j == 0:
        inner = StackGrid(np.linspace(0, 1, 12), surface, ((0.0, 1.0), (0.0, 0.0)), 0, True)
        wide = radii[radii >= 1]
        outer = StackGrid(-np.sqrt(wide**2 - 1)[::-1], surface, ((-far, 0.0), (0.0, 0.0)), 0, True)
        if place == "surface":
            return [inner, outer]
    if place == "lower":
        return [StackGrid(radii, tops[j + 1 : j + 2], ((0.0, far), (tops[j + 1],) * 2), j)]
    if place == "body":
        if case.rigid:
            return []
        depths = tops[-1] + _unlike(np.outer(lengths, _BELOW).ravel())
        return [StackGrid(radii, depths, ((0.0, far), (tops[-1], tops[-1] + far)), len(tops) - 1)]
    h = tops[j + 1] - tops[j]
    of_lengths = np.outer(lengths, _OF_LENGTH).ravel()
    depths = tops[j] + _unlike(np.concatenate([h * _OF_LAYER, of_lengths[of_lengths < h]]))
    depths = depths[depths > 0]
    inside = StackGrid(radii, depths, ((0.0, far), (tops[j], tops[j + 1])), j)
    lower = StackGrid(radii, tops[j + 1 : j + 2], ((0.0, far), (tops[j + 1],) * 2), j)
    # At some radii stresses rise towards the upper interface; the grid inside can miss these.
    upper = StackGrid(radii, tops[j : j + 1], ((0.0, far), (tops[j],) * 2), j)
    return [inside, lower, *((inner, outer) if j == 0 else (upper,))]


def _unlike(values):
    """The values in ascending order, without each that exceeds the one before by less than a hundredth of itself."""
    values = np.unique(values)
    return values[np.append(True, np.diff(values) > 0.01 * np.abs(values[1:]))]


def _peaks(values, top):
    """(side, row, column) of the values (S, V, U) that no neighbour exceeds and that are nearly as large as `top`."""
    padded = np.pad(values, ((0, 0), (1, 1), (1, 1)), constant_values=-np.inf)
    rows, columns = values.shape[1:]
    around = [padded[:, a : a + rows, b : b + columns] for a in range(3) for b in range(3)]
    best = (values >= np.max(around, axis=0)) & (values >= top - (1 - _RIVAL) * abs(top))
    return list(map(tuple, np.argwhere(best)))


def _refined(grid, patches, value, side, row, column):
    """The value of a peak and its r and z, (3,), refined from a point of the coarse grid."""
    at, half = (grid.u[column], grid.v[row]), [_spacing(grid.u, column), _spacing(grid.v, row)]
    largest, (u, v) = climbed(lambda u, v: patches(u, v)[:, side], value, at, half, grid.bounds)
    return np.array([largest, float(grid.radius(u)) * patches.case.signs[side], v])


def _spacing(axis, at):
    """The larger of the distances from a point of a coarse axis to its neighbours; 1 for an axis of one point."""
    return np.abs(np.diff(axis[max(at - 1, 0) : at + 2])).max() if len(axis) > 1 else 1.0


class _Fine:
    """Stresses (4, S, V, U) in a region, at u (U,) and v (V,). Results are kept, because the searches for several
    extremes begin with the same patch."""

    def __init__(self, case, grid):
        self.case, self.grid, self._kept = case, grid, {}

    def __call__(self, u, v):
        u, v = np.atleast_1d(u), np.atleast_1d(v)
        key = u.tobytes(), v.tobytes()
        if key not in self._kept:
            self._kept[key] = self.grid.stresses(self.case, u, v)
        return self._kept[key]
