"""Selection by texts with units: `sel(h="3 um")` along a dimension of SI numbers."""

from typing import Any

import xarray as xr
from xarray.indexes import PandasIndex

from ..scene.quantities import has_unit
from ..spec.vocabulary import VOCABULARY
from .names import SCENE, si, unit_of


class UnitIndex(PandasIndex):
    """An index of SI numbers in which `sel(h="3 um")`, and slices of such texts, find 3e-6."""

    def sel(self, labels: dict, method=None, tolerance=None):
        """As that of other indexes of xarray. Raises ValueError for a text without a unit, or of something else."""
        name, label = next(iter(labels.items()))

        def number(one: Any) -> Any:
            return si(name, one).value if isinstance(one, str) or has_unit(one) else one

        if isinstance(label, slice):
            label = slice(number(label.start), number(label.stop), label.step)
        else:
            label = [number(one) for one in label] if isinstance(label, (list, tuple)) else number(label)
        return super().sel({name: label}, method=method, tolerance=tolerance)


def searchable(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with a UnitIndex along each dimension whose coordinate has a unit."""
    for name in dataset.dims:
        known = name in SCENE or name in VOCABULARY
        if known and dataset[name].attrs.get("units", "1") == unit_of(name) != "1":
            dataset = dataset.drop_indexes(name, errors="ignore").set_xindex(name, UnitIndex)
    return dataset
