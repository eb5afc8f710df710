"""Bodies of one material: independent pieces of it, or one piece, whose moduli are off together."""

from typing import Any

import numpy as np
import xarray as xr

from ..grid import MOVED
from ..vocabulary import BODIES
from .scene import STEP, Scene

_RIGID = "rigid"  # the name of what has no modulus


def alike(names: dict, one: str, other: str) -> Any:
    """Where two bodies are of one material: a bool, or a DataArray over the dimensions of their names.

    names : as those of a Scene
    """
    if one not in names or other not in names:
        return False
    first, second = (_labelled(*names[body]) for body in (one, other))
    same = (first == second) & (first != _RIGID)
    return same if same.any() and not same.all() else bool(same.all())


def none_alike(names: dict) -> bool:
    """Whether no case has two bodies of one material."""
    bodies = list(BODIES)
    return not any(np.any(alike(names, *pair)) for pair in (bodies[:2], bodies[1:], bodies[::2]))


def move(scene: Scene) -> None:
    """Give inputs with spreads the dimension MOVED: all as given, then each in turn moved up and moved down by STEP.

    Inputs of one piece are moved in one turn.
    """
    turns = _turns(scene.spreads, scene.names if scene.same_piece else {})
    order = list(dict.fromkeys(turn for of_input in turns.values() for turn in of_input))
    for name, spread in scene.spreads.items():
        for turn, where in turns[name].items():
            steps, i = np.zeros(1 + 2 * len(order)), order.index(turn)
            steps[1 + 2 * i : 3 + 2 * i] = STEP, -STEP
            scene.given[name] = scene.given[name] + where * spread * xr.DataArray(steps, dims=MOVED)


def _turns(spreads: dict, names: dict) -> dict[str, dict[str, Any]]:
    """Input with a spread -> the input in whose turn it is moved -> where, a bool or a DataArray.

    That is E or ν of the first body that is of the same material there, and otherwise the input itself.

    names : as those of a Scene; {}: all are moved in turn
    """
    found = {name: {name: True} for name in spreads}
    pairs = [(body, other) for j, body in enumerate(BODIES) for other in list(BODIES)[:j]]
    for body, other in pairs:
        same = alike(names, other, body)
        for name, first in zip(BODIES[body][:2], BODIES[other][:2], strict=True):
            if name in spreads and first in spreads and np.any(same):
                left = found[name].pop(name, False)  # where no body before `other` is of the material
                found[name] |= {first: np.logical_and(left, same), name: np.logical_and(left, np.logical_not(same))}
    return {name: {turn: where for turn, where in own.items() if np.any(where)} for name, own in found.items()}


def _labelled(dim: str, texts: list[str]) -> xr.DataArray:
    return xr.DataArray(texts, dims=dim) if dim else xr.DataArray(texts[0])
