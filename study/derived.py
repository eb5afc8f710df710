"""Quantities that follow from a dataset: validity of the model's assumptions, areas, mean pressure, number of spots.

Every function takes an opened dimensionless dataset and returns a DataArray whose attributes come whole from the
vocabulary.
"""

import numpy as np
import xarray as xr

from .vocabulary import attributes

FEW_SPOTS = 100.0
"""The model spreads the asperities evenly: with fewer spots than this in the nominal area, N̄πa², they are not many."""
SPOT_OVER_LAYER = 0.1
"""The micro law takes the layer for a half-space: the central spot must be small against it, b <= 0.1 h."""
ASSUMPTIONS = {1: "layer_not_thin", 2: "few_spots", 4: "spot_not_small_against_h", 8: "n_not_below_one"}


def validity(dataset: xr.Dataset) -> xr.DataArray:
    """Assumptions that each case violates, a sum of masks; 0: all hold.

    1 h >= a on a thin layer; 2 N̄πa² < FEW_SPOTS; 4 b(0) > SPOT_OVER_LAYER h on a layer of either kind; 8 n >= 1 on a
    thin layer (the paper assumes n < 1). A case without numbers (see `status`) only gets the masks that need none.
    int32 over the dimensions of `status`.
    """
    thin, layered = dataset["base"] == "thin_layer", dataset["base"] != "half_space"
    rough = dataset["micro"] != "smooth"
    h = _given(dataset, "h")
    violated = {
        1: thin & (h >= dataset["a"]),
        2: rough & (_spots(dataset) < FEW_SPOTS),
        4: layered & rough & (_spot_radius(dataset) > SPOT_OVER_LAYER * h),
        8: thin & (_given(dataset, "n") >= 1),
    }
    flags = xr.zeros_like(dataset["status"], dtype=np.int32)
    for mask, where in violated.items():
        flags = flags + np.int32(mask) * where.astype(np.int32)
    flags = _named(flags, "validity")
    flags.attrs["flag_masks"] = np.array(list(ASSUMPTIONS), dtype=np.int32)
    flags.attrs["flag_meanings"] = " ".join(ASSUMPTIONS.values())
    return flags


def nominal_area(dataset: xr.Dataset) -> xr.DataArray:
    """Nominal contact area An = πa², in R²."""
    return _named(np.pi * dataset["a"] ** 2, "An")


def nominal_area_ratio(dataset: xr.Dataset, a0) -> xr.DataArray:
    """Nominal contact area over that of the radius a0, An/(π a0²)."""
    return _named((dataset["a"] / a0) ** 2, "An_ratio")


def mean_pressure(dataset: xr.Dataset) -> xr.DataArray:
    """Mean nominal pressure P/An, in E2*."""
    return _named(dataset["P"] / (np.pi * dataset["a"] ** 2), "p_mean")


def number_of_spots(dataset: xr.Dataset) -> xr.DataArray:
    """Number of contact spots N̄ An; NaN where there is no roughness."""
    return _named(_spots(dataset).where(dataset["micro"] != "smooth"), "spots")


def spot_radius(dataset: xr.Dataset) -> xr.DataArray:
    """Radius of the central contact spot b = sqrt(λ/(π N̄)), Eq. (11), in R; NaN where there is no roughness."""
    return _named(_spot_radius(dataset).where(dataset["micro"] != "smooth"), "b0")


def peak_pressure(dataset: xr.Dataset) -> xr.DataArray:
    """Largest real pressure over the points of the profile, Eq. (13) at each, in E2*; `p_max` is that of the middle.

    The two differ on a hard coating with a > h, which bends like a plate and presses most near the edge. Needs the
    profiles p and lam.
    """
    b = np.sqrt(dataset["lam"] / (np.pi * _given(dataset, "Nbar")))
    E1 = xr.where(dataset["base"] == "half_space", 1.0, _given(dataset, "n"))
    spot = 2 / np.pi * (E1 * b / _given(dataset, "Ra") + dataset["p"] * np.arcsin(np.sqrt(dataset["lam"])))
    return _named(xr.where(dataset["micro"] == "smooth", dataset["p"], spot).max("x"), "p_peak")


def effective_modulus(dataset: xr.Dataset) -> xr.DataArray:
    """Effective reduced modulus E_eff = (dP/dD)/(2a), in E2*.

    A smooth punch on a half-space has E_eff = E*. On a layer E_eff is that of a flat punch of radius a, whatever the
    shape of the smooth punch, since dP/dD at p(a) = 0 does not change with a; roughness lowers it.
    """
    return _named(dataset["dP_dD"] / (2 * dataset["a"]), "E_eff")


def from_layered(dataset: xr.Dataset, name: str) -> xr.DataArray:
    """Relative error of a quantity on the thin layer against the exact layer; `base` is a dimension of the dataset.

    NaN where the thin-layer equation does not apply.
    """
    error = dataset[name].sel(base="thin_layer", drop=True) / dataset[name].sel(base="layered", drop=True) - 1
    error.attrs = {"long_name": f"{attributes(name)['long_name']}: thin layer over exact layer, less 1", "units": "1"}
    return error


def _spots(dataset: xr.Dataset) -> xr.DataArray:
    return _given(dataset, "Nbar") * np.pi * dataset["a"] ** 2


def _spot_radius(dataset: xr.Dataset) -> xr.DataArray:
    return np.sqrt(dataset["lam0"] / (np.pi * _given(dataset, "Nbar")))


def _given(dataset: xr.Dataset, name: str) -> xr.DataArray:
    """A parameter, NaN when the study does not have it."""
    if name not in dataset:
        return xr.DataArray(np.nan)
    return dataset[name]


def _named(array: xr.DataArray, name: str) -> xr.DataArray:
    if any(coordinate.attrs.get("units", "1") != "1" for coordinate in array.coords.values()):
        raise ValueError(
            f"{name} is derived from dimensionless datasets: derive first, then convert with study.to_physical"
        )
    array = array.rename(name)
    array.attrs = attributes(name)
    return array
