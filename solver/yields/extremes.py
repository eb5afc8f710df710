"""The largest stresses in layer and body and at the interface, with their places: docs/stresses.md, Extremes."""

from typing import NamedTuple

import numpy as np

from ..compiled.highest import FUNCTIONS
from ..fields.invariants import invariants, mises
from .search.climb import climb
from .search.jets import Jets

#: Name -> the function of sr, st, sz, trz whose largest value is searched for. sz_interface_min is minus the largest
#: -sz.
VALUES = {
    "mises": mises,
    "tresca": lambda *stresses: invariants(*stresses).tresca,
    "s1": lambda *stresses: invariants(*stresses).s1,
    "sr": lambda sr, st, sz, trz: sr + 0 * sz,
    "tau": lambda sr, st, sz, trz: np.abs(trz),
    "tension": lambda sr, st, sz, trz: +sz,
    "compression": lambda sr, st, sz, trz: -sz,
}
#: Name of an extreme -> its function, and the regions in which it is searched for, with a layer and without.
EXTREMES = {
    "mises1": ("mises", ("inside", "outside", "layer", "above"), ()),
    "mises2": ("mises", ("body",), ("inside", "outside", "body")),
    "tresca1": ("tresca", ("inside", "outside", "layer", "above"), ()),
    "tresca2": ("tresca", ("body",), ("inside", "outside", "body")),
    "s1_surface": ("s1", ("inside", "outside"), ("inside", "outside")),
    "s1_layer": ("s1", ("inside", "outside", "layer", "above"), ()),
    "sr_interface1": ("sr", ("above",), ()),
    "tau_interface": ("tau", ("above",), ()),
    "sz_interface_max": ("tension", ("above",), ()),
    "sz_interface_min": ("compression", ("above",), ()),
}
#: Extremes that may not exist: below _NOTHING of the largest pressure they are rounding, and 0.
_MAY_LACK, _NOTHING = ("s1_surface", "s1_layer", "sr_interface1", "tau_interface", "sz_interface_max"), 1e-11
#: Other peaks of the coarse grid are followed too if they are above _RIVAL times the best, or lower than it by less
#: than _ROUGH times the largest pressure, which is the error of rough stresses. Places above _FLAT times the best are
#: followed, peaks or not: two maxima that are as high as that may lie between three points (in 2 of 2,400 bodies).
_RIVAL, _ROUGH, _FLAT = 0.85, 3e-4, 0.997
#: The coarse grid, from which all references of tests/yields/test_largest_stresses.py are reached: radii in a;
#: distances beyond the edge in lengths over which a layer bends, h or n^(1/3) h; and below, depths in a, in octaves of
#: h, and below the interface in a.
_RADII = np.array([0, 0.15, 0.3, 0.45, 0.6, 0.7, 0.8, 0.9, 0.95, 1, 1.05, 1.15, 1.3, 1.6])
_PAST_EDGE, _OF_LENGTHS = np.array([0.12, 0.25, 0.5, 1, 1.5, 2, 3, 4.5, 6.5]), np.array([0.25, 0.4, 0.5, 0.75, 1])
#: Radii of the surface and of the interface where layers thicker than _FELT may have weak tension.
_AWAY, _FELT = np.array([1.8, 2.2, 2.5, 2.8, 3.2, 3.7, 4.4, 5.5]), 0.1
#: Those of films that are nearer to the edge than this, inside too.
_THIN = 1.3
_DEPTHS = np.array([0.06, 0.12, 0.2, 0.3, 0.4, 0.48, 0.6, 0.8, 1.1])
_OF_OCTAVE = np.array([0.25, 0.4, 0.55, 0.7, 0.85, 1, 1.2, 1.4, 1.6])
_BELOW = np.array([0, 0.05, 0.15, 0.3, 0.48, 0.65, 0.9, 1.3])
#: If the pressure is largest in a ring: distances inside the edge, and depths below it, in the distance of the ring.
_OF_RING, _BELOW_RING = np.array([-1, -0.4, 0, 0.3, 0.6, 1, 1.5, 2.2]), np.array([0.25, 0.5, 0.8, 1.2, 1.8, 2.7, 4, 6])
#: The ratio of successive lengths of a thick or stiff layer is at most _APART; lengths within _ALIKE count as one.
_RATIO, _ALIKE = 25.0, 2.0
#: Largest distance of a place, in units of a plus the length over which a layer spreads the pressure.
_FARTHEST = 10.0
#: Where s = sqrt(1 - r²) is above this, near the axis, the coordinate along the surface is the radius.
_NEAR_AXIS = 0.8


