"""The coated body under a scan, from the inputs of a contact."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from solver.bases import is_bare, named

from ..inputs.definition import StudyError, from_call
from ..inputs.punch.pressed_body import PressedBody, body_in
from ..inputs.scene.scene import moduli

#: Inputs of a contact that do not matter here, and the modulus of a body for which only ratios are given.
_USUAL = {"R": "1 um", "P": "1 uN", "micro": "smooth"}
_MODULUS = "1 GPa"


def body_of(on: Mapping[str, Any] | None, caller: str) -> PressedBody:
    """The body with these inputs of `study.solve`; None: a half-space of E1*. Raises StudyError."""
    if on is None:
        return PressedBody()
    if not isinstance(on, Mapping):
        raise StudyError([f"{caller}: on = {on!r}: must be a dictionary of inputs of a layer, such as h, n, nu1"])
    wrong = sorted({*on} & {"R", "P", "a", "D", "micro", "w_adhesion", "shape"})
    if wrong:
        raise StudyError([f"{caller}: on has {wrong[0]}: it must have the body alone"])
    has_moduli = any(name in on for name in ("E2", "body", "rigid_base"))
    inputs = _USUAL | ({} if has_moduli else {"E2": _MODULUS})
    inputs |= {name: value for name, value in on.items() if value is not None}
    inputs.setdefault("base", "stack" if "layers" in on else "layered")
    inputs["base"] = named(inputs["base"]).item()
    try:
        definition = from_call(inputs, [], False, {"output": {"profiles": False}})
    except StudyError as error:
        raise StudyError(text.replace("solve: ", f"{caller}: on: ", 1) for text in error.messages) from None
    scene = definition.scene
    assert scene is not None  # R has a unit, so all have
    if definition.grid.sizes:
        raise StudyError([f"{caller}: on: {', '.join(definition.grid.sizes)} has several values: one body at a time"])
    case = {name: array.item() for name, (_, array) in definition.grid.values.items()}
    try:
        body = body_in(case, 1 / float(scene.R), scene.lexicon)
    except ValueError as error:
        raise StudyError([f"{caller}: on: {error}"]) from None
    return replace(body, E1=_surface_modulus(scene, case) if has_moduli else None)


def _surface_modulus(scene: Any, case: Mapping[str, Any]) -> float:
    """E1* of what lies at the surface, Pa."""
    unit, layer, body = moduli(scene.values, scene.parameters)
    if "layers.1.n" in case:
        return float(unit) * case["layers.1.n"]
    return float(body if is_bare(case["base"]) else layer)
