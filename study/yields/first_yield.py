"""The load at which a body or its asperities first yield."""

import re
from typing import Any

import numpy as np
import xarray as xr

from solver.bases import is_bare
from solver.layers import numbers_of
from solver.shapes import ROUND
from solver.yields.crossing import NUMBERS, Crossing
from solver.yields.first import first_yield as crossing_of
from solver.yields.reach import STEEPEST

from ..data.body_strengths import layer_strengths, strengths
from ..data.contacts import Contacts
from ..fields import friction, numbered, refuse_both, residual_stresses, with_coordinates_of, with_numbered_layers
from ..inputs.vocabulary import CONTROLS, name_in_stack
from ..rules.rule import validity_attributes
from .model_validity import sentences_on, validity_at
from .yielding_contacts import control_of, materials_in, of_dataset, of_inputs, refuse, without_control

BODIES = {"layer": "_Y1", "body": "_Y2", "asperities": "_Ya", "punch": "_Y_punch"}
"""Part that may yield, in the order of the codes of `first_yield` -> the ending of the names of its numbers."""
OUTCOMES = ("first_crossing", "none_up_to_0.2_R", "strength_not_known")
"""Meanings of the values of found_Y1 and so on; for shapes other than balls the second has another name."""
_NO_ASPERITIES = "no_asperities"  # the value 3 of found_Ya
_FOUND_OF_SHAPES = (OUTCOMES[0], f"none_up_to_a_slope_of_{STEEPEST}", OUTCOMES[2])
_LONG_NAMES = {"P": "load", "a": "contact radius", "D": "indentation depth", "p0": "nominal pressure in the centre"}
_POWERS = {"P": (1, 2), "a": (0, 1), "D": (0, 1), "p0": (1, 0)}
_SHARP = "0: below a sharp tip or corner the stress is infinite, so that it yields under any load"
_UNITS = {(1, 2): ("N", "E2* R^2"), (0, 1): ("m", "R"), (1, 0): ("Pa", "E2*")}


