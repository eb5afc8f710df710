"""From inputs with units to a scene and its dimensionless parameters.

The scene has the radius R of the punch (or R1 and R2 of two bodies), Young's moduli E1 of the layer, E2 of the body
below and E_punch of the punch, with Poisson ratios nu1, nu2 and nu_punch.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from solver.bases import is_bare
from solver.laws.own_table import PREFIX
from solver.parameters import allowed as within
from solver.parameters import ends
from solver.shapes import PARABOLOID

from ...arrays import xarray_later as xr
from ...specimen.quantities import READABLE, multiple, quantity, readable, unit_in
from ...terminal import on_one_line
from ..checks import equal_cases, fill_in
from ..grid import equal_values
from ..punch.micro_laws import laws_in_metres
from ..punch.shapes import LENGTHS, MICROMETRE, in_metres, radius_needed
from ..request import NEEDS_NAMES, Input, Request, pull_hint, row_of
from ..vocabulary import SCENE, allowed, bodies_of
from .bodies import assumed, correlate, layered, none_alike, with_materials
from .scene import Scene, dim_of, is_ratio, make_dimensionless, si, with_unit
from .stacks import moduli_of

_POSITIVE, _POISSON = (0.0, np.inf, "must be > 0"), (-1.0, 0.5, "must be in (-1, 0.5]")
#: Bounds of inputs from which others are derived: (must be above, must be at most, words for a message).
_LIMITS = dict.fromkeys(("R", "E1", "E2", "E_punch", "flat_radius", "tip_radius"), _POSITIVE)
_LIMITS |= dict.fromkeys(("nu1", "nu2", "nu_punch"), _POISSON)
_E1, _NU1 = ("E1", "E1_spread", "n"), ("nu1", "nu1_spread")
#: Input that a case without a layer may leave out -> the coordinates that then have no value in this case, "" or NaN.
_OF_LAYER = {"layer": ("layer", *_E1, *_NU1), "E1": _E1, "n": _E1, "h": ("h", "h_spread"), "nu1": _NU1, "bonding": ()}
Place = dict[str, int]
"""Dimension -> index along it."""
_RADIUS = 'R is missing: the radius of the punch, or R1 and R2 of two bodies (a cup: R2 = "-20 mm")'


def read(request: Request, spreads: bool, axes: list[str]) -> Scene:
    """The physical scene that inputs describe. The dimensionless parameters become values of the request.

    Mistakes become messages of the request: no unit, a unit of something else, a missing R or modulus.

    spreads : whether the results shall have spreads
    axes : dimensions in the order that they shall have, behind `case`
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
            _read(scene, request, entry)
    scene.lexicon = request.lexicon  # with the laws and tables that have been read
    errors += [f"same_piece: {NEEDS_NAMES}"] * (request.same_piece and not errors and none_alike(scene.names))
    errors += missing(request, request.values)
    hint = f" ({request.sign} makes this a study with units)"
    errors[before:] = [f"{message}{hint * ('has no unit' in message)}" for message in errors[before:]]
    labels = {name: np.array(texts) for name, (dim, texts) in scene.names.items() if dim == name}
    axes_in_si = [name for name in scene.values if dim_of(name, scene.lexicon) == name]
    fill_in(request, labels | {name: np.asarray(scene.values[name]) for name in axes_in_si})
    errors += [] if errors else impossible(scene) + (same_cases(scene) if request.rows else [])
    if errors:
        return scene
    names = {*request.sections, *inputs}
    _measure(scene)
    scene.assumed = assumed(names, request.values, scene.values)
    correlate(scene, request.correlations, errors)
    if not spreads:
        scene.spreads = scene.correlations = {}
    make_dimensionless(scene)
    errors += moving_tables(scene) + beyond_bounds(scene, inputs)
    request.sizes |= scene.sizes(axes)
    if not errors:  # each has been checked, with its unit or without
        request.values |= {name: (getattr(v, "dims", ()), np.asarray(v)) for name, v in scene.parameters.items()}
    return scene


def _measure(scene: Scene) -> None:
    """Note the unit of length for shapes without a radius, and the tables of shapes that have units."""
    if "R" not in scene.values and "R1" not in scene.values:
        scene.scale = next((name for name in LENGTHS if name in scene.values), MICROMETRE)
    scene.metres = in_metres(scene.parameters.get("shape", ""), scene.lexicon)


