"""Contacts that have no stresses yet."""

import numpy as np

from solver.bases import is_stack
from solver.shapes import PARABOLOID

from ..grid import Grid, along

#: Inputs that decide whether there are stresses.
DECIDE = ("shape", "w_adhesion", "adhesion")


def without_stresses(rough, shape=PARABOLOID, w_adhesion=0.0, adhesion="jkr", *, largest=False) -> str:
    """The reason why some of the cases have no stresses, or no `largest` ones; "" if all have them. Values are texts
    and numbers, or arrays; rough : whether the cases have asperities."""
    shape, sticks = np.asarray(shape), np.asarray(w_adhesion) > 0
    flat = shape == "flat"
    reasons = (
        (
            sticks & (np.asarray(adhesion) != "jkr"),
            'no stresses of contacts that adhere yet, except with adhesion = "jkr"',
        ),
        (
            rough & (shape != PARABOLOID),
            "no stresses under rough punches of this shape yet, only under smooth ones",
        ),
        (
            largest & (flat | sticks),
            "no largest stresses under a flat punch, or where the surfaces adhere: they are infinite at the edge; "
            "study.stresses computes the stresses inside, and shape = rounded_flat has finite ones",
        ),
    )
    return next((f"there are {text}" for where, text in reasons if np.any(where)), "")


def none_in(grid: Grid, *, largest: bool = True) -> str:
    """The same for the cases of a grid."""
    if np.any(is_stack(np.asarray(along(grid, "base")))):
        return "the largest stresses in stacks of layers are not stored: study.extremes computes them for any results"
    rough = ~np.isin(along(grid, "micro"), grid.lexicon.smooth_laws())
    return without_stresses(rough, *(along(grid, name) for name in DECIDE), largest=largest)
