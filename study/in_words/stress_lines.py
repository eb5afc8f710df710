"""The answers of `study.first_yield`, `h_protect`, `extremes` and `stresses` in words."""

from __future__ import annotations

from typing import Any

import numpy as np

from solver import Problem, solve
from solver.bases import is_bare, is_stack
from solver.closed_forms import yield_pressure
from solver.kernels.two_layers import layer_modulus
from solver.yields import contact as yields
from solver.yields import spots
from solver.yields.stacked.largest import DIMENSION, EXTREMES, of_contacts

from ..arrays import xarray_later as xr
from ..data.body_strengths import layer_strengths, strengths
from ..data.contacts import Contacts
from ..data.dataset import flag_words
from ..inputs.vocabulary import VOCABULARY, name_in_stack
from ..rules.rule import RULES
from ..rules.yield_bounds import stress_below_one
from ..specimen import materials
from ..specimen.quantities import readable
from .numbers import given_text, in_its_unit, spread_of
from .stated_inputs import is_rigid

MOST_CASES = 20  # number of cases of a grid that are written out
_BODIES = {"Y1": "layer", "Y2": "body", "Ya": "asperities", "Y_punch": "punch"}
#: Depth at which a body first yields below a sphere, in the radius of the contact (nu = 0.3).
_DEEP = 0.48
_ANY_LOAD = "yields under any load: below a sharp tip or corner the stress is infinite"


def of_stresses(dataset: xr.Dataset) -> str | None:
    """The text on a dataset of one of these functions; None for any other dataset."""
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
    ends = [end for end in _BODIES if f"found_{end}" in case and not ("P_Y_layer" in case and end == "Y1")]
    place = f"layer {int(case['first_layer'])}" if first == "layer" and "first_layer" in case else f"the {first}"
    sentence = f"First to yield, as far as strengths are known: {place}."
    lines = [sentence if first != "not known" else "No load is found."]
    for number in case["layer"].values.tolist() if "P_Y_layer" in case else ():
        lines += _of_body(case.sel(layer=number), "Y_layer", f"layer {number}")
    for end in ends:
        lines += _of_body(case, end)
    return lines


def _of_body(case: xr.Dataset, end: str, layer: str = "") -> list[str]:
    """Sentences on the load and the place at which a body, or a `layer` of a stack, yields, and on assumptions that the
    contact violates there."""
    body = layer or f"the {_BODIES[end]}"
    outcome = flag_words(case[f"found_{end}"]).item()
    verb = "yield" if end == "Ya" else "yields"
    if outcome == "no_asperities":
        return ["The punch is smooth: there are no asperities."]
    if outcome == "strength_not_known":
        return [f"The strength of {body} is not known."]
    if outcome != "first_crossing":
        farthest = outcome.replace("none_up_to_", "").replace("0.2_R", "a = 0.2 R").replace("_", " ")
        missing = "" if end == "Ya" else "; it may be rigid or absent"
        return [f"No load up to {farthest} was found at which {body} {verb}{missing}."]
    if float(case[f"P_{end}"]) == 0:
        why = _ANY_LOAD if np.isnan(float(case[f"r_{end}"])) and end != "Ya" else f"{verb} before there is a load"
        return [f"{body[0].upper()}{body[1:]} {why}."]
    symbols = {"P": "P", "a": "a", "D": "D", "p0": "p(0)"}
    texts = [f"{symbol} = {_number(case, f'{name}_{end}')}" for name, symbol in symbols.items()]
    where = _place(float(case[f"r_{end}"]), float(case[f"z_{end}"]))
    violated = [RULES[word].sentence for word in _words(case, f"validity_{end}") if word in RULES]
    return [
        f"{body[0].upper()}{body[1:]} first {verb} at {', '.join(texts)}, {where}.",
        *(f"Beware: {text}" for text in violated),
    ]


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
        lines.append(f"A bare body would not yield; below a layer of {_number(case, 'h_yields')} or more it does.")
    return lines


def _extremes(case: xr.Dataset) -> list[str]:
    for dim in ("layer", "interface"):
        if dim in case.dims:  # the contact is on a stack
            case = _one_by_one(case, dim)
    names = [str(name) for name in case.data_vars if f"{name}_r" in case and np.isfinite(float(case[str(name)]))]
    rows = []
    for name in names:
        r, z = float(case[f"{name}_r"]), float(case[f"{name}_z"])
        text_of_stress = f"{_stress(case, name, float(case[name]))}, {_place(r, z)}" if np.isfinite(r) else "none"
        label = case[name].attrs.get("long_name", name)
        rows.append((VOCABULARY[name].long_name if name in VOCABULARY else label, text_of_stress))
    width = max((len(label) for label, _ in rows), default=0)
    return [f"  {label:{width}}  {text}" for label, text in rows] or ["The contact has no solution."]


