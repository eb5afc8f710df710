"""Mistakes in a physical scene: inputs outside the bounds of the solver, and inputs that do not go together."""

from __future__ import annotations

from typing import Any

import numpy as np

from solver.bases import is_bare
from solver.laws.own_table import PREFIX
from solver.parameters import allowed as within
from solver.parameters import ends
from solver.shapes import PARABOLOID

from ...arrays import xarray_later as xr
from ...specimen.quantities import multiple, quantity, readable, unit_in
from ...terminal import on_one_line
from ..checks import equal_cases
from ..punch import tables as tables_of_laws
from ..punch.shapes import in_metres, radius_needed
from ..punch.sticking import hint, row_of
from ..request import Input, Request
from ..vocabulary import SCENE, allowed, bodies_of
from .bodies import layered
from .scales import with_unit
from .scene import Scene
from .stacks import moduli_of

Place = dict[str, int]
"""Dimension -> index along it."""
_RADIUS = 'R is missing: the radius of the punch, or R1 and R2 of two bodies (a cup: R2 = "-20 mm")'


def missing(request: Request, values: dict) -> list[str]:
    """Messages for inputs that a physical scene needs and has not, and for inputs that exclude each other.

    values : of the inputs without units, as those of a Grid
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
    lengths = (in_metres, tables_of_laws.in_metres)
    table = next((word for word in tables if not any(given(word, scene.lexicon) for given in lengths)), "")
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
    return f"{label} = {on_one_line(str(text))}: {bounds}{hint(name, _at(value, place), scene.values)}"


def _written(entry: Input, index: list[int], value: float, unit: str) -> tuple[Any, str, float]:
    """The text of a value, the word for its unit, and the size of that unit in the SI `unit`.

    A value of a range has no text, and some units are no single word. Then the word is a multiple of the SI unit that
    suits the value.
    """
    text = entry.at(index)
    word = (entry.unit if entry.array is not None else unit_in(text)) or multiple(abs(value), unit)[0]
    size = quantity("", f"1 {word}", unit).value
    return f"{value / size:g} {word}" if text is None else text, word, size
