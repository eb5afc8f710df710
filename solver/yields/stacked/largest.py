"""The largest stresses in each layer of a stack, at each interface and in the body, with their places.

Each layer, the sides of each, the body, and the surface inside and outside of the contact are searched by themselves,
on a coarse grid of radii and depths, then from its peaks upwards (:mod:`..search.climb`). The grid has the lengths of
all that is there: a, the thickness of each layer and the depth of its top, and those over which stiff layers spread the
pressure.
"""

import numpy as np

from ...bases import is_stack
from ...fields.contact import are_infinite, have_fields, pressures_of
from ...fields.shaped import corners
from ...fields.stacks.section import Section
from ...layers import numbers_of
from ...numerics.threads import one_blas_thread
from ...scaling import dimensionless_pair
from ..contact import of_contacts as of_one_layer
from ..extremes import VALUES, Climb, Climbs, SearchGrid, are_starts
from .stack_jets import StackJets

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
#: Cases whose largest stresses are looked for together.
_TOGETHER = 32
#: The coarse grid: radii in a, up to the edge; distances beyond it, at the ratio _FARTHER, which was enough in 2,400
#: random bodies, from _PAST_EDGE[0] of the shortest length, at most _NEAREST, to _PAST_EDGE[1] of the longest; depths
#: below the top of a layer, in its thickness and in each length; depths below the last interface, in each length.
_RADII = np.array([0, 0.2, 0.4, 0.6, 0.75, 0.85, 0.93, 0.98, 1])
_PAST_EDGE, _NEAREST, _FARTHER = (0.15, 7.0), 0.04, 1.35
_OF_LAYER, _OF_LENGTH = np.array([0, 0.12, 0.3, 0.5, 0.7, 0.88, 1]), np.array([0.1, 0.2, 0.35, 0.5, 0.7, 1])
_BELOW = np.array([0, 0.08, 0.2, 0.35, 0.5, 0.7, 1, 1.4])
#: If a layer is thinner than a, radii inside the edge have the same distances from it, up to _THIN.
_THIN = 0.3
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
    extremes = {name: np.full((3, len(problem), N), np.nan) for name in names}
    index = np.flatnonzero(have_fields(problem, solution) & ~are_infinite(problem) & is_stack(problem.base))
    if len(index):
        part = problem.take(index)
        scaled, ended = dimensionless_pair(part, solution.take(index))
        a = ended.a
        sharp = np.isfinite(corners(scaled, a))
        residual = np.broadcast_to(residual, (len(problem), N))[index] / part.E2[:, None]
        for rows, pressure, _ in pressures_of(scaled, ended, a, with_errors=False):
            for few in np.array_split(np.arange(len(rows)), -(-len(rows) // _TOGETHER)):
                where = zip(rows[few], few, strict=True)
                cases = [
                    Section.of(scaled.take([row]), a[[row]], pressure.take([i]), mu, residual[row]) for row, i in where
                ]
                for row, values in zip(rows[few], _of_sections(cases, names, coarse, only), strict=True):
                    for name in names:
                        extremes[name][:, index[row]] = values[name] * np.array([part.E2[row], 1, 1])[:, None]
        for row in np.flatnonzero(sharp & (part.nu1 < 0.5)):
            _at_tip(extremes, index[row], corners(scaled.take([row]), a[[row]])[0])
    return {name: values if DIMENSION[EXTREMES[name][1]] else values[..., 0] for name, values in extremes.items()}


def mises_in(problem, solution, body, layer, mu, residual, punch=None, coarse=False):
    """The largest von Mises stress and its place, (3, B), of contacts on stacks and on other bodies.

    body : "layer", the one with the number `layer`, from 0; "body"; or "punch"
    residual : (B, N); further arguments as in :func:`of_contacts` here and in :func:`~..contact.of_contacts`
    """
    if body == "punch":
        return of_one_layer(problem, solution, mu, 0.0, ("mises2",), punch, coarse)["mises2"]
    name = "mises1" if body == "layer" else "mises2"
    extremes = of_one_layer(problem, solution, mu, residual[:, 0], (name,), None, coarse)[name]
    stacked = is_stack(problem.base)
    extremes = np.full_like(extremes, np.nan) if body == "layer" and layer else extremes
    if stacked.any():
        name = "mises_layer" if body == "layer" else "mises2"
        only = layer if body == "layer" else None
        values = of_contacts(
            problem.take(stacked), solution.take(stacked), mu, residual[stacked], (name,), coarse, only
        )
        extremes[:, stacked] = values[name][..., layer] if body == "layer" else values[name]
    return extremes


def _at_tip(by_name, case, radius):
    """Write the infinite stresses below a sharp tip or corner into `by_name`."""
    for name in {"mises_layer", "tresca_layer"} & {*by_name}:
        by_name[name][:, case, 0] = np.inf, radius, 0.0


def _of_sections(cases, names, coarse, only):
    """Of each :class:`~...fields.stacks.section.Section` name -> (3, N)."""
    answers, climbs = [], Climbs()
    for number, case in enumerate(cases):
        answers.append({name: np.full((3, len(case.ends)), np.nan) for name in names})
        for name, j, grids, values in _on_coarse_grids(case, names, only):
            top = max((v.max() for v in values.values()), default=np.nan)
            if coarse:
                answers[-1][name][0, j] = top
            largest = np.abs(case.pressure.values).max()
            for region in values if not coarse else ():
                for at in np.argwhere(are_starts(values[region], top, largest)).tolist():
                    start = Climb(EXTREMES[name][0], number, 0, region, *at)
                    climbs.add(start, grids[region], answers[-1][name][:, j])
    scales = [np.abs(case.pressure.values).max(axis=1) for case in cases]
    climbs.climb([StackJets(case) for case in cases], scales, cases[0].signs)
    for values, scale in zip(answers, scales, strict=True):
        for name, best in values.items():
            if name in _MAY_LACK:
                best[:, best[0] <= _NOTHING * scale] = np.array([0.0, np.nan, np.nan])[:, None]
            if EXTREMES[name][0] == "compression":
                best[0] *= -1
    return answers


def _on_coarse_grids(case, names, only):
    """Yield each name, the number of the layer or interface, its regions -> :class:`~..extremes.SearchGrid`, and the
    values there (S, V, U). A region is the number of the layer, from 0, or of the body, and which part of it."""
    if not np.isfinite(case.pressure.values).all():
        return
    lengths, stresses = lengths_of(case), {}
    for place in dict.fromkeys(EXTREMES[name][1] for name in names):
        for j in range(len(case.ends)) if DIMENSION[place] else (0,):
            if only is not None and DIMENSION[place] and j != only:
                continue
            grids = _grids(case, place, j, lengths)
            for region, grid in grids.items():
                if region not in stresses:
                    z, number = grid.v[0], np.full(grid.v.shape[1], region[0])
                    stresses[region] = case.stresses(grid.radius(grid.u), z, number, roughly=True)
            for name in [name for name in names if EXTREMES[name][1] == place]:
                yield name, j, grids, {region: VALUES[EXTREMES[name][0]](*stresses[region]) for region in grids}


def lengths_of(case):
    """Lengths over which stresses change, ascending: a, the thickness h of each layer, the depths of interfaces, and
    those over which a stiff layer spreads its load: h (E/E_below)^(1/3), and on springs of the compliance c
    (E h³ c)^(1/4) for pressure and sqrt(E h c) for shear."""
    ends, G = case.ends, case.stack.shear[0]
    of_layers = np.append(case.last, -1)
    below = np.inf if case.rigid else G[-1]
    stiff = np.array([np.cbrt(max(G[of_layers[j]] / min(below, G[case.last].min()), 1.0)) for j in range(len(ends))])
    thickness = np.diff(np.append(0.0, ends))
    E, unit = case.stack.n[0, case.last], case.h / case.stack.n[0, 0]
    cn, ct = unit * case.stack.cn[0, case.last], unit * case.stack.ct[0, case.last]
    springs = (E * thickness**3 * cn) ** (1 / 4), np.sqrt(E * thickness * ct)
    wanted = np.sort(np.concatenate([[1.0], thickness, ends, thickness * stiff, *springs]))
    wanted = wanted[wanted > 0]
    chosen = [wanted[0]]
    for length in wanted[1:]:
        if length > _ALIKE * chosen[-1]:
            chosen.append(length)
    return np.array(chosen)


def farthest_of(lengths):
    return _FARTHEST * (1 + lengths[-1])


def _grids(case, place, j, lengths):
    """The coarse grids of a place, by their regions."""
    far, tops = farthest_of(lengths), np.append(0.0, case.ends)
    least, most = min(_NEAREST, _PAST_EDGE[0] * lengths[0]), _PAST_EDGE[1] * lengths[-1]
    distances = least * _FARTHER ** np.arange(np.log(most / least) / np.log(_FARTHER))
    films = distances[(distances < _THIN) & (lengths[0] < 1)]
    radii = np.unique(np.concatenate([_RADII, 1 - films, 1 + distances]))

    def grid(u, v, low, high, ends=(0.0, far), root=False):
        return SearchGrid(u, np.array([v]), np.array([ends]), np.array([[low, high]]), False, root)

    def row(number, part, depth):
        return {(number, part): grid(radii, [depth], depth, depth)}

    if place == "surface":
        wide = radii[radii >= 1]
        outer = -np.sqrt(wide**2 - 1)[::-1]
        return {
            (0, "inside"): grid(np.linspace(0, 1, 12), [0.0], 0.0, 0.0, (0.0, 1.0), True),
            (0, "outside"): grid(outer, [0.0], 0.0, 0.0, (-far, 0.0), True),
        }
    if place == "lower":
        return row(j, "lower", tops[j + 1])
    if place == "body":
        if case.rigid:
            return {}
        depths = tops[-1] + _unlike(np.outer(lengths, _BELOW).ravel())
        below = {(len(tops) - 1, "body"): grid(radii, depths, tops[-1], tops[-1] + far)}
        return below | row(len(tops) - 1, "upper", tops[-1])
    h = tops[j + 1] - tops[j]
    of_lengths = np.outer(lengths, _OF_LENGTH).ravel()
    depths = tops[j] + _unlike(np.concatenate([h * _OF_LAYER, of_lengths[of_lengths < h]]))
    depths = depths[depths > 0]
    # At some radii stresses rise towards the upper interface; the grid inside can miss these.
    upper = row(j, "upper", tops[j]) if j else _grids(case, "surface", 0, lengths)
    return {(j, "layer"): grid(radii, depths, tops[j], tops[j + 1])} | row(j, "lower", tops[j + 1]) | upper


def _unlike(values, part=0.01):
    """The values in ascending order, without each that exceeds the last one of these by less than a part of itself."""
    chosen = []
    for value in np.unique(values).tolist():
        if not chosen or value - chosen[-1] > part * abs(value):
            chosen.append(value)
    return np.array(chosen)
