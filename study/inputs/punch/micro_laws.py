"""Micro laws of the asperities in calls and study files: the results that they have, power laws that are fitted, tables
of the user's own, and what the asperities press on: the coated body itself, or a half-space of the layer's material."""

import math
from collections.abc import Mapping
from functools import cache, partial
from typing import Any

import numpy as np

from solver.bases import FELT, is_bare, is_chosen, is_exact, is_stack, on_springs
from solver.laws import Law, own_table
from solver.laws.own_table import OF_FILES
from solver.laws.power_law_fit import fit_power_law
from solver.parameters import allowed, one_of
from solver.problem import can_feel, far_apart, feels

from ...terminal import shown
from ..grid import Grid, along
from ..lexicon import PACKAGE, Lexicon
from ..vocabulary import names

MOST_FITS = 1000
"""Most different values of Nbar Ra² in a study. A law is fitted to each, in 2 ms."""
DIGITS = 10
"""Significant digits of B and beta that are kept. Results are found on disk by the values of their parameters, and the
last digits of a fit depend on the processor."""
COMMENT = "fitted to Nbar and Ra by least squares over pressures from 1e-4 to 0.025 E1*, as in Section 4.1 of the paper"

#: Results that only asperities which feel the layer have.
_OF_FELT = ("p_spot", "r_spot")
#: Nbar Ra^2 is moved by this share of itself. Fits are accurate to some 1e-12 (their root is sought to 1e-15), so that
#: rounding changes a slope by some 1e-9. So does the curvature.
_STEP = 1e-3
#: Numbers of a body count as equal if they differ by a smaller share: moduli and their ratios round differently.
_SAME = 1e-6
_WAY_OUT = "compute the law on the body of the contact, rc.roughness.law(scan, on=...)"
#: Names of the bodies that asperities have pressed on, in the order of the values of `asperities_used`.
USED = ("none", "half_space", "layer")

#: Parameters of the law of asperities that feel the coated body. A law takes some 10 ms for each set of them, which is
#: little if a set has at least so many cases.
_OF_BODIES, _FEW_CASES = ("h", "n", "m", "nu1", "nu2", "bonding", "Nbar"), 20


def results_of(
    laws: Mapping[str, Law], micro: np.ndarray, sticking: bool = False, felt: bool = False
) -> tuple[str, ...]:
    """Names of the results of the `laws` that `micro` names. They include plastic_share if the spots of some law yield,
    results of pull-off if contacts may be `sticking`, and results of spots if some asperities feel the layer (`felt`).
    """
    yields = one_of(micro, [name for name, law in laws.items() if law.yielded]).any()
    left_out = ("plastic_share",) * (not yields) + _OF_FELT * (not felt)
    of_laws = tuple(name for name in names("result") if name not in left_out)
    return of_laws + (names("pull_off") if sticking else ())


def wants_a_fit(grid: Grid) -> bool:
    """Whether some case has the power law, no case has B and beta, and all cases with the power law have Nbar and Ra.

    A grid with only one of B and beta has been refused before.
    """
    power = along(grid, "micro") == "power_law"
    if not power.any() or "B" in grid.values:
        return False
    return bool((np.isfinite(along(grid, "Nbar") * along(grid, "Ra")) | ~power).all())


def fitted(grid: Grid) -> tuple[dict, list[str]]:
    """Values of B and beta over the dimensions of Nbar and Ra, as in `Grid.values`, and messages."""
    products = along(grid, "Nbar") * along(grid, "Ra") ** 2
    different = np.unique(products[np.isfinite(products)]).tolist()
    if len(different) > MOST_FITS:
        few = f"at most {MOST_FITS} values of Nbar Ra^2 are fitted, not {len(different)}"
        return {}, [f"B and beta are missing: {few}"]
    dims = tuple(dim for dim in grid.sizes if dim in {*grid.values["Nbar"][0], *grid.values["Ra"][0]})
    values, errors = {}, []
    for name, fits in fits_to(different).items():
        parameter = PACKAGE.parameter(name)
        rounded = {product: float(f"{fit:.{DIGITS}g}") for product, fit in fits.items()}
        array = np.array([rounded.get(product, np.nan) for product in products.ravel().tolist()])
        values[name] = dims, array.reshape([grid.sizes[dim] for dim in dims])
        wrong = [f"{product:g} is {fit:g}" for product, fit in fits.items() if not allowed(parameter, fit)][:1]
        errors += [f"{name} fitted to Nbar Ra^2 = {fit}: must be in {parameter.interval}" for fit in wrong]
    return values, errors


