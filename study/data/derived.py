"""Quantities that follow from a dataset: validity of the model's assumptions, areas, mean pressure, number of spots.

Every function takes an opened dimensionless dataset and returns a DataArray whose attributes come whole from the
vocabulary.
"""

import numpy as np
import xarray as xr

from ..spec.vocabulary import attributes

FEW_SPOTS = 100.0
"""The model spreads the asperities evenly: with fewer spots than this in the nominal area, N̄πa², they are not many."""
SPOT_OVER_LAYER = 0.1
"""The micro law takes the layer for a half-space: the central spot must be small against it, b <= 0.1 h."""
NOT_THIN = 0.1
"""Largest model error of a thin layer: `make validity` prints and draws where it reaches these 10 %."""
MERGING = 0.4
"""Largest λ(0) of spots that do not merge: the disc cell then overestimates A[p] by 10 % against a square lattice of
asperities and by 11 % against a hexagonal one, λ and p_max err by 3 % (tests/laws/test_micro_lattice.py)."""
STEEP = 0.2
"""Largest a/R: Tabor's representative strain 0.2 a/R (The Hardness of Metals, 1951) is then 4 %, and the sphere is at
r = a by (a/R)²/4 = 1 % deeper than the paraboloid r²/2R."""
COMPRESSED = 0.1
"""Largest compressive strain of the layer; linear elasticity errs by about as much as the strain. It is D/h where the
layer gives way, and where the body below does, no more than p(0)/E1*."""
ASSUMPTIONS = {
    1: "layer_not_thin",
    2: "few_spots",
    4: "spot_not_small_against_h",
    8: "n_not_below_one",
    16: "spots_merging",
    32: "strain_not_small",
}


def validity(dataset: xr.Dataset) -> xr.DataArray:
    """Assumptions that each case violates, a sum of masks; 0: all hold.

    1 model error of a thin layer > NOT_THIN; 2 N̄πa² < FEW_SPOTS; 4 b(0) > SPOT_OVER_LAYER h on a layer of any kind;
    8 n >= 1 on a thin layer asked for by name (the paper assumes n < 1); 16 λ(0) > MERGING; 32 a/R > STEEP, or both D/h
    and p(0)/E1* > COMPRESSED. A case without numbers (see `status`) only gets the masks that need none. int32 over the
    dimensions of `status`.
    """
    layered, rough = dataset["base"] != "half_space", dataset["micro"] != "smooth"
    thin = _used_a_thin_layer(dataset["model_used"])
    h, n = _given(dataset, "h"), _given(dataset, "n")
    compressed = (dataset["D"] > COMPRESSED * h) & (dataset["p0"] > COMPRESSED * n)
    violated = {
        1: thin & (dataset["model_error"] > NOT_THIN),
        2: rough & (_spots(dataset) < FEW_SPOTS),
        4: layered & rough & (_spot_radius(dataset) > SPOT_OVER_LAYER * h),
        8: (dataset["base"] == "thin_layer") & (n >= 1),
        16: rough & (dataset["lam0"] > MERGING),
        32: (dataset["a"] > STEEP) | layered & compressed,
    }
    flags = xr.zeros_like(dataset["status"], dtype=np.int32)
    for mask, where in violated.items():
        flags = flags + np.int32(mask) * where.astype(np.int32)
    flags = named(flags, "validity")
    flags.attrs["flag_masks"] = np.array(list(ASSUMPTIONS), dtype=np.int32)
    flags.attrs["flag_meanings"] = " ".join(ASSUMPTIONS.values())
    return flags


def _used_a_thin_layer(model_used: xr.DataArray) -> xr.DataArray:
    words = zip(model_used.attrs["flag_values"], model_used.attrs["flag_meanings"].split(), strict=True)
    return model_used.isin([value for value, word in words if word.endswith("thin_layer")])


def nominal_area(dataset: xr.Dataset) -> xr.DataArray:
    """Nominal contact area An = πa², in R²."""
    return named(np.pi * dataset["a"] ** 2, "An")


def nominal_area_ratio(dataset: xr.Dataset, a0) -> xr.DataArray:
    """Nominal contact area over that of the radius a0, An/(π a0²)."""
    return named((dataset["a"] / a0) ** 2, "An_ratio")


def mean_pressure(dataset: xr.Dataset) -> xr.DataArray:
    """Mean nominal pressure P/An, in E2*."""
    return named(dataset["P"] / (np.pi * dataset["a"] ** 2), "p_mean")


def number_of_spots(dataset: xr.Dataset) -> xr.DataArray:
    """Number of contact spots N̄ An; NaN where there is no roughness."""
    return named(_spots(dataset).where(dataset["micro"] != "smooth"), "spots")


def spot_radius(dataset: xr.Dataset) -> xr.DataArray:
    """Radius of the central contact spot b = sqrt(λ/(π N̄)), Eq. (11), in R; NaN where there is no roughness."""
    return named(_spot_radius(dataset).where(dataset["micro"] != "smooth"), "b0")


def peak_pressure(dataset: xr.Dataset) -> xr.DataArray:
    """Largest real pressure over the points of the profile, Eq. (13) at each, in E2*; `p_max` is that of the middle.

    The two differ on a hard coating with a > h, which bends like a plate and presses most near the edge. Needs the
    profiles p and lam.
    """
    b = np.sqrt(dataset["lam"] / (np.pi * _given(dataset, "Nbar")))
    E1 = xr.where(dataset["base"] == "half_space", 1.0, _given(dataset, "n"))
    spot = 2 / np.pi * (E1 * b / _given(dataset, "Ra") + dataset["p"] * np.arcsin(np.sqrt(dataset["lam"])))
    return named(xr.where(dataset["micro"] == "smooth", dataset["p"], spot).max("x"), "p_peak")


def effective_modulus(dataset: xr.Dataset) -> xr.DataArray:
    """Effective reduced modulus E_eff = (dP/dD)/(2a), in E2*.

    A smooth punch on a half-space has E_eff = E*. On a layer E_eff is that of a flat punch of radius a, whatever the
    shape of the smooth punch, since dP/dD at p(a) = 0 does not change with a; roughness lowers it.
    """
    return named(dataset["dP_dD"] / (2 * dataset["a"]), "E_eff")


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


def named(array: xr.DataArray, name: str) -> xr.DataArray:
    """The array under a name of the vocabulary, with its attributes. Raises ValueError for physical units."""
    if any(coordinate.attrs.get("units", "1") != "1" for coordinate in array.coords.values()):
        raise ValueError(
            f"{name} is derived from dimensionless datasets: derive first, then convert with study.to_physical"
        )
    array = array.rename(name)
    array.attrs = attributes(name)
    return array
