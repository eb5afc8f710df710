"""Which contacts have no stresses yet."""

import numpy as np

from solver.parameters import STACKED
from solver.shapes import PARABOLOID

from ..laws import smooth_laws


def without_stresses(base, micro, shape=PARABOLOID, w_adhesion=0.0) -> str:
    """Why some of the cases have no stresses; "" where all have them. Values are texts and numbers, or arrays."""
    rough = ~np.isin(micro, smooth_laws())
    reasons = (
        (np.isin(base, STACKED[1]), "in stacks of layers yet, but of one layer (base = layered)"),
        (np.asarray(w_adhesion) > 0, "of contacts that stick (w_adhesion > 0) yet"),
        (
            np.asarray(shape) == "flat",
            "under a flat punch, at whose edge they are infinite, but under a rounded_flat one",
        ),
        (rough & (np.asarray(shape) != PARABOLOID), "under rough punches of this shape yet, but under smooth ones"),
    )
    return next((f"there are no stresses {text}" for where, text in reasons if np.any(where)), "")
