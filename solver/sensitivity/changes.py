"""What an input changes: the numbers of the cases, by differences of explicit functions of the parameters.

All derivatives are by the logarithm of an input; by a Poisson ratio itself. The formulas of bodies and laws are asked
for their numbers a little above and a little below: nothing is solved, so that there is no noise of an iteration.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..layers import numbers_of
from ..parameters import CONTROL, is_ratio
from ..rough.equation import Cases, groups
from ..rough.punch import punch_of
from ..scaling import as_cases
from ..shapes import PARABOLOID, shape_of

#: An input is moved up and down by this part of itself, a Poisson ratio by this number. The curvature then adds 1e-8
#: times a third derivative, and rounding 1e-12.
STEP = 1e-4
#: Numbers of a shape are moved by this part of STEP: rounding then adds 1e-10.
_NEARER = 1e-2
#: Numbers that are no inputs: they say how a case is solved, or are units, whose effect follows from dimensions.
_NO_INPUTS = {"accuracy", "k", "rtol", "R", "E2"}


def inputs_of(problem):
    """Names of all inputs, the control first: numbers that have an interval."""
    rows = problem.known.table(numbers_of(problem.parameters))
    numbers = [name for name, row in rows.items() if row.interval and not row.whole and name not in _NO_INPUTS]
    return (problem.control, *numbers)


def moved(problem, inputs, step=STEP):
    """:class:`~solver.problem.Problem` of 2 k B cases: for each of the k inputs all cases with it moved up, then all
    with it moved down."""
    size, k = len(problem), len(inputs)
    rows = problem.take(np.tile(np.arange(size), 2 * k))
    sign = np.array([1.0, -1.0])[:, None]
    arrays = {name: values for name, values in (("value", rows.value), *rows.parameters.items()) if name not in inputs}
    for i, name in enumerate(inputs):
        key = "value" if name in CONTROL else name
        values = np.array(arrays.get(key, getattr(rows, key)), dtype=float).reshape(k, 2, size)
        values[i] += sign * step * (1.0 if is_ratio(name) else values[i])
        arrays[key] = values.ravel()
    value = arrays.pop("value")
    return type(problem)(problem.control, value, rows.parameters | arrays, problem.known)


def slope_of(values, k, step=STEP):
    """Derivatives (k, B, ...) from values (2 k B, ...) of the cases of :func:`moved`; 0 where nothing changes, infinite
    values too."""
    up, down = np.moveaxis(values.reshape(k, 2, len(values) // (2 * k), *values.shape[1:]), 1, 0)
    return np.where(up == down, 0.0, (up - down) / (2 * step))


def moved_along(values, slopes):
    """Values (2 k B, ...) of the moved cases, from values (B, ...) that have the derivatives `slopes` (k, B, ...)."""
    both = np.stack([values + STEP * slopes, values - STEP * slopes], axis=1)
    return both.reshape(-1, *values.shape[1:])


class Changes(NamedTuple):
    """Derivatives of the numbers of B cases by k inputs, (k, B) each: of the groups X, Y, Z; of the logarithms of p*,
    A* and the controlled value; of the numbers of the law, `own`; and of ln h of the body, whose operator depends on
    h/a. `depth` (k, B) is that of the depth of the punch, and `drop` (s (m,) -> (k, B, m)) makes that of its drop:
    numbers of a shape change both. `cases`: the 2 k B moved ones; `on_body`: indices of the inputs that change the
    operator in another way."""

    cases: Cases
    X: np.ndarray
    Y: np.ndarray
    Z: np.ndarray
    p_star: np.ndarray
    A_star: np.ndarray
    value: np.ndarray
    own: tuple
    h: np.ndarray
    on_body: list
    depth: np.ndarray
    drop: Callable


def changes_of(part, eta, k):
    """:class:`Changes` at η = ln a (B,), from the 2 k B moved cases `part` of :func:`moved`, in units R = E2* = 1."""
    cases = as_cases(part)
    law = cases.law
    X, Y, Z = (slope_of(v[:, 0], k) for v in groups(cases, np.tile(eta, 2 * k)))
    logs = (slope_of(np.log(v), k) for v in (law.p_star, law.A_star, cases.value))
    own = tuple(slope_of(v[:, 0], k) for v in law.own)
    h, acts = np.zeros((k, len(eta))), np.zeros(k, dtype=bool)
    for name, values in _leaves(cases.body):
        if name == "h":
            h = slope_of(np.log(values), k)
        elif values.dtype.kind == "f":
            slopes = slope_of(values, k)
            acts |= np.any(slopes != 0, axis=tuple(range(1, slopes.ndim)))
    h[acts] = 0.0  # the operators of the moved bodies have the change of h already
    return Changes(cases, X, Y, Z, *logs, own, h, np.flatnonzero(acts).tolist(), *_of_punch(part, eta, k))


def _of_punch(part, eta, k):
    """Derivatives of the depth of the punch, (k, B), and a function that has those of its drop, for the moved cases.

    Numbers of a shape are moved by _NEARER of what the others are: a kink moves with them, and nodes next to it must
    stay on its other side.
    """
    if part.shape[0] == PARABOLOID:
        return np.zeros((k, len(eta))), lambda s: 0.0
    nearer = {}
    for name in part.known.shapes[str(part.shape[0])].parameters:
        values = getattr(part, name)
        if values.dtype.kind == "f":
            both = values.reshape(k, 2, len(eta))
            middle = both.mean(axis=1, keepdims=True)
            nearer[name] = (middle + _NEARER * (both - middle)).ravel()
    punch, a = punch_of(shape_of(part.but(**nearer))), np.tile(np.exp(eta), 2 * k)
    step = STEP * _NEARER
    return slope_of(punch.depth(a), k, step), lambda s: slope_of(punch.drop(a, s), k, step)


def _leaves(body, name=""):
    """Yield the name and the array of each number of a body."""
    if hasattr(body, "_fields"):
        for key, part in zip(body._fields, body, strict=True):
            yield from _leaves(part, key)
    elif isinstance(body, np.ndarray):
        yield name, body
