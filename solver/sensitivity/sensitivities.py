"""Derivatives of the answers by the inputs: one more linear system for each solution.

The equation of each case is found again on its mesh, from its radius, by a few Newton steps; there :mod:`.state` has
all derivatives at once. Where that fails, the case is solved with each input moved: :mod:`.differences`.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..numerics.ladder import STACK
from ..numerics.threads import one_blas_thread
from ..parameters import is_ratio
from ..problem import Problem
from ..rough.results import pointed
from ..scaling import as_cases, dimensionless
from ..solution import Solution
from ..status import Status
from .added import added_slopes
from .again import found_again, meshes, same, stacks, without_state
from .changes import changes_of, inputs_of, moved, slope_of
from .differences import SIGNED, by_differences
from .held import Held, held
from .points import of_corners, profiles
from .state import implicit, operators_of
from .stiffness import stiffness_slopes

#: Quantities that have sensitivities, arrays (B,) of a :class:`~solver.solution.Solution`; and those among them whose
#: unit has the modulus as a factor.
QUANTITIES = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD", "A0")
_OF_MODULUS = ("P", "p0", "p_max", "dP_dD")
#: Where a number changes by more than so many times itself with ln input it is taken to be near 0.
_NEAR_0 = 5.0
#: Those whose sensitivity is not known where they are 0, as a load may be under adhesion, or infinite, or not known.
_NEVER_0 = tuple(name for name in QUANTITIES if name != "A0")
#: Those that the pressure on the axis decides, which is not known under a point.
_OF_CENTRE = ("p0", "p_max", "A0")
#: Most unknowns of a stack: with k inputs it has k right-hand sides.
_STACK = STACK // 4


class Sensitivities(NamedTuple):
    """Derivatives of B solutions by k inputs.

    Attributes
    ----------
    inputs : their names, the control first
    logs : quantity -> (B, k), d ln quantity/d ln input; by a Poisson ratio d ln quantity/d ratio. 0 where an input does
        not act, or is 0; NaN of a case without numbers. A smooth punch has 0 for A0, which is 0
    slopes : quantity -> (B, k), d quantity/d ln input in its unit, also where the quantity is 0
    p, lam : (B, k, m), d p/d ln input at fixed r/a, in the unit of p, and d λ/d ln input
    """

    inputs: tuple
    logs: dict
    slopes: dict
    p: np.ndarray
    lam: np.ndarray


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN
def sensitivities(
    problem: Problem, solution: Solution, x: ArrayLike = (), inputs: Sequence[str] | None = None
) -> Sensitivities:
    """Derivatives of solved cases by their inputs.

    Parameters
    ----------
    problem, solution : the cases, and what `solve` has made of them
    x : (m,), radii r/a in [0, 1] of the profiles
    inputs : some names of parameters that are numbers, and of the control; None: all

    Returns
    -------
    Sensitivities

    Examples
    --------
    >>> from solver import Problem, solve
    >>> problem = Problem.of(P=[1e-5, 2e-5], micro="smooth", base="half_space")
    >>> print(sensitivities(problem, solve(problem), inputs=("P",)).logs["a"].round(6).ravel())
    [0.333333 0.333333]
    """
    inputs, x = tuple(inputs_of(problem) if inputs is None else inputs), np.asarray(x, dtype=float)
    solved = np.isfinite(solution.P) & np.isfinite(solution.D)
    solved &= np.isin(solution.status, (Status.CONVERGED, Status.TOLERANCE_NOT_MET))
    index, acting = np.flatnonzero(solved), [name for name in inputs if _acts(problem, name)]
    size, places = len(problem), [inputs.index(name) for name in acting]
    logs = {name: np.where(solved[:, None], 0.0, np.full((size, len(inputs)), np.nan)) for name in QUANTITIES}
    signed = {name: logs[name].copy() for name in SIGNED}
    shapes = np.where(solved[:, None, None], 0.0, np.full((2, size, len(inputs), len(x)), np.nan))
    if acting and len(index):
        part, ended = problem.take(index), solution.take(index)
        ended = replace(ended, a=ended.a / part.R, D=ended.D / part.R)
        by_name, at_x, slopes = _of_solved(dimensionless(part), ended, acting, x)
        for found, into in (by_name, logs), (slopes, signed):
            for name, values in found.items():
                into[name][np.ix_(index, places)] = values.T
        shapes[np.ix_((0, 1), index, places)] = np.moveaxis(at_x, 1, 2)
    near = {name: _near_0(problem, getattr(solution, name), name, values) for name, values in signed.items()}
    for name, (at, straight) in near.items():
        logs[name] = np.where(at, straight / getattr(solution, name)[:, None], logs[name])
    for name in _NEVER_0:
        values = getattr(solution, name)
        logs[name][~np.isfinite(values) | (values == 0)] = np.nan
    slopes = {name: values * getattr(solution, name)[:, None] for name, values in logs.items()}
    slopes |= {name: np.where(*pair, slopes[name]) for name, pair in near.items()}
    return Sensitivities(inputs, logs, slopes, shapes[0] * problem.E2[:, None, None], shapes[1])


def _near_0(problem, value, name, slopes):
    """(B, k) bool, where a number with the `value` (B,) is near 0, or 0, under adhesion; and its `slopes` (B, k) in its
    unit."""
    of_E2, of_R = SIGNED[name]
    straight = slopes * (problem.E2**of_E2 * problem.R**of_R)[:, None]
    sticks, size = (problem.w_adhesion > 0)[:, None], np.abs(value)[:, None]
    return sticks & ((np.abs(straight) > _NEAR_0 * size) | (size == 0) & np.isfinite(straight)), straight


def _acts(problem, name):
    """Whether an input changes the answer of some case: it is used, and neither left out nor, but for Poisson ratios,
    0 everywhere."""
    if name == problem.control:
        return True
    values = getattr(problem, name)
    there = np.isfinite(values) & (is_ratio(name) | (values != 0))
    return bool(np.any(there & problem.known.uses(name, lambda key: getattr(problem, key))))


def _of_solved(scaled, solution, inputs, x):
    """Quantity -> (k, B), and (2, k, B, m), of solutions that have numbers; and quantity -> (k, B) of SIGNED ones by
    differences. `scaled`, and a and D of the `solution`, are in units R = E2* = 1."""
    k, size = len(inputs), len(scaled)
    logs = {name: np.full((k, size), np.nan) for name in QUANTITIES}
    slopes = {name: np.full((k, size), np.nan) for name in SIGNED}
    shapes, left = np.full((2, k, size, len(x)), np.nan), np.ones(size, dtype=bool)
    felt = scaled.feels_layer()
    scaled = scaled.but(asperities_on=np.where(felt, "layer", "half_space"))  # also where a moved h is below the pitch
    now, above = held(scaled, solution.model_used), moved(scaled, inputs)
    beside = held(above, np.tile(solution.model_used, 2 * k))
    stateless = without_state(scaled)
    again = np.flatnonzero(~stateless & ~felt)
    for rows, nodes in stacks(now.written.take(again), meshes(solution, scaled)[again], solution.a[again], _STACK):
        index = again[rows]
        rows = (np.arange(2 * k)[:, None] * size + index).ravel()
        part = now.take(index), beside.take(rows), above.take(rows)
        good, derivatives, at_x = _of_stack(*part, solution.take(index), nodes, x)
        left[index[good]] = False
        for name, values in derivatives.items():
            logs[name][:, index[good]] = values[:, good]
        shapes[:, :, index[good]] = at_x[:, :, good]
    for fine in (False, True):
        rest = np.flatnonzero(left & ~now.added & (stateless == fine))
        if not len(rest):
            continue
        derivatives, shapes[:, :, rest], signed = by_differences(now.named.take(rest), inputs, QUANTITIES, x, fine)
        for found, into in (derivatives, logs), (signed, slopes):
            for name, values in found.items():
                into[name][:, rest] = values
    return logs, shapes, slopes


def _of_stack(now: Held, beside: Held, above, solution, nodes, x):
    """(B,) bool, whether the solutions were found again; quantity -> (k, B); and (2, k, B, m) for p and λ.

    beside, above : the 2 k B moved cases as they are solved, and as they were asked for
    """
    k, rtol = len(beside.E2) // (2 * len(now.E2)), now.written.rtol
    iterated = found_again(as_cases(now.written), nodes, solution.a, rtol)
    ev, d_E2 = iterated.at, slope_of(np.log(beside.E2), k)
    changes = changes_of(beside.written, ev.state.eta, k)
    operators = operators_of(ev, changes)
    derivatives = implicit(ev, changes, operators)
    logs = derivatives.logs | {"dP_dD": stiffness_slopes(ev, beside.written, derivatives, operators)}
    bent = ev.cases.law.bent(ev.state.y, ev.curve.q)
    if bent.any():
        logs["Ar_An"] = np.where(bent, of_corners(ev, changes, derivatives), logs["Ar_An"])
    logs |= {name: logs[name] + d_E2 for name in _OF_MODULUS}
    at = profiles(ev, changes, derivatives, x)
    d_p, d_lam = now.E2[:, None] * (at.d_p + d_E2[..., None] * at.p), at.d_lam
    if now.added.any():
        spots, lam = added_slopes(ev, changes, derivatives, above, (now.E2, d_E2), x)
        logs = {name: np.where(now.added, spots.get(name, values), values) for name, values in logs.items()}
        d_lam = np.where(now.added[:, None], lam, d_lam)
    finite = np.ones(len(now.E2), dtype=bool)
    for name, values in logs.items():
        finite &= np.isfinite(values).all(axis=0) | (pointed(ev.cases) & (name in _OF_CENTRE))
    good = iterated.closed & finite & same(ev, solution, rtol)
    return good, logs, np.stack([d_p, d_lam])
