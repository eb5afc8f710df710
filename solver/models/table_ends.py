"""Contacts that would reach beyond the last row of the table of their shape."""

from dataclasses import replace

import numpy as np

from ..shapes import shape_of
from ..shapes.table import PREFIX
from ..status import Status
from .named import solve_named

#: Part of the last radius that stands for the last radius; and rtol of the contact with that radius.
_LAST, _ROUGHLY = 1 - 1e-9, 1e-4


def beyond_table(scaled, solution):
    """(B,) bool: whether the contact would reach beyond the last row of the table of its shape. If the load or depth is
    given and the case was not solved, it is compared with that of a contact up to the last row.

    scaled : the problem in units R = E2* = 1
    """
    past_end, of_table = np.zeros(len(scaled), dtype=bool), np.char.startswith(scaled.shape, PREFIX)
    for word in np.unique(scaled.shape[of_table]).tolist():
        index = np.flatnonzero(scaled.shape == word)
        most = shape_of(scaled.take(index)).most()
        if scaled.control == "a":
            past_end[index] = scaled.value[index] >= most
            continue
        left = np.flatnonzero(solution.status[index] != Status.CONVERGED)
        if len(left):
            part, control = scaled.take(index[left]), scaled.control
            last = replace(part, control="a", value=most[left] * _LAST).but(rtol=_ROUGHLY, w_adhesion=0.0)
            past_end[index[left]] = part.value > getattr(solve_named(last, np.zeros(0)), control)
    return past_end
