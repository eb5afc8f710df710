"""Doubts about contacts besides the assumptions of the model. Each condition yields sentences, often none."""

from __future__ import annotations

import numpy as np

from solver.bases import is_bare
from solver.laws.own_table import LAW_UNIT
from solver.parameters import one_of

from ..arrays import xarray_later as xr
from ..arrays.labelled import as_xarray
from ..inputs.lexicon import lexicon_in
from ..inputs.vocabulary import BODIES, ROWS
from ..specimen.quantities import readable
from ..terminal import rounded
from .rule import in_si, of_cases, rule

#: Values of real bodies, in SI units: outside them a unit was mistaken, mPa for MPa or Mm for mm. The softest gels have
#: some 10 Pa, diamond 1.2 TPa; the sharpest tips have some nm, and layers are not thinner than an atom.
_REAL = dict.fromkeys(("E1", "E2", "E_punch"), (1.0, 2e12, "materials have 1 Pa to 2 TPa"))
_REAL |= dict.fromkeys(("R", "Ra"), (1e-10, 1e3, "radii of bodies are 0.1 nm to 1 km"))
_REAL |= {"h": (5e-11, 1e3, "layers are 0.05 nm to 1 km thick")}
_RATIOS = tuple(ratio for _, ratio, _ in BODIES.values())
#: Bodies on which the nominal pressure is known; on layers below the first it is not.
_PRESSED = ("punch", "layer", "body")
#: Inputs whose spread is judged: those with a unit that cannot be zero, and Poisson ratios.
_STRENGTHS = ("hardness", "yield_strength", "Y1", "Y2", "Y_punch")
_LENGTHS = ("a", "D", "h", "Ra", "sigma", "R", "R1", "R2")
_SPREAD = ("P", *_LENGTHS, "Nbar", "E1", "E2", "E_punch", *_STRENGTHS, *_RATIOS)
#: The yield strength of every metal is below E/50. Plastics, rubber and gels, softer than 10 GPa, bear a larger share.
YIELD, STIFF = 0.03, 1e10


@rule()
def ra_as_of_iso(v):
    if {"Ra", "Nbar", "micro"} <= {*v} and not one_of(v["micro"].values, lexicon_in(v).smooth_laws()).all():
        from ..specimen.roughness import looks_like_iso_ra  # here, since it loads the measurement of scans

        Ra, Nbar = (v["Ra"] + 0 * v["Nbar"]).values, (0 * v["Ra"] + v["Nbar"]).values  # with one order of axes
        yield from filter(None, [looks_like_iso_ra(Ra, Nbar, si="units" in v["Ra"].attrs)])


@rule()
def table_of_several_radii(v):
    tables = {"R", "micro"} <= {*v} and np.char.startswith(v["micro"].values.astype(str), "table:").any()
    tables = tables and LAW_UNIT not in v  # tables with lengths have it
    if tables and np.ptp(v["R"].values) > 0 and not (v["R"].dims and {*v["R"].dims} <= {*v["micro"].dims}):
        yield (
            "A table gives A, or the heights z, in R: with several R its asperities grow with the punch. Give each R a "
            "table of its own, in cases."
        )


@rule()
def metals_yield(v):
    """Bodies in SI units under so much pressure that a metal would yield: the worst case of the body under most
    pressure.

    A body under a layer has the largest nominal pressure only where the contact is wide against the layer.
    """
    moduli = {body: v[BODIES[body][0]] for body in _PRESSED if in_si(v, BODIES[body][0])}
    stiff = [E.values[(E.values >= STIFF) & np.isfinite(E.values)] for E in moduli.values()]
    least = min((E.min(initial=np.inf) for E in stiff), default=np.inf)
    if not ("p_peak" in v and (v["p_peak"] > YIELD * least).any()):
        return []
    v = {name: as_xarray(variable) for name, variable in v.items()}
    # it is infinite at an edge or a tip: the sentence on the shape says so
    v |= {name: v[name].where(np.isfinite(v[name])) for name in ("p_peak", "p_ring") if name in v}
    moduli = {body: as_xarray(E) for body, E in moduli.items()}
    moduli = {body: E.where((E >= STIFF) & np.isfinite(E)) for body, E in moduli.items()}
    bare = is_bare(v["base"])
    under = v["p_peak"].where(bare, v["p_ring"].where(v["a"] > v["h"]) if "h" in v else np.nan)
    pressures = {"punch": v["p_peak"], "layer": v["p_peak"].where(~bare), "body": under}
    shares = {body: (pressures[body] / moduli.get(body, xr.Variable((), np.nan))).fillna(0) for body in _PRESSED}
    body = max(shares, key=lambda body: shares[body].max())
    exceeds = sum(share > YIELD for share in shares.values()) > 0
    share = f"The pressure on the {body} reaches {rounded(float(shares[body].max()))} of its Young's modulus"
    sentence = f"{of_cases(exceeds.values)}{share}: metals yield before that, which the model leaves out."
    return [sentence] * bool(exceeds.any())


@rule()
def nothing_real_has_it(v):
    for name, (low, high, words) in _REAL.items():
        values = v[name].values if in_si(v, name) else np.array(np.nan)
        outside = values[((values < low) | (values > high)) & np.isfinite(values)]
        if outside.size:
            yield f"{name} = {readable(float(outside[0]), ROWS[name].unit)}: {words}; is its unit right?"


@rule()
def spread_too_wide(v):
    for name in _SPREAD:
        if f"{name}_spread" not in v or not (name in _RATIOS or in_si(v, name)):
            continue
        value, spread = v[name], v[f"{name}_spread"]
        limit = 0.5 - value if name in _RATIOS else abs(value)
        if f"{name}_off" in v:  # with adhesion the load and the depth pass through 0
            limit = np.fmax(limit, abs(v[f"{name}_off"]))
        if name in ("R1", "R2"):  # in a close cup R = 1/(1/R1 + 1/R2) changes by more
            limit = limit * np.minimum(abs(value / v["R"]), 1)
        with np.errstate(invalid="ignore"):  # a rigid body has inf, and 0 inf is NaN
            zero = 0 * (value + spread + limit)  # over the dimensions of all three
            value, spread, limit = (np.ravel(zero + array) for array in (value, spread, limit))
        wide = np.flatnonzero((spread > 0) & (spread >= limit))[:1]
        for text in [readable(float(value[i]), ROWS[name].unit, float(spread[i])) for i in wide]:
            yield f"{name} = {text}: this spread is too wide for the ± of the results, which is of first order."
