"""The bases, by their names: the body under the punch, and its equation. No other file compares these words.

Each function takes the word of a base, or an array of words of any kind (of numpy, of xarray), and returns a bool, or
an array of bool of the same kind and shape.
"""

from typing import Any, NamedTuple

import numpy as np


class Base(NamedTuple):
    """One base.

    layers : number of layers on the half-space: "none", "one", or "stack" for any number
    springs : whether the layers act like springs on the half-space, Eq. (3)
    exact : the name of the base with the same layers and without that simplification
    chosen : whether the solver chooses for each case the cheapest equation that is accurate enough
    """

    layers: str
    springs: bool
    exact: str
    chosen: bool = False


#: Name -> :class:`Base`, in the order of the choices of `base`.
TABLE = {
    "half_space": Base("none", False, "half_space"),
    "thin_layer": Base("one", True, "layered"),
    "layered": Base("one", False, "layered"),
    "auto": Base("one", False, "layered", chosen=True),
    "stack": Base("stack", False, "stack"),
    "thin_stack": Base("stack", True, "stack"),
}
BASES = tuple(TABLE)
#: The bases with a layer; with a stack of layers; with springs; and those on which asperities can feel the coated body.
#: Among the last, a base that leaves the equation to the solver then has that of the exact layer.
WITH_LAYERS = tuple(name for name, row in TABLE.items() if row.layers != "none")
STACKS = tuple(name for name, row in TABLE.items() if row.layers == "stack")
SPRINGS = tuple(name for name, row in TABLE.items() if row.springs)
FELT = tuple(name for name in WITH_LAYERS if not TABLE[name].springs)
_BARE = tuple(name for name in BASES if name not in WITH_LAYERS)
_ONE_ON_SPRINGS = tuple(name for name in SPRINGS if name not in STACKS)
_CHOSEN = tuple(name for name, row in TABLE.items() if row.chosen)
_EXACT = tuple(name for name in FELT if name not in _CHOSEN)
_EXACT_STACKS = tuple(name for name in _EXACT if name in STACKS)
_MAY_BE_LAYERED = tuple(name for name in FELT if name not in STACKS)


def _among(base: Any, words: tuple[str, ...]) -> Any:
    met = base == words[0]
    for word in words[1:]:
        met = met | (base == word)
    return met


def is_bare(base: Any) -> Any:
    """Whether there is no layer."""
    return _among(base, _BARE)


def on_springs(base: Any) -> Any:
    """Whether one layer or a stack acts like springs, Eq. (3)."""
    return _among(base, SPRINGS)


def is_thin_layer(base: Any) -> Any:
    """Whether one layer acts like springs."""
    return _among(base, _ONE_ON_SPRINGS)


def is_stack(base: Any) -> Any:
    """Whether there is a stack of layers, exact or as springs."""
    return _among(base, STACKS)


def is_exact_stack(base: Any) -> Any:
    """Whether there is a stack of layers whose equation is the exact one."""
    return _among(base, _EXACT_STACKS)


def is_exact(base: Any) -> Any:
    """Whether the equation is that of an exact layer or stack."""
    return _among(base, _EXACT)


def may_be_layered(base: Any) -> Any:
    """Whether the equation is that of one exact layer, or may become that."""
    return _among(base, _MAY_BE_LAYERED)


def is_chosen(base: Any) -> Any:
    """Whether the solver still has to choose the equation of each case."""
    return _among(base, _CHOSEN)


def exact_of(base: Any) -> np.ndarray:
    """The bases with the same layers and the exact equation; an array of words."""
    words = np.asarray(base)
    return np.select([words == name for name in TABLE], [row.exact for row in TABLE.values()], words)


def named(base: Any) -> np.ndarray:
    """The bases, with the exact base in place of each whose equation the solver still has to choose; an array of
    words."""
    return np.where(is_chosen(base), exact_of(base), base)
