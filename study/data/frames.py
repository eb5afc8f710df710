"""The contacts of a dataset as rows: a line for each, and a line for each point of each profile."""

from typing import Any

import xarray as xr

from .dataset import decode


def frames(dataset: xr.Dataset) -> dict[str, Any]:
    """DataFrames of pandas: "contacts", a row for each; "profiles", a row for each point x = r/a, where there are some.

    The headings have units, "P (N)" or "P (E2* R^2)". The dimensions are the first columns. The other variables follow
    in the order of the dataset, each spread right after its value. Quantities of stacks have a column for each layer or
    interface. status, model_used and validity are words.
    """
    words = {name: decode(array) for name, array in dataset.data_vars.items() if "flag_meanings" in array.attrs}
    dataset = dataset.assign(words).reset_coords(drop=False)
    dims = list(dataset["status"].dims)
    dataset = _one_of_each([dim for dim in ("layer", "interface") if dim in dataset.dims and dim not in dims], dataset)
    along_x = [name for name, array in dataset.data_vars.items() if "x" in array.dims]
    tables = {"contacts": dataset.drop_vars([*along_x, "x"], errors="ignore")}
    if along_x:
        tables["profiles"] = dataset[along_x]
    return {name: _frame(table, [*dims, *["x"] * (name == "profiles")]) for name, table in tables.items()}


def _one_of_each(numbered: list[str], dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with a variable for each layer or interface, "mises_layer 1" and so on, in place of one over all."""
    columns = {}
    for name, array in dataset.data_vars.items():
        dim = next((dim for dim in numbered if dim in array.dims), None)
        count = dataset.sizes[dim] if dim else 0
        columns |= {f"{name} {j + 1}": array.isel({dim: j}, drop=True) for j in range(count)} or {name: array}
    return xr.Dataset(columns, dataset.drop_dims(numbered).coords, dataset.attrs) if numbered else dataset


def _frame(table: xr.Dataset, dims: list) -> Any:
    headings = {name: _heading(str(name), array) for name, array in table.variables.items()}
    order = [*dims, *_spreads_after_values([name for name in map(str, table.data_vars) if name not in dims])]
    if not dims:
        table = table.expand_dims("contact")
    return table.to_dataframe().reset_index()[order].rename(columns=headings)


def _spreads_after_values(names: list[str]) -> list[str]:
    spreads = {name: f"{name}_spread" for name in names if f"{name}_spread" in names}
    values = [name for name in names if name not in spreads.values()]
    return [column for name in values for column in (name, spreads.get(name)) if column]


def _heading(name: str, array: xr.Variable) -> str:
    unit = array.attrs.get("scale") or array.attrs.get("units", "1")
    return name if unit == "1" else f"{name} ({unit})"
