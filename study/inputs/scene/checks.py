"""What can be wrong with a physical scene as a whole, though each of its inputs is right."""

from numbers import Real
from typing import Any

import numpy as np
import xarray as xr

from solver.laws.own_table import PREFIX

from ...terminal import shown
from ..checks import not_given
from ..given import one_control
from ..grid import twins
from ..vocabulary import VOCABULARY
from .bodies import BODIES, layered
from .scales import over_dimensions
from .scene import STEP, Scene

_RADIUS = 'R is missing: the radius of the punch, or R1 and R2 of two bodies (a cup: R2 = "-20 mm")'


def missing(parameters: dict, names: set[str], errors: list[str]) -> list[str]:
    """Messages for what a physical scene cannot do without, and for what cannot be given together.

    names : those of all parameters that are given, also in some of [[cases]] only; errors : what is wrong with them
    """
    pair = [name for name in ("R1", "R2") if name in parameters]
    messages = [_RADIUS] if "R" not in parameters and not pair else []
    if len(pair) == 1:
        other = "R2" if pair == ["R1"] else "R1"
        messages.append(f'{other} is missing: R1 and R2 go together; of a flat body {other} = "flat"')
    if pair and "R" in parameters:
        messages.append(f"R and {pair[0]} are both given: R = 1/(1/R1 + 1/R2) follows from R1 and R2")
    if "E2" not in parameters:
        messages.append('E2 is missing: Young\'s modulus of the body (under the layer, if there is one), or "rigid"')
    if layered(parameters) and not {"E1", "n", "layer"} & {*parameters, *names}:
        messages.append('E1 is missing: Young\'s modulus of the layer (without a layer: base = "half_space")')
    for modulus, _, ratio in BODIES.values():
        if modulus in parameters and ratio in parameters:
            messages.append(f"{modulus} and {ratio} are both given: one follows from the other")
    if "nu_punch" in parameters and "E_punch" not in parameters:
        messages.append("nu_punch is given without E_punch: a punch without a modulus is rigid")

    def texts(name: str) -> list:
        """The values of a parameter that has texts: its default, where it is not given."""
        return np.ravel(np.array(parameters.get(name, VOCABULARY[name].own.default), dtype=object)).tolist()

    absent = not_given({*parameters, *names, "n"}, texts, errors)
    if absent and "micro = " in absent[-1] and "micro" not in names:
        absent[-1] += ' (without asperities: micro = "smooth")'
    return messages + one_control(names) + absent


def equal_cases(scene: Scene) -> list[str]:
    """A message for two of [[cases]] that are the same, in whatever units they are given."""
    arrays = [v for table in (scene.given, scene.spreads, scene.parameters) for v in table.values()]
    columns = [v.values.tolist() for v in arrays if isinstance(v, xr.DataArray) and v.dims == ("case",)]
    columns += [texts for dim, texts in scene.names.values() if dim == "case"]
    return [f"cases {i} and {j} are the same" for i, j in twins(list(zip(*columns, strict=True)))]


def impossible(scene: Scene) -> list[str]:
    """Messages for bodies that cannot touch as they are given."""
    given, messages = scene.given, []
    up = {name: given[name] + STEP * scene.spreads.get(name, 0.0) for name in ("R1", "R2") if name in given}
    if up and not np.all(1 / up["R1"] + 1 / up["R2"] > 0):
        R1, R2 = (f"{name} = {_shown(given[name])} m" for name in ("R1", "R2"))
        too = ", with their spreads too" * bool({*up} & {*scene.spreads})
        wider = f"a cup (the negative radius) must be wider than its ball{too}"
        messages.append(f"{R1}, {R2}: 1/R1 + 1/R2 must be > 0: {wider}")
    n = np.array(scene.parameters.get("n", given.get("n", 1.0)), dtype=object)
    if not all(isinstance(one, Real) and not isinstance(one, bool) for one in n.ravel().tolist()):
        return [*messages, f"n = {shown(scene.parameters['n'])}: must be a number"]
    rigid = np.isinf(given["E2"])
    if not np.any(rigid):
        wrong = 'n = 0 is a rigid base: give E2 = "rigid" and E1, the modulus of the layer'
        return messages + [wrong] * bool((n == 0).any())
    if np.any(rigid & (over_dimensions(scene.parameters.get("base", "layered"), "base") == "half_space")):
        swap = "a rigid body and an elastic ball are the same contact as a rigid ball on a body of the ball's modulus"
        messages.append(f'E2 is rigid and base = "half_space": no layer is there to yield; {swap}')
    if "n" in scene.parameters:
        messages.append("E2 is rigid and n is given: give E1, the modulus of the layer")
    return messages


def moving_tables(scene: Scene) -> list[str]:
    """A message where a table of one's own, whose lengths are in R, would change with the spread of a radius."""
    micro = np.ravel(np.array(scene.parameters.get("micro", ""), dtype=object)).tolist()
    table = next((word for word in micro if str(word).startswith(PREFIX)), "")
    moved = sorted({"R", "R1", "R2"} & {*scene.spreads})
    if not (table and moved):
        return []
    return [f"{moved[0]} has a spread: the lengths in {table} are in R and would change with it; give {moved[0]} none"]


def _shown(value: Any) -> str:
    return ", ".join(f"{one:g}" for one in np.ravel(value)[:3].tolist()) + " ..." * (np.size(value) > 3)