class Climb(NamedTuple):
    """The climb of one function, a name of :data:`VALUES`, for one case of a batch, from a point of the coarse grid of
    a region."""

    function: str
    batch: int
    case: int
    region: str
    side: int
    row: int
    column: int


class SearchGrid(NamedTuple):
    """The coarse grid of a region: u (U,) and v (B, V), the bounds of both (B, 2), and whether the region is the body.

    v is the depth, and u the radius. On the surface, if `root`, the radius is sqrt(1 - u |u|): stresses are smooth
    functions of u up to the edge.
    """

    u: np.ndarray
    v: np.ndarray
    u_bounds: np.ndarray
    v_bounds: np.ndarray
    body: bool
    root: bool = False

    def radius(self, u):
        return np.sqrt(np.maximum(1 - u * np.abs(u), 0.0)) if self.root else u


def extremes(loaded, names=EXTREMES):
    """Name of :data:`EXTREMES` -> (3, B): its value in units of the pressure, and its place, r (signed if mu > 0) and
    z, in a. NaN where there is no such body."""
    return together([loaded], names)[0]


def together(batches, names=EXTREMES):
    """The :func:`extremes` of each of several :class:`~.loaded.Loaded`, with or without layers, which share mu."""
    answers, climbs = [], Climbs()
    for number, loaded in enumerate(batches):
        values, wanted, grids, coarse = _on_coarse_grids(loaded, names)
        answers.append(values)
        largest = np.abs(loaded.pressure.values).max(axis=1)
        there = np.isfinite(loaded.pressure.values).all(axis=1)
        for name, kinds in wanted.items():
            function, here = EXTREMES[name][0], [kind for kind in kinds if kind in grids]
            for i, *at in _starts(VALUES[function], here, coarse, grids, np.where(there, largest, np.nan)):
                start = Climb(function, number, i, *at)
                climbs.add(start, grids[start.region], values[name][:, i])
    scales = [np.abs(loaded.pressure.values).max(axis=1) for loaded in batches]
    climbs.climb([Jets(loaded) for loaded in batches], scales, batches[0].signs)
    for loaded, values in zip(batches, answers, strict=True):
        largest = np.abs(loaded.pressure.values).max(axis=1)
        for name, best in values.items():
            if name in _MAY_LACK:
                best[:, best[0] <= _NOTHING * largest] = np.array([0.0, np.nan, np.nan])[:, None]
            if name == "sz_interface_min":
                best[0] *= -1
    return answers


def coarsely(loaded, names=EXTREMES):
    """The largest values on the coarse grids, name -> (3, B); their places are NaN."""
    answer, wanted, grids, coarse = _on_coarse_grids(loaded, names)
    for name, kinds in wanted.items():
        for region in kinds:
            if region in grids:
                values = VALUES[EXTREMES[name][0]](*coarse[region].swapaxes(0, 1))
                there = grids[region].v <= grids[region].v_bounds[:, 1:]
                values = np.where(there[:, None, :, None], values, -np.inf).max(axis=(1, 2, 3))
                answer[name][0] = np.fmax(answer[name][0], values)
    return answer


def _on_coarse_grids(loaded, names):
    """Four mappings: name -> an array for the answer; name -> its regions; region -> its grid; and region -> the
    stresses on it, (B, 4, S, V, U)."""
    answer = {name: np.full((3, len(loaded.h)), np.nan) for name in names}
    wanted = {name: EXTREMES[name][2 if loaded.bare else 1] for name in names}
    grids = regions(loaded)
    grids = {name: grid for name, grid in grids.items() if any(name in kinds for kinds in wanted.values())}
    coarse = {
        region: loaded.stresses(grid.radius(grid.u), grid.v, grid.body, roughly=True).swapaxes(0, 1)
        for region, grid in grids.items()
    }
    return answer, wanted, grids, coarse


def farthest_of(loaded):
    """The largest distance (B,) from the centre, in a, of places that are searched."""
    stiff = 0 * loaded.h if loaded.bare else np.maximum(1.0, np.cbrt(loaded.layers.n))
    return _FARTHEST * (1 + stiff * loaded.h)


