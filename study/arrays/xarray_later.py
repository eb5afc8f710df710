"""xarray, imported at its first use: ``from ..arrays import xarray_later as xr``.

The import takes as long as solving some thousand contacts, and a single contact in the terminal does not need it
(`make start`).
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from xarray import DataArray as DataArray
    from xarray import Dataset as Dataset
    from xarray import Variable as Variable


def __getattr__(name: str) -> Any:
    if name.startswith("__"):  # Python asks for __path__ when something is imported from here
        raise AttributeError(name)
    globals()[name] = member = getattr(import_module("xarray"), name)  # next time Python finds it directly
    return member


def is_array(value: Any) -> bool:
    """Whether a value is a DataArray. Before xarray is imported there are none."""
    xarray = sys.modules.get("xarray")
    return xarray is not None and isinstance(value, xarray.DataArray)


def is_dataset(value: Any) -> bool:
    """Whether a value is a Dataset."""
    xarray = sys.modules.get("xarray")
    return xarray is not None and isinstance(value, xarray.Dataset)
