"""What the rules say of contacts: assumptions that they violate, with their size, and inputs that nothing real has."""

import xarray as xr

from ..data import derived
from ..rules.rule import sentences
from .pressures import RING


def doubts(contact: xr.Dataset) -> list[str]:
    """A sentence for each assumption of the model that some cases violate, and for inputs that nothing real has."""
    v = dict(contact.variables)  # arithmetic of DataArrays takes longer than solving a contact
    return sentences(v | (_largest(contact) if v["p_max"].attrs.get("units") == "Pa" else {}))


def _largest(contact: xr.Dataset) -> dict[str, xr.Variable]:
    """p_ring and p_peak, the largest nominal and real pressures that are known: those of the centre, or of a ring that
    the profile has."""
    v = contact.variables
    nominal, real = v["p0"], v["p_max"]
    top = v["p"].max("x") if "p" in v else nominal
    ring = top > RING * nominal
    if ring.any():
        try:
            peak = derived.peak_pressure(contact).variable
        except ValueError:  # the moduli are not known, as of a mean
            peak = top
        nominal, real = top.where(ring, nominal), peak.where(ring & (peak > real), real)
    return {"p_ring": nominal, "p_peak": real}
