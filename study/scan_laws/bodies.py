"""The coated body that a scan presses on, of the inputs of a contact."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from solver import Problem
from solver.bases import is_bare, named
from solver.body import BODIES
from solver.parameters import LAYER
from solver.scaling import dimensionless

from ..inputs.definition import StudyError, from_call

#: Inputs of a contact which do not count here, and the modulus of a body of which ratios alone are given.
_USUAL = {"R": "1 um", "P": "1 uN", "micro": "smooth"}
_MODULUS = "1 GPa"


@dataclass(frozen=True)
class PressedBody:
    """What a scan presses on.

    Attributes
    ----------
    kernel : function of k (W,) in 1/m that gives (L + m)/(1 + m); None: 1
    m : E1*/E_punch*; the modulus that is felt is E1*/(1 + m)
    inputs : parameter -> number or word, lengths in m: what tells it from other bodies; None of a half-space
    """

    kernel: Callable | None = None
    m: float = 0.0
    inputs: dict[str, Any] | None = None


def body_of(on: Mapping[str, Any] | None, caller: str) -> PressedBody:
    """The body of inputs of a layer, as `study.solve` takes them; None: a half-space of E1*. Raises StudyError."""
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
    told = {name: grid[name] for name in grid if _tells(name)}
    lengths = [name for name in told if scene.lexicon.rows[name].powers == (0, 1)]
    told |= {name: told[name] * float(scene.R) for name in lengths}
    return PressedBody(lambda k: (solid.kernel.whole((k * h)[None])[0] + m) / (1 + m), m, told)


def _tells(name: str) -> bool:
    """Whether a parameter says what a body is."""
    of_layers = name.startswith("layers.") and name.rpartition(".")[2] in LAYER
    return of_layers or name in ("h", "n", "m", "nu1", "nu2", "bonding")
