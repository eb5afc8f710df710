"""The inputs of contacts that a text or a figure states, their order, and their words."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from solver.bases import is_bare
from solver.laws.own_table import LAW_UNIT

from ..arrays import xarray_later as xr
from ..data.dataset import are_numbers
from ..data.si import SAME_PIECE
from ..inputs.lexicon import Lexicon, lexicon_in
from ..inputs.punch.shapes import in_metres
from ..inputs.vocabulary import (
    BODIES,
    CONTROLS,
    FIRST_MATERIAL,
    bodies_of,
    names,
    parameters_of_layers,
    scene_of,
)
from .numbers import given_text, spread_of

_OF_BODIES = [name for body in ("punch", "layer", "body") for name in (body, *BODIES[body][:2])]
#: Inputs without a default that a contact may have and not use: "sigma" with micro = "disc_cell", "E1" on a half-space.
_OPTIONAL = ("E1", "h", "Nbar", "Ra", "sigma", "B", "beta", "hardness", "yield_strength", "Y1", "Y2", "Y_punch")


def of_lower_layers(inputs: Iterable[str]) -> list[str]:
    """Names of the inputs of a stack's layers below the first, and of the further inputs of the first, layer by layer.

    inputs : names of the inputs of contacts, which show the number of layers
    """
    inputs = [str(name) for name in inputs]
    names = (*bodies_of(inputs), *scene_of(inputs), *parameters_of_layers(inputs))
    names = [name for name in (*names, *{FIRST_MATERIAL} & {*inputs}) if name.startswith("layers.")]
    order = (
        "material",
        "h",
        "E1",
        "E1_bottom",
        "n",
        "n_bottom",
        "nu",
        "nu_bottom",
        "profile",
        "bonding",
        "cn",
        "ct",
        "Y",
    )
    places = {name: (int(name.split(".")[1]), order.index(name.split(".")[2])) for name in names}
    return sorted(places, key=lambda name: places[name])


def all_inputs(contacts: Iterable[str], lexicon: Lexicon) -> list[str]:
    """All inputs in order: radii, materials of the bodies, the control, the layer, the asperities.

    contacts : a dataset, or names of its variables, which show the number of layers
    """
    between = [name for name in names("material") if name not in (*_OF_BODIES, "base")]
    of_laws = [name for name, entry in lexicon.rows.items() if entry.role == "roughness" and name != "micro"]
    of_shapes = [name for name, entry in lexicon.rows.items() if entry.role == "shape"]
    of_punch = ["R1", "R2", "R", *of_shapes]
    lower = of_lower_layers(contacts)
    return [*of_punch, *_OF_BODIES, *CONTROLS, *between, *lower, *names("adhesion"), "micro", *of_laws]


def used_inputs(contacts: xr.Dataset) -> list[str]:
    """The inputs in a dataset on which the answer of some contact depends; [] for a dataset without contacts.

    ν of a rigid body is left out, and so are n and m where the moduli are given. A law that is not registered may
    depend on every input of asperities.
    """
    if "base" not in contacts.variables:
        return []

    def values(name: str) -> np.ndarray:
        return contacts[name].values

    hidden = {"R"} if "R1" in contacts or contacts.attrs.get("scale", "R") not in ("R", "1") else set()
    lexicon = lexicon_in(contacts)
    hidden |= _of_punch_hidden(contacts, lexicon)
    if "E2" in contacts:
        hidden |= {"n", "m", *(name for name in of_lower_layers(contacts.variables) if name.endswith(".n"))}
    hidden |= {"m", "punch", "E_punch", "nu_punch", "Y_punch"} if is_rigid(contacts, "punch") else set()
    hidden |= {"n", "body", "E2", "nu2", "Y2"} if is_rigid(contacts, "base") else set()
    hidden |= {"layer", "E1", "nu1", "Y1"} if is_bare(values("base")).all() else set()
    hidden |= {"layer"} if "layer" in contacts and are_numbers(contacts["layer"]) else set()
    hidden |= {"micro"} if np.isin(values("micro"), lexicon.smooth_laws()).all() else set()
    unknown_law = not np.isin(values("micro"), list(lexicon.known.laws)).all()
    certain = {ratio for modulus, ratio, _ in bodies_of(contacts.variables).values() if modulus in contacts}
    certain |= set(names("roughness")) if unknown_law else set()
    certain |= {"hardness", "yield_strength"} if "micro" not in hidden else set()  # rules compare with them
    strengths = ("Y1", "Y2", "Y_punch", *(name for name in of_lower_layers(contacts.variables) if name.endswith(".Y")))
    certain |= {name for name in strengths if name in contacts and np.isfinite(values(name)).any()}
    return [
        name
        for name in all_inputs(contacts.variables, lexicon)
        if name in contacts.variables
        and name not in hidden
        and (name not in lexicon.rows or name in certain or lexicon.matters(name, values))
    ]


def _of_punch_hidden(contacts: xr.Dataset, lexicon: Lexicon) -> set[str]:
    """Inputs of the shape and of adhesion that need not be stated: defaults, and inputs for the solver alone."""
    hidden = {"table_unit"} if "shape" in contacts and np.any(in_metres(contacts["shape"].values, lexicon)) else set()
    hidden |= {LAW_UNIT}
    if "w_adhesion" in contacts:
        hidden |= (
            {name for name in names("adhesion") if name != "w_adhesion"}
            if (contacts["w_adhesion"] == 0).all()
            else set()
        )
        hidden |= {"branch"} if "a" in contacts.coords or (contacts["branch"] == "stable").all() else set()
    return hidden


def is_rigid(contacts: xr.Dataset, body: str) -> bool:
    """Whether the punch of all contacts, or the base under their layers, is known to be rigid.

    The modulus decides, if there is one: `groupby` and `mean` of xarray drop m and n where these vary.
    """
    modulus, ratio = ("E_punch", "m") if body == "punch" else ("E2", "n")
    if modulus in contacts:
        return bool(np.isinf(contacts[modulus]).all())
    if ratio not in contacts or (ratio == "n" and is_bare(contacts["base"]).any()):
        return False
    return bool((contacts[ratio] == 0).all())


def input_lines(case: xr.Dataset, left_out=()) -> list[str]:
    """The line "Given: ..." of one contact, without its control and the names `left_out`, and "Not used: ..." if it has
    inputs that change nothing."""
    used = used_inputs(case)
    inputs = [name for name in used if name not in (*left_out, *CONTROLS) and not name.startswith("layers.")]
    unsaid = " (assumed)" * ("R" in case and "E_punch" not in case)
    rigid = [f"a rigid punch{unsaid}"] * is_rigid(case, "punch") + ["a rigid base"] * is_rigid(case, "base")
    unused = [name for name in _OPTIONAL if name in case and name not in (*used, *left_out)]
    unused = [name for name in unused if np.isfinite(case[name])]  # NaN: given for other cases
    texts = [*rigid, *(given_text(case, name) for name in inputs), *_pieces(case, used)]
    lines = ["Given: " + ", ".join(texts), *_stack(case, used)]
    return lines + [f"Not used: {', '.join(given_text(case, name) for name in unused)}"] * bool(unused)


def _stack(case: xr.Dataset, used: list[str]) -> list[str]:
    """A line on the geometry of a stack, from its second layer down to the base; [] for a single layer."""
    parts: dict[str, list[str]] = {}
    for name in (name for name in used if name.startswith("layers.") and name in case and not case[name].dims):
        number, _, field = name.removeprefix("layers.").partition(".")
        text = given_text(case, name).replace(f"layers.{number}.", "").removeprefix("material ")
        if text not in ("uniform", "nan") and not text.endswith("= nan"):
            parts.setdefault(number, []).append(text)
    below = "a rigid base" if is_rigid(case, "base") else "the body"
    texts = [f"layer {number}: {', '.join(texts)}" for number, texts in parts.items()]
    return [f"Stack, from the surface down: {'; '.join(texts)}; then {below}"] if texts else []


def _pieces(case: xr.Dataset, used: list[str]) -> list[str]:
    """Texts that say whether bodies of one material, with a spread, are independent pieces: it changes every ±."""
    of_material: dict[str, list[str]] = {}
    for body, (modulus, ratio, _) in bodies_of(case.variables).items():
        if body in case and modulus in used and spread_of(case, modulus) + spread_of(case, ratio) > 0:
            of_material.setdefault(str(case[body].values), []).append(body)
    texts = []
    for material, bodies in of_material.items():
        is_one_piece = all(case[body].attrs.get("comment") == SAME_PIECE for body in bodies)
        which = "one piece" if is_one_piece else "independent pieces"
        bodies = [body.removesuffix(".material").replace("layers.", "layer ") for body in bodies]
        texts += [f"{', '.join(bodies[:-1])} and {bodies[-1]} {which} of {material}"] * (len(bodies) > 1)
    return texts
