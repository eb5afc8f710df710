"""Curves without a pull: their work of adhesion is 0, and their other unknowns come from a fit without adhesion."""

from typing import Any

import numpy as np
import xarray as xr
from scipy import special

#: A pull is a load below the baseline by so many standard deviations of a point, on an average of so many neighbours.
#: With 10,000 points of white noise, some 1e-4 of curves have a pull.
_PULL, _AVERAGE = 2.5, 5
#: Level of the test that adhesion reduces the sum of squares, and its number of further unknowns: the work, the point
#: from which on others adhere, and one for the chance gain of the best of several searches.
_SURE, _MORE = 0.95, 3
#: Parameters without a meaning if there is no adhesion.
OF_ADHESION = ("w_adhesion", "adhesion", "sigma0", "z0", "branch", "k_machine")
#: Ending of a name -> function that combines the intervals of two fits.
_BOTH = {"low": np.fmin, "high": np.fmax, "spread": np.fmax}
_LOST = (5, 6, 127)  # statuses without numbers


def without(free: Any, parameters: dict) -> tuple[Any, dict]:
    """`free` and the parameters for the same fit without adhesion."""
    names = [name for name in free if name not in OF_ADHESION]
    rest = {name: free[name] for name in names} if isinstance(free, dict) else names
    return rest, {name: value for name, value in parameters.items() if name not in OF_ADHESION}


def _is_quiet(plain: xr.Dataset) -> bool:
    """Whether the load of a curve is nowhere below the baseline by more than its noise.

    plain : fit of the curve without adhesion

    The noise is that of the shallower half of the points before the contact point.
    """
    x, y, residual = (plain[name].values for name in ("D", "P", "residual"))
    points = np.flatnonzero(np.isfinite(residual))
    points = points[np.argsort(x[points], kind="stable")]
    base = float(plain["P0"]) if "P0" in plain else 0.0
    base = base + (float(plain["tilt"]) * x[points] if "tilt" in plain else 0.0)
    loads, before = y[points] - base, x[points] < (float(plain["D0"]) if "D0" in plain else 0.0)
    shallow = np.flatnonzero(before)[: before.sum() // 2]
    noise = np.sqrt(np.mean(residual[points] ** 2))
    if len(shallow) >= 2 * _AVERAGE:
        loads, noise = loads - np.median(loads[shallow]), np.std(loads[shallow])
    means = np.convolve(loads, np.full(_AVERAGE, 1 / _AVERAGE), "valid")
    return bool(means.min(initial=0.0) > -_PULL * noise)


def without_pull(fitted: xr.Dataset, plain: xr.Dataset, low: float) -> tuple[np.ndarray, np.ndarray]:
    """Which curves (curve,) have no pull: adhesion is at its low bound, or lowers the sum of squares by no more than
    chance would; and for which of all curves it lowers it.

    plain : the fits without adhesion; low : the low bound of w_adhesion
    """
    are_fits = ~plain["fit_status"].isin(_LOST).values & ~fitted["fit_status"].isin(_LOST).values
    squares, bare_squares = (np.nansum(part["residual"].values ** 2, axis=1) for part in (fitted, plain))
    freedom = np.maximum(fitted["effective_points"].values - fitted.sizes["cov_i"], 1.0)
    gain = (bare_squares - squares) / np.maximum(squares, 1e-300) * freedom
    betters = are_fits & (gain > 0) & (fitted["w_adhesion"].values > low * (1 + 1e-6))
    by_chance = are_fits & (~betters | (special.fdtr(_MORE, freedom, gain / _MORE) < _SURE))
    no_pull = np.zeros(len(by_chance), bool)
    for i in np.flatnonzero(by_chance):
        no_pull[i] = _is_quiet(plain.isel(curve=i))
    return no_pull, betters


def joined(fitted: xr.Dataset, plain: xr.Dataset, no_pull: np.ndarray, betters: np.ndarray) -> xr.Dataset:
    """Fits with adhesion, and in place of those of curves without a pull those without it, `plain`. `no_pull` says
    where; both arrays are those of :func:`without_pull`."""
    fitted = fitted.copy(deep=True)
    for i in np.flatnonzero(no_pull).tolist():
        _put(fitted, plain, i, betters[i])
    return fitted.assign(no_pull=("curve", no_pull, {"long_name": "whether the curve has no pull: w_adhesion is 0"}))


def _put(fitted: xr.Dataset, plain: xr.Dataset, curve: int, better: bool) -> None:
    """Put the numbers of a curve in `plain` in the place of those in `fitted`.

    better : whether some adhesion fits better, by no more than chance; then the intervals cover those of both fits
    """
    before = fitted.isel(curve=curve).copy(deep=True)
    for name in plain.data_vars:
        if name in fitted and name != "covariance":
            fitted[name].values[curve] = plain[name].values[curve]
            if better and (both := _BOTH.get(str(name).rpartition("_")[2])):
                fitted[name].values[curve] = both(before[name].values, plain[name].values[curve])
    names = {name: fitted[name].values for name in ("cov_i", "cov_j")}
    fitted["covariance"].values[curve] = plain["covariance"].isel(curve=curve).reindex(names).values
    fitted["w_adhesion"].values[curve], fitted["w_adhesion_spread"].values[curve] = 0.0, np.nan
    if "w_adhesion_low" in fitted:
        fitted["w_adhesion_low"].values[curve] = 0.0
        fitted["w_adhesion_high"].values[curve] = before["w_adhesion_high"] if better else np.nan