def _read(scene: Scene, request: Request, entry: Input) -> None:
    """Put the numbers of an input into the scene."""
    name, before = entry.name, len(request.errors)
    has_unit = name in SCENE or name in _LIMITS or scene.lexicon.rows[name].powers != (0, 0)
    if has_unit or is_ratio(name) or entry.has_unit:
        try:
            _add(scene, entry)
        except ValueError as error:
            request.errors.append(f"{error}{_material(entry)}")
        return
    request.read(entry)
    if len(request.errors) == before:
        dims, array = request.values[name]
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


def missing(request: Request, values: dict) -> list[str]:
    """Messages for inputs that a physical scene needs but lacks, and for inputs that exclude each other.

    values : of the inputs without units, like those of a Grid
    """
    names, messages = {*request.sections}, []
    pair = [name for name in ("R1", "R2") if name in names]
    round_ = radius_needed(values.get("shape", ((), PARABOLOID))[1])
    messages += [_RADIUS] if round_ and "R" not in names and not pair else []
    if len(pair) == 1:
        other = "R2" if pair == ["R1"] else "R1"
        messages.append(f'{other} is missing: R1 and R2 go together; of a flat body {other} = "flat"')
    if pair and "R" in names:
        messages.append(f"R and {pair[0]} are both given: R = 1/(1/R1 + 1/R2) follows from R1 and R2")
    if not {"E2", "body"} & names:
        messages.append('E2 is missing: Young\'s modulus of the body (under the layer, if there is one), or "rigid"')
    several = "sublayers" in names
    lacking = layered(values) and not {"E1", "n", "layer"} & names
    if lacking and not several:
        messages.append('E1 is missing: Young\'s modulus of the layer (without a layer: base = "half_space")')
    others = [name.removesuffix(".h") for name in names if name.startswith("layers.") and name.endswith(".h")]
    without = [name for name in sorted(others) if not {f"{name}.{field}" for field in ("E1", "n", "material")} & names]
    without = ["layers.1"] * (lacking and several) + without
    messages += [f"{name}.E1 is missing: Young's modulus of this layer, or its material" for name in without]
    for modulus, _, ratio in bodies_of(names).values():
        if modulus in names and ratio in names:
            messages.append(f"{modulus} and {ratio} are both given: one follows from the other")
    if "nu_punch" in names and not {"E_punch", "punch"} & names:
        messages.append("nu_punch is given without E_punch: a punch without a modulus is rigid")
    return messages


def same_cases(scene: Scene) -> list[str]:
    """A message for two of [[cases]] that are the same, in whatever units they are given."""
    arrays = [v for table in (scene.values, scene.spreads, scene.parameters) for v in table.values()]
    columns = [v.values.tolist() for v in arrays if xr.is_array(v) and v.dims == ("case",)]
    columns += [texts for dim, texts in scene.names.values() if dim == "case"]
    return equal_cases(list(zip(*columns, strict=True)))


def impossible(scene: Scene) -> list[str]:
    """Messages for bodies that cannot touch."""
    values, messages = scene.values, []
    if "R1" in values and not np.all(1 / values["R1"] + 1 / values["R2"] > 0):
        R1, R2 = (f"{name} = {_shown(values[name])} m" for name in ("R1", "R2"))
        messages.append(f"{R1}, {R2}: 1/R1 + 1/R2 must be > 0: a cup (the negative radius) must be wider than its ball")
    rigid = np.isinf(values["E2"])
    if not np.any(rigid):
        wrong = 'n = 0 is a rigid base: give E2 = "rigid" and E1, the modulus of the layer'
        return messages + [wrong] * bool(np.any(scene.parameters.get("n", values.get("n", 1.0)) == 0))
    if np.any(rigid & (is_bare(scene.parameters.get("base", "layered")))):
        swap = "a rigid body and an elastic ball are the same contact as a rigid ball on a body of the ball's modulus"
        messages.append(f'E2 is rigid and base = "half_space": there is no layer that could deform; {swap}')
    if "n" in scene.parameters:
        messages.append("E2 is rigid and n is given: give E1, the modulus of the layer")
    return messages


