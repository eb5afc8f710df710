"""The largest pressures of a contact, in the centre or in a ring."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import xarray_later as xr
from ..arrays.labelled import as_xarray
from ..data import derived
from ..data.dataset import OneCase, as_dataset

#: The pressure in a ring exceeds p(0) by at least this factor. A smaller excess changes none of two digits.
RING = 1.01


class Largest(NamedTuple):
    """The largest pressures of a case.

    real : the largest real pressure, in the ring if there is one, otherwise p_max; NaN where it is not known
    place : index of the ring in the profile; None: the centre
    """

    real: float
    place: int | None


def largest(case: xr.Dataset | OneCase) -> Largest:
    """The largest pressures of one case, over the points of its profile."""
    p0, p_max = float(case["p0"]), float(case["p_max"])
    if not np.isfinite(p0):  # under a sharp tip
        return Largest(p_max, None)
    p = case["p"].values if "p" in case else np.array([p0])
    place = int(np.argmax(p)) if np.isfinite(p).all() else 0
    if not p[place] > RING * p0:
        return Largest(p_max, None)
    try:
        real = float(derived.peak_pressure(as_dataset(case)))
    except ValueError:  # the moduli are not known, as for a mean
        real = np.nan
    return Largest(real, place)


def largest_of_all(contact: xr.Dataset | OneCase) -> dict[str, xr.Variable]:
    """p_ring, p_peak: the largest known nominal and real pressures of each case, in the centre or in a ring."""
    v = contact.variables
    nominal, real = v["p0"], v["p_max"]
    top = v["p"].max("x") if "p" in v else nominal
    ring = top > RING * nominal
    if np.isinf(nominal).any():  # under sharp tips
        nominal, real = (v.where(np.isfinite(v)) for v in (nominal, real))
    if ring.any():
        contact = as_dataset(contact)
        nominal, real, top, ring = (as_xarray(variable) for variable in (nominal, real, top, ring))
        try:
            peak = derived.peak_pressure(contact).variable
        except ValueError:  # the moduli are not known, as for a mean
            peak = top
        nominal, real = top.where(ring, nominal), peak.where(ring & (peak > real), real)
    if "p_spot" in v:
        real = np.fmax(real, as_xarray(v["p_spot"]))  # the pressure in the middle of a spot may be lower
    return {"p_ring": nominal, "p_peak": real}
