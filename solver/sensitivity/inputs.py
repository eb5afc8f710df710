"""The inputs by which there are derivatives, the cases with each of these moved, and the differences.

All derivatives are by the logarithm of an input, except those by a Poisson ratio, which are by the ratio itself.
"""

import numpy as np

from ..layers import numbers_of
from ..parameters import CONTROL, is_ratio

#: The logarithm of an input is moved up and down by this, and so is a Poisson ratio. The error by the third derivative
#: is then 1e-8 times this, and that by rounding 1e-12 to 1e-9. The radius moves by the same factors: then few ratios of
#: two lengths are different, such as those that say where the kinks of a punch are (:mod:`.step`).
STEP = 1e-4
#: Numbers that are not inputs: they control how a case is solved, or are units, whose effect follows from dimensions.
_NO_INPUTS = {"accuracy", "k", "rtol", "R", "E2"}


def inputs_of(problem):
    """Names of all inputs, which are the numbers with an interval; the control is the first."""
    rows = problem.known.table(numbers_of(problem.parameters))
    numbers = [name for name, row in rows.items() if row.interval and not row.whole and name not in _NO_INPUTS]
    return (problem.control, *numbers)


def moved_cases(problem, inputs, step=STEP, copies=0):
    """:class:`~solver.problem.Problem` of 2 (k + copies) B cases: for each of the k inputs, all cases with this input
    moved up, then all with it moved down. `copies` pairs of unmoved blocks follow."""
    size, k = len(problem), len(inputs)
    rows = problem.take(np.tile(np.arange(size), 2 * (k + copies)))
    sign = np.array([1.0, -1.0])[:, None]
    value, arrays = rows.value, {}
    for i, name in enumerate(inputs):
        values = np.array(rows.value if name in CONTROL else getattr(rows, name), dtype=float)
        pair = values.reshape(-1, 2, size)[i]
        if is_ratio(name):
            pair += sign * step
        else:
            pair *= np.exp(sign * step)
        if name in CONTROL:
            value = values
        else:
            arrays[name] = values
    return type(problem)(problem.control, value, rows.parameters | arrays, problem.known)


def slope_of(values, k, step=STEP):
    """Derivatives (k, B, ...) from values (2 k B, ...) of :func:`moved_cases`; 0 where nothing changes, even if the
    values are infinite."""
    up, down = np.moveaxis(values.reshape(k, 2, len(values) // (2 * k), *values.shape[1:]), 1, 0)
    return np.where(up == down, 0.0, (up - down) / (2 * step))
