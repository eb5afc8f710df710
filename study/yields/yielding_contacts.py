"""The contacts of a question on first yield or on the protecting layer: from inputs, or from a dataset."""

from typing import Any

import numpy as np
import xarray as xr

from ..data.contacts import Contacts, refuse_no_results
from ..inputs.definition import StudyError
from ..inputs.request import AnyValue
from ..inputs.vocabulary import CONTROLS
from ..solving import unsolved
from ..specimen.foreign import plain
from ..specimen.materials import Material
from ..specimen.quantities import quantity


def refuse(who: str, parameters: dict, names: tuple, reason: str) -> None:
    """Raise StudyError for each of these names that is given."""
    wrong = [f"{who}: leave out {name}: {reason}" for name in names if parameters.get(name) is not None]
    if wrong:
        raise StudyError(wrong)


def of_inputs(who: str, parameters: dict, name: str, value: float) -> Contacts:
    """The contacts with these inputs and an arbitrary value of one more, without solving them.

    value : of the further input where inputs have no units
    """
    any_value = AnyValue(value, "1 nN" if name == "P" else "1 um")
    contacts = Contacts.of(unsolved(who, parameters | {name: any_value}), who)
    contacts.refuse_without_stresses(who)
    return contacts


def of_dataset(who: str, contact: Any, strengths: dict[str, Any], left_out: tuple) -> Contacts:
    """The contacts of a dataset with these `strengths` in place of its own.

    left_out : the wanted inputs, which are not dimensions of the answer
    """
    refuse_no_results(contact, who)
    contact = contact.isel({name: 0 for name in left_out if name in contact["status"].dims})
    for name, strength in strengths.items():
        value, spread = _strength(who, name, strength, "R" in contact.coords)
        about = {"units": "Pa"} if "R" in contact.coords else {}
        contact = contact.drop_vars(f"{name}_spread", errors="ignore").assign_coords({name: ((), value, about)})
        if spread:
            contact = contact.assign_coords({f"{name}_spread": ((), spread, about)})
    contacts = Contacts.of(contact, who)
    contacts.refuse_without_stresses(who)
    return contacts


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


def materials_in(parameters: dict) -> dict[str, Material]:
    """The materials among the parameters that are `Material` objects, by name."""
    values = [parameters.get(body) for body in ("punch", "layer", "body")]
    stack = parameters.get("layers", ())
    values += [layer.get("material") for layer in stack if isinstance(layer, dict)] if isinstance(stack, list) else []
    several = [material for value in values for material in (value if isinstance(value, (list, tuple)) else [value])]
    return {material.name: material for material in several if isinstance(material, Material)}


def without_control(dataset: xr.Dataset, name: str) -> xr.Dataset:
    """The dataset without the wanted input."""
    return dataset.drop_vars([name, f"{name}_spread"], errors="ignore")
