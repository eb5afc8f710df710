"""Contacts that have no stresses yet, and which of the largest ones a study stores."""

import numpy as np

from solver.layers import numbers_of
from solver.shapes import PARABOLOID

from ..grid import Grid, along
from ..vocabulary import VOCABULARY, names

#: Inputs that decide whether there are stresses.
DECIDE = ("shape", "w_adhesion", "adhesion")
#: The extremes of stacks -> the dimension that each has beside those of the contacts, or none, and its words.
OF_STACKS = {
    "mises_layer": ("layer", "largest von Mises stress of each layer"),
    "tresca_layer": ("layer", "largest Tresca stress of each layer"),
    "s1_layer": ("layer", "largest tension in each layer"),
    "sr_interface": ("interface", "largest radial tension at the lower side of each layer"),
    "tau_interface": ("interface", "largest shear stress at each interface"),
    "sz_interface_max": ("interface", "largest axial tension at each interface"),
    "sz_interface_min": ("interface", "largest axial compression at each interface"),
    "s1_surface": ("", "largest tension on the surface"),
    "mises2": ("", "largest von Mises stress of the body"),
    "tresca2": ("", "largest Tresca stress of the body"),
}
#: A stack of one layer has these too: the name of one layer -> the same over layers.
OF_ONE_LAYER = {"mises1": "mises_layer", "tresca1": "tresca_layer", "sr_interface1": "sr_interface"}
_PLACES = ("_r", "_z")
#: What the number of a layer is called while `layer` may still be an axis of materials.
LAYER_NUMBER = "layer_number"
_NUMBERED = {"layer": "layer, from the surface down", "interface": "interface, below the layer of the same number"}


def stored(grid: Grid, some_feel: bool) -> tuple[str, ...]:
    """Names of the largest stresses, and of their places, that a study of a grid stores.

    some_feel : whether asperities of some cases feel the coated body
    """
    spots = names("spot_stress") if some_feel else ()
    layers = numbers_of(grid.values)
    if not layers:
        return names("stress") + spots
    extremes = [*OF_STACKS, *OF_ONE_LAYER] if layers == 1 else [*OF_STACKS]
    return tuple(f"{name}{end}" for name in extremes for end in ("", *_PLACES)) + spots


def dimension(name: str) -> str:
    """The dimension that an extreme of stacks, or its place, has beside those of the contacts; "" where it has none."""
    return OF_STACKS.get(_extreme(name), ("", ""))[0]


def words(name: str, stacked: bool) -> str:
    """The long name of an extreme or of its place. stacked : of stacks of layers"""
    extreme = _extreme(name)
    if not stacked or extreme not in OF_STACKS:
        return VOCABULARY[name].long_name
    return OF_STACKS[extreme][1] + VOCABULARY[name].long_name.removeprefix(VOCABULARY[extreme].long_name)


def numbered(layers: int, *dims: str) -> dict[str, tuple]:
    """Coordinates of layers and interfaces of stacks, counted from 1 at the surface: name -> dimension, values,
    attributes."""
    return {dim: (dim, np.arange(1, layers + 1), {"long_name": _NUMBERED[dim]}) for dim in dims}


def _extreme(name: str) -> str:
    """The extreme of which a name is, or whose place it is."""
    return name[:-2] if name.endswith(_PLACES) else name


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
    """The same of the cases of a grid."""
    rough = ~np.isin(along(grid, "micro"), grid.lexicon.smooth_laws())
    return without_stresses(rough, *(along(grid, name) for name in DECIDE), largest=largest)