def _one_by_one(case: xr.Dataset, dim: str) -> xr.Dataset:
    """The dataset with a variable for each layer or interface in place of a variable over `dim`."""
    single = {}
    for name in [str(name) for name in case.data_vars if dim in case[name].dims]:
        for number in case[dim].values.tolist():
            value = case[name].sel({dim: number}, drop=True)
            words = value.attrs["long_name"]
            for several in ("each layer", "each interface"):
                words = words.replace(several, f"{several.removeprefix('each ')} {number}")
            end = next((end for end in ("_r", "_z") if name.endswith(end)), "")
            single[f"{name.removesuffix(end)} {number}{end}"] = value.assign_attrs(long_name=words)
    return case.drop_dims(dim).assign(single)


def _fields(case: xr.Dataset) -> list[str]:
    if not np.isfinite(float(case["stress_error"])):
        return ["The contact has no solution."]
    lines = [f"Stresses at {case.sizes['r']} radii and {case.sizes['z']} depths."]
    for name in ("mises", "s1", "s3"):
        values = case[name].transpose("z", "r").values
        if not np.isnan(values).all():
            place = np.unravel_index((np.nanargmin if name == "s3" else np.nanargmax)(values), values.shape)
            where = _place(float(case["r"][place[1]]), float(case["z"][place[0]]))
            which = "minimum" if name == "s3" else "maximum"
            lines.append(
                f"{case[name].attrs['long_name']}, {which}: {_stress(case, name, float(values[place]))}, {where}."
            )
    return [*lines, f"The error of any stress is at most {float(case['stress_error']):.1g} of the largest stress."]


def _stress(case: xr.Dataset, name: str, value: float) -> str:
    """A stress with its unit, or over E2* (E1* on a rigid body)."""
    text = in_its_unit(case, name, float(f"{value:.4g}"))
    scale = case[name].attrs.get("scale", "")
    return text.replace(scale, "E1*" if is_rigid(case, "base") else "E2*") if scale else text


def _number(case: xr.Dataset, name: str) -> str:
    return in_its_unit(case, name, float(f"{float(case[name]):.4g}"), spread_of(case, name))


def _place(r: float, z: float) -> str:
    """A place in words; r and z in a."""
    across = "on the axis" if abs(r) < 1e-3 else f"at r = {r:.3g} a"
    return f"{across}, at the surface" if z == 0 else f"{across}, {z:.3g} a deep"


#: Extreme of the interfaces, or of the lower sides of layers -> words for the largest value and its place.
_LARGEST = {
    "tau_interface": "largest shear stress of an interface is {} (interface {})",
    "sz_interface_max": "largest tension across an interface is {} (interface {})",
    "sr_interface": "largest tension at the lower side of a layer is {} (layer {})",
}


def in_stacks(problem: Problem, solution: Any, names: list[str]) -> dict[str, np.ndarray]:
    """Extremes of stacks by name -> (3, B): the value in the unit of E2, r and z in a.

    A name has the number of a layer, "mises_layer 2", or 0 for none, "mises2 0".
    """
    wanted = [name for name in names if " " in name and name.split()[0] in EXTREMES]
    if not wanted:
        return {}
    values = of_contacts(problem, solution, names=tuple(dict.fromkeys(name.split()[0] for name in wanted)))
    extremes = {}
    for name in wanted:
        key, number = name.split()
        extremes[name] = values[key][..., int(number) - 1] if DIMENSION[EXTREMES[key][1]] else values[key]
    return extremes


def strengths_of_layer(case: xr.Dataset, number: int, unit: float) -> list[tuple]:
    """Strengths of a layer's material other than its yield strength, and of the interface below it.

    unit : of the strengths, Pa

    Each is (who, stress, words for it, verb, words for the strength, strength, its spread, False: not from hardness).
    """
    name, strengths = name_in_stack(number, "material"), []
    try:
        material = materials.get(str(case[name].values)) if name in case else None
    except LookupError:  # a material of the user's file
        material = None
    for who, stress, what, of in (
        (f"layer {number}", "s1_layer", "largest tension", "fracture"),
        (f"interface {number}", "tau_interface", "largest shear stress", "interface"),
    ):
        if strength := getattr(material, f"{of}_strength", None):
            verb, words = ("crack", "fracture strength") if of == "fracture" else ("fail", "strength")
            spread = getattr(material, f"{of}_strength_spread")
            strengths.append((who, f"{stress} {number}", what, verb, words, strength / unit, spread / unit, False))
    return strengths


