"""Fits of measured curves in words: the fitted inputs with their intervals, and the limits of each curve."""

from __future__ import annotations

import numpy as np

from ..arrays import xarray_later as xr
from ..data.dataset import decode
from ..inputs.lexicon import default
from ..inputs.vocabulary import ROWS, name_in_stack
from ..rules.rule import RULES
from ..specimen.quantities import readable
from ..terminal import rounded
from .sentences import NOT_VIOLATED

NAMES_OF_SHIFTS = {"D0": "contact point", "P0": "baseline", "tilt": "slope of the baseline"}
"""Unknowns of a fit that are not inputs of the contact."""
MOST_CURVES = 20  # number of curves that are written out
#: Correlation of the logarithms of two inputs above which no curve separates them; a product of their powers may be
#: known.
_ALIKE = 0.995
#: Standard deviations from its prior above which an input contradicts it.
_AGAINST = 2.5
_WITHOUT_NUMBERS = ("no_contact", "invalid_input", "not_run")
_SENTENCES = {
    "at_bound": "The best value is at a bound: widen the bounds, or the curve does not determine it.",
    "iteration_limit": "The search has not ended: do not use these values.",
    "several_minima": "Another value fits as well: the interval contains all of them.",
    "not_identifiable": "The curve does not determine one end of the interval: the search stopped there.",
    "no_contact": "A straight line describes the curve as well: it contains no contact, or none that these inputs "
    "describe. The depth D must grow and the load P must rise as the punch goes in.",
    "not_run": "It was not fitted, because the call was interrupted.",
    "invalid_input": "Nothing is fitted: there are fewer points than unknowns, all are at one place, or no contact has "
    "a solution.",
}


#: For a load that rises from the shallowest point on, and that a straight line describes as well.
_THROUGHOUT = (
    "From the shallowest point on the load rises nearly along a straight line: either the baseline drifts, or the "
    "curve is in contact throughout, as an unloading curve is. P(D) alone does not say where such a contact begins, so "
    "no modulus follows. An unloading curve gives one by its slope dP/dD at the deepest point and the contact radius "
    'there: x="a", y="dP_dD" (docs/afm.md). A loading curve needs points before the contact too.'
)
_FLOWS = (
    "This is not a modulus: a body this stiff flows below a sharp tip, so its loading is not an elastic contact. "
    "Take the slope dP/dD at the beginning of the unloading and the contact radius there (Oliver and Pharr), and fit "
    'x="a", y="dP_dD" (docs/afm.md).'
)
_ENDED = (
    "The deepest contact is beyond the end of the law of its asperities on the coated body: the spots merge or, on a "
    "soft layer, the disc cell fails. Take shallower points, or give asperities_on."
)


def of_fit(fitted: xr.Dataset) -> str:
    """The text of a Dataset of `study.fit`, or of one of its curves."""
    fitted = fitted if "curve" in fitted.dims else fitted.expand_dims("curve")
    names = [str(name) for name in fitted["cov_i"].values]
    inputs, shifts = [n for n in names if n not in NAMES_OF_SHIFTS], [n for n in names if n in NAMES_OF_SHIFTS]
    x, y, level = fitted.attrs["x"], fitted.attrs["y"], fitted.attrs["level"]
    count = fitted.sizes["curve"]
    shifted = f"; also {' and '.join(NAMES_OF_SHIFTS[name] for name in shifts)}" if shifts else ""
    kind = "A plan for" if f"{y}_fit" not in fitted else "Fitted to"
    lines = [fitted.attrs["given"], ""] if "given" in fitted.attrs else []
    lines += [
        f"{kind} {count} curve{'s' * (count != 1)} {y}({x}): {', '.join(inputs)}{shifted}. ± is one standard deviation."
    ]
    if f"{names[0]}_low" in fitted:
        lines[-1] += f" In brackets: {100 * level:g} % intervals."
    for i in range(min(count, MOST_CURVES)):
        lines += ["", *_of_curve(fitted.isel(curve=i), i, count, inputs, shifts)]
    if count > MOST_CURVES:
        words, counts = np.unique(decode(fitted["fit_status"]).values.astype(str), return_counts=True)
        lines += [
            "",
            f"and {count - MOST_CURVES} more. For all of them: "
            + ", ".join(f"{n} {w}" for w, n in zip(words, counts, strict=True)),
        ]
    return "\n".join([*lines, *([""] * (count > 1) + [text] if (text := fitted.attrs.get("assumed")) else [])])


