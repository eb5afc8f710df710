"""Messages for inputs with units that are outside the bounds of the solver. They quote the input: "P = -10 N: ..."."""

from __future__ import annotations

from typing import Any

import numpy as np

from solver.parameters import allowed as within
from solver.parameters import ends

from ...arrays import xarray_later as xr
from ...specimen.quantities import multiple, quantity, readable, unit_in
from ...terminal import on_one_line
from ..punch.sticking import hint, row_of
from ..request import Input
from ..vocabulary import SCENE, allowed, bodies_of
from .layers import moduli_of
from .scales import with_unit
from .scene import Scene

Place = dict[str, int]
"""Dimension -> index along it."""


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
