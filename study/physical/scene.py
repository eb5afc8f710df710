"""A physical scene: its inputs in SI units, what the solver gets, and the results in SI units with their spreads."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import xarray as xr

from ..data.dataset import Parts
from ..data.units import PHYSICAL_SCALE, physical_attributes, with_unit
from ..inputs.definition import Definition
from ..inputs.grid import MOVED
from ..inputs.vocabulary import ROWS, VOCABULARY
from .index import searchable

#: Part of its spread by which an input is moved, for the derivatives by central differences. It is small, so that the
#: curvature does not count (1e-4 in test_spreads_of_hertz), and large against rtol.
STEP = 0.1
ASSUMED = "not given: the default"
SAME_PIECE = "same_piece: bodies of one material are one piece of it"
#: Results that get no spread.
_WITHOUT_SPREAD = ("error", "profile_error", "model_error", "residual")


@dataclass
class Scene:
    """A physical scene.

    given : input -> its SI values, a float or a DataArray
    spreads : input -> standard deviations, likewise; only of inputs that have some
    parameters : dimensionless, for the solver
    R, unit : radius (m) and modulus (Pa) that are 1 for the solver; the modulus is E2*, or E1* on a rigid base
    dims : dimension while the cases are solved -> name of it in the results
    labels : of the dimension `case`
    names : punch, layer, body -> (dimension or "", names of materials along it)
    given_in : coordinate -> the cases that have it, a DataArray; without a layer a case may have none
    assumed : interface and Poisson ratios that count and are not given, so that they have their defaults
    same_piece : whether bodies of one material are one piece of it
    """

    given: dict = field(default_factory=dict)
    spreads: dict = field(default_factory=dict)
    dims: dict = field(default_factory=dict)
    labels: list = field(default_factory=list)
    names: dict = field(default_factory=dict)
    given_in: dict = field(default_factory=dict)
    assumed: tuple = ()
    same_piece: bool = False
    parameters: dict = field(default_factory=dict)
    R: Any = 1.0
    unit: Any = 1.0

    def sizes(self, axes: list[str]) -> dict[str, int]:
        """Dimension while the cases are solved -> its length; first `case`, then the axes in their order."""
        dim_of, found = {name: dim for dim, name in self.dims.items()}, {}
        arrays = [v for v in (*self.given.values(), *self.parameters.values()) if isinstance(v, xr.DataArray)]
        known = {dim: size for array in arrays for dim, size in array.sizes.items()}
        for dim in ("case", *(dim_of.get(axis, axis) for axis in axes)):
            if dim in known:
                found[dim] = known[dim]
            elif isinstance(self.parameters.get(dim), list):
                found[dim] = len(self.parameters[dim])
        return found

    def radii(self) -> dict[str, xr.Variable]:
        """R1 and R2 of two bodies in R, over the dimensions while the cases are solved; {} where R was given."""
        return {name: _variable(self.given[name] / self.R) for name in ("R1", "R2") if name in self.given}

    def within(self, window: dict[str, slice]) -> "Scene":
        """The scene of the cases in a window: a slice for each dimension that there is while the cases are solved."""

        def cut(value: Any) -> Any:
            if not isinstance(value, xr.DataArray):
                return value
            return value.isel({dim: part for dim, part in window.items() if dim in value.dims})

        tables = (self.given, self.spreads, self.given_in)
        given, spreads, given_in = ({name: cut(v) for name, v in table.items()} for table in tables)
        labels = self.labels[window["case"]] if self.labels else []
        names = {body: (dim, texts[window[dim]] if dim else texts) for body, (dim, texts) in self.names.items()}
        changed = {"given": given, "spreads": spreads, "given_in": given_in, "labels": labels, "names": names}
        return replace(self, **changed, R=cut(self.R), unit=cut(self.unit))

    def results(self, parts: Parts) -> xr.Dataset:
        """The dataset in SI units, made of the dimensionless results: inputs as given, results with their spreads."""
        results, coords = {}, {}
        for name, variable in (parts.variables | parts.coords).items():
            if name in self.given or name == MOVED:
                continue
            known = name in VOCABULARY and VOCABULARY[name].powers != (0, 0)
            found = _in_si(name, variable, self.unit, self.R) if known else variable
            if MOVED in found.dims:
                results |= _spread(name, found, parts.variables.get("model_used"))
                found = found.isel({MOVED: 0})
            (coords if name in parts.coords else results)[name] = found
        coords |= {name: _coordinate(name, self._as_given(name, value)) for name, value in self.given.items()}
        for name, value in self.spreads.items():
            coords[f"{name}_spread"] = _coordinate(name, value, f"standard deviation of {name}, as given")
        for body, (dim, texts) in self.names.items():
            values = texts if dim else texts[0]
            about = {"comment": SAME_PIECE} if self.same_piece and self.spreads else {}
            coords[body] = xr.Variable(dim or (), values, {"long_name": f"material of the {body}"} | about)
        for name, there in self.given_in.items():
            if name in coords:
                coords[name] = coords[name].where(there.variable, "" if name == "layer" else np.nan)
        if self.labels:
            coords["label"] = xr.Variable("case", self.labels)
        for name in self.assumed:
            coords[name].attrs["comment"] = ASSUMED
        attributes = parts.attributes | {PHYSICAL_SCALE: "SI; R, E1, E2 and E_punch are coordinates"}
        return searchable(Parts(self._renamed(results), self._renamed(coords), attributes).dataset())

    def _as_given(self, name: str, value: Any) -> Any:
        """An input over the dimensions in which it was given. Where it was moved with another body it has more."""
        if MOVED not in getattr(value, "dims", ()):
            return value
        own = getattr(self.spreads.get(name, value), "dims", ())
        return value.isel({dim: 0 for dim in value.dims if dim not in own or dim == MOVED})

    def _renamed(self, variables: dict[str, xr.Variable]) -> dict[str, xr.Variable]:
        """The variables over the dimensions that the results have."""
        if not self.dims:
            return variables
        dims = {name: [self.dims.get(dim, dim) for dim in variable.dims] for name, variable in variables.items()}
        return {name: xr.Variable(dims[name], v.data, v.attrs, v.encoding) for name, v in variables.items()}


def dataset_of(definition: Definition, parts: Parts) -> xr.Dataset:
    """The dataset of a study: in SI units if the study has units, else dimensionless."""
    return definition.scene.results(parts) if definition.scene else parts.dataset()


def _coordinate(name: str, value: Any, long_name: str = "") -> xr.Variable:
    """SI values of the input `name`, or their spreads, as given, with the unit."""
    return _variable(value, {"long_name": long_name or ROWS[name].long_name} | _units(ROWS[name].unit))


def _variable(value: Any, attributes: dict | None = None) -> xr.Variable:
    dims, data = (value.dims, value.data) if isinstance(value, xr.DataArray) else ((), value)
    return xr.Variable(dims, data, attributes)


def _units(unit: str) -> dict[str, str]:
    """The attribute `units`; a pure number has none."""
    return {} if unit == "1" else {"units": unit}


def _in_si(name: str, variable: xr.Variable, unit: Any, R: Any) -> xr.Variable:
    """A dimensionless variable in the SI unit of its name, its dimensions first."""
    powers, dims = VOCABULARY[name].powers, variable.dims
    if isinstance(unit, xr.DataArray) or isinstance(R, xr.DataArray):
        found = with_unit(variable, powers, _variable(unit), _variable(R)).transpose(*dims, ...)
        dims, data = found.dims, found.data
    else:  # the usual case is made quick: arithmetic of labelled arrays takes as long as a contact
        data = with_unit(variable.data, powers, unit, R)
    data = data.astype(variable.dtype, copy=False)
    return xr.Variable(dims, data, physical_attributes(name, variable.attrs), variable.encoding)


def _spread(name: str, variable: xr.Variable, used: xr.Variable | None) -> dict[str, xr.Variable]:
    """{"NAME_spread": standard deviation of a result}, {} for a result that gets none.

    It is the root of Σ (∂result/∂input · spread of the input)², to first order, for independent inputs. Inputs of one
    piece are moved at once, so that they count as one.

    used : `model_used`, None of coordinates alone. On the base auto the cases moved up and down may be solved by two
        models, and a step from one model to another is no derivative. Then the case as given is compared with the moved
        one that has its model.
    """
    if VOCABULARY[name].role not in ("control", "result", "profile") or name in _WITHOUT_SPREAD:
        return {}
    (given, up, down), (own, plus, minus) = (
        [v.isel({MOVED: part}) for part in (0, slice(1, None, 2), slice(2, None, 2))] for v in (variable, used)
    )
    change = up - down
    if not (plus.data == minus.data).all():
        of_one_side = (2 * (up - given)).where(plus == own, (2 * (given - down)).where(minus == own))
        change = change.where((plus == minus) | change.isnull(), of_one_side)
    spread = np.sqrt(((change / (2 * STEP)) ** 2).sum(MOVED, skipna=False))
    long_name = f"standard deviation of {name}, from the spreads of the inputs"
    spread.attrs = {"long_name": long_name} | _units(VOCABULARY[name].unit)
    return {f"{name}_spread": spread}