def fits_to(products: list[float]) -> dict[str, dict[float, float]]:
    """B and beta -> Nbar Ra² -> the fitted value, in full digits."""
    power_laws = {product: fit_power_law(product) for product in products}
    return {name: {product: getattr(law, name) for product, law in power_laws.items()} for name in ("B", "beta")}


def slopes_of_fit(products: Any) -> dict[str, Any]:
    """B and beta -> d ln B/d ln(Nbar Ra^2), d ln beta/d ln(Nbar Ra^2) of the fits to `products`, Nbar Ra^2.

    products : a number or a DataArray, as the slopes are
    """
    values = np.array([_slopes_of_fit(v) if v > 0 else (0.0, 0.0) for v in np.ravel(products).tolist()]).T
    zero = 0.0 * products
    return {name: zero + slopes.reshape(np.shape(products)) for name, slopes in zip(("B", "beta"), values, strict=True)}


@cache
def _slopes_of_fit(product: float) -> tuple[float, float]:
    up, down = (fit_power_law(product * (1 + step)) for step in (_STEP, -_STEP))
    return float(np.log(up.B / down.B) / (2 * _STEP)), float(np.log(up.beta / down.beta) / (2 * _STEP))


def laws_in_metres(words: Any, lexicon: Lexicon) -> bool:
    """Whether some word of `micro` is a table whose A is a length."""
    there = {name for name, law in lexicon.known.laws.items() if own_table.in_metres(law)}
    return bool(there) and not there.isdisjoint(np.unique(np.asarray(words).astype(str)).tolist())


def mistakes_of_tables(grid: Grid, physical: bool) -> list[str]:
    """Messages about tables with lengths in a call without units, and about contacts on another body than that on which
    the law of a scan was computed."""
    laws = grid.lexicon.known.laws
    names = [name for name, law in laws.items() if own_table.in_metres(law)] if "micro" in grid.values else []
    if not names:
        return []
    micro = along(grid, "micro")
    names = [name for name in names if (micro == name).any()]
    if names and not physical:
        example = 'R = "5 mm", E2 = "200 GPa"'
        return [f"micro = {shown(names[0])}: A is a length: give the other inputs with units too ({example})"]
    return [text for name in names if laws[name].body for text in _on_another_body(grid, laws[name], micro == name)]


def _on_another_body(grid: Grid, law: Law, cases: np.ndarray) -> list[str]:
    """At most one message, if some of the `cases` of the law are not on the law's body."""
    assert law.body is not None
    if (is_bare(along(grid, "base")) & cases).any():
        return [f"micro = {shown(law.name)}: is the law of a scan on a coated body, not a half-space: {_WAY_OUT}"]
    for name, value in law.body.items():
        unit = "m" if name in grid.lexicon.rows and grid.lexicon.rows[name].powers == (0, 1) else ""
        if name not in grid.values:
            there, differs = np.array("none"), np.array(True)
        elif isinstance(value, str):
            there = along(grid, name)
            differs = there != value
        else:
            there = along(grid, name) / (along(grid, own_table.LAW_UNIT) if unit else 1.0)
            differs = ~np.isclose(there, value, rtol=_SAME, atol=0)
        if (wrong := differs & cases).any():
            other = np.broadcast_to(there, wrong.shape)[wrong][0]
            is_of = f"{name} = {_text(value, unit)}, not {_text(other, unit)}"
            return [f"micro = {shown(law.name)}: is the law of a scan on a body with {is_of}: {_WAY_OUT}"]
    return []


