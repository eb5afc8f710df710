"""Sharp tips in hard bodies: loading is no elastic contact there."""

import numpy as np
import xarray as xr

from ..model import CurveModel

#: Bodies at least as stiff, in Pa, flow below a sharp tip, whatever they are made of: the mean pressure of the elastic
#: contact, E* cot(half_angle)/2, is 0.18 E* under a Berkovich tip, and their hardness is at most some 0.1 E*. Rubbers
#: and gels, which do not flow, are softer than 0.1 GPa.
HARD = 1e9
#: cot(half_angle)/2 of tips that count as sharp: hardness over E* is above this in few metals.
_BLUNT = 0.02
_POINTED = ("berkovich", "vickers", "cube_corner")
_TANGENT = 3.0  # a blunt cone is sharp where the contact is so many times as wide as its ball


def flows(model: CurveModel, modulus: np.ndarray, contacts: xr.Dataset) -> np.ndarray:
    """Which contacts (M,) of a fit are those of a sharp tip in a body that flows below it.

    modulus : (M,) in Pa, of what is touched
    contacts : the contacts at the deepest points, of `solve`
    """
    numbers = model.scene.parameters
    shape = numbers.get("shape", "paraboloid")
    if (model.x, model.y) != ("D", "P") or shape not in (*_POINTED, "cone", "blunt_cone"):
        return np.zeros(len(modulus), bool)
    hard = modulus >= HARD
    if shape in _POINTED:
        return hard
    angle = contacts["half_angle"].values if "half_angle" in contacts else numbers["half_angle"]
    slope = 1 / np.tan(np.radians(np.asarray(angle, float)))
    if shape == "blunt_cone":
        hard &= contacts["a"].values > _TANGENT * model.scene.values["tip_radius"] * slope
    return hard & (slope / 2 > _BLUNT)
