"""Where the iteration begins: the mesh a case is likely to need, how good its operator must be, and the first state."""

import numpy as np

from ..body.layered import operator_error, place_weights
from ..numerics.ladder import LADDER
from ..numerics.mesh import mesh
from . import newton
from .equation import State, evaluate, first_guess, groups, guess_pressure, guess_radius, softness
from .results import interpolate

#: Part of rtol that the operator's own error may come to, and the largest change of ln a over which the layer's is not
#: formed anew: what that leaves out is of its square.
_SHARE, _FARTHEST = 1e-2, 1e-5
#: Tolerance below which no case on springs begins on the coarsest mesh: few stay there.
_FINE = 3e-5
#: Steps on the coarse mesh, and the changes of ln a over which the operator is not formed anew: for them, and for the
#: state they end in.
_STEPS, _FAR, _NEAR = 2, 0.2, 1e-3


def only_as_wanted(cases, rtol):
    """The cases with an operator of the layer no better than rtol (B,) calls for; 0: to rounding."""
    coarse = operator_error(cases.layer, guess_radius(cases), 0, True) < _SHARE * rtol
    return cases._replace(reach=np.minimum(10 * rtol, _FARTHEST), coarse=coarse)


def nodes_wanted(cases, rtol):
    """Number of nodes (B,) that just about meet rtol, as random samples have it: the fewer, the wider the layer at the
    edge in which the asperities yield more than the base; of a smooth punch, the thicker the layer."""
    a = guess_radius(cases)
    if not cases.law.rough:
        share, base, slope = cases.layer.h / a, 2.3, 0.9
    else:
        X, Y, Z = groups(cases, np.log(a))
        q = guess_pressure(cases, X * softness(cases, a)[:, None], Y, Z, np.ones(1))
        share = (Z * cases.law.evaluate(cases.law.guess(q)).g)[:, 0]  # of s² = 1 in the centre
        base, slope = np.where(cases.C > 0, 3.4, 1.1), cases.law.law.rise
    rise = slope * np.clip(np.nan_to_num(share), 0.0, 1.0)
    nodes = np.where(cases.C > 0, 0.97, 0.93) * (-np.log10(rtol) - base + 3.6 * rise) / (0.25 + rise)
    return np.maximum(nodes, np.where((cases.C > 0) & (rtol < _FINE), LADDER[1], 0))


def begin(cases, grid, limit, begun=None, y=None, eta=None):
    """State to begin with on a mesh: y (B, n) and eta (B,) of the cases `begun` (B,), if any; and weights known there.

    The others take a few steps on a coarse mesh from the closed forms, if they have more than `limit`.
    """
    fresh = np.arange(len(cases.value)) if begun is None else np.flatnonzero(~begun)
    if begun is not None and not len(fresh):
        return State(y, eta), []
    part = cases if begun is None else cases.take(fresh)
    if limit or grid.n < 8:
        state, known = first_guess(part, grid), []
    else:
        state, known = _approach(part, grid)
    if begun is None:
        return state, known
    y[fresh], eta[fresh] = state
    return State(y, eta), place_weights(known, fresh)


def _approach(cases, grid):
    """State on a mesh, and the weights of the layer there, after a few steps on a coarse mesh."""
    coarse = mesh(5 if grid.n <= 12 else 8)
    state, known = first_guess(cases, coarse), []
    for _ in range(_STEPS):
        ev = evaluate(cases._replace(reach=cases.reach + _FAR), state, coarse, known)
        state, known = newton.advance(cases, state, ev, coarse)[0], ev.base.weights
    ev = evaluate(cases._replace(reach=cases.reach + _NEAR), state, coarse, known)
    return State(interpolate(cases, ev, coarse, grid.s, 1e-2), state.eta), ev.base.weights
