"""Results in the multiples of SI units in which they are read: µm, mN, GPa."""

import numpy as np
import xarray as xr

from ..specimen.quantities import READABLE, multiple
from .units import PHYSICAL_SCALE


def readable(dataset: xr.Dataset) -> xr.Dataset:
    """A dataset in SI units with each variable in the multiple that suits its largest number, for plots and tables.

    Coordinates have it too: a thickness of 2e-6 m is found by sel(h=2.0), in the µm of its attribute `units`. A spread
    has the multiple of its quantity.

    Raises ValueError for a dataset without physical units.
    """
    if PHYSICAL_SCALE not in dataset.attrs:
        raise ValueError("the dataset is dimensionless: study.to_physical gives it units")
    found = {}
    for name, variable in dataset.variables.items():
        owner = dataset.variables.get(str(name).removesuffix("_spread"), variable)
        unit = variable.attrs.get("units", "1")
        if unit not in READABLE or unit == "1" or variable.dtype.kind != "f":
            continue
        finite = np.abs(owner.values[np.isfinite(owner.values)])
        word, size = multiple(finite.max() if finite.size else np.inf, unit)
        found[name] = xr.Variable(variable.dims, variable.data / size, variable.attrs | {"units": word})
    scale = "readable multiples of SI units, by the attribute units"
    return dataset.assign(found).assign_attrs({PHYSICAL_SCALE: scale})
