"""The contacts that first yield and the protecting layer are asked about: those of inputs, or of a dataset."""

import warnings
from typing import Any

import numpy as np
import xarray as xr

from ..again import Again, refuse_without_stresses
from ..inputs.definition import StudyError
from ..inputs.request import Request
from ..inputs.vocabulary import CONTROLS
from ..solving import solve
from ..specimen.foreign import plain
from ..specimen.materials import Material
from ..specimen.quantities import quantity


def refuse(who: str, parameters: dict, names: tuple, reason: str) -> None:
    """Raise StudyError for each of these names that is given."""
    wrong = [f"{who}: leave out {name}: {reason}" for name in names if parameters.get(name) is not None]
    if wrong:
        raise StudyError(wrong)


def contacts(who: str, parameters: dict, name: str, value: float) -> tuple[xr.Dataset, Again]:
    """Contacts with these inputs, of which one is any value: no warning of these contacts is shown."""
    physical = Request.in_python(parameters, [], False, {}).physical
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            any_ = ("1 nN" if name == "P" else "1 um") if physical else value
            contact = solve(**parameters, **{name: any_}, x=2, profiles=False)
        except StudyError as error:
            raise StudyError(message.replace("solve: ", f"{who}: ", 1) for message in error.messages) from None
    again = Again.of(contact, who)
    refuse_without_stresses(again, who)
    return contact, again


def of_dataset(who: str, contact: Any, strengths: dict[str, Any], left_out: tuple) -> tuple[xr.Dataset, Again]:
    """The contacts of a dataset with these `strengths`, in place of its own. left_out : what is looked for, and is no
    dimension of the answer."""
    Again.of(contact, who)  # refuses what is no dataset of contacts
    contact = contact.isel({name: 0 for name in left_out if name in contact["status"].dims})
    for name, strength in strengths.items():
        value, spread = _strength(who, name, strength, "R" in contact.coords)
        about = {"units": "Pa"} if "R" in contact.coords else {}
        contact = contact.drop_vars(f"{name}_spread", errors="ignore").assign_coords({name: ((), value, about)})
        if spread:
            contact = contact.assign_coords({f"{name}_spread": ((), spread, about)})
    again = Again.of(contact, who)
    refuse_without_stresses(again, who)
    return contact, again


def _strength(who: str, name: str, strength: Any, physical: bool) -> tuple[float, float]:
    """Value and spread, in Pa or over E2*."""
    try:
        value = quantity(name, plain(strength), "Pa" if physical else "1")
    except (TypeError, ValueError) as error:
        raise StudyError([f"{who}: {error}"]) from None
    if not 0 < value.value < np.inf:
        raise StudyError([f"{who}: {name} = {value.value:g}: must be finite and above 0"])
    return value.value, value.spread


def control_of(contact: xr.Dataset) -> str:
    """P, a or D, which controls the contacts of a dataset."""
    return next(name for name in CONTROLS if name in contact.coords)


def own_materials(parameters: dict) -> dict[str, Material]:
    """The materials that are given as such, by name."""
    given = [parameters.get(body) for body in ("punch", "layer", "body")]
    several = [one for value in given for one in (value if isinstance(value, (list, tuple)) else [value])]
    return {one.name: one for one in several if isinstance(one, Material)}


def without_control(dataset: xr.Dataset, name: str) -> xr.Dataset:
    """The dataset without what was looked for."""
    return dataset.drop_vars([name, f"{name}_spread"], errors="ignore")
