"""Which inputs of contacts a text or a figure states, and in which order."""

import numpy as np
import xarray as xr

from solver.laws import LAWS

from ..inputs.laws import smooth_laws
from ..inputs.scene.layers import recall
from ..inputs.vocabulary import BODIES, CONTROLS, SCENE, VOCABULARY, matters, names

_OF_BODIES = [name for body in ("punch", "layer", "body") for name in (body, *BODIES[body][:2])]


def of_lower_layers() -> list[str]:
    """Names of what the layers of a stack below the first have, and the first besides, one layer after the other."""
    names = [name for name in (*BODIES, *SCENE, *VOCABULARY) if name.startswith("layers.")]
    order = ("material", "h", "E1", "E1_bottom", "n", "n_bottom", "nu", "nu_bottom", "profile", "bonding", "cn", "ct")
    places = {name: (int(name.split(".")[1]), order.index(name.split(".")[2])) for name in names}
    return sorted(places, key=lambda name: places[name])


def all_inputs() -> list[str]:
    """All inputs in order: radii, what the bodies are made of, the control, the layer, the asperities."""
    between = [name for name in names("material") if name not in (*_OF_BODIES, "base")]
    of_laws = [name for name, entry in VOCABULARY.items() if entry.role == "roughness" and name != "micro"]
    return ["R1", "R2", "R", *_OF_BODIES, *CONTROLS, *between, *of_lower_layers(), "micro", *of_laws]


def used_inputs(contacts: xr.Dataset) -> list[str]:
    """The inputs in a dataset that the answer of some contact depends on; [] for a dataset without contacts.

    Left out are ν of a rigid body, and n and m where the moduli are given. A law that is not registered may depend on
    all that there is of asperities.
    """
    if "base" not in contacts.variables:
        return []
    recall(contacts.variables)

    def values(name: str) -> np.ndarray:
        return contacts[name].values

    hidden = {"R"} if "R1" in contacts else set()
    hidden |= {"n", "m", *(name for name in of_lower_layers() if name.endswith(".n"))} if "E2" in contacts else set()
    hidden |= {"m", "punch", "E_punch", "nu_punch", "Y_punch"} if is_rigid(contacts, "punch") else set()
    hidden |= {"n", "body", "E2", "nu2", "Y2"} if is_rigid(contacts, "base") else set()
    hidden |= {"layer", "E1", "nu1", "Y1"} if (values("base") == "half_space").all() else set()
    hidden |= {"micro"} if np.isin(values("micro"), smooth_laws()).all() else set()
    unknown_law = not np.isin(values("micro"), list(LAWS)).all()
    certain = {ratio for modulus, ratio, _ in BODIES.values() if modulus in contacts}
    certain |= set(names("roughness")) if unknown_law else set()
    certain |= {"hardness", "yield_strength"} if "micro" not in hidden else set()  # rules compare with them
    certain |= {name for name in ("Y1", "Y2", "Y_punch") if name in contacts and np.isfinite(values(name)).any()}
    return [
        name
        for name in all_inputs()
        if name in contacts.variables
        and name not in hidden
        and (name not in VOCABULARY or name in certain or matters(name, values))
    ]


def is_rigid(contacts: xr.Dataset, body: str) -> bool:
    """Whether the punch of all contacts, or the base under their layers, is known to be rigid.

    The modulus says it, if there is one: `groupby` and `mean` of xarray leave out m and n where these vary.
    """
    modulus, ratio = ("E_punch", "m") if body == "punch" else ("E2", "n")
    if modulus in contacts:
        return bool(np.isinf(contacts[modulus]).all())
    if ratio not in contacts or (ratio == "n" and (contacts["base"] == "half_space").any()):
        return False
    return bool((contacts[ratio] == 0).all())
