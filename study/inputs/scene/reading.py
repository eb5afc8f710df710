"""From inputs with units to a scene and its dimensionless parameters.

The scene has the radius R of the punch (or R1 and R2 of two bodies), Young's moduli E1 of the layer, E2 of the body
below and E_punch of the punch, with Poisson ratios nu1, nu2 and nu_punch.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ...specimen.quantities import READABLE, quantity
from ...terminal import on_one_line
from ..draft import Draft
from ..given import NEEDS_NAMES, Given, Input
from ..grid import equal_values
from ..vocabulary import BODIES, ROWS, SCENE, VOCABULARY
from .bodies import assumed, with_materials
from .bounds import beyond_bounds
from .checks import impossible, missing, moving_tables, same_cases
from .names import dim_of, si
from .pieces import correlate, none_alike
from .scales import make_dimensionless
from .scene import Scene

_POSITIVE, _POISSON = (0.0, np.inf, "must be > 0"), (-1.0, 0.5, "must be in (-1, 0.5]")
#: Bounds of inputs from which others are derived: must be above, must be at most, words for a message.
_LIMITS = dict.fromkeys(("R", "E1", "E2", "E_punch"), _POSITIVE) | dict.fromkeys(("nu1", "nu2", "nu_punch"), _POISSON)
_E1, _NU1 = ("E1", "E1_spread", "n"), ("nu1", "nu1_spread")
#: What a case without a layer may leave out -> the coordinates that then have no value there, "" or NaN.
_OF_LAYER = {"layer": ("layer", *_E1, *_NU1), "E1": _E1, "n": _E1, "h": ("h", "h_spread"), "nu1": _NU1, "bonding": ()}


def read(given: Given, draft: Draft, spreads: bool, axes: list[str]) -> Scene:
    """The physical scene that inputs describe. What the solver gets goes to the draft, and all that is wrong: no unit,
    a unit of something else, a missing R or modulus.

    spreads : whether the results shall have spreads
    axes : dimensions in the order that they shall have, behind `case`
    """
    scene, errors = Scene(same_piece=given.same_piece, labels=given.labels), given.errors
    before = len(errors)
    inputs, scene.names = with_materials(_filled(given, scene), errors)
    # a list of heights in µm is no axis h/R, which depends on the dimensions of R as well
    own = {name: dim_of(name) for name, entry in inputs.items() if entry.dims == (name,)}
    inputs = {n: replace(entry, dims=tuple(own.get(dim, dim) for dim in entry.dims)) for n, entry in inputs.items()}
    for entry in inputs.values():
        if not entry.is_wrong:
            _read(scene, draft, entry)
    errors += [f"same_piece: {NEEDS_NAMES}"] * (given.same_piece and not errors and none_alike(scene.names))
    errors += missing(given, draft.values)
    hint = f" ({given.sign} makes this a study with units)"
    errors[before:] = [f"{message}{hint * ('has no unit' in message)}" for message in errors[before:]]
    labels = {name: np.array(texts) for name, (dim, texts) in scene.names.items() if dim == name}
    draft.check(labels | {name: np.asarray(value) for name, value in scene.given.items() if dim_of(name) == name})
    errors += [] if errors else impossible(scene) + (same_cases(scene) if given.rows else [])
    if errors:
        return scene
    names = {*given.sections, *inputs}
    scene.assumed = assumed(names, draft.values, scene.given)
    correlate(scene, given.correlations, errors)
    if not spreads:
        scene.spreads = scene.correlations = {}
    make_dimensionless(scene)
    errors += moving_tables(scene) + beyond_bounds(scene, inputs)
    draft.sizes |= scene.sizes(axes)
    for name, value in scene.parameters.items() if not errors else ():
        draft.put(name, getattr(value, "dims", ()), np.asarray(value))
    return scene


def _read(scene: Scene, draft: Draft, entry: Input) -> None:
    """Put the numbers of an input into the scene."""
    name, before = entry.name, len(draft.errors)
    if name in SCENE or name in _LIMITS or VOCABULARY[name].powers != (0, 0) or entry.has_unit:
        try:
            _add(scene, entry)
        except ValueError as error:
            draft.errors.append(f"{error}{_material(entry)}")
        return
    draft.read(entry)
    if len(draft.errors) == before:
        dims, array = draft.values[name]
        scene.parameters[name] = xr.DataArray(array, dims=dims) if dims else array.item()


def _material(entry: Input) -> str:
    """The end of a message about a modulus that is given as a word; "" for all else."""
    body = next((body for body, (modulus, _, _) in BODIES.items() if modulus == entry.name), "")
    word = entry.array is None and not entry.dims and isinstance(entry.values[0], str) and entry.values[0][:1].isalpha()
    return f"; a material is given as {body}, in place of {entry.name}" if body and word else ""


def _filled(given: Given, scene: Scene) -> dict[str, Input]:
    """The inputs with those of [[cases]] for every case. What a case without a layer leaves out is taken from another
    case: no answer depends on it, and results do not show it."""
    base = given.inputs.get("base")
    found, default = dict(given.inputs), VOCABULARY["base"].own.default
    bases = [] if base is None or base.is_wrong or base.array is not None else base.values
    bases = [default if one is None else one for one in bases]
    if len(bases) != len(given.rows):
        bases = bases * len(given.rows) if len(bases) == 1 else [default] * len(given.rows)
    for name, entry in found.items():
        if entry.section != "[[cases]]":
            continue
        there = np.array([one is not None for one in entry.values])
        if name == "base":
            found[name] = replace(entry, values=bases)
        elif (there | (name in _OF_LAYER and np.array([one == "half_space" for one in bases]))).all():
            first = entry.values[int(np.argmax(there))]
            found[name] = replace(entry, values=[first if one is None else one for one in entry.values])
            if not there.all():
                scene.given_in |= dict.fromkeys(_OF_LAYER[name], xr.DataArray(there, dims="case"))
        else:
            given.errors.append(f"{name} must be given in every case, or once for all")
            found[name] = replace(entry, values=None)
    return found


def _add(scene: Scene, entry: Input) -> None:
    """Put the SI values and spreads of an input into the scene. Raises ValueError for values that it cannot have."""
    name, unit = entry.name, ROWS[entry.name].unit
    if entry.array is not None:
        value, spread = _of_array(entry, unit), 0.0
    elif entry.dims:
        found = [si(name, one, f"{name}[{i}]") for i, one in enumerate(entry.values)]
        value = xr.DataArray([one.value for one in found], dims=entry.dims)
        spread = xr.DataArray([one.spread for one in found], dims=entry.dims)
    else:
        found = si(name, entry.values[0])
        value, spread = found.value, found.spread
    if entry.dims == (dim_of(name),):
        scene.dims[dim_of(name)] = name
        for message in equal_values(name, value.values.tolist(), lambda one: f"{one:g} {unit}".removesuffix(" 1")):
            raise ValueError(message)
    low, high, limits = _LIMITS.get(name, (-np.inf, np.inf, "must be a number"))
    if name in ("R1", "R2"):
        _refuse(entry, value, value == 0, "must not be 0")
    _refuse(entry, value, ~np.asarray((value > low) & (value <= high)), limits)
    if not np.all(spread == 0):
        limit, limits = (high, limits) if np.isfinite(high) else (0.0, "must not be 0")
        at_limit = (spread > 0) & (value == limit)
        _refuse(entry, value, at_limit, f"with its spread it {limits}; at the limit itself give no spread")
        scene.spreads[name] = spread
    scene.given[name] = value


def _refuse(entry: Input, value: Any, where: Any, reason: str) -> None:
    """Raise ValueError for the first value that is refused, if some are.

    where : whether each is refused, over the dimensions of `value`
    """
    for place in np.argwhere(np.asarray(where))[:1].tolist():
        text = entry.at(place)
        text = f"{np.asarray(value)[tuple(place)]:g}" if text is None else on_one_line(str(text))
        raise ValueError(f"{entry.name}{place or ''} = {text}: {reason}")


def _of_array(entry: Input, unit: str) -> xr.DataArray:
    """SI values of a DataArray, by its attribute `units`."""
    name, array = entry.name, entry.array
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name}: a DataArray must hold numbers; texts with units may be a list")
    values = np.asarray(array.values, float)  # 210 GPa of float16 would be infinite in Pa
    if unit != "1" and "units" not in array.attrs:
        raise ValueError(f'{name}: the DataArray has no attribute "units"; {READABLE[unit][0]} needs one')
    if unit != "1" or entry.unit != "1":
        values = values * quantity(name, f"1 {array.attrs['units']}", unit).value
    return xr.DataArray(values, dims=entry.dims)
