"""The largest stresses of solved contacts."""

import numpy as np

from ..bases import is_bare, is_stack
from ..fields.contact import are_infinite, bodies_of, have_fields, pressures_of
from ..fields.shaped import corners
from ..fields.stacks.section import Section
from ..layers import numbers_of
from ..numerics.threads import one_blas_thread
from ..scaling import dimensionless_pair
from ..shapes import shaped
from .extremes import EXTREMES, coarsely, together
from .loaded import Loaded
from .stacked.upper_layer import UpperLayer

#: If the pressure is largest at s = sqrt(1 - r²) below this, it is so in a ring that coarse grids would miss.
_AT_THE_EDGE = 0.5
#: Number of cases whose coarse grids are in memory together: each has some 1,000 points and as many waves.
_TOGETHER = 64
#: Extremes that are infinite below a sharp tip or corner, without a layer (True) and with one: there sz = -p and sr =
#: -(1 + 2 nu) p/2 on the axis, and sr = -p and st = -2 nu p at a ring.
_OF_TIPS = {True: ("mises2", "tresca2"), False: ("mises1", "tresca1")}


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN
def of_contacts(problem, solution, mu=0.0, residual=0.0, names=tuple(EXTREMES), punch=None, coarse=False):
    """Extremes of solved contacts, a batch of any mixture: name -> (3, B), the value in the unit of E2, and its place,
    r (signed if mu > 0) and z, in a. NaN where the contact is not solved, has no such body, or is on a stack of layers
    (:mod:`.stacked.largest`).

    problem, solution : B cases, and their :class:`~solver.solution.Solution`
    mu : >= 0, the coefficient of friction
    residual : (B,) or a number, biaxial stress of the layer, in the unit of E2
    names : names of :data:`~.extremes.EXTREMES`
    punch : (B,), Poisson ratios of the punches, if the stresses are those of the punch: a half-space under the same
        pressure. Its extremes have the names of a bare body, "mises2" and so on
    coarse : whether there are only values, from the coarse grid, which are up to 10 % too small
    """
    largest_of = {name: np.full((3, len(problem)), np.nan) for name in names}
    below = np.full(len(problem), punch is not None) | ~is_stack(problem.base)
    index = np.flatnonzero(have_fields(problem, solution) & ~are_infinite(problem) & below)
    residual = np.broadcast_to(residual, len(problem)) / problem.E2
    if len(index):
        scaled, ended = dimensionless_pair(problem.take(index), solution.take(index))
        a = ended.a
        sharp = corners(scaled, a)
        for group in _some(scaled, ended, a, mu, residual[index], None if punch is None else punch[index]):
            batches = [loaded for _, loaded in group]
            answers = [coarsely(loaded, names) for loaded in batches] if coarse else together(batches, names)
            for (rows, loaded), largest in zip(group, answers, strict=True):
                tips, here = np.isfinite(sharp[rows]) & (_touched(loaded) < 0.5), index[rows]
                for name, values in largest.items():
                    values[0] *= problem.E2[here]
                    if name in _OF_TIPS[loaded.bare]:
                        values[0, tips], values[1, tips], values[2, tips] = np.inf, sharp[rows][tips], 0.0
                    largest_of[name][:, here] = values
    return largest_of


def _some(scaled, ended, a, mu, residual, punch):
    """Yield lists of pairs, indices of cases and their :class:`~.loaded.Loaded`, with about _TOGETHER cases in a
    list."""
    group = []
    for rows, pressure, _ in pressures_of(scaled, ended, a, with_errors=False):
        nu = None if punch is None else punch[rows]
        for some, loaded in alike(scaled.take(rows), a[rows], pressure, mu, residual[rows], nu):
            group.append((rows[some], loaded))
            if sum(len(index) for index, _ in group) >= _TOGETHER:
                yield group
                group = []
    if group:
        yield group


def _touched(loaded):
    """Poisson ratio (B,) of the layer or body that the punch touches."""
    return loaded.layers.nu2 if loaded.bare else loaded.layers.nu1


def alike(scaled, a, pressure, mu, residual, punch=None):
    """Yield indices of cases that share a coarse grid, and their :class:`~.loaded.Loaded`; for each contact on a stack
    its :class:`~.stacked.upper_layer.UpperLayer`. residual : (B,), or (B, N) for the layers of stacks"""
    stacked = is_stack(scaled.base) & (punch is None)
    residual = residual.reshape(len(scaled), -1)
    for i in np.flatnonzero(stacked):
        layers = np.broadcast_to(residual[i], max(1, numbers_of(scaled.parameters)))
        yield np.array([i]), UpperLayer(Section.of(scaled.take([i]), a[[i]], pressure.take([i]), mu, layers))
    others = np.flatnonzero(~stacked)
    if len(others):
        nu = None if punch is None else punch[others]
        for some, loaded in _alike(scaled.take(others), a[others], pressure.take(others), mu, residual[others, 0], nu):
            yield others[some], loaded


def _alike(scaled, a, pressure, mu, residual, punch):
    """As :func:`alike`, for cases on one layer or none."""
    bare = is_bare(scaled.base) | (punch is not None)
    h = np.where(bare, 1.0, scaled.h / a)
    n = np.where(bare, 1.0, scaled.n)
    kinds = np.stack([bare, n == 0, np.floor(np.log2(h)), np.floor(np.log2(np.maximum(n, 1.0)) / 3)], axis=1)
    _, kind = np.unique(kinds, axis=0, return_inverse=True)
    for number in range(kind.max() + 1):
        index = np.flatnonzero(kind.ravel() == number)
        for some in np.array_split(index, -(-len(index) // _TOGETHER)):
            cases = scaled.take(some) if punch is None else scaled.take(some).but(nu2=punch[some])
            layers, part = bodies_of(cases, bare[some[0]]), pressure.take(some)
            ring = _ring(part) if len(some) == 1 and shaped(cases)[0] else 0.0
            yield some, Loaded(layers, h[some], part, bool(bare[some[0]]), mu, residual[some], ring)


def _ring(pressure):
    """Distance from the edge at which the pressure of one case is largest; 0 if that is not near the edge."""
    s = pressure.mesh.s[np.argmax(pressure.values[0])]
    return s**2 / (1 + np.sqrt((1 - s) * (1 + s))) if s < _AT_THE_EDGE else 0.0
