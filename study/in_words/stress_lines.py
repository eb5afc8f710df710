"""The answers of `study.first_yield`, `h_protect`, `extremes` and `stresses` in words."""

from __future__ import annotations

import numpy as np

from ..arrays import xarray_later as xr
from ..data.dataset import flag_words
from ..inputs.vocabulary import VOCABULARY
from ..rules.rule import RULES
from .numbers import given_text, in_its_unit, spread_of
from .stated_inputs import is_rigid

MOST_CASES = 20  # of a grid that are written out
_BODIES = {"Y1": "layer", "Y2": "body", "Ya": "asperities", "Y_punch": "punch"}
_ANY_LOAD = "yields under any load: below a sharp tip or corner the stress is infinite"


def of_stresses(dataset: xr.Dataset) -> str | None:
    """The text on such a dataset; None of any other."""
    if "model_used" in dataset:
        return None
    kinds = {"first_yield": _first_yield, "h_protect": _protection, "mises2_r": _extremes, "stress_error": _fields}
    name = next((name for name in kinds if name in dataset), None)
    if name is None:
        return None
    dims = [str(dim) for dim in dataset[name].dims]
    if not dims:
        return "\n".join(kinds[name](dataset))
    dataset = dataset.reset_index([dim for dim in dims if hasattr(dataset.indexes.get(dim), "levels")])
    cases, texts = dataset.stack({"one": dims}, create_index=False), []
    for i in range(min(cases.sizes["one"], MOST_CASES)):
        case = cases.isel(one=i)
        where = str(case["label"].values) if "label" in case else ", ".join(given_text(case, dim) for dim in dims)
        texts.append("\n".join([f"--- {where}", *kinds[name](case)]))
    if cases.sizes["one"] > MOST_CASES:
        texts.append(f"--- and {cases.sizes['one'] - MOST_CASES} more cases: choose some with sel() or isel()")
    return "\n\n".join(texts)


def _first_yield(case: xr.Dataset) -> list[str]:
    first = flag_words(case["first_yield"]).item().replace("_", " ")
    there = [end for end in _BODIES if f"found_{end}" in case]
    lines = [f"First to yield, of what is known: the {first}."] if first != "not known" else ["No load is found."]
    for end in there:
        lines += _of_body(case, end)
    return lines


def _of_body(case: xr.Dataset, end: str) -> list[str]:
    """Whether a body yields, at which load and where, and what the contact violates there."""
    body, found = _BODIES[end], flag_words(case[f"found_{end}"]).item()
    verb = "yield" if body == "asperities" else "yields"
    if found == "no_asperities":
        return ["The punch is smooth: there are no asperities."]
    if found == "strength_not_known":
        return [f"The strength of the {body} is not known."]
    if found != "first_crossing":
        farthest = found.replace("none_up_to_", "").replace("0.2_R", "a = 0.2 R").replace("_", " ")
        missing = "" if body == "asperities" else ", or is rigid or not there"
        return [f"No load is found at which the {body} {verb}: not up to {farthest}{missing}."]
    if float(case[f"P_{end}"]) == 0:
        why = _ANY_LOAD if np.isnan(float(case[f"r_{end}"])) and end != "Ya" else f"{verb} before there is a load"
        return [f"The {body} {why}."]
    symbols = {"P": "P", "a": "a", "D": "D", "p0": "p(0)"}
    texts = [f"{symbol} = {_number(case, f'{name}_{end}')}" for name, symbol in symbols.items()]
    where = _place(float(case[f"r_{end}"]), float(case[f"z_{end}"]))
    violated = [RULES[word].sentence for word in _words(case, f"validity_{end}") if word in RULES]
    return [f"The {body} first {verb} at {', '.join(texts)}, {where}.", *(f"Beware: {text}" for text in violated)]


def _words(case: xr.Dataset, name: str) -> list[str]:
    return flag_words(case[name]).item().split() if name in case else []


def _protection(case: xr.Dataset) -> list[str]:
    h, least = (float(case[name]) for name in ("h_protect", "h_yields"))
    if np.isnan(h):
        return [f"The thickness that protects the body is not known: {case['h_protect'].attrs.get('message', '')}."]
    if h == 0:
        return ["The body does not yield, whatever the thickness of the layer."]
    lines = [f"The body does not yield below a layer thicker than {_number(case, 'h_protect')}."]
    if np.isfinite(least):
        lines.append(f"A bare body would not yield: from a thickness of {_number(case, 'h_yields')} on it does.")
    return lines


def _extremes(case: xr.Dataset) -> list[str]:
    names = [str(name) for name in case.data_vars if f"{name}_r" in case and np.isfinite(float(case[str(name)]))]
    rows = []
    for name in names:
        r, z = float(case[f"{name}_r"]), float(case[f"{name}_z"])
        there = f"{_stress(case, name, float(case[name]))}, {_place(r, z)}" if np.isfinite(r) else "none"
        rows.append((VOCABULARY[name].long_name if name in VOCABULARY else name, there))
    width = max((len(label) for label, _ in rows), default=0)
    return [f"  {label:{width}}  {text}" for label, text in rows] or ["The contact has no solution."]


def _fields(case: xr.Dataset) -> list[str]:
    if not np.isfinite(float(case["stress_error"])):
        return ["The contact has no solution."]
    lines = [f"Stresses at {case.sizes['r']} radii and {case.sizes['z']} depths."]
    for name in ("mises", "s1", "s3"):
        values = case[name].transpose("z", "r").values
        if not np.isnan(values).all():
            place = np.unravel_index((np.nanargmin if name == "s3" else np.nanargmax)(values), values.shape)
            where = _place(float(case["r"][place[1]]), float(case["z"][place[0]]))
            which = "least" if name == "s3" else "at most"
            lines.append(
                f"{case[name].attrs['long_name']}, {which}: {_stress(case, name, float(values[place]))}, {where}."
            )
    return [*lines, f"Any stress is within {float(case['stress_error']):.1g} of the largest."]


def _stress(case: xr.Dataset, name: str, value: float) -> str:
    """A stress with its unit, or over E2*, over E1* on a rigid body."""
    text = in_its_unit(case, name, float(f"{value:.4g}"))
    scale = case[name].attrs.get("scale", "")
    return text.replace(scale, "E1*" if is_rigid(case, "base") else "E2*") if scale else text


def _number(case: xr.Dataset, name: str) -> str:
    return in_its_unit(case, name, float(f"{float(case[name]):.4g}"), spread_of(case, name))


def _place(r: float, z: float) -> str:
    """A place in words; r and z in a."""
    across = "on the axis" if abs(r) < 1e-3 else f"at r = {r:.3g} a"
    return f"{across}, at the surface" if z == 0 else f"{across}, {z:.3g} a deep"
