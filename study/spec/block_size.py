"""How many cases a block has where a study does not say: the longer a case may take, the fewer, for a kill costs the
blocks in the making."""

import numpy as np

from .grid import Grid, along

#: Ordinary cases: some seconds of work. Cases of some milliseconds each. Cases of up to ten seconds.
USUAL, SLOW, SLOWEST = 8000, 1000, 100
#: A stiffer layer, and a smaller rtol, may want a mesh of its own for each case.
_STIFF, _FINE = 1e3, 1e-9
#: More nodes than the solver itself begins with.
_MANY = 96


def usual_block(grid: Grid) -> int:
    """Number of cases of a block of a grid, by the dearest that it may hold; the same whatever is already computed."""
    n, rtol, nodes = (along(grid, name) for name in ("n", "rtol", "nodes"))
    layered = np.isin(along(grid, "base"), ("layered", "auto")).any()
    approximated = (along(grid, "scheme") == "picard").any()
    if layered and (approximated or (n > _STIFF).any() or (rtol < _FINE).any()):
        return SLOWEST
    return SLOW if approximated or (nodes > _MANY).any() else USUAL
