"""A physical scene: what it gives the solver, and the results in SI units with their spreads."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr

from ..data.units import DONE
from ..spec.vocabulary import VOCABULARY
from .names import SCENE, UnitIndex, unit_of

#: Part of a spread by which an input is moved for its derivative: small against what is not linear, large against rtol.
STEP = 0.1
#: The dimension along which inputs are moved, while the cases are solved.
MOVED = "moved input"


@dataclass
class Scene:
    """A physical scene: `parameters` are dimensionless, for the solver; `dressed` gives its results in SI units.

    given : name -> SI values, a float or a DataArray; spreads : the same of the inputs that have spreads;
    dims : dimension while solving -> name of the parameter; labels : of the dimension `case`
    """

    given: dict = field(default_factory=dict)
    spreads: dict = field(default_factory=dict)
    dims: dict = field(default_factory=dict)
    labels: list = field(default_factory=list)
    parameters: dict = field(default_factory=dict)
    R: Any = 1.0
    E2_star: Any = 1.0

    def dressed(self, dataset: xr.Dataset) -> xr.Dataset:
        """The dimensionless results of `parameters` in SI units, the inputs as given, with spreads of the results."""
        changed = {}
        for name in dataset.variables:
            if name in VOCABULARY and VOCABULARY[name].powers != (0, 0):
                i, j = VOCABULARY[name].powers
                changed[name] = dataset[name].variable * _variable(self.E2_star**i * self.R**j)
                attributes = {key: text for key, text in dataset[name].attrs.items() if key != "scale"}
                changed[name].attrs = attributes | {"units": unit_of(name)}
        coords = {name: array for name, array in changed.items() if name in dataset.coords}
        found = dataset.assign_coords(coords)
        found = found.assign({name: array for name, array in changed.items() if name in dataset.data_vars})
        if MOVED in dataset.dims:
            found = _with_spreads(found)
        return self._named(found).assign_attrs({DONE: "SI; R, E1, E2 and E_punch are coordinates"})

    def _named(self, found: xr.Dataset) -> xr.Dataset:
        """With the inputs as coordinates in SI, under their own names."""
        inputs = {name for name in found.variables if name in self.given}
        found = found.drop_vars(inputs).rename_dims({dim: name for dim, name in self.dims.items() if dim in found.dims})
        for name, given in self.given.items():
            long_name = SCENE[name][1] if name in SCENE else VOCABULARY[name].long_name
            found = found.assign_coords({name: self._coordinate(given, name, long_name)})
        for name, spread in self.spreads.items():
            long_name = f"standard deviation of {name}, as given"
            found = found.assign_coords({f"{name}_spread": self._coordinate(spread, name, long_name)})
        if self.labels:
            found = found.assign_coords(label=("case", self.labels))
        for name in self.dims.values():
            if name in found.dims and unit_of(name) != "1":
                found = found.drop_indexes(name).set_xindex(name, UnitIndex)
        return found

    def _coordinate(self, given: Any, name: str, long_name: str) -> xr.Variable:
        """SI values as given, over the dimensions of the results, with the unit of the parameter `name`."""
        variable = _variable(given)
        variable = variable.isel({MOVED: 0}) if MOVED in variable.dims else variable
        dims = [self.dims.get(dim, dim) for dim in variable.dims]
        return xr.Variable(dims, variable.data, {"long_name": long_name, "units": unit_of(name)})


def _variable(value: Any) -> xr.Variable:
    return value.variable if isinstance(value, xr.DataArray) else xr.Variable((), value)


def _with_spreads(found: xr.Dataset) -> xr.Dataset:
    """The results as given, each with its standard deviation `NAME_spread`, to first order, of independent inputs."""
    centre = found.isel({MOVED: 0}).drop_vars(MOVED, errors="ignore")
    for name, array in found.data_vars.items():
        if MOVED not in array.dims or VOCABULARY[name].role not in ("control", "result", "profile"):
            continue
        if name in ("error", "model_error", "residual"):
            continue
        up, down = (array.isel({MOVED: slice(first, None, 2)}) for first in (1, 2))
        spread = np.sqrt((((up - down) / (2 * STEP)) ** 2).sum(MOVED, skipna=False))
        spread.attrs = {"long_name": f"standard deviation of {name}, from the spreads of the inputs"}
        spread.attrs["units"] = array.attrs.get("units", "1")
        centre[f"{name}_spread"] = spread
    return centre