def regions(loaded):
    """Name -> :class:`SearchGrid` of each region that the cases have."""
    h, B = loaded.h, len(loaded.h)
    octave = 2.0 ** np.floor(np.log2(h[0]))
    stiff = 1.0 if loaded.bare else max(1.0, np.cbrt(loaded.layers.n.max()))
    far = farthest_of(loaded)
    bending = 0.5 if loaded.bare else octave * stiff
    past_edge = np.minimum(1 + bending * _PAST_EDGE, far.max())
    lengths = _lengths(octave, bending)
    thick = np.outer(lengths, _OF_LENGTHS).ravel() * (not loaded.bare and lengths[-1] > 1)
    ring, deep = (np.unique(loaded.ring * values) for values in (_OF_RING, _BELOW_RING))
    within = 2 - past_edge[past_edge < _THIN]
    radii = np.unique(np.concatenate([_RADII, past_edge[:6], thick, 1 - ring, within]))
    away = _AWAY * (octave > _FELT)
    wide = np.unique(np.concatenate([_RADII, past_edge, thick, 1 - ring, within, away]))
    surface = np.zeros((B, 1))
    of_ring, of_film = np.sqrt(np.maximum(ring * (2 - ring), 0.0)), np.sqrt((1 - within) * (1 + within))
    inner, none = np.unique(np.concatenate([np.linspace(0, 1, 12), of_ring, of_film])), np.zeros((B, 2))
    from_axis = np.stack([0 * far, far], axis=1)
    outer = -np.sqrt(wide[wide >= 1] ** 2 - 1)[::-1]
    grids = {
        "inside": SearchGrid(inner, surface, none + [0.0, 1.0], none, loaded.bare, True),
        "outside": SearchGrid(outer, surface, -from_axis[:, ::-1], none, loaded.bare, True),
    }
    if loaded.bare:
        depths = np.tile(np.unique(np.concatenate([_DEPTHS, [1.5, 2.5], deep[deep > 0]])), (B, 1))
        return grids | {"body": SearchGrid(radii, depths, from_axis, from_axis, True)}
    near = np.concatenate([_DEPTHS, deep[deep > 0]])
    depths = np.unique(np.concatenate([near[2 * octave > near], octave * _OF_OCTAVE]))
    grids["layer"] = SearchGrid(radii, np.tile(depths, (B, 1)), from_axis, np.stack([0 * h, h], axis=1), False)
    grids["above"] = SearchGrid(wide, h[:, None], from_axis, np.stack([h, h], axis=1), False)
    if np.all(loaded.layers.n > 0):
        bounds = np.stack([h, h + far], axis=1)
        across, below = _of_body(radii, lengths)
        grids["body"] = SearchGrid(across, h[:, None] + below, from_axis, bounds, True)
    return grids


def _of_body(radii, lengths):
    """Radii, and depths below the interface, of the coarse grid of a body whose stresses change over these lengths."""
    if lengths[-1] <= 1:
        return radii, _BELOW
    axes = radii[radii <= _RADII[-1]], _BELOW
    return (np.unique(np.concatenate([axis, (lengths[:, None] * axis).ravel()])) for axis in axes)


def _lengths(octave, bending):
    """Lengths over which stresses change far from the contact: from the longer of a and h to that over which a stiff
    layer spreads the pressure, each at most _APART times the one before."""
    least = max(1.0, octave)
    if bending <= _ALIKE * least:
        return np.array([least])
    return np.geomspace(least, bending, 2 + int(np.log(bending / least) / np.log(_RATIO)))


def _starts(value, kinds, coarse, grids, largest):
    """(case, region, side, row, column) of the coarse points of each case that are larger than their neighbours, and
    not much smaller than the largest.

    coarse : region -> stresses (B, 4, S, V, U); largest : (B,), of the pressure, NaN of cases that are left out
    """
    best, on_grids = np.full(len(largest), np.nan), {}
    for region in kinds:
        grid, values = grids[region], value(*coarse[region].swapaxes(0, 1))
        inside = grid.v <= grid.v_bounds[:, 1:]
        values = np.where(inside[:, None, :, None], values, -np.inf)
        on_grids[region] = values
        best = np.fmax(best, np.where(np.isfinite(values), values, -np.inf).max(axis=(1, 2, 3)))
    best, largest, starts = best[:, None, None, None], largest[:, None, None, None], []
    for region, values in on_grids.items():
        where = are_starts(values, best, largest) & np.isfinite(values)
        starts += [(case, region, *at) for case, *at in np.argwhere(where).tolist()]
    return starts


def are_starts(values, best, largest):
    """bool: from which values (..., V, U) of a coarse grid to climb; `best` is the largest value of all grids, and
    `largest` the largest pressure, NaN for none."""
    enough = best - (1 - _RIVAL) * np.abs(best) - _ROUGH * largest
    flat = best - (1 - _FLAT) * np.abs(best)
    return (values >= enough) & (are_peaks(values) | (values >= flat))


