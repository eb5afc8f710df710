"""The command `point`: one contact in the terminal, in words or as JSON."""

import json
import math
import sys
import warnings
from argparse import ArgumentTypeError

import numpy as np
import xarray as xr

from ..data.dataset import decode
from ..data.derived import QUANTITIES
from ..derivatives import spread_of_formula
from ..in_words import SHOWN, FarOutside, doubts, summary
from ..in_words.inputs import all_inputs
from ..inputs.definition import StudyError
from ..inputs.scene.names import INFINITE
from ..solving import solve
from ..terminal import answer, say
from .arguments import assignment

_DERIVED = ("p_ring", "r_ring", "p_peak", "D_body")  # of QUANTITIES, that JSON has besides
_SWITCH = {"true": True, "false": False}


def items(options) -> list[list[str]]:
    """All that was given describes one contact."""
    return [options.items]


def point(options, given: list[str]) -> int:
    """Solve the contact and say what was found; exit code 1 for one that has no solution."""
    parameters = parameters_of(given)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the summary says it; but that may take long
        warnings.simplefilter("always", FarOutside)
        warnings.showwarning = lambda text, *_: say(f"beware: {text}", sys.stderr)
        try:
            found = solve(**parameters)  # with the profile p, which may be largest in a ring
        except StudyError as error:
            raise StudyError(message.removeprefix("solve: ") for message in error.messages) from None
    text = json.dumps(as_numbers(found), indent=2, ensure_ascii=False) if options.json else summary(found)
    return answer(text) or (0 if int(found["status"]) == 0 else 1)


def parameters_of(given: list[str]) -> dict[str, float | str | bool]:
    """Arguments of `study.solve` from texts NAME=VALUE. Raises StudyError with a message for each that is none."""
    found, errors = {}, []
    for text in given:
        try:
            name, value = assignment(text)
        except ArgumentTypeError as error:
            errors.append(f'{error}, such as R="5 mm"')
            continue
        errors += [f"{name} is given twice"] * (name in found)
        if name == "same_piece":
            errors += [f"{text}: must be same_piece=true or same_piece=false"] * (str(value).lower() not in _SWITCH)
            value = _SWITCH.get(str(value).lower())
        elif name in solve.__kwdefaults__:
            errors.append(f"{name} says nothing of one contact: leave it out")
        found[name] = value
    if errors:
        raise StudyError(errors)
    return found


def as_numbers(found: xr.Dataset) -> dict:
    """Inputs and results of one case for JSON: value, unit, and spread where the inputs have some; flags by name."""
    found = found.assign({name: QUANTITIES[name](found) for name in _DERIVED} | _spreads_of_derived(found))
    shown = {
        name: described(found, name) for name in dict.fromkeys((*all_inputs(), *SHOWN, *_DERIVED)) if name in found
    }
    shown |= {name: number(found[name]) for name in ("error", "model_error")}
    shown |= {name: decode(found[name]).item() for name in ("status", "model_used")}
    shown["validity"] = decode(found["validity"]).item().split()
    return shown | {"beware": doubts(found)}


def _spreads_of_derived(found: xr.Dataset) -> dict[str, xr.DataArray]:
    """NAME_spread of derived quantities, if results have spreads: NaN where it does not follow from these.

    A largest pressure does not change with its place to first order. That of the centre stays there.
    """
    if "p_spread" not in found:
        return {}
    place = int(np.argmax(found["p"].values))
    spreads = {"p_ring": found["p_spread"][place].drop_vars("x"), "p_peak": found["p_max_spread"]}
    spreads["D_body"] = found.get("D_spread")
    formulas = {"r_ring": _ring if place else lambda _: math.nan}
    formulas |= {name: QUANTITIES[name] for name in ["p_peak"] * bool(place) + ["D_body"] * bool(found.get("m", 0.0))}
    spreads |= {name: xr.DataArray(spread_of_formula(found, formula)) for name, formula in formulas.items()}
    return {f"{name}_spread": spread for name, spread in spreads.items() if spread is not None}


def _ring(dataset: xr.Dataset) -> float:
    """The radius of the ring of one contact, where the parabola through the three points at the largest pressure has
    its top: it moves with the inputs, which the point of `r_ring` does not."""
    p, x = dataset["p"].values, dataset["x"].values
    place = min(max(int(np.argmax(p)), 1), len(p) - 2)
    bend, slope, _ = np.polyfit(x[place - 1 : place + 2] - x[place], p[place - 1 : place + 2], 2)
    return float(dataset["a"]) * (x[place] - slope / (2 * bend))


def described(found: xr.Dataset, name: str) -> dict | str:
    """Value, unit and spread of a variable; a text as it is, and "rigid" or "flat" in place of an infinite number."""
    array = found[name]
    if array.dtype.kind in "UO":
        return str(array.values)
    if name in INFINITE and math.isinf(array):
        return INFINITE[name][0]
    unit = array.attrs.get("scale") or array.attrs.get("units", "1")
    spread = {"spread": number(found[f"{name}_spread"])} if f"{name}_spread" in found else {}
    return {"value": number(array), "unit": unit} | spread


def number(array: xr.DataArray) -> float | None:
    """A number, None for NaN, which JSON does not have."""
    value = float(array)
    return value if math.isfinite(value) else None
