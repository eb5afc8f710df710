"""Materials by name: `punch`, `layer` and `body` of a physical scene stand for E and ν of each."""

from dataclasses import replace
from typing import Any

import numpy as np

from solver.bases import WITH_LAYERS

from ...specimen import materials
from ...specimen.quantities import Quantity
from ...terminal import shown
from ..grid import equal_values
from ..lexicon import PACKAGE
from ..vocabulary import BODIES, absent, bodies_of, finite
from .scene import RIGID_TEXTS

_MAY_BE_RIGID = ("punch", "body")
#: Shapes that people give as `punch`, which is a material. A proposal of materials with like names would mislead.
_LINES = ("cylinder", "roller")
_SHAPES = ("sphere", "ball", "paraboloid", "cone", "berkovich", "vickers", "flat", "pyramid", *_LINES)


def with_materials(inputs: dict, errors: list[str]) -> tuple[dict, dict, dict]:
    """The inputs with E and ν in place of materials; body -> (dimension or "", names of its materials); and the same
    with their strengths, as a Scene has them.

    E and ν have the spreads of the table of materials; messages are appended to `errors`.
    """
    inputs, names, strengths = dict(inputs), {}, {}
    for body, follows in bodies_of(inputs).items():
        entry = inputs.pop(body, None)
        if entry is None:
            continue
        both = [name for name in follows if name in inputs]
        errors += [f"{body} and {name} are both given: {name} follows from {body}" for name in both]
        if entry.is_wrong:
            continue
        try:
            texts, *columns, known = of_names(body, entry.values if entry.array is None else entry.array)
        except LookupError as error:
            errors.append(str(error.args[0]))
            continue
        errors += equal_values(body, texts, str) if entry.dims == (body,) else []
        for name, column in zip(follows, columns, strict=False):
            inputs[name] = replace(entry, name=name, values=list(column), array=None)
        names[body] = "".join(entry.dims), list(texts)
        if any(strength == strength for strength, *_ in known):
            strengths[body] = "".join(entry.dims), list(known)
    return inputs, names, strengths


def of_names(body: str, names: Any) -> list[tuple]:
    """Names, E, ν and strengths of the materials of a body. Raises LookupError for what is no material.

    names : a list; a DataArray if they come from results
    """
    try:
        if getattr(names, "dims", ()) not in ((), (body,)):
            raise LookupError("a DataArray of names is over the dimension of its own name; give a list, or cases")
        checked = [_checked(name) for name in (names if isinstance(names, list) else np.ravel(names.values).tolist())]
        table = {text: _material(body, name) for text, name in {str(name): name for name in checked}.items()}
    except LookupError as error:
        modulus, ratio, _ = BODIES[body]
        raise LookupError(f"{body}: {error.args[0]} (or give {modulus} and {ratio})") from error
    return list(zip(*(table[str(name)] for name in checked), strict=True))


def layered(values: dict) -> bool:
    """Whether some case may have a layer; values : as those of a Grid. A word that is no base is refused elsewhere."""
    _, base = values.get("base", ((), PACKAGE.parameter("base").default))
    return bool(np.isin(base, WITH_LAYERS).any())


def assumed(names: set[str], values: dict, si_values: dict) -> tuple[str, ...]:
    """Names of what has its default though it matters: Poisson ratios of elastic bodies, the interface of a layer.

    names : of the inputs that the user gives; values : as those of a Grid; si_values : the inputs in SI units
    """
    ratios = [nu for E, nu, _ in bodies_of(names).values() if not np.isinf(si_values.get(E, np.inf)).all()]
    return tuple(name for name in [*ratios, *layered(values) * ["bonding"]] if name not in names)


def _checked(name: Any) -> str | materials.Material:
    """The name or material itself; "inf" for the number. Raises LookupError for anything else."""
    if isinstance(name, float) and name == np.inf:
        return "inf"
    if isinstance(name, tuple):
        raise LookupError(f"{shown(name)} is a tuple: a list is an axis, and `layers`, a list of layers, a stack")
    if not isinstance(name, (str, materials.Material)):
        raise LookupError(f'{shown(name)} is not the name of a material, such as "steel 52100"')
    return name


def _material(body: str, name: str | materials.Material) -> tuple[str, Quantity, Quantity, materials.Strength]:
    """Name, E, ν and strength of a material, or of a name. Raises LookupError for a name that is not in the table."""
    if body in _MAY_BE_RIGID and str(name).lower() in RIGID_TEXTS:
        return "rigid", Quantity(np.inf), Quantity(0.3), materials.Strength()
    if body == "punch" and str(name).lower() in _SHAPES:
        lines = str(name).lower() in _LINES
        shape = absent(str(name)) if lines else 'the punch is a ball of radius R, or has a shape = "cone" or so on'
        raise LookupError(f'{shown(name)} is not a material, such as "steel 52100"; {shape}')
    material = materials.get(name) if isinstance(name, str) else name  # one of the user's own
    if not all(map(finite, (material.E, material.nu, material.E_spread, material.nu_spread))):
        raise LookupError(f"{shown(material.name)}: E, nu and their spreads must be finite numbers, E in Pa")
    E, nu = Quantity(material.E, material.E_spread), Quantity(material.nu, material.nu_spread)
    return material.name, E, nu, materials.known_strength(material)