def of_interfaces(contact: Contacts, problem: Problem, solution: Any) -> list[str]:
    """A sentence on the interface and the lower side under the largest stress, for a contact on a stack of layers."""
    if not is_stack(problem.base[0]):
        return []
    values, parts = of_contacts(problem, solution, names=tuple(_LARGEST)), []
    for name, words in _LARGEST.items():
        of_each = values[name][0, 0]
        if len(of_each) > 1 and np.nanmax(of_each) > 0:
            number = int(np.nanargmax(of_each))
            parts.append(words.format(_in_pascal(contact, of_each[number]), number + 1))
    return [f"The {', the '.join(parts)}."] if parts else []


def which_yields(dataset: xr.Dataset) -> str:
    """Whether the layer or the body yields, in the contacts in which one of them does."""
    flags = dataset["validity"].values.ravel() & 512
    if (contacts := Contacts.in_words(dataset)) is None:
        return ""
    some, limits = np.flatnonzero(flags), strengths(contacts, {})
    if layers := layer_strengths(contacts, {}):
        return which_of_stacks(contacts, some, layers, limits["body"])
    if not any(np.isfinite(limits[body]).any() for body in ("layer", "body")) or contacts.without_stresses():
        return ""
    problem = contacts.problem.take(some)
    stress, parts = yields.of_contacts(problem, solve(problem), names=("mises1", "mises2")), []
    for body, name in (("layer", "mises1"), ("body", "mises2")):
        count = int((stress[name][0] > limits[body][some]).sum())
        parts += [f"the {body} yields in {count} of them" if len(flags) > 1 else f"the {body} yields"] * bool(count)
    return f"{_capital(', '.join(parts))}." if parts else ""


def which_of_stacks(contacts: Contacts, some: np.ndarray, layers: list, body: np.ndarray) -> str:
    """A sentence on the layer of stacks, or the body, that yields in `some` contacts.

    layers : strengths of the layers, by :func:`~..data.body_strengths.layer_strengths`
    body : strength of the body, (B,)
    """
    problem = contacts.problem.take(some)
    stresses = in_stacks(
        problem, solve(problem), [f"mises_layer {j}" for j in range(1, len(layers) + 1)] + ["mises2 0"]
    )
    strength = [*(value[some] for value, *_ in layers), body[some]]
    names, parts = [f"layer {j}" for j in range(1, len(layers) + 1)] + ["the body"], []
    for name, (stress, _, _), limit in zip(names, stresses.values(), strength, strict=True):
        count = int((stress > limit).sum())
        where = f" in {count} of them" * (contacts.problem.shape.size > 1)
        parts += [f"{name} yields{where}"] * bool(count)
    return f"{_capital(', '.join(parts))}." if parts else ""


def _in_pascal(contact: Contacts, value: float) -> str:
    if not contact.scene:
        return f"{value:.2g} E2*"
    return readable(float(f"{value * contact.units[0].item():.2g}"), "Pa")


def at_asperities(problem: Problem) -> tuple[np.ndarray, np.ndarray]:
    """The modulus below the asperities, in series with the punch, and the Poisson ratio below them."""
    bare = is_bare(problem.base)
    E = np.where(bare, 1.0, layer_modulus(problem.n)) / (1 + problem.m)
    return E * problem.E2, np.where(bare, problem.nu2, problem.nu1)


def below_spots(problem: Problem, solution: Any) -> np.ndarray:
    """(3, 1): the stress below a spot, and its place. A law without a radius has the stress of a sphere under the same
    pressure, on the surface. On a half-space it is at most that of one asperity that bears the whole load."""
    stress, E, nu = spots.of_contacts(problem, solution), *at_asperities(problem)
    below = stress_below_one(solution.P, E, problem.Ra, nu)
    if np.isnan(stress[0, 0]):
        largest = np.fmax(solution.p_max[0], solution.p_spot[0])
        stress[:, 0] = (largest - solution.p0[0]) / yield_pressure(nu)[0], 0.0, 0.0
    elif below[0] < stress[0, 0] and not problem.feels_layer()[0]:
        b = np.cbrt(3 * solution.P[0] * problem.Ra[0] / (4 * E[0]))
        stress[:, 0] = below[0], 0.0, _DEEP * b / solution.a[0]
    return stress


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]