def first_yield(
    contact: xr.Dataset | None = None,
    *,
    Y1: Any = None,
    Y2: Any = None,
    hardness: Any = None,
    yield_strength: Any = None,
    Y_punch: Any = None,
    mu: float = 0.0,
    sigma_res: float | str = 0.0,
    **parameters: Any,
) -> xr.Dataset:
    """The load at which layer, body, asperities and punch first yield, by von Mises: docs/stresses.md.

    The largest stress need not grow with the load: the answer is the first load at which it exceeds the strength, up to
    a = 0.2 R, or under shapes other than balls up to a slope of 0.4 at the edge. Under a sharp tip or corner the bodies
    yield at any load: P_Y1 is 0. Strengths that are not given come from the named materials, whose hardness is 2.84
    yield strengths.

    Parameters
    ----------
    contact : contacts of `study.solve` or of a results file, in place of the parameters. Their loads do not matter
    Y1, Y2, Y_punch : yield strengths of layer, body and punch, > 0
    hardness, yield_strength : of the softer of the asperity and the surface under it, > 0; one of the two is enough
    mu : >= 0; with mu > 0 the punch slides in full
    sigma_res : residual biaxial stress of the layer, tension positive; "-2 GPa" where there are units. For stacks that
        of all layers, or a list with one for each
    parameters : the strengths of the layers of stacks, layers.2.Y and so on; without a contact also those of
        `study.solve`, except P, a and D

    Returns
    -------
    xarray.Dataset : over the dimensions of the parameters: P_Y1, a_Y1, D_Y1, p0_Y1, the contact at which the layer
        first yields, and r_Y1, z_Y1, the place in units of a (with mu > 0 r is x, < 0 behind the contact). The same for
        the body with Y2, for the asperities with Ya, and for an elastic punch, a half-space under the same pressure,
        with Y_punch. found_Y1 and so on: 0, the load is the first crossing; 1, there is none up to a = 0.2 R, or up to
        that slope; 2, the strength is not known; 3, only for found_Ya, the punch is smooth. Where it is not 0 the
        numbers are NaN, and P_Y1 has a `message`. validity_Y1 and so on: `validity` of the contact at that load, 0
        without a load; P_Y1 has a `comment` with it in words. P_Y1_spread and so on, for a strength with a spread: the
        spread that follows from it alone. `first_yield`: the part that yields first, among those that are known. For
        stacks P_Y_layer, a_Y_layer and so on over `layer`, counted from 1 at the surface, in place of P_Y1, and
        `first_layer`, the layer that yields first

    Raises
    ------
    StudyError : input that cannot be used, such as P, a or D, which are to be determined

    Examples
    --------
    >>> import study
    >>> found = study.first_yield(Y2=0.005, base="half_space", nu2=0.3, micro="smooth")
    >>> round(found.p0_Y2.item() / 0.005, 6)
    1.612797
    """
    mu = friction(mu)
    strengths_of_call = {"Y1": Y1, "Y2": Y2, "Y_punch": Y_punch, "hardness": hardness, "yield_strength": yield_strength}
    strengths_of_call = {name: value for name, value in strengths_of_call.items() if value is not None}
    if contact is not None:
        strengths_of_call |= {name: parameters.pop(name) for name in [*parameters] if _OF_A_LAYER.fullmatch(name)}
        refuse_both("first_yield", contact, parameters)
        contacts = of_dataset("first_yield", contact, strengths_of_call, CONTROLS)
        name = control_of(contacts.dataset)
    else:
        refuse("first_yield", parameters, (*CONTROLS, "cases"), "it is what is looked for")
        name = "P" if "flat_radius" in parameters else "a"  # a flat end does not allow any value of a
        contacts = of_inputs("first_yield", parameters | strengths_of_call, name, 1e-3)
    stress, _ = contacts.units
    materials, problem = materials_in(parameters), contacts.problem
    values, spreads = (strengths(contacts, materials, spread) for spread in (False, True))
    residual = residual_stresses(sigma_res, contacts)
    nu_punch = contacts.coordinate("nu_punch", 0.3)
    variables, loads = {}, []
    if stacked := numbers_of(problem.parameters) > 0:
        layers, named = layer_strengths(contacts, materials), with_numbered_layers(contacts)
        of_layers, in_layers = _of_layers(contacts, layers, mu, residual)
        contacts = named
        variables |= {
            key: xr.Variable((*named.dims, *value.dims[len(named.dims) :]), value.values, value.attrs)
            for key, value in of_layers.items()
        }
        loads.append(in_layers.min(axis=1))
        first_layer = np.where(np.isfinite(in_layers).any(axis=1), 1 + in_layers.argmin(axis=1), 0).astype(np.int8)
        variables["first_layer"] = labelled(contacts, first_layer, {"long_name": _FIRST_LAYER})
    for body, end in BODIES.items():
        if stacked and body == "layer":
            continue
        strength = np.where(_is_elastic(problem, body), values[body], np.nan)
        if np.isfinite(strength).any():
            crossing = crossing_of(problem, body, strength, mu, residual, nu_punch, bool(np.any(spreads[body] > 0)))
        else:
            crossing = Crossing.none(len(problem))
        outcome = np.where(crossing.crossed, 0, np.where(np.isnan(values[body]), 2, 1))
        outcome = np.where((body == "asperities") & ~_is_elastic(problem, "asperities"), 3, outcome).astype(np.int8)
        loads.append(np.where(crossing.crossed, crossing.numbers["P"], np.inf))
        variables |= _variables(contacts, body, end, crossing, outcome)
        if np.any(spreads[body] > 0):
            variables |= _spreads(contacts, body, end, crossing, spreads[body] / values[body])
    loads = np.array(loads)
    first = np.where(np.isfinite(loads).any(axis=0), 1 + loads.argmin(axis=0), 0).astype(np.int8)
    about = _flags("what yields first", ("not_known", *BODIES))
    variables["first_yield"] = labelled(contacts, first, about)
    answer = without_control(with_coordinates_of(contacts.dataset, variables), name)
    return answer.assign_coords(numbered(contacts, "layer")) if stacked else answer


#: The name of a strength of a layer.
_OF_A_LAYER = re.compile(r"layers\.\d+\.Y")
_FIRST_LAYER = "layer that yields first among the layers, counted from 1 at the surface; 0: none is known to"


def _of_layers(contacts: Contacts, layers: list, mu: float, residual: np.ndarray) -> tuple[dict, np.ndarray]:
    """The variables of the layers of stacks over `layer`, and their loads (B, N), inf where there is none.

    A stack of one layer also has the variables of a single layer.
    """
    problem, columns, loads = contacts.problem, [], []
    for j, (strength, spread, _) in enumerate(layers):
        strength = np.where(is_bare(problem.base), np.nan, strength)
        crossing = Crossing.none(len(problem))
        if np.isfinite(strength).any():
            slopes = bool(np.any(spread > 0))
            crossing = crossing_of(problem, "layer", strength, mu, residual, slopes=slopes, layer=j)
        outcome = np.where(crossing.crossed, 0, np.where(np.isnan(strength), 2, 1)).astype(np.int8)
        loads.append(np.where(crossing.crossed, crossing.numbers["P"], np.inf))
        columns_of_layer = _variables(contacts, f"layer {j + 1}", "_Y_layer", crossing, outcome)
        if any(np.any(spread > 0) for _, spread, _ in layers):
            columns_of_layer |= _spreads(
                contacts, f"layer {j + 1}", "_Y_layer", crossing, np.nan_to_num(spread / strength)
            )
        columns.append(columns_of_layer)
    variables = {name: _over_layers([columns_of_layer[name] for columns_of_layer in columns]) for name in columns[0]}
    if len(layers) == 1:
        variables |= {name.replace("_Y_layer", "_Y1"): value for name, value in columns[0].items()}
    return variables, np.stack(loads, axis=1)


