"""The limits of the law of asperities on the coated body: a thick layer, a layer like its body, a thin layer.

Units E1* = Ra = l = 1; a square lattice, bonded, nu1 = 0.25, nu2 = 0.3, at one contact fraction.
"""

import numpy as np
import xarray as xr
from influence import Layer
from validate_cells import Cell, body

from solver.laws import cell_rows

LAM, BODIES = 0.1, (0.2, 10.0)
#: Pitch over h of thick layers and of thin ones, and n - 1 of layers that hardly differ from their body.
THICK, THIN, ALIKE = (0.5, 0.6, 0.8, 1.0), (120.0, 240.0, 480.0, 960.0), (0.1, 0.01, 0.001, 0.0)
#: Pitch over h of a layer so thick that exp(-2 Gh) is below rounding.
_HALF_SPACE = 0.01


def rows(pitch, n: float, nu1: float = 0.25) -> np.ndarray:
    """p, A and p_max (3, pitch)."""
    return np.array(cell_rows("square", LAM, pitch, n, nu1, 0.3, "bonded"))


def rates() -> xr.Dataset:
    """The differences of p, A and p_max from each limit, over n: `thick`, also over L(Gh) - 1 of the longest wave G;
    `alike`, over n - 1, with equal ν; `thin`, from the half-space of the body, also as a share of that at twice h."""
    thick, over, alike, thin = ([] for _ in range(4))
    bare = rows(_HALF_SPACE, 1.0)
    for n in BODIES:
        off = rows(np.array(THICK), n) / bare[:, None] - 1
        longest = [body(Cell("square", LAM, pitch, Layer(1.0, n, 0.25, bonded=True)))(np.array([2 * np.pi]))[0] - 1
                   for pitch in THICK]  # fmt: skip
        thick.append(off)
        over.append(off / longest)
        stiff = np.array([1 / n, 1.0, 1 / n])  # p and p_max are proportional to E2* = E1*/n
        thin.append(rows(np.array(THIN), n) / (stiff * bare)[:, None] - 1)
    alike = np.array([rows(8.0, 1 + more, 0.3) / bare - 1 for more in ALIKE]).T
    where = {"quantity": ["p", "A", "p_max"], "n": list(BODIES), "thick_pitch": list(THICK), "thin_pitch": list(THIN)}
    data = {"thick": (("n", "quantity", "thick_pitch"), thick), "over": (("n", "quantity", "thick_pitch"), over)}
    data |= {"alike": (("quantity", "more"), alike), "thin": (("n", "quantity", "thin_pitch"), thin)}
    return xr.Dataset(data, where | {"more": list(ALIKE)})
