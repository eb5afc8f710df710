"""Rules that compare the stresses of a contact with the strengths of its bodies and asperities."""

from functools import partial

import numpy as np

from solver import Status, solve
from solver.laws.elastic_plastic import TABOR
from solver.layers import full_name, numbers_of
from solver.models.spot_pressure import lifts_off
from solver.parameters import one_of
from solver.yields import spots
from solver.yields.stacked.largest import mises_in

from ..inputs.lexicon import lexicon_of
from ..inputs.vocabulary import CONTROLS, NUMERICS
from . import yield_bounds
from .rule import WORDS, have, rule

_BODIES = {"Y1": "mises1", "Y2": "mises2"}
#: The coarse grid underestimates a stress by at most this share, and overestimates it by at most _MORE. If the limit is
#: between these bounds, the stress is computed.
_MISSED, _MORE = 0.15, 1e-3
OF_MATERIAL, FROM_HARDNESS = "_of_material", "_from_hardness"
"""Endings of Y1, Y2 and Y_punch: the strength of the named material, and whether it is the hardness over 2.84."""
_OF_ASPERITIES = {"yield_strength", "hardness", *(f"{name}{OF_MATERIAL}" for name in ("Y1", "Y2", "Y_punch"))}
_SOURCES = ("call", "material", "hardness")


@rule(512, "a body would yield", "0.63")
def body_yields(v, times):
    """A body would yield: the von Mises stress in it exceeds its yield strength. The results are those of bodies that
    stay elastic."""
    limits = {name: _limit(v, times * of_body(v, name)[0]) for name in _BODIES if {*v} & {name, f"{name}{OF_MATERIAL}"}}
    limits = {_BODIES[name]: limit for name, limit in limits.items() if np.isfinite(limit).any()}
    unknown = [extreme for extreme in limits if _stored(v, extreme) is None]
    bounds = yield_bounds.of_bodies(v) if unknown else {}
    yields = np.False_
    for extreme, limit in limits.items():
        if (stored := _stored(v, extreme)) is not None:
            yields = yields | (stored > limit)
            continue
        low, high = bounds[extreme]
        body = "layer" if extreme == "mises1" else "body"
        yields = yields | _exceeded(limit, low, high, lambda index, limit, body=body: _stress(v, body, 0, index, limit))
    for layer in range(1, numbers_of(v)):
        limit = _limit(v, times * of_body(v, full_name(layer + 1, "Y"))[0])
        if (stored := v.get(f"mises_layer {layer + 1}")) is not None:
            yields = yields | (stored > limit)
        elif np.isfinite(limit).any():
            low, high = yield_bounds.of_stacks(v)
            yields = yields | _exceeded(limit, low, high, partial(_stress, v, "layer", layer))
    return yields


def _stored(v, extreme):
    """The largest stress of the layer, of stacks the first, or of the body, of results that have it; None of others."""
    return v.get("mises_layer 1" if extreme == "mises1" and numbers_of(v) else extreme)


@rule(1024, "asperities would yield", "0.65")
def asperities_yield(v, times):
    """The asperities would yield: below a spot the stress exceeds the yield strength. The real area is then larger than
    this one, and pmax smaller (micro = "elastic_plastic")."""
    limit = _limit(v, times * of_asperities(v)[0])
    if not np.isfinite(limit).any():
        return np.False_
    return _exceeded(limit, *yield_bounds.of_asperities(v), lambda index, _: _stress_of_spots(v, index))


@rule(16384, "spots lift off", "0.59")
def spot_lifts_off(v, times):
    """The pressure in the middle of a spot turns negative: the layer, far harder than the body, lifts off there, and
    what touches is a ring, which the law of the asperities leaves out."""
    lifted = np.zeros(v["status"].shape, dtype=bool)
    index = np.flatnonzero(np.isfinite(v["p_spot"])) if "p_spot" in v else ()
    if len(index):
        lifted.flat[index] = lifts_off(problem_of(v, index), np.broadcast_to(v["lam0"], lifted.shape).flat[index])
    return lifted


def of_body(v, name):
    """Yield strength of a body in E2*, NaN where it is not known, and its source, an index of `_SOURCES`.

    v : `numbers` of a dataset, with the strengths of named materials
    name : of the input, "Y1" for the layer and so on
    """
    value, source = first([v.get(name, np.nan), 0], _of_material(v, name))
    return np.where(True if name == "Y2" else v["layered"], value, np.nan), source


def of_asperities(v):
    """Yield strength of elastic asperities in E2*, and its source: from the call, or of the softer surface."""
    if not {*v} & _OF_ASPERITIES:
        return np.array(np.nan), np.array(0)
    yielding = [name for name, law in v["known"].laws.items() if law.yielded]
    elastic = have("rough", v["micro"], v["known"]) & ~one_of(v["micro"], yielding)
    named = [_of_material(v, name) for name in ("Y1", "Y2", "Y_punch")]
    call = first([v.get("yield_strength", np.nan), 0], [v.get("hardness", np.nan) / TABOR, 0])
    # if one strength is not known, the other serves: a stress that exceeds it exceeds the lower of both
    named[2] = first(named[2], [np.where(v["m"] > 0, np.inf, np.nan), 0])
    named[:2] = [first(strength, [np.inf, 0]) for strength in named[:2]]
    value, source = first(call, softer(*named, ~v["layered"], v["m"] > 0))
    value = np.where(np.isinf(value), np.nan, value)
    return np.where(elastic, value, np.nan), source


