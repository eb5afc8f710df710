"""The bodies of a physical scene: `punch`, `layer` and `body` name materials, which stand for E and ν of each; and the
correlations of spreads, of bodies that are one piece of material and by the user."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np

from solver.bases import WITH_LAYERS

from ...arrays import xarray_later as xr
from ...specimen import materials
from ...specimen.quantities import Quantity
from ...terminal import shown
from ..grid import equal_values
from ..lexicon import PACKAGE
from ..vocabulary import BODIES, absent, bodies_of, finite
from .scene import RIGID_TEXTS, Scene, over

_MAY_BE_RIGID = ("punch", "body")
#: Shapes that people give as `punch`, which is a material. To propose materials with similar names would mislead.
_LINES = ("cylinder", "roller")
_SHAPES = ("sphere", "ball", "paraboloid", "cone", "berkovich", "vickers", "flat", "pyramid", *_LINES)
_RIGID = "rigid"  # the name of the material of a body without a modulus
#: A matrix of correlations has eigenvalues >= 0; a correlation of 1 makes some of them 0 except for rounding.
_ROUNDING = 1e-9
FORM = 'must be a number from -1 to 1 for each pair of inputs, such as {("E1", "E2"): 0.5}'


def with_materials(inputs: dict, errors: list[str]) -> tuple[dict, dict, dict]:
    """The inputs with E and ν in place of materials; body -> (dimension or "", names of its materials); and the same
    table with strengths, as in a Scene.

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
            texts, *columns, strength_rows = of_names(body, entry.values if entry.array is None else entry.array)
        except LookupError as error:
            errors.append(str(error.args[0]))
            continue
        errors += equal_values(body, texts, str) if entry.dims == (body,) else []
        for name, column in zip(follows, columns, strict=False):
            inputs[name] = replace(entry, name=name, values=list(column), array=None)
        names[body] = "".join(entry.dims), list(texts)
        if any(strength == strength for strength, *_ in strength_rows):
            strengths[body] = "".join(entry.dims), list(strength_rows)
    return inputs, names, strengths


def of_names(body: str, names: Any) -> list[tuple]:
    """Names, E, ν and strengths of the materials of a body. Raises LookupError for a name that is no material.

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
    """Whether some case may have a layer; values : like those of a Grid. A word that is no base is refused
    elsewhere."""
    _, base = values.get("base", ((), PACKAGE.parameter("base").default))
    return bool(np.isin(base, WITH_LAYERS).any())


def assumed(names: set[str], values: dict, si_values: dict) -> tuple[str, ...]:
    """Names of inputs that have their defaults although they matter: Poisson ratios of elastic bodies, the interface.

    names : of the inputs that the user gives; values : like those of a Grid; si_values : the inputs in SI units
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


def alike(names: dict, body: str, other_body: str) -> Any:
    """Where two bodies are of one material: a bool, or a DataArray over the dimensions of their names.

    names : as those of a Scene
    """
    if body not in names or other_body not in names:
        return False
    first, second = (_labelled(*names[name]) for name in (body, other_body))
    same = (first == second) & (first != _RIGID)
    return same if same.any() and not same.all() else bool(same.all())


def none_alike(names: dict) -> bool:
    """Whether no case has two bodies of one material."""
    return not any(np.any(alike(names, *pair)) for pair in combinations(bodies_of(names), 2))


def of_one_piece(scene: Scene) -> dict[tuple[str, str], Any]:
    """The correlations of bodies that are cut from one piece: their moduli deviate equally, and so do their Poisson
    ratios."""
    correlations = {}
    for body, other_body in combinations(bodies_of(scene.names), 2):
        same = alike(scene.names, body, other_body)
        for pair in zip(BODIES[body][:2], BODIES[other_body][:2], strict=True):
            if {*pair} <= {*scene.spreads} and np.any(same):
                correlations[pair] = 1.0 * same
    return correlations


def correlate(scene: Scene, pairs: Any, errors: list[str]) -> None:
    """Give the scene its correlations. Mistakes in the `pairs` that the user gives become messages."""
    scene.correlations = correlations = of_one_piece(scene) if scene.same_piece else {}
    if not isinstance(pairs, dict) or not all(isinstance(pair, tuple) and len(pair) == 2 for pair in pairs):
        errors.append(f"correlations = {shown(pairs)}: {FORM}")
        return
    for pair, value in pairs.items():
        without = [name for name in pair if name not in scene.spreads]
        called = f"correlations: {' and '.join(map(str, pair))}"
        if without:
            errors.append(f"{called}: {without[0]} has no spread; {', '.join(scene.spreads) or 'no input'} has one")
        elif pair[0] == pair[1] or pair in correlations or pair[::-1] in correlations:
            errors.append(f"{called}: " + ("are one input" if pair[0] == pair[1] else "have a correlation already"))
        elif not finite(value) or not -1 <= value <= 1:
            errors.append(f"{called} = {shown(value)}: must be a number from -1 to 1")
        else:
            correlations[pair] = float(value)
    dims = tuple({dim for value in correlations.values() for dim in getattr(value, "dims", ())})
    if pairs and not errors and np.linalg.eigvalsh(matrix(scene, dims)).min() < -_ROUNDING:
        errors.append("correlations: these cannot all hold: their matrix has a negative eigenvalue")


def matrix(scene: Scene, dims: tuple[str, ...]) -> np.ndarray:
    """The correlations of the k inputs with spreads, (..., k, k) over the dimensions `dims`."""
    names = list(scene.spreads)
    parts = [over(value, dims) for value in scene.correlations.values()]
    shape = np.broadcast_shapes((1,) * len(dims), *(part.shape for part in parts))
    array = np.broadcast_to(np.eye(len(names)), (*shape, len(names), len(names))).copy()
    for (first, second), part in zip(scene.correlations, parts, strict=True):
        i, j = names.index(first), names.index(second)
        array[..., i, j] = array[..., j, i] = part
    return array


def _labelled(dim: str, texts: list[str]) -> xr.DataArray:
    return xr.DataArray(texts, dims=dim) if dim else xr.DataArray(texts[0])