def _of_curve(curve: xr.Dataset, i: int, count: int, inputs: list[str], shifts: list[str]) -> list[str]:
    status = str(decode(curve["fit_status"]).item())
    name = curve["curve"].item() if "curve" in curve.coords else i
    lines = [f"Curve {name}: {status.replace('_', ' ')}"] if count > 1 or status != "converged" else []
    if status == "no_contact" and _rises_throughout(curve):
        return [*lines, _THROUGHOUT]
    if status in _WITHOUT_NUMBERS:
        return [*lines, _SENTENCES[status]]
    rows = [(name, _long_name(name), _text(curve, name)) for name in (*inputs, *shifts)]
    widths = max(len(words) for _, words, _ in rows), max(len(name) for name, _, _ in rows)
    lines += [f"  {words:{widths[0]}}  {name:{widths[1]}} = {text}" for name, words, text in rows]
    lines += _residual(curve)
    doubts = _doubts(curve, inputs)
    lines += _points(curve) + doubts
    lines += [_SENTENCES[status]] if status in _SENTENCES else []
    lines += _inseparable_pairs(curve, inputs)
    lines += [_FLOWS] if "flows" in curve and bool(curve["flows"]) else []
    broken = str(decode(curve["validity"]).item()).split() if int(curve["validity"]) else []
    lines += [f"At the deepest point: {RULES[name].sentence}" for name in broken if name in RULES]
    ended = "outside_law" in curve and bool(curve["outside_law"])
    lines += [_ENDED] * ended
    lines += [f"At the deepest point {NOT_VIOLATED[0].lower()}{NOT_VIOLATED[1:]}"] * (
        count == 1 and not broken and not ended and not doubts and status == "converged"
    )
    return lines


def _rises_throughout(curve: xr.Dataset) -> bool:
    """Whether y rises with x nearly along a line, and still with a fifth of the slope in the shallowest third."""
    if f"{curve.attrs['y']}_fit" not in curve:
        return False
    x, y = (curve[curve.attrs[name]].values for name in ("x", "y"))
    has_numbers = np.isfinite(x) & np.isfinite(y)
    order = np.argsort(x[has_numbers], kind="stable")
    x, y = x[has_numbers][order], y[has_numbers][order]
    third = len(x) // 3
    if third < 3 or np.ptp(x[:third]) == 0:
        return False
    slopes = [np.polyfit(part - part[0], values, 1)[0] for part, values in ((x, y), (x[:third], y[:third]))]
    return bool(np.corrcoef(x, y)[0, 1] > 0.95 and slopes[0] > 0 and slopes[1] > 0.2 * slopes[0])


def _residual(curve: xr.Dataset) -> list[str]:
    """A sentence on the distance of the points from the fit; none for a plan."""
    if "residual" not in curve:
        return []
    name, rms = curve.attrs["y"], float(np.sqrt((curve["residual"] ** 2).mean()))
    share = rms / float(curve[name].max() - curve[name].min())
    unit = curve["residual"].attrs["units"]
    off = readable(float(f"{rms:.2g}"), unit)
    return [f"The points deviate from the fit by {off} (rms), {_percent(share)} of the range of {name}."]


def _doubts(curve: xr.Dataset, inputs: list[str]) -> list[str]:
    """Sentences where the points disagree with the fit, or are not independent; none for a plan."""
    if "effective_points" not in curve:
        return []
    name, lines = inputs[0], []
    if "no_pull" in curve and bool(curve["no_pull"]):
        lines.append(
            "The load is nowhere below the baseline by more than the noise: without a pull the curve says nothing "
            "about adhesion. The fit has w_adhesion = 0."
        )
    count, effective = int(np.isfinite(curve["residual"]).sum()), float(curve["effective_points"])
    if effective < count:
        lines.append(
            f"The residuals are correlated: {count} points say as much as {max(round(effective), 1)} independent "
            "ones, which the intervals take into account."
        )
    if bool(curve["misfit_larger"]):
        ratio = rounded(float(curve["misfit_ratio"]))
        lines.append(
            f"In contact the points are {ratio} times as far from the fit as before it: "
            "this is not noise, but a contact that the model does not describe."
        )
    for prior in (input_name for input_name in inputs if f"{input_name}_from_prior" in curve):
        off = float(curve[f"{prior}_from_prior"])
        if abs(off) > _AGAINST:
            lines.append(
                f"{prior} is {float(f'{abs(off):.2g}'):g} standard deviations from its value in the call: the curve "
                "contradicts that ±, or the model does not describe the curve."
            )
    if bool(curve["changes"]):
        change = 100 * (np.exp(float(curve["change"])) - 1)
        lines.append(
            f"{name} changes with the depth that is fitted, by {change:+.0f} % from the beginning of the contact to "
            "the deepest point: one value does not describe the curve."
        )
    parts = curve[f"{name}_over_depth"].values
    if np.isfinite(parts).any():
        unit = curve[f"{name}_over_depth"].attrs["units"]
        texts = (readable(float(f"{value:.3g}"), unit) if np.isfinite(value) else "-" for value in parts)
        quarters = " | ".join(texts)
        lines.append(
            f"{name} by quarters of the depth, the shallowest first: {quarters}. `depth=(low, high)` fits a part."
        )
    return lines


