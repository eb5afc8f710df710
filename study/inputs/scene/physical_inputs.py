"""From inputs with units to a scene and its dimensionless parameters.

The scene has the radius R of the punch (or R1 and R2 of two bodies), Young's moduli E1 of the layer, E2 of the body
below and E_punch of the punch, with Poisson ratios nu1, nu2 and nu_punch.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...arrays import xarray_later as xr
from ...specimen.quantities import READABLE, quantity
from ...terminal import on_one_line
from ..draft import Draft
from ..grid import equal_values
from ..punch.shapes import LENGTHS, MICROMETRE, in_metres
from ..request import NEEDS_NAMES, Input, Request
from ..vocabulary import SCENE, bodies_of
from .bodies import assumed, with_materials
from .mistakes import beyond_bounds, impossible, missing, moving_tables, same_cases
from .pieces import correlate, none_alike
from .scales import make_dimensionless
from .scene import Scene, dim_of, is_ratio, si

_POSITIVE, _POISSON = (0.0, np.inf, "must be > 0"), (-1.0, 0.5, "must be in (-1, 0.5]")
#: Bounds of inputs from which others are derived: (must be above, must be at most, words for a message).
_LIMITS = dict.fromkeys(("R", "E1", "E2", "E_punch", "flat_radius", "tip_radius"), _POSITIVE)
_LIMITS |= dict.fromkeys(("nu1", "nu2", "nu_punch"), _POISSON)
_E1, _NU1 = ("E1", "E1_spread", "n"), ("nu1", "nu1_spread")
#: Input that a case without a layer may leave out -> the coordinates that then have no value in this case, "" or NaN.
_OF_LAYER = {"layer": ("layer", *_E1, *_NU1), "E1": _E1, "n": _E1, "h": ("h", "h_spread"), "nu1": _NU1, "bonding": ()}


def read(request: Request, draft: Draft, spreads: bool, axes: list[str]) -> Scene:
    """The physical scene that inputs describe. The dimensionless parameters go to the draft.

    Mistakes become messages of the draft: a missing unit, a unit of another kind, a missing R or modulus.

    spreads : whether the results shall have spreads
    axes : dimensions in the wanted order, after `case`
    """
    scene = Scene(same_piece=request.same_piece, labels=request.labels, lexicon=request.lexicon)
    errors = request.errors
    before = len(errors)
    inputs, scene.names, scene.strengths = with_materials(_filled(request, scene), errors)
    # a list of h in µm is an axis "h in SI": h/R changes along the dimensions of R too
    in_si = {name: dim_of(name, request.lexicon) for name, entry in inputs.items() if entry.dims == (name,)}
    inputs = {n: replace(entry, dims=tuple(in_si.get(dim, dim) for dim in entry.dims)) for n, entry in inputs.items()}
    for entry in inputs.values():
        if not entry.is_wrong:
            _read(scene, draft, entry)
    scene.lexicon = request.lexicon  # with the laws and tables that have been read
    errors += [f"same_piece: {NEEDS_NAMES}"] * (request.same_piece and not errors and none_alike(scene.names))
    errors += missing(request, draft.values)
    hint = f" ({request.sign} makes this a study with units)"
    errors[before:] = [f"{message}{hint * ('has no unit' in message)}" for message in errors[before:]]
    labels = {name: np.array(texts) for name, (dim, texts) in scene.names.items() if dim == name}
    axes_in_si = [name for name in scene.values if dim_of(name, scene.lexicon) == name]
    draft.check(labels | {name: np.asarray(scene.values[name]) for name in axes_in_si})
    errors += [] if errors else impossible(scene) + (same_cases(scene) if request.rows else [])
    if errors:
        return scene
    names = {*request.sections, *inputs}
    _measure(scene)
    scene.assumed = assumed(names, draft.values, scene.values)
    correlate(scene, request.correlations, errors)
    if not spreads:
        scene.spreads = scene.correlations = {}
    make_dimensionless(scene)
    errors += moving_tables(scene) + beyond_bounds(scene, inputs)
    draft.sizes |= scene.sizes(axes)
    if not errors:  # each has been checked, with its unit or without
        draft.values |= {name: (getattr(v, "dims", ()), np.asarray(v)) for name, v in scene.parameters.items()}
    return scene


def _measure(scene: Scene) -> None:
    """Note the unit of length for shapes without a radius, and the tables of shapes that have units."""
    if "R" not in scene.values and "R1" not in scene.values:
        scene.scale = next((name for name in LENGTHS if name in scene.values), MICROMETRE)
    scene.metres = in_metres(scene.parameters.get("shape", ""), scene.lexicon)


def _read(scene: Scene, draft: Draft, entry: Input) -> None:
    """Put the numbers of an input into the scene."""
    name, before = entry.name, len(draft.errors)
    has_unit = name in SCENE or name in _LIMITS or scene.lexicon.rows[name].powers != (0, 0)
    if has_unit or is_ratio(name) or entry.has_unit:
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
    """The end of a message about a word in place of a modulus; otherwise ""."""
    body = next((body for body, (modulus, _, _) in bodies_of([entry.name]).items() if modulus == entry.name), "")
    word = entry.array is None and not entry.dims and isinstance(entry.values[0], str) and entry.values[0][:1].isalpha()
    return f"; a material is given as {body}, in place of {entry.name}" if body and word else ""


def _filled(request: Request, scene: Scene) -> dict[str, Input]:
    """The inputs, with a value in each of [[cases]].

    A case without a layer may leave out the inputs of the layer. It gets their values from another case: no result
    depends on them or shows them.
    """
    base = request.inputs.get("base")
    inputs, default = dict(request.inputs), request.lexicon.parameter("base").default
    bases = [] if base is None or base.is_wrong or base.array is not None else base.values
    bases = [default if value is None else value for value in bases]
    if len(bases) != len(request.rows):
        bases = bases * len(request.rows) if len(bases) == 1 else [default] * len(request.rows)
    for name, entry in inputs.items():
        if entry.section != "[[cases]]":
            continue
        present = np.array([value is not None for value in entry.values])
        if name == "base":
            inputs[name] = replace(entry, values=bases)
        elif (present | (_is_of_layer(name) and np.array([value == "half_space" for value in bases]))).all():
            first = entry.values[int(np.argmax(present))]
            inputs[name] = replace(entry, values=[first if value is None else value for value in entry.values])
            if not present.all():
                scene.cases_of |= dict.fromkeys(_OF_LAYER.get(name, ()), xr.DataArray(present, dims="case"))
        else:
            request.errors.append(f"{name} must be given in every case, or once for all")
            inputs[name] = replace(entry, values=None)
    return inputs


def _is_of_layer(name: str) -> bool:
    return name in _OF_LAYER or name == "sublayers" or name.startswith("layers.")


def _add(scene: Scene, entry: Input) -> None:
    """Put the SI values and spreads of an input into the scene. Raises ValueError for values that are not allowed."""
    name, unit = entry.name, scene.lexicon.all_rows[entry.name].unit
    dim = dim_of(name, scene.lexicon)
    if entry.array is not None:
        value, spread = _of_array(entry, unit), 0.0
    elif entry.dims:
        quantities = [si(name, text, f"{name}[{i}]", scene.lexicon) for i, text in enumerate(entry.values)]
        value = xr.DataArray([number.value for number in quantities], dims=entry.dims)
        spread = xr.DataArray([number.spread for number in quantities], dims=entry.dims)
    else:
        single = si(name, entry.values[0], lexicon=scene.lexicon)
        value, spread = single.value, single.spread
    if entry.dims == (dim,):
        scene.dims[dim] = name
        twins = equal_values(name, value.values.tolist(), lambda number: f"{number:g} {unit}".removesuffix(" 1"))
        if twins:
            raise ValueError(twins[0])
    low, high, limits = _limits_of(name)
    if name in ("R1", "R2"):
        _refuse(entry, value, value == 0, "must not be 0")
    _refuse(entry, value, ~np.asarray((value > low) & (value <= high)), limits)
    if not np.all(spread == 0):
        limit, limits = (high, limits) if np.isfinite(high) else (0.0, "must not be 0")
        at_limit = (spread > 0) & (value == limit)
        _refuse(entry, value, at_limit, f"with its spread it {limits}; at the limit itself give no spread")
        scene.spreads[name] = spread
    scene.values[name] = value


def _limits_of(name: str) -> tuple[float, float, str]:
    """Bounds of an input: it must be above the first, and at most the second; and words for a message."""
    of_layer = _POISSON if is_ratio(name) else _POSITIVE if name in SCENE else (-np.inf, np.inf, "must be a number")
    return _LIMITS.get(name, of_layer if name.startswith("layers.") else (-np.inf, np.inf, "must be a number"))


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
