"""What is said of asperities that feel the layer: that they do, and where their law ends."""

from __future__ import annotations

import numpy as np

from solver import Status
from solver.laws.cell.family import MOST, REACH
from solver.models.cells import last_fraction
from solver.models.range_of_law import without_family

from ...again import Again
from ...arrays import xarray_later as xr
from ...inputs.definition import StudyError
from ...inputs.punch.asperities import USED
from ...rules.rule import of_cases
from ...terminal import rounded

#: A law that ends at less than this part of the largest contact fraction ends because the disc cell goes wrong.
_EARLY = 0.999
_FAR = f"The pitch of the asperities is above {MOST:g} h: what the layer does to them is not known there"
_MERGED = (
    f"The spots cover more than {REACH:g} of the area in the centre, or in a ring, and are no circles any more: the \
law of asperities on the coated body ends there"
)
_HALF_SPACE = 'asperities_on = "half_space" has numbers, of a half-space of the layer\'s material.'


def presses_on(case: xr.Dataset) -> str:
    """The end of the sentence on the model: what the asperities press on, where the contact says it."""
    if "asperities_used" not in case or case["asperities_used"] == 0:
        return ""
    felt = case["asperities_used"] == USED.index("layer")
    return (
        ", which press on the coated body itself" if felt else ", which press on a half-space of the layer's material"
    )


def ended(contacts: xr.Dataset) -> list[str]:
    """Sentences on contacts at pressures that the law of asperities on their bodies does not know, and the way out."""
    if "asperities_used" not in contacts:
        return []
    outside = (contacts["status"].values == Status.OUTSIDE_LAW) & (
        contacts["asperities_used"].values == USED.index("layer")
    )
    if not outside.any():
        return []
    try:
        problem = Again.of(contacts, "summary").problem
    except StudyError:  # of a mean, say
        return []
    index, last = np.flatnonzero(outside), np.full(outside.shape, np.nan)
    part, far = problem.take(index), np.zeros_like(outside)
    last.flat[index], far.flat[index] = last_fraction(part), without_family(part)
    early = outside & ~far & (last < _EARLY * REACH)
    said = []
    if early.any():
        text = f"On a layer this soft the disc cell goes wrong where spots cover more than {rounded(last[early].min())}"
        said.append(f'{of_cases(early)}{text} of the area: micro = "hex_lattice" goes on to {REACH:g}.')
    for where, text in ((far, _FAR), (outside & ~far & ~early, _MERGED)):
        said += [f"{of_cases(where)}{text}; {_HALF_SPACE}"] * bool(where.any())
    return said
