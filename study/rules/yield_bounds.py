"""Bounds of the largest von Mises stresses in closed form: where they decide, no stress is computed.

Everything is in units of E2*, over the dimensions of the cases. An unknown bound is 0 or infinite. The constants were
chosen with 800 random contacts: n 1e-3 to 1e3, h/a 0.01 to 100, Poisson ratios 0 to 0.5, smooth and rough, with both
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

#: In a bare rough body the stress is that of a smooth ball, p(0)/q, times a factor between these (observed: 0.91 to
#: 1.00).
_BARE = 0.8, 1.15
#: In a layer the stress is at most _LAYER max(n, 1)^(2/3) times the pressure (observed: 1.23), since a hard layer bends
#: like a plate.
_LAYER = 1.5
#: In the body below a layer the stress is at most _BODY times the pressure (observed: 1.00), and times P/h² (0.91).
_BODY = 1.25
#: The stress is at least this share of the pressure in a layer thicker than a (observed: 0.39). In a thinner soft
#: layer, which cannot give way sideways, it is at least _SOFT (1 - 2 nu)/(1 - nu) of it (0.59), in a thinner hard one
#: _HARD (1 - 2 nu) of it (0.6).
_THICK, _SOFT, _HARD = 0.3, 0.5, 0.4
#: In a layer of a stack, and in the body below it, the stress is at most _STACK times the pressure, times the ratio of
#: the largest modulus to the smallest to the power 2/3.
_STACK = 1.5
#: Stress of the cell alone, below asperities that feel the layer, over the largest pressure in the spot. Below spots
#: narrower than _WIDE h it is between these (observed in 1,400 cells: 0.40 and 0.82), below others at most
#: _LAYER max(n, 1)^(2/3) (1.15).
_WIDE, _OF_SPOT = 0.6, (0.35, 0.95)
#: Largest pressure on a hard layer, in a ring, over that in the centre (observed: 2.6 over the larger of p(0) and the
#: mean).
_RING = 4.0


class Bounds(NamedTuple):
    """The stress is between `low` and `high`."""

    low: np.ndarray
    high: np.ndarray


@np.errstate(all="ignore")  # for cases without numbers
def of_bodies(v) -> dict[str, Bounds]:
    """Bounds of the stress in the layer, "mises1", and in the body, "mises2".

    v : `numbers` of a dataset, as for rules
    """
    layered, rough, nu1, nu2 = v["layered"], v["rough"], _value(v, "nu1"), _value(v, "nu2")
    has_bounds, none = _has_bounds(v), Bounds(0.0, np.inf)
    mean = v["P"] / (np.pi * v["a"] ** 2)
    pressure, bounds = np.fmax(v["p0"], mean), {"mises1": none, "mises2": none}
    if np.any(layered):
        n, h = v["n"], v["h"]
        least = np.where(n <= 1, _SOFT * (1 - 2 * nu1) / (1 - nu1), _HARD * (1 - 2 * nu1))
        least = np.where(h > v["a"], np.maximum(least, _THICK), least)
        layer = Bounds(least * pressure, _LAYER * np.maximum(n, 1.0) ** (2 / 3) * pressure)
        below = Bounds(0.0, _BODY * np.minimum(pressure, v["P"] / h**2))
        coated = has_bounds & layered & (nu1 >= 0)
        bounds = {"mises1": _where(coated, layer), "mises2": _where(coated & (nu2 >= 0), below)}
    if not np.all(layered):
        ball = v["p0"] / yield_pressure(np.maximum(nu2, 0.0))
        low, high = (np.where(rough, factor, 1.0) * ball for factor in _BARE)
        alone = _where(has_bounds & ~layered & (nu2 >= 0), Bounds(low, high))
        bounds["mises2"] = Bounds(*(np.where(layered, *pair) for pair in zip(bounds["mises2"], alone, strict=True)))
    if np.any(stacked := is_stack(v["base"])):
        stack = of_stacks(v)
        bounds = {
            name: Bounds(*(np.where(stacked, *pair) for pair in zip(stack, one_layer, strict=True)))
            for name, one_layer in bounds.items()
        }
    return bounds


@np.errstate(all="ignore")
def of_stacks(v) -> Bounds:
    """Bounds of the stress in each layer of a stack, and in the body below it."""
    numbers = range(1, numbers_of(v) + 1)
    names = [full_name(number, field) for number in numbers for field in ("n", "n_bottom")]
    moduli = [np.where(v["n"] == 0, np.nan, 1.0), *(np.asarray(v[name], dtype=float) for name in names if name in v)]
    moduli = [np.where(n == 0, 1.0, n) for n in moduli]  # the first layer on a rigid base has n = 0
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
    """Bounds of the stress on the axis of the central spot: that of the spot alone, more or less those of the nominal
    pressure."""
    layered, p0, p_max, nu, whole = v["layered"], v["p0"], v["p_max"], _nu(v), of_bodies(v)
    pressure = np.fmax(p0, v["P"] / (np.pi * v["a"] ** 2))
    disc = (0.5 - nu) + 2 / 3 * (1 + nu) * np.sqrt((1 + nu) / 4.5)  # on the axis of a uniform pressure, over it
    further = np.where(layered, whole["mises1"].high, whole["mises2"].high) + 2 * disc * pressure
    low = (p_max - p0) / yield_pressure(nu) - further
    high = disc * p_max * np.where(layered & (v["n"] > 1), _RING, 1.0) + further
    high = np.where(2 * p0 < pressure, np.inf, high)  # the centre says little about a ring
    small = ~layered | (v["b"] < v["h"])  # otherwise the stress of the spot reaches below the layer
    bounds, alone = _where(_has_bounds(v) & small & (nu >= 0), Bounds(low, high)), one_asperity(v)
    bounds = Bounds(np.fmin(bounds.low, alone), np.fmin(bounds.high, alone))
    return _on_body(v, bounds, whole["mises1"].high) if "p_spot" in v else bounds


def _on_body(v, on_half_space: Bounds, further) -> Bounds:
    """Bounds for asperities that feel the layer, where p_spot is known; elsewhere `on_half_space`.

    further : largest stress of the nominal pressure
    """
    p_spot, narrow = v["p_spot"], v["b"] < _WIDE * v["h"]
    low = np.where(narrow, _OF_SPOT[0] * p_spot, 0.0)
    high = np.where(narrow, _OF_SPOT[1], _LAYER * np.maximum(v["n"], 1.0) ** (2 / 3)) * p_spot
    by_spot = _where(_has_bounds(v) & (_nu(v) >= 0), Bounds(low - further, high + further))
    felt = np.isfinite(p_spot)
    return Bounds(*(np.where(felt, *pair) for pair in zip(by_spot, on_half_space, strict=True)))


def one_asperity(v) -> np.ndarray:
    """The stress below an asperity that bears the whole load, an upper bound. NaN without its radius Ra, and for
    asperities that feel the layer, which bends below them."""
    E = np.where(v["layered"], v["E1*"], 1.0) / (1 + v["m"])  # of both touching bodies in series
    alone = stress_below_one(v["P"], E, v.get("Ra", np.nan), _nu(v))
    return np.where(np.isfinite(v["p_spot"]), np.nan, alone) if "p_spot" in v else alone


@np.errstate(all="ignore")
def stress_below_one(P, E, Ra, nu):
    """Largest von Mises stress below a sphere of radius Ra under the load P: Hertz's p(0) over q; NaN where P < 0."""
    return np.where(P >= 0, np.cbrt(6 * P * E**2 / (np.pi**3 * Ra**2)), np.nan) / yield_pressure(nu)


@np.errstate(all="ignore")
def spot_alone(v) -> np.ndarray:
    """The stress below the central spot as below a sphere: its largest pressure, less the nominal one, over q."""
    return (np.fmax(v["p_max"], v.get("p_spot", np.nan)) - v["p0"]) / yield_pressure(_nu(v))


def _nu(v) -> np.ndarray:
    return np.where(v["layered"], _value(v, "nu1"), _value(v, "nu2"))


def _value(v, name):
    return v[name] if name in v else PACKAGE.parameter(name).default


def _has_bounds(v) -> np.ndarray:
    """Whether bounds are known: for balls without adhesion that are not on stacks."""
    ball = v["shape"] == PARABOLOID if "shape" in v else True
    free = ~(v["w_adhesion"] > 0) if "w_adhesion" in v else True
    return ball & free & ~is_stack(v["base"])


def _where(where, bounds: Bounds) -> Bounds:
    low, high = (np.where(where, *pair) for pair in ((bounds.low, 0.0), (bounds.high, np.inf)))
    return Bounds(np.nan_to_num(low, nan=0.0), np.where(np.isnan(high), np.inf, high))
