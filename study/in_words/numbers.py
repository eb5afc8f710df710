"""Inputs and results as text: a number with its unit and ±."""

from __future__ import annotations

import numpy as np

from ..arrays import xarray_later as xr
from ..data.dataset import as_dataset
from ..data.derived import QUANTITIES
from ..data.si import ASSUMED
from ..derivatives import spread_of_formula
from ..inputs.punch.shapes import ANGLES
from ..inputs.vocabulary import BODIES, CONTROLS
from ..specimen.quantities import READABLE, readable

#: Inputs whose text needs a word before it -> the word.
_WORDS = {"shape": "shape", "tip": "tip", "adhesion": "adhesion", "branch": "branch"}
#: The word of `asperities_on` -> the ground of the asperities.
_ASPERITIES = {
    "auto": "asperities on the layer where their pitch is above h",
    "layer": "asperities on the layer",
    "half_space": "asperities on a half-space of the layer's material",
}
#: Models of adhesion as people write them.
_MODELS = {"jkr": "JKR", "dmt": "DMT", "maugis": "Maugis"}


def given_text(case: xr.Dataset, name: str) -> str:
    """An input with its unit: "h = 2 µm"."""
    if name not in case:
        return str(name)
    value = case[name].values[()]
    assumed = " (assumed)" * (case[name].attrs.get("comment") == ASSUMED)
    if isinstance(value, (str, np.str_)):
        word = _MODELS.get(str(value), str(value)) if name == "adhesion" else str(value)
        words = f"{_WORDS[name]} {word}" if name in _WORDS else word.replace("_", " ")
        words = _ASPERITIES[str(value)] if name == "asperities_on" else words
        return f"{name} of {value}" if name in BODIES else words + assumed
    text = f"{name} = {in_its_unit(case, name, float(value), spread_of(case, name))}"
    text += " Ra/E1*^beta" * (name == "B") + "°" * (name in ANGLES) + assumed
    return text + " (fitted to Nbar and Ra)" * ("comment" in case[name].attrs and name in ("B", "beta"))


def in_its_unit(case: xr.Dataset, name: str, value: float, spread: float = 0.0) -> str:
    """A number with ± in the unit of a variable, or with its scale: "2.5 µm", "0.02 R"."""
    unit = case[name].attrs.get("units", "1")
    if unit in READABLE and unit != "1":
        return readable(value, unit, spread)
    scale = case[name].attrs.get("scale", "" if unit == "1" else unit)
    return f"{readable(value, '1', spread)} {scale}".rstrip()


def spread_of(case: xr.Dataset, name: str) -> float:
    """The spread of an input, or that of a result from the spreads of the inputs; 0 without one."""
    return float(case[f"{name}_spread"]) if f"{name}_spread" in case else 0.0


def result_text(case: xr.Dataset, name: str) -> str:
    """A result with its unit and ±."""
    is_given = name in CONTROLS and name in case.coords
    return _with_spread(case, name, float(case[name]), spread_of(case, name), "error" * (not is_given))


def ring_text(case: xr.Dataset, place: int) -> str:
    """The nominal pressure at a point of the profile, with ±, and its radius: "487 ± 12 MPa at r = 146.5 µm"."""
    spread = float(case["p_spread"][place]) if "p_spread" in case else 0.0
    pressure = _with_spread(case, "p", float(case["p"][place]), spread, "profile_error")
    return f"{pressure} at r = {in_its_unit(case, 'a', float(case['a'] * case['x'][place]))}"


def spot_text(case: xr.Dataset) -> str:
    """The largest real pressure in the central spot, and its place there: "1.32 ± 0.01 GPa at 0.7 of its radius"."""
    relative = spread_of(case, "p_max") / float(case["p_max"]) if "p_max_spread" in case else 0.0
    pressure = float(case["p_spot"])
    place = f"{float(case['r_spot']):.2g}"
    return f"{_with_spread(case, 'p_spot', pressure, relative * pressure, 'error')} at {place} of its radius"


def peak_text(case: xr.Dataset, pressure: float) -> str:
    """The largest real pressure, in a ring, with ± where inputs have spreads."""
    if "p_max_spread" not in case:
        return in_its_unit(case, "p_max", float(f"{pressure:.3g}"))
    spread = spread_of_formula(as_dataset(case), QUANTITIES["p_peak"])  # whose formulas are those of a dataset
    return _with_spread(case, "p_max", pressure, spread, "profile_error")


def _with_spread(case: xr.Dataset, name: str, value: float, spread: float, error: str) -> str:
    """A value with ±, from its spread, its `error` and `model_error`.

    error : name of the error; "" for an input
    """
    if not np.isfinite(value):
        return "unknown" if np.isnan(value) else "infinite" if value > 0 else "minus infinite"
    if not np.isfinite(spread):
        return f"{in_its_unit(case, name, value)} ± unknown"
    kinds = [kind for kind in (error, "model_error") if error and kind in case and np.isfinite(float(case[kind]))]
    parts = [spread, *(_size(case, name, value) * float(case[kind]) for kind in kinds)]
    return in_its_unit(case, name, value, float(np.sqrt(np.sum(np.square(parts)))))


def _size(case: xr.Dataset, name: str, value: float) -> float:
    """The size to which errors of a result are relative: with adhesion at least the load or the depth at pull-off."""
    off = case.get(f"{name}_off")
    return abs(value) if off is None or not np.isfinite(off) else max(abs(value), abs(float(off)))
