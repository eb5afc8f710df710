"""The assumptions of the model that `validity` looks at: their limits, their masks, their texts."""

import tomllib
from collections.abc import Mapping
from importlib.resources import files

import numpy as np
import xarray as xr

from solver.kernels.two_layers import layer_modulus
from solver.laws import LAWS

from ..inputs.vocabulary import VOCABULARY, attributes

FEW_SPOTS = 100.0
"""Fewest asperities in touch: the model spreads them evenly, so they must be many. Of equal heights N̄πa² touch."""
SPOT_OVER_LAYER = 0.1
"""The micro law takes the layer for a half-space: the central spot must be small against it, b <= 0.1 h."""
PITCH_OVER_LAYER = 2.0
"""A layer bends between asperities whose pitch 1/sqrt(N̄) is larger than this times h. A[p] then errs: by up to 2.4 %
where the pitch is 2 h, by up to 11 % where it is 3 h (`make validate`, docs/validate.md)."""
NOT_THIN = 0.1  # largest model error of a thin layer: `make validity` prints and draws where it reaches these 10 %
MERGING = 0.4
"""Largest λ(0) of spots that do not merge: the disc cell then overestimates A[p] by 10 % against a square lattice of
asperities and by 11 % against a hexagonal one, λ and p_max err by 3 % (tests/laws/test_micro_lattice.py)."""
STEEP = 0.2
"""Largest a/R: Tabor's representative strain 0.2 a/R (The Hardness of Metals, 1951) is then 4 %, and the sphere is at
r = a by (a/R)²/4 = 1 % deeper than the paraboloid r²/2R. Of two bodies of known radii R1 and R2 it is also the largest
a over the smaller of them: in a close cup R is far larger than both."""
COMPRESSED = 0.1
"""Largest compressive strain of the layer; linear elasticity errs by about as much. A layer that gives way itself has
the strain D/h. If rather the body below gives way, the strain of the layer is at most p(0)/E1*."""
STRETCHED = 0.1
"""A layer bent to the sphere is under tension, which bears a part of the pressure. Linear elasticity leaves that out.
This is the largest part of p(0) that it may bear. With a free edge at r = a it bears E1* h a²/(8 R³) if h < a (Föppl's
equations; tests/data/test_validity_stretched.py)."""
STEEP_SPOT = 0.5
"""Largest b(0)/Ra: the strain under an asperity, 0.2 b/Ra, is then 10 %, the sphere is 6 % deeper than the paraboloid,
and p_max = 0.32 E1* is above the hardness of any metal."""
_TEXTS = tomllib.loads((files(__package__) / "assumptions.toml").read_text(encoding="utf-8"))
ASSUMPTIONS = {1 << i: name for i, name in enumerate(_TEXTS)}


def assumption_texts(key: str) -> dict[str, str]:
    """Name of each assumption -> one of its texts in assumptions.toml, with the limits in it; "" where it has none."""
    return {name: own.get(key, "").format(**globals(), percent=100 * NOT_THIN) for name, own in _TEXTS.items()}


def validity(dataset: xr.Dataset) -> xr.DataArray:
    """Assumptions that each case violates, a sum of the masks of ASSUMPTIONS; 0: all hold. docs/model.md explains them.

    A case without numbers (see `status`) only gets the masks that need none. int32 over the dimensions of `status`.

    Raises ValueError for results with units, which hold it already: the masks compare with R = 1 and E2* = 1.
    """
    if has_units(dataset):
        raise ValueError("validity follows from results without units; those with units hold it: dataset.validity")
    return xr.DataArray(validity_of(dataset.variables), dataset["status"].coords, name="validity")


