"""Selection by texts with units: `sel(h="3 um")` along a dimension of SI numbers."""

from typing import Any

import numpy as np
import xarray as xr
from xarray.indexes import PandasIndex

from ..inputs.lexicon import default, lexicon_in
from ..inputs.scene.scene import si
from ..specimen.quantities import has_unit


class _AsPandasIndex(type):
    """The class of UnitIndex, which counts as equal to PandasIndex.

    xarray aligns two arrays only if their indexes have equal classes. Results must be aligned where they are reindexed,
    or subtracted from values that were measured at some of their loads.
    """

    def __eq__(cls, other: Any) -> bool:
        return other is cls or other is PandasIndex

    def __hash__(cls) -> int:
        return hash(PandasIndex)


class UnitIndex(PandasIndex, metaclass=_AsPandasIndex):
    """An index of SI numbers in which `sel(h="3 um")`, and slices and lists of such texts, find 3e-6."""

    def sel(self, labels: dict, method=None, tolerance=None):
        """As that of other indexes of xarray. Raises ValueError for a text without a unit, or of something else."""
        (name, label), rows = next(iter(labels.items())), default().all_rows

        def number(value: Any) -> Any:
            text = isinstance(value, str) or has_unit(value)
            return si(name, value, lexicon=default()).value if text and name in rows else value

        if isinstance(label, slice):
            label = slice(number(label.start), number(label.stop), label.step)
        elif getattr(label, "dtype", None) is not None and label.dtype.kind in "OTU":  # an array of texts
            numbers = np.reshape([number(value) for value in np.asarray(label).ravel().tolist()], label.shape)
            label = label.copy(data=numbers) if isinstance(label, (xr.DataArray, xr.Variable)) else numbers
        else:
            label = [number(value) for value in label] if isinstance(label, (list, tuple)) else number(label)
        return super().sel({name: label}, method=method, tolerance=number(tolerance))

    def reindex_like(self, other, method=None, tolerance=None) -> dict:
        """As that of other indexes of xarray. Raises ValueError for texts: they would be the new coordinate."""
        texts = [label for label in other.index if isinstance(label, str)] if other.index.dtype.kind in "OTU" else ()
        if texts:
            raise ValueError(f'{other.dim}: give numbers in the SI unit here; texts such as "{texts[0]}" are for sel')
        return super().reindex_like(other, method=method, tolerance=tolerance)


def searchable(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with a UnitIndex along each dimension whose coordinate has a unit."""
    rows = lexicon_in(dataset).all_rows
    for name, variable in dataset.variables.items():
        unit = variable.attrs.get("units")
        if variable.dims == (name,) and name in rows and isinstance(unit, str) and unit == rows[name].unit != "1":
            dataset = dataset.drop_indexes(name, errors="ignore").set_xindex(name, UnitIndex)
    return dataset