def are_peaks(values):
    """bool: which values (..., V, U) are at least as large as their neighbours."""
    sides = [(0, 0)] * (values.ndim - 2)
    padded = np.pad(values, (*sides, (1, 1), (1, 1)), constant_values=-np.inf)
    rows, columns = values.shape[-2:]
    around = [padded[..., a : a + rows, b : b + columns] for a in range(3) for b in range(3)]
    return values >= np.max(around, axis=0)


class Climbs:
    """The starts of the climbs of several batches: each is climbed once, for all extremes that it may raise."""

    def __init__(self):
        self._extremes: dict[Climb, list[np.ndarray]] = {}
        self._boxes: list = []

    def add(self, start, grid, extreme):
        """A start on a :class:`SearchGrid`. It may raise `extreme`, a view (3,) of a value and its place r, z."""
        if start not in self._extremes:
            self._extremes[start] = []
            self._boxes.append(_box_of(grid, start))
        self._extremes[start].append(extreme)

    def climb(self, jets, scales, signs):
        """Raise the extremes to what is above them. The arguments are those of :func:`_climbed`."""
        values, places = _climbed(jets, list(self._extremes), self._boxes, scales, signs)
        for extremes_of_start, value, place in zip(self._extremes.values(), values, places, strict=True):
            for extreme in extremes_of_start:
                if not extreme[0] >= value:
                    extreme[:] = value, *place


def _climbed(jets, tasks, boxes, scales, signs):
    """Largest values (T,) near the starts of T tasks, and their places (T, 2), r and z.

    jets : of each batch; :class:`~.search.jets.Jets`, or :class:`~.stacked.stack_jets.StackJets`
    boxes : of :func:`_box_of`; scales : of each batch, a number (B,) of the size of the stresses
    signs : of x on the sides
    """
    if not tasks:
        return [], []
    functions = _numbered([task.function for task in tasks])
    areas = _numbered([(task.batch, task.region) for task in tasks])
    case, side = (np.array([getattr(task, name) for task in tasks]) for name in ("case", "side"))
    root, boxes = np.array([root for _, root in boxes]), np.array([box for box, _ in boxes]).swapaxes(0, 1)

    def at(index, u, v):
        stresses = np.empty((6, 4, len(index)))
        keys = np.stack([areas.of[index], case[index], side[index], u, v, root[index]])
        _, first, inverse = np.unique(keys, axis=1, return_index=True, return_inverse=True)
        for number in np.unique(areas.of[index]):
            here = first[areas.of[index[first]] == number]
            (batch, region), some = areas.names[number], index[here]
            stresses[..., here] = jets[batch](region, case[some], side[some], root[some], u[here], v[here])
        return stresses[..., first[inverse.ravel()]]

    def value(index, stresses):
        values = np.empty(stresses.shape[1:])
        for number, name in enumerate(functions.names):
            here = np.flatnonzero(functions.of[index] == number)
            if len(here):
                values[here] = VALUES[name](*stresses[:, here])
        return values

    scale = np.array([scales[task.batch][task.case] for task in tasks])
    numbers = np.array([FUNCTIONS.index(task.function) for task in tasks])
    values, places = climb(at, value, numbers, *boxes, scale)
    r = np.where(root, np.sqrt(np.maximum(1 - places[:, 0] * np.abs(places[:, 0]), 0.0)), places[:, 0])
    return values, np.stack([r * np.array(signs)[side], places[:, 1]], axis=1)


class _Numbered(NamedTuple):
    """Distinct words, and for each of T words its index (T,) among them."""

    names: list
    of: np.ndarray


def _numbered(words):
    names = list(dict.fromkeys(words))
    numbers = {name: number for number, name in enumerate(names)}
    return _Numbered(names, np.array([numbers[word] for word in words]))


def _box_of(grid, task):
    """(4, 2): start, half widths, and lower and upper bounds of a task; and whether its u is the root. Near the axis u
    is the radius."""
    u, v = grid.u[task.column], grid.v[task.case]
    half, bounds = _spacing(grid.u, task.column), grid.u_bounds[task.case]
    root = grid.root and u < _NEAR_AXIS
    if root and bounds[1] > 0:
        bounds = 0.0, _NEAR_AXIS + 0.1
    elif grid.root and not root:
        u, half, bounds = grid.radius(u), _spacing(grid.radius(grid.u), task.column), (0.0, 0.9)
    low, high = zip(bounds, grid.v_bounds[task.case], strict=True)
    return [(u, v[task.row]), (half, _spacing(v, task.row)), low, high], root


def _spacing(axis, at):
    """The larger distance from a point of a coarse axis to its neighbours."""
    return np.abs(np.diff(axis[max(at - 1, 0) : at + 2])).max() if len(axis) > 1 else 1.0