def _points(curve: xr.Dataset) -> list[str]:
    """A sentence on unusual points of a curve: gaps, equal x, no order; none for a plan.

    NaN after the last point only pads a shorter curve, and is not a gap.
    """
    if "residual" not in curve:
        return []
    name, x, y = curve.attrs["x"], curve[curve.attrs["x"]].values, curve[curve.attrs["y"]].values
    has_numbers = np.isfinite(x) & np.isfinite(y)
    written = np.flatnonzero(np.isfinite(x) | np.isfinite(y)).max(initial=-1) + 1
    x_of_points, gaps = x[has_numbers], written - has_numbers.sum()
    equal = len(x_of_points) - len(np.unique(x_of_points))
    steps = np.sign(np.diff(x_of_points))
    words = [f"{gaps} of {written} points have no numbers and are left out."] * bool(gaps)
    words += [f"{equal} points have the same {name} as another; each counts."] * bool(equal)
    words += [f"The points are not in the order of {name}, which does not matter."] * (len({*steps[steps != 0]}) > 1)
    return [" ".join(words)] if words else []


def _percent(share: float) -> str:
    """A share as a percentage with two digits, and without a power of ten for 100 %."""
    return f"{float(f'{100 * share:.2g}'):g} %"


def _long_name(name: str) -> str:
    if name.startswith("layers.1."):
        return ROWS[name_in_stack(1, name.removeprefix("layers.1."))].long_name.replace("the layer", "layer 1")
    row = default().all_rows.get(name)  # None: an input of a law that is not registered
    return NAMES_OF_SHIFTS.get(name) or (row.long_name if row else name)


def _text(curve: xr.Dataset, name: str) -> str:
    unit, spread = curve[f"{name}_spread"].attrs["units"], float(curve[f"{name}_spread"])
    if name not in curve:  # a plan
        return f"assumed, ± {readable(float(f'{spread:.2g}'), unit)}"
    if name == "w_adhesion" and "no_pull" in curve and bool(curve["no_pull"]):
        most = float(curve.get("w_adhesion_high", np.nan))
        return "0 (no pull)" + (f"  (0 to {readable(float(f'{most:.2g}'), unit)})" if np.isfinite(most) else "")
    text = readable(float(curve[name]), unit, spread)
    if f"{name}_low" not in curve:
        return text
    low, high = (readable(_rounded(float(curve[f"{name}_{end}"]), spread), unit) for end in ("low", "high"))
    return f"{text}  ({low} to {high})"


def _rounded(end: float, spread: float) -> float:
    """The end of an interval with the decimals that two digits of the spread have."""
    if not (np.isfinite(end) and np.isfinite(spread) and spread > 0):
        return end
    return round(end, 1 - int(np.floor(np.log10(spread)))) + 0.0


def _inseparable_pairs(curve: xr.Dataset, inputs: list[str]) -> list[str]:
    """Sentences on pairs of inputs that the curve cannot separate: the product of powers that is known, and how
    well."""
    lines = []
    for a, first in enumerate(inputs):
        for second in inputs[a + 1 :]:
            pair = [first, second]
            if any(name not in curve for name in pair):
                continue
            values = np.array([float(curve[name]) for name in pair])
            C = curve["covariance"].sel(cov_i=pair, cov_j=pair).values / np.outer(values, values)
            with np.errstate(invalid="ignore", divide="ignore"):
                correlation = C[0, 1] / np.sqrt(C[0, 0] * C[1, 1])
            if not np.abs(correlation) > _ALIKE:
                continue
            power = -C[0, 1] / C[1, 1]
            least = np.sqrt(max(C[0, 0] + 2 * power * C[0, 1] + power**2 * C[1, 1], 0.0))
            at = readable(values[1], curve[second].attrs["units"])
            lines.append(
                f"{first} and {second} cannot be told apart by this curve (correlation {correlation:.3f}). "
                f"The curve determines {first} ({second}/{at})^{power:.2f} to {_percent(least)}."
            )
    return lines