def _text(value: Any, unit: str) -> str:
    return shown(str(value)) if isinstance(value, str) else f"{value:.6g} {unit}".strip()


def felt(grid: Grid) -> np.ndarray:
    """bool, along the dimensions of the grid: the cases whose asperities feel the coated body below the surface."""
    words = (along(grid, name) for name in ("base", "micro", "asperities_on", "Nbar", "h"))
    return feels(*words, grid.lexicon.known.laws)


def many_bodies(grid: Grid) -> bool:
    """Whether asperities feel so many bodies, or have so many pitches, that each has only a few cases."""
    if not felt(grid).any():
        return False
    names = [name for name in grid.values if name in _OF_BODIES or name.startswith("layers.")]
    dims = {dim for name in names for dim in grid.values[name][0]}
    return _FEW_CASES * math.prod(grid.sizes[dim] for dim in dims) > grid.size > _FEW_CASES


def is_said(grid: Grid) -> bool:
    """Whether the results have `asperities_used`: some asperities feel the layer, or the study has `asperities_on`."""
    return "asperities_on" in grid.values or bool(felt(grid).any())


def used(grid: Grid) -> np.ndarray:
    """int8, over all dimensions of the grid: places in `USED`."""
    laws = grid.lexicon.known.laws
    rough = one_of(along(grid, "micro"), [name for name, law in laws.items() if law.rough])
    return np.broadcast_to(rough.astype(np.int8) + felt(grid), grid.shape).astype(np.int8)


def stand_apart(grid: Grid) -> np.ndarray:
    """bool, along the dimensions of the grid: the distance between asperities is larger than the thickness of the
    layer, and numbers of the case depend on that."""
    if not {"h", "Nbar"} <= {*grid.values}:
        return np.False_
    base, micro, check = (along(grid, name) for name in ("base", "micro", "model_check"))
    laws, cases_with = grid.lexicon.known.laws, partial(grid.lexicon.cases_with, values=partial(along, grid))
    exact = is_exact(base) | is_chosen(base) & can_feel(base, micro, laws)
    # these take the `model_error` of the exact layer, although their asperities do not feel it
    against = on_springs(base) & (is_stack(base) | (check == "first_order"))
    counts = exact | against & can_feel("layered", micro, laws)
    there = cases_with("Nbar") & cases_with("h")
    return counts & there & far_apart(along(grid, "Nbar"), along(grid, "h"))


def mistakes_of_choice(grid: Grid, sections: Any) -> list[str]:
    """Messages about asperities that are to feel a layer and cannot, and about a choice where there is none."""
    if "asperities_on" not in sections:
        return []
    base, micro, on = np.broadcast_arrays(*(along(grid, name) for name in ("base", "micro", "asperities_on")))
    laws = grid.lexicon.known.laws
    can, layer, messages = can_feel("layered", micro, laws), on == "layer", []
    if (wrong := ~can & (layer if can.any() else on != "auto")).any():
        choices = " or ".join(shown(name) for name, law in laws.items() if law.on_body)
        way_out = f"leave it out, or take micro = {choices}"
        messages.append(f"{_with(on[wrong], 'micro', micro[wrong])}, {_why(laws[str(micro[wrong][0])])}: {way_out}")
    if (thin := layer & can & ~one_of(base, FELT)).any():
        way_out = 'take base = "layered" or "stack", or asperities_on = "auto"'
        messages.append(f"{_with(on[thin], 'base', base[thin])}, on which they press on a half-space: {way_out}")
    return messages


def _with(words: np.ndarray, name: str, values: np.ndarray) -> str:
    return f"asperities_on = {shown(str(words[0]))} is given with {name} = {shown(str(values[0]))}"


def _why(law: Law) -> str:
    if not law.rough:
        return "which has no asperities"
    if law.name == "power_law" or law.name.startswith(OF_FILES):
        return "whose A[p] is given, whatever asperities press on"
    return "a law that takes no kernel of the body"