def softer(layer, body, punch, bare, elastic_punch):
    """The softer of two surfaces: the layer or a bare body, and an elastic punch; NaN where one strength is not known.

    Each argument, and the result, is a sequence of the strength and of values that belong to it.
    """
    touched = [np.where(bare, *pair) for pair in zip(body, layer, strict=True)]
    by_punch = elastic_punch & ((punch[0] < touched[0]) | np.isnan(punch[0]))
    return [np.where(by_punch, *pair) for pair in zip(punch, touched, strict=True)]


def first(values, fallback):
    """A strength and the values that belong to it, or the fallback where the strength is NaN."""
    return [np.where(np.isnan(values[0]), other, part) for part, other in zip(values, fallback, strict=True)]


def strength_from(v) -> str:
    """The source of the strengths in the masks: "call", "material" or "hardness" (of a material without a known yield
    strength); "layer: call, asperities: hardness" where the sources differ, "" without strengths."""
    words = {}
    of_layers = {full_name(number, "Y") for number in range(2, numbers_of(v) + 1)}
    if not {*v} & {*_BODIES, *_OF_ASPERITIES, *of_layers, *(f"{name}{OF_MATERIAL}" for name in of_layers)}:
        return ""
    strengths = {"layer": of_body(v, "Y1"), "body": of_body(v, "Y2"), "asperities": of_asperities(v)}
    for number in range(2, numbers_of(v) + 1):
        strengths[f"layer {number}"] = of_body(v, full_name(number, "Y"))
    for part, (value, source) in strengths.items():
        some = np.unique(np.broadcast_to(source, np.shape(value))[np.isfinite(value)])
        if len(some):
            words[part] = " and ".join(_SOURCES[i] for i in some.tolist())
    alike = {*words.values()}
    return alike.pop() if len(alike) == 1 else ", ".join(f"{part}: {word}" for part, word in words.items())


WORDS["strength_from"] = strength_from


def _of_material(v, name):
    """The strength of the material of a body and its source; NaN where it is not known."""
    return v.get(f"{name}{OF_MATERIAL}", np.nan), np.where(v.get(f"{name}{FROM_HARDNESS}", False), 2, 1)


def _limit(v, strength):
    """The strength for solved cases, NaN for others, over all cases."""
    return np.where(v["status"] == Status.CONVERGED, np.broadcast_to(strength, v["status"].shape), np.nan)


def _exceeded(limit, low, high, stress):
    """Whether the stress exceeds the limit, by its bounds; if the limit is between these, the stress is computed.

    stress : stress(index, limits) computes the stresses of the cases `index`; NaN: not known
    """
    finite = np.isfinite(limit)
    exceeded = np.array(finite & (low > limit))  # an array even for one case
    index = np.flatnonzero(finite & ~exceeded & ~(high <= limit))
    if len(index):
        exceeded.flat[index] = stress(index, limit.flat[index]) > limit.flat[index]
    return exceeded


def _stress(v, body, layer, index, limit):
    """The largest stress of the "body" or of a "layer", by a coarse grid, and precisely where that is near the limit.

    layer : number of the layer, from 0
    """
    problem, solution = solved(v, index)
    none = np.zeros((len(index), max(1, numbers_of(problem.parameters))))
    value = mises_in(problem, solution, body, layer, 0.0, none, coarse=True)[0]
    near = np.flatnonzero((value < (1 + _MORE) * limit) & (value > (1 - _MISSED) * limit))
    if len(near):
        value[near] = mises_in(problem.take(near), solution.take(near), body, layer, 0.0, none[near])[0]
    return value


def _stress_of_spots(v, index):
    """The stress on the axis of spots, or that of the spot alone where it is not computed, as for a user's law."""
    shape = v["status"].shape
    alone = np.broadcast_to(yield_bounds.spot_alone(v), shape).flat[index]
    least = np.broadcast_to(yield_bounds.one_asperity(v), shape).flat[index]
    problem, solution = solved(v, index)
    value = spots.of_contacts(problem, solution)[0]
    return np.fmin(np.where(np.isnan(value), alone, value), least)


def problem_of(v, index):
    """The problem of some of the cases, with their radii as the control."""
    shape = v["status"].shape
    lexicon = lexicon_of(v["known"])
    names = [name for name in lexicon.parameters_of(v) if name in v and name not in (*NUMERICS, *CONTROLS)]
    return lexicon.problem({name: np.broadcast_to(v[name], shape).ravel()[index] for name in ("a", *names)})


def solved(v, index, x=(0.0, 1.0)):
    """The problem of some of the cases, with their radii as the control, and its solution; profiles at the radii x."""
    problem = problem_of(v, index)
    solution, converged = solve(problem, x), v["status"].ravel()[index] == Status.CONVERGED
    solution.status[~converged] = Status.INVALID_INPUT
    return problem, solution
