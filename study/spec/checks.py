"""What can be wrong with a grid as a whole, though each of its parameters is right."""

from functools import partial

import numpy as np

from ..terminal import shown
from .grid import Grid, along, on_rigid_base
from .laws import smooth_laws
from .vocabulary import CONTROLS, PARAMETERS, VOCABULARY, cases_with


def missing_parameters(grid: Grid) -> list[str]:
    """Messages for parameters that some case needs and does not have."""
    messages = []
    for name in PARAMETERS:
        selector, words = VOCABULARY[name].own.needed_by
        if VOCABULARY[name].own.default is not None or (name in CONTROLS and name not in grid.values):
            continue
        gaps = np.isnan(along(grid, name))
        gaps = gaps & cases_with(name, partial(along, grid)) if gaps.any() else gaps
        if gaps.any():
            case = np.argwhere(gaps)[0][list(grid.sizes).index("case")] if name in grid.values else ""
            found = [shown(word) for word in words if word in along(grid, selector)]
            reason = f": {selector} = {' or '.join(found)} needs it" if found else ""
            messages.append(f"{name} is missing{f' in case {case}' if name in grid.values else ''}{reason}")
    return messages


def mixed_units(grid: Grid) -> list[str]:
    """A message if layers on a rigid base, whose numbers are in E1*, are among others, whose numbers are in E2*."""
    if not on_rigid_base(grid).any():
        return []
    n, layered = np.broadcast_arrays(along(grid, "n"), cases_with("n", partial(along, grid)))
    if not (n[layered] > 0).any():
        return []
    return [
        "n = 0, a rigid base, is among others: its numbers are in E1*, theirs in E2*. Make two studies, or give "
        'physical values (R, E1, E2 = "rigid", ... with units)'
    ]


def picard_for_nothing(grid: Grid) -> list[str]:
    """A message if all cases with the scheme "picard" are smooth: it solves rough cases only.

    In a grid that has it for rough cases too, each smooth case is refused by its status.
    """
    asked, smooth = along(grid, "scheme") == "picard", smooth_laws()
    if not asked.any() or (asked & ~np.isin(along(grid, "micro"), smooth)).any():
        return []
    others = " or ".join(shown(name) for name in VOCABULARY["micro"].own.choices if name not in smooth)
    names = " or ".join(map(shown, smooth))
    return [f'scheme = "picard" has no case to solve: micro must be {others} there, not {names}']
