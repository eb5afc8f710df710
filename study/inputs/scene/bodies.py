"""Materials by name: `punch`, `layer` and `body` of a physical scene stand for E and ν of each."""

from typing import Any

import numpy as np

from solver import laws

from ...specimen import materials
from ...specimen.quantities import Quantity
from ...terminal import shown
from ..grid import equal_values
from ..vocabulary import SCENE, VOCABULARY, finite
from .names import RIGID_TEXTS, CaseValues, QuantityList

#: Body -> names of its modulus and Poisson ratio, and of the ratio of moduli that follows from them.
BODIES = {"punch": ("E_punch", "nu_punch", "m"), "layer": ("E1", "nu1", "n"), "body": ("E2", "nu2", "")}
laws.RESERVED.update(SCENE, BODIES)  # a law must not call a parameter like an input of a scene
_MAY_BE_RIGID = ("punch", "body")
#: What people give as `punch` that is no material; names of materials near these would mislead.
_SHAPES = ("sphere", "ball", "paraboloid", "cone", "berkovich", "vickers", "flat", "cylinder", "pyramid")


def with_materials(parameters: dict, errors: list[str]) -> tuple[dict, dict]:
    """The parameters with E and ν in place of materials, and body -> (dimension or "", names of its materials).

    E and ν have the spreads of the table of materials; messages are appended to `errors`.
    """
    found, names = dict(parameters), {}
    for body, follows in BODIES.items():
        if body not in parameters:
            continue
        given = found.pop(body)
        if getattr(given, "dims", None) in ((), (body,)):  # of earlier results
            given = given.values.tolist()
        errors += [f"{body} and {name} are both given: {name} follows from {body}" for name in follows if name in found]
        several = isinstance(given, list) or (isinstance(given, tuple) and body != "layer")
        try:
            values = given if several else [given]
            if not len(values):
                raise LookupError("must have at least one material")
            known = {str(one): one for one in map(_checked, values)}
            known = {text: _material(body, one) for text, one in known.items()}
        except LookupError as error:
            errors.append(f"{body}: {error.args[0]} (or give {follows[0]} and {follows[1]})")
            found[follows[0]] = Quantity(1.0)  # so that no second message says that it is missing
            continue
        texts, *numbers = zip(*(known[str(one)] for one in values), strict=True)
        errors += equal_values(body, texts, str) if several and not isinstance(given, CaseValues) else []
        dim = ("case" if isinstance(given, CaseValues) else body) if several else ""
        for name, column in zip(follows, numbers, strict=False):
            found[name] = QuantityList(list(column), dim) if several else column[0]
        names[body] = dim, list(texts)
    return found, names


def layered(parameters: dict) -> bool:
    """Whether some case may have a layer."""
    layers = {*VOCABULARY["base"].own.choices} - {"half_space"}  # of a word that is no base it is said later
    return not isinstance(parameters.get("base"), str) or parameters["base"] in layers


def assumed(parameters: dict, given: dict) -> tuple[str, ...]:
    """What is not given and has its default, though it counts: Poisson ratios of elastic bodies, interface of a layer.

    given : the inputs in SI units
    """
    ratios = [nu for E, nu, _ in BODIES.values() if not np.isinf(given.get(E, np.inf)).all()]
    return tuple(name for name in [*ratios, *layered(parameters) * ["bonding"]] if name not in parameters)


def _checked(name: Any) -> str | materials.Material:
    """The same name or material; "inf" of the number. Raises LookupError for anything else."""
    if isinstance(name, float) and name == np.inf:
        return "inf"
    if hasattr(name, "dims"):
        raise LookupError("a DataArray of names is over the dimension of its own name; give a list, or cases")
    if isinstance(name, tuple):
        raise LookupError(f"{shown(name)} is a tuple: a list is an axis, a stack of layers is not yet there")
    if not isinstance(name, (str, materials.Material)):
        raise LookupError(f'{shown(name)} is no name of a material, such as "steel 52100"')
    return name


def _material(body: str, name: str | materials.Material) -> tuple[str, Quantity, Quantity]:
    """Name, E and ν of a material, or of a name. Raises LookupError for a name that is not in the table."""
    if body in _MAY_BE_RIGID and str(name).lower() in RIGID_TEXTS:
        return "rigid", Quantity(np.inf), Quantity(0.3)
    if body == "punch" and str(name).lower() in _SHAPES:
        shape = "the punch is a ball of radius R, other shapes are not in the model"
        raise LookupError(f'{shown(name)} is no material, such as "steel 52100"; {shape}')
    found = materials.get(name) if isinstance(name, str) else name  # one of the user's own
    if not all(map(finite, (found.E, found.nu, found.E_spread, found.nu_spread))):
        raise LookupError(f"{shown(found.name)}: E, nu and their spreads must be finite numbers, E in Pa")
    return found.name, Quantity(found.E, found.E_spread), Quantity(found.nu, found.nu_spread)
