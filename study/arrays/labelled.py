"""An array with names of its dimensions and attributes: what datasets are made of, before there is one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from . import xarray_later as xr


class Labelled(np.lib.mixins.NDArrayOperatorsMixin):
    """As a Variable of xarray, with what is needed before a dataset is made: arithmetic, by the names of dimensions.
    For whatever else is asked of it, it becomes one.

    dims : names, one a dimension
    data : array, of numpy or dask
    attrs, encoding : as those of a Variable
    """

    def __init__(self, dims: str | Sequence[str], data: Any, attrs: dict | None = None, encoding: dict | None = None):
        self.dims = (dims,) if isinstance(dims, str) else tuple(dims)
        self.data = data if hasattr(data, "__array_function__") else np.asarray(data)
        self.attrs, self.encoding = dict(attrs or {}), dict(encoding or {})

    @classmethod
    def of(cls, variable: xr.Variable) -> Labelled:
        """A Variable of xarray as a Labelled."""
        return cls(variable.dims, variable.data, variable.attrs, variable.encoding)

    def to_xarray(self) -> xr.Variable:
        """The Variable of xarray. Of plain numbers and texts it is made without xarray's checks: these import dask."""
        plain = type(self.data) is np.ndarray and self.data.dtype.kind in "biufU"
        return xr.Variable(self.dims, self.data, self.attrs, self.encoding, fastpath=plain)

    def to_axis(self) -> xr.Variable:
        """The Variable of xarray of a coordinate along its own dimension. xarray makes an index of it, and would import
        pint to do so; of plain numbers the index is made here."""
        if not (type(self.data) is np.ndarray and self.data.dtype == np.float64):
            return self.to_xarray()
        import pandas as pd

        return xr.IndexVariable(self.dims, pd.Index(self.data), self.attrs, self.encoding, fastpath=True)

    @property
    def values(self) -> np.ndarray:
        return np.asarray(self.data)

    @property
    def shape(self) -> tuple[int, ...]:
        return self.data.shape

    @property
    def ndim(self) -> int:
        return len(self.dims)

    @property
    def dtype(self) -> np.dtype:
        return self.data.dtype

    def over(self, dims: tuple) -> Any:
        """The array over all of `dims`, of length 1 along those that it lacks."""
        return along(dims, self)

    def transpose(self, *dims: str) -> Labelled:
        """The array with its dimensions in this order."""
        return Labelled(dims, self.data.transpose([self.dims.index(dim) for dim in dims]), self.attrs, self.encoding)

    def item(self) -> Any:
        """The value of an array without dimensions."""
        return self.values.item()

    def any(self) -> bool:
        """Whether some value is true."""
        return bool(self.values.any())

    def all(self) -> bool:
        """Whether each value is true."""
        return bool(self.values.all())

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.to_xarray(), name)

    def max(self, dim: str | None = None) -> Any:
        """The largest along a dimension; NaN counts only where all are NaN."""
        if dim is None:
            return self.to_xarray().max()
        axis = self.dims.index(dim)
        return Labelled(self.dims[:axis] + self.dims[axis + 1 :], np.fmax.reduce(self.values, axis=axis))

    def __float__(self) -> float:
        return float(self.values)

    def __bool__(self) -> bool:
        return bool(self.values)

    def __getitem__(self, place: int) -> Labelled:
        return Labelled(self.dims[1:], self.data[place], self.attrs)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.array(self.values, dtype=dtype, copy=copy)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        if method != "__call__" or options:
            return NotImplemented
        if any(hasattr(one, "dims") and not isinstance(one, Labelled) for one in inputs):  # of xarray
            return ufunc(*(as_xarray(one) if isinstance(one, Labelled) else one for one in inputs))
        dims = tuple(dict.fromkeys(dim for one in inputs if isinstance(one, Labelled) for dim in one.dims))
        return Labelled(dims, ufunc(*(one.over(dims) if isinstance(one, Labelled) else one for one in inputs)))


def along(dims: tuple, variable: Labelled | xr.Variable) -> Any:
    """The numbers of a variable over some of the dimensions `dims`, of length 1 along the others."""
    if variable.dims == dims:
        return variable.data
    own = variable if variable.ndim < 2 else variable.transpose(*(dim for dim in dims if dim in variable.dims))
    return own.data[tuple(slice(None) if dim in own.dims else None for dim in dims)]


def as_xarray(variable: Labelled | xr.Variable, name: str = "") -> xr.Variable:
    """A Variable of xarray, if it is not one already; `name` : of a coordinate."""
    if not isinstance(variable, Labelled):
        return variable
    return variable.to_axis() if variable.dims == (name,) else variable.to_xarray()
