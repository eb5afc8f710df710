"""An array with named dimensions and attributes: the part of which datasets are made, before there is a dataset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from . import xarray_later as xr


class Labelled(np.lib.mixins.NDArrayOperatorsMixin):
    """A light Variable of xarray, with arithmetic by the names of dimensions. For any other use it becomes a Variable.

    dims : name of each dimension
    data : array of numpy or dask
    attrs, encoding : as in a Variable
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
        """The Variable of xarray. Plain numbers and texts skip the checks of xarray, which import dask."""
        plain = type(self.data) is np.ndarray and self.data.dtype.kind in "biufU"
        return xr.Variable(self.dims, self.data, self.attrs, self.encoding, fastpath=plain)

    def to_axis(self) -> xr.Variable:
        """The Variable of xarray for a coordinate along its own dimension.

        xarray makes an index of it, and would import pint to do so. For plain numbers the index is made here.
        """
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
        if any(hasattr(operand, "dims") and not isinstance(operand, Labelled) for operand in inputs):  # xarray's
            return ufunc(*(as_xarray(operand) if isinstance(operand, Labelled) else operand for operand in inputs))
        dims = tuple(dict.fromkeys(dim for operand in inputs if isinstance(operand, Labelled) for dim in operand.dims))
        return Labelled(
            dims, ufunc(*(operand.over(dims) if isinstance(operand, Labelled) else operand for operand in inputs))
        )


def along(dims: tuple, variable: Labelled | xr.Variable) -> Any:
    """The numbers of a variable over some of the dimensions `dims`, of length 1 along the others."""
    if variable.dims == dims:
        return variable.data
    ordered = variable if variable.ndim < 2 else variable.transpose(*(dim for dim in dims if dim in variable.dims))
    return ordered.data[tuple(slice(None) if dim in ordered.dims else None for dim in dims)]


def as_xarray(variable: Labelled | xr.Variable, name: str = "") -> xr.Variable:
    """The Variable of xarray.

    name : of a coordinate
    """
    if not isinstance(variable, Labelled):
        return variable
    return variable.to_axis() if variable.dims == (name,) else variable.to_xarray()
