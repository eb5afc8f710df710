"""What can be wrong with a grid as a whole, though each of its parameters is right."""

from collections.abc import Callable, Collection, Iterable
from functools import partial

import numpy as np

from solver import Problem
from solver.laws import LAWS, untried
from solver.scaling import dimensionless, law_of

from ..terminal import shown
from .grid import Grid, along
from .laws import smooth_laws
from .vocabulary import CONTROLS, PARAMETERS, VOCABULARY, cases_with

FITTED = ("B", "beta")
"""Parameters that are fitted to Nbar and Ra where neither is given (`fitted.py`)."""


def not_given(given: Collection[str], texts: Callable[[str], Iterable], errors: list[str]) -> list[str]:
    """Messages for parameters without a default that are not given, though some case needs them.

    given : names of those that are given; texts : a function, name of a parameter such as base -> its values
    errors : found before. If one is of an unknown name or section, the missing parameter may be there: no messages then
    """
    messages = []
    if any("is not a parameter" in error or "is not a section" in error for error in errors):
        return []
    neither = not {*FITTED} & {*given}  # is given: then both are fitted, and it is said once to what
    for name in PARAMETERS:
        own = VOCABULARY[name].own
        selector, words = own.needed_by
        if name in given or name in CONTROLS or own.default is not None:
            continue
        values = texts(selector)
        found = " or ".join(shown(word) for word in words if word in values)
        if name in FITTED and neither:
            if found and name == FITTED[0] and not {"Nbar", "Ra"} <= {*given}:
                messages.append("B and beta may be given; if neither is, they are fitted to Nbar and Ra")
        elif found:
            messages.append(f"{name} is missing: {selector} = {found} needs it")
    return messages


def missing_parameters(grid: Grid) -> list[str]:
    """Messages for parameters that are given, but not in some case that needs them."""
    messages = []
    for name in grid.values:
        gaps = np.isnan(along(grid, name)) if VOCABULARY[name].own.default is None else np.False_
        gaps = gaps & cases_with(name, partial(along, grid)) if gaps.any() else gaps
        if gaps.any():
            selector, words = VOCABULARY[name].own.needed_by
            case = np.argwhere(gaps)[0][list(grid.sizes).index("case")]
            found = [shown(word) for word in words if word in along(grid, selector)]
            reason = f": {selector} = {' or '.join(found)} needs it" if found else ""
            messages.append(f"{name} is missing in case {case}{reason}")
    return messages


def mixed_units(grid: Grid) -> list[str]:
    """A message if layers on a rigid base, whose numbers are in E1*, are among others, whose numbers are in E2*."""
    n, layered = np.broadcast_arrays(along(grid, "n"), cases_with("n", partial(along, grid)))
    if not (n == 0).any() or not (n[layered] > 0).any():
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


def slips_of_laws(grid: Grid) -> list[str]:
    """Messages for micro laws of somebody else's that fail when they are tried at a few cases of the grid."""
    messages, (dims, micro) = [], grid.values["micro"]
    for word in sorted(word for word in set(micro.ravel().tolist()) if untried(LAWS[word])):
        having = np.argwhere(micro == word)
        few = {dim: having[np.linspace(0, len(having) - 1, 3).astype(int), axis] for axis, dim in enumerate(dims)}
        few = {dim: few.get(dim, np.linspace(0, size - 1, 3).astype(int)) for dim, size in grid.sizes.items()}
        given = {name: array[tuple(few[dim] for dim in own)] for name, (own, array) in grid.values.items()}
        try:
            law_of(dimensionless(Problem.of(**given)))
        except ValueError as error:
            messages.append(str(error))
    return messages
