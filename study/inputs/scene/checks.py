"""Mistakes in a physical scene as a whole, though each of its inputs is right."""

from __future__ import annotations

from typing import Any

import numpy as np

from solver.bases import is_bare
from solver.laws.own_table import PREFIX
from solver.shapes import PARABOLOID

from ...arrays import xarray_later as xr
from ..checks import equal_cases
from ..punch import tables as tables_of_laws
from ..punch.shapes import in_metres, radius_needed
from ..request import Request
from ..vocabulary import bodies_of
from .bodies import layered
from .scene import Scene

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
        messages.append(f'E2 is rigid and base = "half_space": no layer is there to yield; {swap}')
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