def _over_layers(columns: list) -> xr.Variable:
    """One variable over `layer`, with the messages and comments on each of its values."""
    about = {**columns[0].attrs, "long_name": columns[0].attrs["long_name"].replace("layer 1", "layer")}
    for name in ("message", "comment"):
        texts = [f"layer {j}: {column.attrs[name]}" for j, column in enumerate(columns, 1) if name in column.attrs]
        about |= {name: "; ".join(texts)} if texts else {}
    return xr.Variable((*columns[0].dims, "layer"), np.stack([column.values for column in columns], axis=-1), about)


def _is_elastic(problem: Any, body: str) -> np.ndarray:
    """Which cases have such a body, and the body is elastic."""
    bare = is_bare(problem.base)
    rough = np.isfinite(problem.Nbar) & (problem.micro != "smooth")
    return {"layer": ~bare, "body": bare | (problem.n > 0), "asperities": rough, "punch": problem.m > 0}[body]


def _variables(contacts: Contacts, body: str, end: str, crossing: Crossing, outcome: np.ndarray) -> dict:
    where, variables = f"at which the {body} first yield{'' if body == 'asperities' else 's'}", {}
    stress, size = contacts.units
    for name in NUMBERS:
        i, j = _POWERS[name]
        about = about_of(contacts, f"{_LONG_NAMES[name]} {where}", (i, j))
        variables[f"{name}{end}"] = labelled(contacts, crossing.numbers[name] * stress**i * size**j, about)
    variables[f"r{end}"] = labelled(contacts, crossing.r, {"long_name": f"radius of the place {where}, over a"})
    variables[f"z{end}"] = labelled(contacts, crossing.z, {"long_name": f"depth of the place {where}, over a"})
    round_ = np.isin(contacts.problem.shape, ROUND)
    words = (OUTCOMES if round_.all() else _FOUND_OF_SHAPES) + (_NO_ASPERITIES,) * (body == "asperities")
    variables[f"found{end}"] = labelled(contacts, outcome, _flags(f"whether the load {where} was found", words))
    if outcome.any():
        variables[f"P{end}"].attrs["message"] = _message(body, outcome, crossing.unsolved, round_.all())
    flags = validity_at(contacts, crossing)
    variables[f"validity{end}"] = labelled(contacts, flags, _about_validity(body))
    sharp = bool(((outcome == 0) & (crossing.numbers["P"] == 0) & ~round_).any())
    if comment := ". ".join(text for text in (_SHARP * sharp, sentences_on(flags)) if text):
        variables[f"P{end}"].attrs["comment"] = comment
    return variables


def _spreads(contacts: Contacts, body: str, end: str, crossing: Crossing, relative: np.ndarray) -> dict:
    """P_Y1_spread and so on: the spreads that follow from the spread of the strength alone."""
    variables, (stress, size) = {}, contacts.units
    for name in NUMBERS:
        i, j = _POWERS[name]
        spread = np.abs(crossing.by_strength[name]) * crossing.numbers[name] * relative * stress**i * size**j
        words = f"standard deviation of {name}{end}, from the spread of the strength of the {body} alone"
        variables[f"{name}{end}_spread"] = labelled(contacts, spread, about_of(contacts, words, (i, j)))
    return variables


def _message(body: str, outcome: np.ndarray, unsolved: np.ndarray, round_: bool) -> str:
    """The reasons why there is no load, with the number of cases of each."""
    farthest = "a = 0.2 R" if round_ else f"a slope of the shape of {STEEPEST}, or a = 0.2 R of balls"
    need = {"layer": "Y1", "body": "Y2", "punch": "Y_punch", "asperities": "hardness or yield_strength"}
    need = need.get(body) or name_in_stack(int(body.removeprefix("layer ")), "Y")
    reasons = {
        f"the strength of the {body} is not known: give {need}": outcome == 2,
        "the punch is smooth and has no asperities": outcome == 3,
        "contacts on the way have no solution, or it yields already at the smallest load examined": (outcome == 1)
        & unsolved,
        f"the {body} does not yield up to {farthest}, or is rigid or absent": (outcome == 1) & ~unsolved,
    }
    parts = [f"{where.sum()} of {where.size} cases: {reason}" for reason, where in reasons.items() if where.any()]
    return "; ".join(parts)


def _about_validity(body: str) -> dict[str, Any]:
    return {
        "long_name": f"assumptions that the contact at the first yield of the {body} violates"
    } | validity_attributes()


def _flags(long_name: str, words: tuple) -> dict[str, Any]:
    return {
        "long_name": long_name,
        "flag_values": np.arange(len(words), dtype=np.int8),
        "flag_meanings": " ".join(words),
    }


def about_of(contacts: Contacts, long_name: str, powers: tuple[int, int]) -> dict[str, str]:
    unit, scale = _UNITS[powers]
    return {"long_name": long_name} | ({"units": unit} if contacts.scene else {"scale": scale})


def labelled(contacts: Contacts, values: np.ndarray, about: dict) -> xr.Variable:
    return xr.Variable(contacts.dims, values.reshape(contacts.shape), about)
