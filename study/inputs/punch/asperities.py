"""What the asperities of a study press on: the coated body itself, or a half-space of the layer's material."""

import math
from functools import partial
from typing import Any

import numpy as np

from solver.bases import FELT, is_chosen, is_exact, is_stack, on_springs
from solver.laws import Law
from solver.laws.own_table import OF_FILES
from solver.parameters import one_of
from solver.problem import can_feel, far_apart, feels

from ...terminal import shown
from ..grid import Grid, along

#: What asperities have pressed on, value of `asperities_used` -> its name.
USED = ("none", "half_space", "layer")

#: What the law of asperities that feel the body depends on, which takes some 10 ms for each. Where a body and a pitch
#: have at least so many cases that is little.
_OF_BODIES, _FEW_CASES = ("h", "n", "m", "nu1", "nu2", "bonding", "Nbar"), 20


def felt(grid: Grid) -> np.ndarray:
    """bool, along the dimensions of the grid: the cases whose asperities feel what lies below the surface."""
    words = (along(grid, name) for name in ("base", "micro", "asperities_on", "Nbar", "h"))
    return feels(*words, grid.lexicon.known.laws)


def many_bodies(grid: Grid) -> bool:
    """Whether asperities feel bodies, or stand at pitches, of which there are more than a few for each case."""
    if not felt(grid).any():
        return False
    names = [name for name in grid.values if name in _OF_BODIES or name.startswith("layers.")]
    dims = {dim for name in names for dim in grid.values[name][0]}
    return _FEW_CASES * math.prod(grid.sizes[dim] for dim in dims) > grid.size > _FEW_CASES


def is_said(grid: Grid) -> bool:
    """Whether the results say what the asperities press on: some feel the layer, or the study names `asperities_on`."""
    return "asperities_on" in grid.values or bool(felt(grid).any())


def used(grid: Grid) -> np.ndarray:
    """int8, over all dimensions of the grid: places in `USED`."""
    laws = grid.lexicon.known.laws
    rough = one_of(along(grid, "micro"), [name for name, law in laws.items() if law.rough])
    return np.broadcast_to(rough.astype(np.int8) + felt(grid), grid.shape).astype(np.int8)


def stand_apart(grid: Grid) -> np.ndarray:
    """bool, along the dimensions of the grid: asperities stand farther apart than the layer is thick, and numbers of
    the case depend on that."""
    if not {"h", "Nbar"} <= {*grid.values}:
        return np.False_
    base, micro, check = (along(grid, name) for name in ("base", "micro", "model_check"))
    laws, cases_with = grid.lexicon.known.laws, partial(grid.lexicon.cases_with, values=partial(along, grid))
    exact = is_exact(base) | is_chosen(base) & can_feel(base, micro, laws)
    # the `model_error` of these is that of the exact layer, though asperities on them do not feel it
    against = on_springs(base) & (is_stack(base) | (check == "first_order"))
    counts = exact | against & can_feel("layered", micro, laws)
    there = cases_with("Nbar") & cases_with("h")
    return counts & there & far_apart(along(grid, "Nbar"), along(grid, "h"))


def mistakes(grid: Grid, sections: Any) -> list[str]:
    """Messages about asperities that are to feel a layer and cannot, and about a choice where there is none."""
    if "asperities_on" not in sections:
        return []
    base, micro, on = np.broadcast_arrays(*(along(grid, name) for name in ("base", "micro", "asperities_on")))
    known = grid.lexicon.known.laws
    can, layer, messages = can_feel("layered", micro, known), on == "layer", []
    if (wrong := ~can & (layer if can.any() else on != "auto")).any():
        laws = " or ".join(shown(name) for name, law in known.items() if law.on_body)
        way_out = f"leave it out, or take micro = {laws}"
        messages.append(f"{_with(on[wrong], 'micro', micro[wrong])}, {_why(known[str(micro[wrong][0])])}: {way_out}")
    if (thin := layer & can & ~one_of(base, FELT)).any():
        way_out = 'take base = "layered" or "stack", or asperities_on = "auto"'
        messages.append(f"{_with(on[thin], 'base', base[thin])}, on which they press on a half-space: {way_out}")
    return messages


def _with(words: np.ndarray, name: str, values: np.ndarray) -> str:
    return f"asperities_on = {shown(str(words[0]))} is given with {name} = {shown(str(values[0]))}"


def _why(law: Law) -> str:
    if not law.rough:
        return "which has no asperities"
    if law.name == "power_law" or law.name.startswith(OF_FILES):
        return "whose A[p] is given, whatever asperities press on"
    return "a law that takes no kernel of the body"