def validity_of(variables: Mapping, times: float = 1.0) -> xr.Variable:
    """`validity` of the variables of a dataset. It computes with arrays, since DataArrays take as long as a contact.

    variables : dimensionless; with R1 and R2, in R, where the radii of both bodies are known
    times : how many times beyond its limit an assumption counts as violated
    """
    status, used = variables["status"], variables["model_used"].attrs
    v = {name: _along(status.dims, own) for name, own in variables.items() if set(own.dims) <= set(status.dims)}
    layered, rough = v["base"] != "half_space", have("rough", v["micro"])
    h, n = v.get("h", np.nan), v.get("n", np.nan)
    E1 = np.where(layered, layer_modulus(n), 1.0) / (1 + v.get("m", 0.0))  # of layer and punch in series
    # By (13) this is at most b/Ra of the central spot. It also serves laws whose b(0) is a mean, and those without Ra.
    steep = np.pi / 2 * (v.get("p_max", np.nan) - v["p0"]) / E1
    compressed = (v["D"] > times * COMPRESSED * h) & (v["p0"] > times * COMPRESSED * layer_modulus(n))
    stretched = layer_modulus(n) * np.minimum(h, v["a"]) * v["a"] ** 2 > 8 * times * STRETCHED * v["p0"]
    models = zip(used["flag_values"], used["flag_meanings"].split(), strict=True)
    thin = sum(v["model_used"] == value for value, word in models if word.endswith("thin_layer")) > 0
    violated = {
        1: thin & (v["model_error"] > times * NOT_THIN),
        2: rough & (spots(v) * _touching(v) < FEW_SPOTS / times),
        4: layered & rough & (spot_radius(v) > times * SPOT_OVER_LAYER * h),
        8: (v["base"] == "thin_layer") & (n >= times),
        16: rough & have("smears", v["micro"]) & (v["lam0"] > times * MERGING),
        32: (v["a"] > times * STEEP) | layered & (compressed | stretched),
        64: rough & ((spot_radius(v) > times * STEEP_SPOT * v.get("Ra", np.nan)) | (steep > times * STEEP_SPOT)),
        128: layered & rough & (v.get("Nbar", np.nan) * (times * PITCH_OVER_LAYER * h) ** 2 < 1),
        256: v["a"] > times * STEEP * np.minimum(*(np.abs(v.get(name, np.nan)) for name in ("R1", "R2"))),
    }
    flags = sum((np.int32(mask) * where for mask, where in violated.items()), np.zeros(status.shape, np.int32))
    return xr.Variable(status.dims, flags, attributes("validity") | validity_attributes())


def validity_attributes() -> dict:
    """CF flags of `validity`."""
    masks = np.array(list(ASSUMPTIONS), dtype=np.int32)
    return {"flag_masks": masks, "flag_meanings": " ".join(ASSUMPTIONS.values())}


def _along(dims: tuple, variable: xr.Variable):
    """The numbers of a variable over some of the dimensions `dims`, of length 1 along the others."""
    if variable.dims == dims:
        return variable.data
    own = variable if variable.ndim < 2 else variable.transpose(*(dim for dim in dims if dim in variable.dims))
    return own.data[tuple(slice(None) if dim in own.dims else None for dim in dims)]


def have(feature: str, micro):
    """Whether the law of each case has a feature, such as "rough". A law that is not registered is taken to have it."""
    return sum(micro == name for name, law in LAWS.items() if not getattr(law, feature)) == 0


def _touching(values):
    """Share of the summits in the centre that touch: 1 of equal heights."""
    share = np.ones(())
    for law in [law for name, law in LAWS.items() if law.touching and np.any(values["micro"] == name)]:
        touch = law.touching(values["A0"], **{name: values.get(name, np.nan) for name in law.parameters})
        share = np.where(values["micro"] == law.name, touch, share)
    return share


def spots(values):
    return values.get("Nbar", np.nan) * np.pi * values["a"] ** 2


def spot_radius(values):
    return np.sqrt(values["lam0"] / (np.pi * values.get("Nbar", np.nan)))


def has_units(dataset: xr.Dataset) -> bool:
    """Whether the numbers are in SI units, also of a dataset without the coordinates that say it."""
    return any(own.attrs.get("units", "1") != "1" for name, own in dataset.variables.items() if name in VOCABULARY)
