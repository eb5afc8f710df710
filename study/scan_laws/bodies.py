"""The coated body under a scan, from the inputs of a contact."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from solver import Problem
from solver.bases import is_bare, named
from solver.body import BODIES
from solver.parameters import LAYER
from solver.scaling import dimensionless

from ..inputs.definition import StudyError, from_call

#: Inputs of a contact that do not matter here, and the modulus of a body for which only ratios are given.
_USUAL = {"R": "1 um", "P": "1 uN", "micro": "smooth"}
_MODULUS = "1 GPa"


@dataclass(frozen=True)
class PressedBody:
    """The body under a scan.

    Attributes
    ----------
    kernel : (L + m)/(1 + m) as a function of k (W,) in 1/m; None: 1
    m : E1*/E_punch*; the modulus of body and punch in series is E1*/(1 + m)
    inputs : parameter -> number or word, lengths in m, by which the body is recognised; None for a half-space
    """

    kernel: Callable | None = None
    m: float = 0.0
    inputs: dict[str, Any] | None = None


def body_of(on: Mapping[str, Any] | None, caller: str) -> PressedBody:
    """The body with these inputs of `study.solve`; None: a half-space of E1*. Raises StudyError."""
    if on is None:
        return PressedBody()
    if not isinstance(on, Mapping):
        raise StudyError([f"{caller}: on = {on!r}: must be a dictionary of inputs of a layer, such as h, n, nu1"])
    wrong = sorted({*on} & {"R", "P", "a", "D", "micro", "w_adhesion", "shape"})
    if wrong:
        raise StudyError([f"{caller}: on has {wrong[0]}: it must have the body alone"])
    moduli = {} if any(name in on for name in ("E2", "body", "rigid_base")) else {"E2": _MODULUS}
    inputs = _USUAL | moduli | {name: value for name, value in on.items() if value is not None}
    inputs.setdefault("base", "stack" if "layers" in on else "layered")
    if is_bare(inputs["base"]):
        return PressedBody()
    inputs["base"] = named(inputs["base"]).item()
    try:
        definition = from_call(inputs, [], False, {"output": {"profiles": False}})
    except StudyError as error:
        raise StudyError(text.replace("solve: ", f"{caller}: on: ", 1) for text in error.messages) from None
    scene = definition.scene
    assert scene is not None  # R has a unit, so all have
    if definition.grid.sizes:
        raise StudyError([f"{caller}: on: {', '.join(definition.grid.sizes)} has several values: one body at a time"])
    numbers = {name: value for name, value in scene.parameters.items() if name in scene.lexicon.parameters}
    problem = dimensionless(Problem.of(known=scene.lexicon.known, **numbers))
    solid = BODIES[str(problem.base[0])](problem)
    if solid.kernel is None:
        raise StudyError([f'{caller}: on: base = "{problem.base[0]}" has no kernel: take "layered" or "stack"'])
    h, m = float(solid.h[0]) * float(scene.R), float(solid.m[0])
    grid = {name: array.item() for name, (_, array) in definition.grid.values.items()}
    inputs_of_body = {name: grid[name] for name in grid if _describes_body(name)}
    lengths = [name for name in inputs_of_body if scene.lexicon.rows[name].powers == (0, 1)]
    inputs_of_body |= {name: inputs_of_body[name] * float(scene.R) for name in lengths}
    return PressedBody(lambda k: (solid.kernel.whole((k * h)[None])[0] + m) / (1 + m), m, inputs_of_body)


def _describes_body(name: str) -> bool:
    """Whether a parameter belongs to the description of a body."""
    of_layers = name.startswith("layers.") and name.rpartition(".")[2] in LAYER
    return of_layers or name in ("h", "n", "m", "nu1", "nu2", "bonding")