def moving_tables(scene: Scene) -> list[str]:
    """A message if a table of the user's, whose lengths are in R, would change with the spread of a radius."""
    words = [np.ravel(np.array(scene.parameters.get(name, ""), dtype=object)).tolist() for name in ("micro", "shape")]
    tables = [str(word) for word in sum(words, []) if str(word).startswith(PREFIX)]
    lengths = (in_metres, laws_in_metres)
    table = next((word for word in tables if not any(have_unit(word, scene.lexicon) for have_unit in lengths)), "")
    moved = sorted({"R", "R1", "R2"} & {*scene.spreads})
    if not (table and moved):
        return []
    return [f"{moved[0]} has a spread: the lengths in {table} are in R and would change with it; give {moved[0]} none"]


def _shown(value: Any) -> str:
    return ", ".join(f"{number:g}" for number in np.ravel(value)[:3].tolist()) + " ..." * (np.size(value) > 3)


def beyond_bounds(scene: Scene, inputs: dict[str, Input]) -> list[str]:
    """A message for each input with a unit, and each ratio of moduli, that is outside its interval.

    inputs : E and ν in place of materials
    """
    with_units = [name for name in scene.values if name not in SCENE and scene.lexicon.rows[name].powers != (0, 0)]
    messages = [_message(scene, inputs[name], place) for name in with_units for place in _first_outside(scene, name)]
    moduli = {ratio: modulus for modulus, _, ratio in (*bodies_of(scene.values).values(), *moduli_of(scene.values))}
    for ratio, modulus in moduli.items():
        for place in _first_outside(scene, ratio) if ratio and modulus in scene.values else ():
            entry, value = scene.lexicon.rows[ratio], _at(scene.parameters[ratio], place)
            modulus_text = f"{modulus} = {readable(_at(scene.values[modulus], place), 'Pa')}"
            bounds = allowed(scene.lexicon.parameter(ratio))
            messages.append(f"{modulus_text}: {entry.long_name}: {ratio} = {value:.4g}: {bounds}")
    return messages


def _first_outside(scene: Scene, name: str) -> list[Place]:
    """The place of the first dimensionless value of a parameter that is outside its interval; [] if all are inside."""
    values = scene.parameters[name]
    inside = within(row_of(name, scene.values, scene.lexicon), np.asarray(values))
    outside = [] if inside.all() else np.argwhere(~inside)[:1].tolist()  # argwhere takes as long as all else here
    return [dict(zip(getattr(values, "dims", ()), index, strict=True)) for index in outside]


def _at(value: Any, place: Place) -> Any:
    """The number of an array at a place, the first one along dimensions that the place does not have."""
    if not xr.is_array(value):
        return value
    return value.isel({dim: place.get(dim, 0) for dim in value.dims}).item()


def _message(scene: Scene, entry: Input, place: Place) -> str:
    """The message for the value of an input at a place."""
    name = entry.name
    value, row = scene.values[name], scene.lexicon.rows[name]
    parameter = row_of(name, scene.values, scene.lexicon)
    index = [place[dim] for dim in getattr(value, "dims", ())]
    label = f"{name}{index}" if index else name
    text, word, size = _written(entry, index, _at(value, place), scene.lexicon.all_rows[name].unit)
    R, unit = _at(scene.R, place), _at(scene.unit, place)
    # the bounds in the unit of the value
    low, high = (f"{with_unit(end, row.powers, unit, R) / size:.4g}" for end in ends(parameter.interval)[:2])
    interval = f"{parameter.interval[0]}{low}, {high}{parameter.interval[-1]}"
    modulus = "E1*" if np.isinf(_at(scene.values["E2"], place)) else "E2*"
    scale = row.scale.replace("E2*", modulus)
    units = ((modulus, readable(unit, "Pa")), ("R", readable(R, "m")))
    here = " and ".join(f"{symbol} = {text}" for symbol, text in units if symbol in scale)
    bounds = f"{allowed(parameter._replace(interval=interval))} {word}, which is {parameter.interval} {scale}, {here}"
    return f"{label} = {on_one_line(str(text))}: {bounds}{pull_hint(name, _at(value, place), scene.values)}"


def _written(entry: Input, index: list[int], value: float, unit: str) -> tuple[Any, str, float]:
    """The text of a value, the word for its unit, and the size of that unit in the SI `unit`.

    A value of a range has no text, and some units are no single word. Then the word is a multiple of the SI unit that
    suits the value.
    """
    text = entry.at(index)
    word = (entry.unit if entry.array is not None else unit_in(text)) or multiple(abs(value), unit)[0]
    size = quantity("", f"1 {word}", unit).value
    return f"{value / size:g} {word}" if text is None else text, word, size
