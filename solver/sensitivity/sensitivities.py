"""Derivatives of the answers by the inputs: one Newton step of each solved contact for each moved input.

The equation of each case is solved once more on its mesh, at its radius. :mod:`.step` makes the contacts with the same
radius and an input moved up and down. The differences of their answers are derivatives at fixed radius. From these and
the derivatives by the radius follows, with the control, the change of the radius. Smooth contacts that have another
equation are solved at the same radius with each input moved, and if all that fails, under the control:
:mod:`.differences`.
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
from ..scaling import dimensionless
from ..solution import Solution
from ..status import Status
from .answers import QUANTITIES, derivatives_of
from .differences import SIGNED, at_their_radii, by_differences, of_radii
from .inputs import inputs_of
from .same_mesh import meshes, stacks, without_state
from .solved_cases import solved_cases

#: A number counts as near 0 if its derivative by ln input is more than this many times the number itself.
_NEAR_0 = 5.0
#: Quantities whose sensitivity is NaN where they are infinite, NaN, or 0, as a load under adhesion may be.
_NEVER_0 = tuple(name for name in QUANTITIES if name != "A0")
#: Most unknowns of a stack: with k inputs each of its contacts has 2 (k + 1) moved ones.
_STACK = STACK // 8


class Sensitivities(NamedTuple):
    """Derivatives of B solutions by k inputs.

    Attributes
    ----------
    inputs : names of the inputs, the control first
    logs : quantity -> (B, k), d ln quantity/d ln input; for a Poisson ratio d ln quantity/d ratio. 0 where an input
        does not act, or is 0; NaN for a case without numbers. For a smooth punch the derivatives of A0, which is 0, are
        0
    slopes : quantity -> (B, k), d quantity/d ln input in the unit of the quantity, even where the quantity is 0
    p, lam : (B, k, m), d p/d ln input at fixed r/a, in the unit of p, and d λ/d ln input

    Examples
    --------
    >>> from solver import Problem, solve
    >>> problem = Problem.of(a=0.04, micro="smooth", base="half_space")
    >>> slopes = sensitivities(problem, solve(problem), inputs=("a",))
    >>> print(slopes.inputs, f"{slopes.logs['P'].item():.4f}")
    ('a',) 3.0000
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
    problem, solution : the cases, and their solution by `solve`
    x : (m,), radii r/a in [0, 1] of the profiles
    inputs : names of the control and of parameters that are numbers; None: all of them

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
        ended = replace(ended, a=ended.a / part.R, D=ended.D / part.R, P=ended.P / (part.E2 * part.R**2))
        by_name, at_x, slopes = _of_solved(dimensionless(part), ended, acting, x)
        for derivatives, into in (by_name, logs), (slopes, signed):
            for name, values in derivatives.items():
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
    """(B, k) bool, whether under adhesion a number with the `value` (B,) is 0 or near 0; and its `slopes` (B, k) in its
    unit."""
    of_E2, of_R = SIGNED[name]
    straight = slopes * (problem.E2**of_E2 * problem.R**of_R)[:, None]
    adheres, size = (problem.w_adhesion > 0)[:, None], np.abs(value)[:, None]
    return adheres & ((np.abs(straight) > _NEAR_0 * size) | (size == 0) & np.isfinite(straight)), straight


def _acts(problem, name):
    """Whether an input changes the answer of some case: whether it is used, given, and not 0; a Poisson ratio may be
    0."""
    if name == problem.control:
        return True
    values = getattr(problem, name)
    there = np.isfinite(values) & (is_ratio(name) | (values != 0))
    return bool(np.any(there & problem.known.uses(name, lambda key: getattr(problem, key))))


def _of_solved(scaled, solution, inputs, x):
    """The answers of :func:`~.differences.by_differences` for solutions that have numbers; SIGNED numbers have
    derivatives only where these are by differences. `scaled`, and a and D of the `solution`, are in units R = E2* =
    1."""
    k, size = len(inputs), len(scaled)
    logs = {name: np.full((k, size), np.nan) for name in QUANTITIES}
    slopes = {name: np.full((k, size), np.nan) for name in SIGNED}
    shapes, left = np.full((2, k, size, len(x)), np.nan), np.ones(size, dtype=bool)
    # asperities press on the same body when h is moved, even if it is then below the pitch
    scaled = scaled.but(asperities_on=np.where(scaled.feels_layer(), "layer", "half_space"))
    now, stateless = solved_cases(scaled, solution.model_used), without_state(scaled)
    by_step = np.flatnonzero(~stateless)
    cases = now.written.take(by_step), meshes(solution, scaled)[by_step], solution.a[by_step]
    for rows, nodes in stacks(*cases, _STACK, scaled.micro[by_step]):
        index = by_step[rows]
        part = scaled.take(index), now.take(index), solution.take(index)
        good, derivatives, at_x = derivatives_of(*part, inputs, nodes, x)
        left[index[good]] = False
        for name, values in derivatives.items():
            logs[name][:, index[good]] = values[:, good]
        shapes[:, :, index[good]] = at_x[:, :, good]
    for index in of_radii(scaled):
        part = now.named.take(index), solution.take(index)
        good, *derivatives = at_their_radii(*part, inputs, QUANTITIES, x)
        left[index[good]] = False
        _put((logs, shapes, slopes), index, derivatives, good)
    for fine in (False, True):
        rest = np.flatnonzero(left & ~now.added & (stateless == fine))
        if len(rest):
            derivatives = by_differences(now.named.take(rest), inputs, QUANTITIES, x, fine)
            _put((logs, shapes, slopes), rest, derivatives, np.full(len(rest), True))
    return logs, shapes, slopes


def _put(answers, index, derivatives, good):
    """Put the three answers of :func:`~.differences.by_differences` for the cases `index` into those of all cases,
    where they are `good`, (b,) bool."""
    (logs, shapes, slopes), (by_name, at_x, signed) = answers, derivatives
    shapes[:, :, index[good]] = at_x[:, :, good]
    for values_of, into in (by_name, logs), (signed, slopes):
        for name in into:
            into[name][:, index[good]] = values_of[name][:, good]
