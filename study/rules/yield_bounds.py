"""Bounds of the largest von Mises stresses in closed form: where they decide, no stress is searched for.

All is in units of E2*, over the dimensions of the cases. A bound that is not known is 0 or infinite. The constants were
chosen with 800 random contacts, n 1e-3 to 1e3, h/a 0.01 to 100, Poisson ratios 0 to 0.5, smooth and rough, of both
interfaces; tests/rules/test_yield_bounds.py has others.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from solver.bases import is_stack
from solver.closed_forms import yield_pressure
from solver.layers import full_name, numbers_of
from solver.shapes import PARABOLOID

from ..inputs.lexicon import PACKAGE

#: On a bare body the stress under asperities is p(0)/q, of a smooth ball, times a factor between these (0.91 to 1.00
#: were seen).
_BARE = 0.8, 1.15
#: In a layer it is at most _LAYER max(n, 1)^(2/3) times the pressure (1.23 was seen): a hard one bends like a plate.
_LAYER = 1.5
#: In the body below a layer it is at most _BODY times the pressure (1.00), and times P/h² (0.91).
_BODY = 1.25
#: At least this part of the pressure: in a layer thicker than a (0.39 was seen); in a thinner soft one this times
#: (1 - 2 nu)/(1 - nu), its stress where it cannot give way sideways (0.59); in a hard one times 1 - 2 nu (0.6).
_THICK, _SOFT, _HARD = 0.3, 0.5, 0.4
#: In a layer of a stack, and in the body below it, it is at most _STACK times the pressure, times the largest over the
#: smallest modulus to the power 2/3.
_STACK = 1.5
#: Below asperities that feel the layer, of the cell alone, over the largest pressure of the spot: below spots narrower
#: than _WIDE h the stress is between these (0.40 and 0.82 of 1,400 cells were seen), below others at most
#: _LAYER max(n, 1)^(2/3) times this pressure (1.15).
_WIDE, _OF_SPOT = 0.6, (0.35, 0.95)
#: Largest pressure of a hard layer, in a ring, over that of the centre (2.6 over the larger of p(0) and the mean).
_RING = 4.0


class Bounds(NamedTuple):
    """The stress is between `low` and `high`."""

    low: np.ndarray
    high: np.ndarray


@np.errstate(all="ignore")  # of cases without numbers
def of_bodies(v) -> dict[str, Bounds]:
    """Of the layer, "mises1", and the body, "mises2"; v : `numbers` of a dataset, as rules have it."""
    layered, rough, nu1, nu2 = v["layered"], v["rough"], _value(v, "nu1"), _value(v, "nu2")
    known, none = _known(v), Bounds(0.0, np.inf)
    mean = v["P"] / (np.pi * v["a"] ** 2)
    pressure, made = np.fmax(v["p0"], mean), {"mises1": none, "mises2": none}
    if np.any(layered):
        n, h = v["n"], v["h"]
        least = np.where(n <= 1, _SOFT * (1 - 2 * nu1) / (1 - nu1), _HARD * (1 - 2 * nu1))
        least = np.where(h > v["a"], np.maximum(least, _THICK), least)
        layer = Bounds(least * pressure, _LAYER * np.maximum(n, 1.0) ** (2 / 3) * pressure)
        below = Bounds(0.0, _BODY * np.minimum(pressure, v["P"] / h**2))
        coated = known & layered & (nu1 >= 0)
        made = {"mises1": _where(coated, layer), "mises2": _where(coated & (nu2 >= 0), below)}
    if not np.all(layered):
        ball = v["p0"] / yield_pressure(np.maximum(nu2, 0.0))
        low, high = (np.where(rough, factor, 1.0) * ball for factor in _BARE)
        alone = _where(known & ~layered & (nu2 >= 0), Bounds(low, high))
        made["mises2"] = Bounds(*(np.where(layered, *pair) for pair in zip(made["mises2"], alone, strict=True)))
    if np.any(stacked := is_stack(v["base"])):
        stack = of_stacks(v)
        made = {
            name: Bounds(*(np.where(stacked, *pair) for pair in zip(stack, own, strict=True)))
            for name, own in made.items()
        }
    return made


@np.errstate(all="ignore")
def of_stacks(v) -> Bounds:
    """Of each layer of stacks, and of the body below them."""
    numbers = range(1, numbers_of(v) + 1)
    names = [full_name(number, field) for number in numbers for field in ("n", "n_bottom")]
    moduli = [np.where(v["n"] == 0, np.nan, 1.0), *(np.asarray(v[name], dtype=float) for name in names if name in v)]
    moduli = [np.where(n == 0, 1.0, n) for n in moduli]  # of the first layer on a rigid base
    moduli = np.stack(np.broadcast_arrays(*moduli))
    contrast = np.nanmax(moduli, axis=0) / np.nanmin(moduli, axis=0)
    pressure = np.fmax(v["p0"], v["P"] / (np.pi * v["a"] ** 2))
    profiles = [v[full_name(number, "profile")] for number in numbers if full_name(number, "profile") in v]
    tabled = np.any([np.char.startswith(np.asarray(words, dtype=str), "table") for words in profiles], axis=0)
    ball = v["shape"] == PARABOLOID if "shape" in v else True
    free = ~(v["w_adhesion"] > 0) if "w_adhesion" in v else True
    high = np.where(ball & free & ~tabled, _STACK * contrast ** (2 / 3) * pressure, np.inf)
    return Bounds(0.0 * high, np.where(np.isnan(high), np.inf, high))


@np.errstate(all="ignore")
def of_asperities(v) -> Bounds:
    """Of the axis of the central spot: that of the spot alone, give or take those of the nominal pressure."""
    layered, p0, p_max, nu, whole = v["layered"], v["p0"], v["p_max"], _nu(v), of_bodies(v)
    pressure = np.fmax(p0, v["P"] / (np.pi * v["a"] ** 2))
    disc = (0.5 - nu) + 2 / 3 * (1 + nu) * np.sqrt((1 + nu) / 4.5)  # of a uniform pressure, on its axis
    further = np.where(layered, whole["mises1"].high, whole["mises2"].high) + 2 * disc * pressure
    low = (p_max - p0) / yield_pressure(nu) - further
    high = disc * p_max * np.where(layered & (v["n"] > 1), _RING, 1.0) + further
    high = np.where(2 * p0 < pressure, np.inf, high)  # of a ring the centre says little
    small = ~layered | (v["b"] < v["h"])  # else the spot is deeper than the layer
    bounds, alone = _where(_known(v) & small & (nu >= 0), Bounds(low, high)), one_asperity(v)
    bounds = Bounds(np.fmin(bounds.low, alone), np.fmin(bounds.high, alone))
    return _on_body(v, bounds, whole["mises1"].high) if "p_spot" in v else bounds


def _on_body(v, others: Bounds, further) -> Bounds:
    """Those of asperities that feel the layer, where p_spot is known; else those of `others`. further : of the nominal
    pressure"""
    p_spot, narrow = v["p_spot"], v["b"] < _WIDE * v["h"]
    low = np.where(narrow, _OF_SPOT[0] * p_spot, 0.0)
    high = np.where(narrow, _OF_SPOT[1], _LAYER * np.maximum(v["n"], 1.0) ** (2 / 3)) * p_spot
    known = _where(_known(v) & (_nu(v) >= 0), Bounds(low - further, high + further))
    felt = np.isfinite(p_spot)
    return Bounds(*(np.where(felt, *pair) for pair in zip(known, others, strict=True)))


def one_asperity(v) -> np.ndarray:
    """The stress below an asperity that bears the whole load: none bears more; NaN without its radius Ra, and of
    asperities that feel the layer, which bends below them."""
    E = np.where(v["layered"], v["E1*"], 1.0) / (1 + v["m"])  # of asperities and of what they touch in series
    alone = stress_below_one(v["P"], E, v.get("Ra", np.nan), _nu(v))
    return np.where(np.isfinite(v["p_spot"]), np.nan, alone) if "p_spot" in v else alone


@np.errstate(all="ignore")
def stress_below_one(P, E, Ra, nu):
    """Largest von Mises stress below a sphere of radius Ra under the load P: Hertz's p(0) over q; NaN where P < 0."""
    return np.where(P >= 0, np.cbrt(6 * P * E**2 / (np.pi**3 * Ra**2)), np.nan) / yield_pressure(nu)


@np.errstate(all="ignore")
def spot_alone(v) -> np.ndarray:
    """The stress below the central spot as of a sphere: its largest pressure, less the nominal one, over q."""
    return (np.fmax(v["p_max"], v.get("p_spot", np.nan)) - v["p0"]) / yield_pressure(_nu(v))


def _nu(v) -> np.ndarray:
    return np.where(v["layered"], _value(v, "nu1"), _value(v, "nu2"))


def _value(v, name):
    return v[name] if name in v else PACKAGE.parameter(name).default


def _known(v) -> np.ndarray:
    """Where bounds are known: balls that do not stick, not on stacks."""
    ball = v["shape"] == PARABOLOID if "shape" in v else True
    free = ~(v["w_adhesion"] > 0) if "w_adhesion" in v else True
    return ball & free & ~is_stack(v["base"])


def _where(known, bounds: Bounds) -> Bounds:
    low, high = (np.where(known, *pair) for pair in ((bounds.low, 0.0), (bounds.high, np.inf)))
    return Bounds(np.nan_to_num(low, nan=0.0), np.where(np.isnan(high), np.inf, high))
