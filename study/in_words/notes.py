"""Sentences about some contacts alone: shapes, adhesion, asperities that feel the layer, spots that unload."""

from __future__ import annotations

import numpy as np

from solver.bases import is_bare
from solver.laws import heights
from solver.shapes import PARABOLOID
from solver.shapes.cone import KIND, PYRAMIDS

from ..arrays import xarray_later as xr
from ..inputs.lexicon import lexicon_in
from ..inputs.punch.micro_laws import USED
from ..inputs.vocabulary import names
from ..specimen.quantities import readable
from .numbers import in_its_unit

#: Results of pull-off and pull-in that a summary lists, in this order.
OF_PULL_OFF = tuple(name for name in names("pull_off") if name != "stable")
#: Cones, and pyramids that count as cones -> cotangent of their half angle; None: the angle is an input.
_CONES = {KIND.name: None} | {kind.name: float(kind.of(size=1).cot[0]) for kind in PYRAMIDS}
#: Least correction that is worth a sentence: a smaller one is less than the spread of a material's moduli.
_SMALL = 0.005
#: On spheres with random heights, as from a scan: measured on six surfaces (docs/roughness.md, Which law when).
_SPHERES = (
    "If the asperities come from a scan, these spheres touch about two thirds of the area of the scan, and their pmax "
    "is up to 1.4 times too small, and some 9 times where single points stand out. rc.roughness.law(scan), or "
    "`roughcoat scan FILE --law OUT.csv`, is the law of the scan itself (docs/roughness.md)."
)
_SHARP_EDGE = "The pressure is infinite at the edge of a flat punch: shape = rounded_flat has a rounded edge."


def sticks(contacts: xr.Dataset) -> bool:
    """Whether a work of adhesion is among the inputs."""
    return "w_adhesion" in contacts.variables


def shape_of(case: xr.Dataset) -> str:
    """The shape of the punch of one contact; by default the paraboloid."""
    return str(case["shape"].values) if "shape" in case.variables else PARABOLOID


def of_shape(case: xr.Dataset) -> list[str]:
    """Sentences about the shape of the punch; none for a paraboloid."""
    shape = shape_of(case)
    if shape == PARABOLOID:
        return []
    kind = lexicon_in(case).known.shapes.get(shape)
    sentences = [f"Shape: {kind.words if kind else shape}{_angle_of(shape)}."]
    if np.isposinf(case["p0"]):
        sentences.append("The tip is sharp: p(0) is infinite, so every material yields in the centre.")
    elif np.isnan(case["p0"]) and np.isfinite(case["a"]) and case["status"] == 0:
        sentences.append("The tip is sharp: a, P and D are known; p(0), pmax and λ(0) are not.")
    if shape == "flat" and case["status"] == 0:
        sentences.append(_SHARP_EDGE)
    return sentences + _inwards(case, shape)


def _angle_of(shape: str) -> str:
    cot = _CONES.get(shape)
    return f" (half angle {np.degrees(np.arctan(1 / cot)):.4g}°)" if cot else ""


def _inwards(case: xr.Dataset, shape: str) -> list[str]:
    """A note on the inward pull of the surface under a cone: Hay, Bolshakov and Pharr (1999)."""
    nu = case.get("nu2" if is_bare(case["base"]) else "nu1")
    if shape not in _CONES or nu is None:
        return []
    cot = _CONES[shape] or float(1 / np.tan(np.radians(case["half_angle"])))
    c = cot * (1 - 2 * float(nu)) / (4 * (1 - float(nu)))
    gamma = np.pi * (np.pi / 4 + 0.1548 * c) / (np.pi / 2 - 0.8312 * c) ** 2
    if gamma - 1 < _SMALL:
        return []
    where = "" if is_bare(case["base"]) else " on a half-space of the layer's material"
    return [
        f"Note: a rigid cone pulls the surface inwards, which is left out here. At the same depth the load is then "
        f"about {gamma:.3g} times as large{where} (Hay, Bolshakov and Pharr 1999; docs/shapes.md)."
    ]


def of_scan(case: xr.Dataset) -> list[str]:
    """A sentence on spheres with random heights that stand for a scan; none with another law."""
    return [f"Spheres: {_SPHERES}"] if case["micro"].values == heights.LAW.name else []


def of_adhesion(case: xr.Dataset) -> list[str]:
    """Sentences about a contact with adhesion: whether it is stable, when it pulls off, and where it jumps into
    contact."""
    if not sticks(case):
        return []
    if not case["w_adhesion"] > 0:
        return ["Adhesion: w_adhesion is 0, so the surfaces do not adhere."]
    if not np.isfinite(case["P_off"]):
        return ["Adhesion: pull-off is not known."]
    off = f"P = {_text(case, 'P_off')}, D = {_text(case, 'D_off')}, a = {_text(case, 'a_off')}"
    control = _control_of_machine(case)
    sentences = [f"Adhesion: {control} the punch comes off at {off}."]
    if case["status"] == 0:
        state = "This contact is stable" if case["stable"] else "This contact is unstable: left alone it comes off"
        sentences.insert(0, f"{state}.")
    if np.isfinite(case["a_in"]) and case["a_in"] > 0:
        state = f"a = {_text(case, 'a_in')} at P = {_text(case, 'P_in')}"
        sentences.append(f"When the surfaces first touch, the contact jumps to {state}.")
    if case["adhesion"] == "jkr" and not ({"z0", "sigma0"} & {*case.variables}):
        sentences.append("Without its range z0 it is not known whether the attraction reaches too far for JKR.")
    return sentences


def _control_of_machine(case: xr.Dataset) -> str:
    """The control of the punch, as the beginning of a sentence."""
    k = case["k_machine"] if "k_machine" in case.variables else None
    if k is not None and np.isfinite(k) and k > 0:
        return f"on a machine of stiffness {in_its_unit(case, 'k_machine', float(k))}"
    stiff = bool(np.isinf(k)) if k is not None and not np.isnan(k) else "D" in case.coords
    return "under depth control" if stiff else "under load control"


def _text(case: xr.Dataset, name: str) -> str:
    return in_its_unit(case, name, float(case[name]))


def unit_of_length(case: xr.Dataset) -> list[str]:
    """A sentence where the unit of length of a profile is not given."""
    scale = case.attrs.get("scale", "R")
    in_R = shape_of(case) == "power" or shape_of(case).startswith("table:") and "table_unit" not in case.variables
    if scale in ("R", "1") or not in_R or "R" not in case.variables:
        return []
    length = readable(float(case["R"]), "m")
    return [f"R, the unit of length of the profile, is not given: it is taken to be {scale}, {length}."]


def presses_on(case: xr.Dataset) -> str:
    """The end of the sentence on the model: the body under the asperities, where the contact says it."""
    if "asperities_used" not in case or case["asperities_used"] == 0:
        return ""
    felt = case["asperities_used"] == USED.index("layer")
    return (
        ", which press on the coated body itself" if felt else ", which press on a half-space of the layer's material"
    )
