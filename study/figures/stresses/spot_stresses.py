"""The stresses in the picture of a central spot: in a section below it, and along two lines."""

import numpy as np
import xarray as xr

from solver import solve
from solver.fields.invariants import mises
from solver.yields.below.central_spot import section, spot_of

from ...data.contacts import Contacts
from ...fields import residual_stress
from ...in_words.stated_inputs import is_rigid
from ...inputs.definition import StudyError
from .regions import Region, Stresses, one_contact, yield_strengths

#: Number of depths in the layer and in the body; number of radii, which include the edge of the spot; depth of the body
#: in the picture, in pitches.
_LAYER, _BODY, _RADII, _DEPTH = 41, 41, 61, 0.6


def of_central_spot(contact: xr.Dataset, sigma_res: float | str) -> tuple[xr.Dataset, Stresses]:
    """The contact without dimensions, and the stresses below its central spot, up to half of the pitch from the axis.

    Raises StudyError for several contacts, an unsolved contact, and asperities that do not feel the layer.
    """
    contact = one_contact(contact)
    contacts = Contacts.of(contact, "plot_stresses")
    contacts.refuse_without_stresses("plot_stresses")
    problem, unit = contacts.problem, float(contacts.units[0][0])
    solution = solve(problem)
    (b, pitch, h), far = spot_of(problem, solution)
    if np.isnan(b):
        way_out = 'asperities_on = "layer" on an exact base, and a law of asperities that have a radius'
        raise StudyError([f'plot_stresses: below = "spot" needs asperities that feel the layer: {way_out}'])
    r = np.linspace(0, far, _RADII)
    r[np.argmin(np.abs(r - b / pitch))] = b / pitch
    residual = float(residual_stress(sigma_res, contacts)) / unit

    def at(z, body):
        """sr, st, sz, trz (4, Z, R) on both sides of the axis."""
        near = section(problem, solution, r, z / pitch, body, residual) * unit
        return np.concatenate([near[..., :0:-1] * np.array([1, 1, 1, -1])[:, None, None], near], axis=2)

    around = np.concatenate([-r[:0:-1], r]) * pitch
    z, below = np.linspace(0, h, _LAYER), h + np.linspace(0, _DEPTH * pitch, _BODY)
    rigid = is_rigid(contact, "base")
    layer, body = at(z, False), None if rigid else at(below, True)
    regions = [Region(around, z, mises(*layer)), None if rigid else Region(around, below, mises(*body))]
    surface = {"sr": layer[0, 0], "st": layer[1, 0], "p": -layer[2, 0]}
    interface = {"trz_above": layer[3, -1], "sz_above": layer[2, -1], "sr_above": layer[0, -1]}
    interface |= {} if rigid else {"sr_below": body[0, 0]}
    largest = {}
    for name, region in zip(("mises1", "mises2"), regions, strict=True):
        if region:
            i, j = np.unravel_index(region.mises.argmax(), region.mises.shape)
            largest |= {name: region.mises[i, j], f"{name}_r": abs(around[j]), f"{name}_z": region.z[i]}
    strengths = yield_strengths(contacts)
    return contact, Stresses(*regions, surface, interface, around, largest, strengths, h, b)
