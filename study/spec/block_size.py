"""Number of cases in a block when the study does not say it.

A run that is killed loses the blocks in work, so blocks of slow cases are small.
"""

import numpy as np

from .grid import Grid, along

USUAL = 8000  # of ordinary cases: some seconds of work
SLOW = 1000  # of cases that take some milliseconds each
SLOWEST = 100  # of cases that may take ten seconds each
#: On the exact layer, an n above this or an rtol below this may need a mesh for each single case.
_STIFF, _FINE = 1e3, 1e-9
_MANY_NODES = 96  # a user who asks for more has more than the solver begins with


def usual_block(grid: Grid) -> int:
    """Number of cases in a block of a grid, by its slowest kind of case, whatever is computed already."""
    n, rtol, nodes = (along(grid, name) for name in ("n", "rtol", "nodes"))
    layered = np.isin(along(grid, "base"), ("layered", "auto")).any()
    approximated = (along(grid, "scheme") == "picard").any()
    if layered and (approximated or (n > _STIFF).any() or (rtol < _FINE).any()):
        return SLOWEST
    return SLOW if approximated or (nodes > _MANY_NODES).any() else USUAL
