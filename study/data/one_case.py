"""One contact, read like a dataset. None is made: xarray takes as long to import as thousand contacts to solve."""

from __future__ import annotations

from typing import Any

from solver.numerics.kept import once

from ..arrays import xarray_later as xr
from ..arrays.labelled import Labelled
from .dataset import DatasetParts


class OneCase:
    """A contact without dimensions but `x`: `contact["a"]`, `"h" in contact`, `contact.attrs` and so on, as of a
    dataset. For anything else `as_dataset` makes that.

    variables, coords : name -> Labelled, of all and of the coordinates
    attrs : of the dataset
    """

    def __init__(self, parts: DatasetParts):
        self.variables, self.coords, self.attrs = parts.variables | parts.coords, parts.coords, parts.attributes
        self._parts = parts

    @once
    def dataset(self) -> xr.Dataset:
        """The dataset of the contact."""
        return self._parts.dataset()

    def __contains__(self, name: str) -> bool:
        return name in self.variables

    def __getitem__(self, name: str) -> Labelled:
        return self.variables[name]

    def get(self, name: str, default: Any = None) -> Any:
        """The variable of a name, or the default."""
        return self.variables.get(name, default)


def as_dataset(contact: xr.Dataset | OneCase) -> xr.Dataset:
    """The dataset of a contact, whichever of both it is."""
    return contact.dataset if isinstance(contact, OneCase) else contact


def is_contact(value: Any) -> bool:
    """Whether it is a dataset, or one contact."""
    return isinstance(value, OneCase) or xr.is_dataset(value)
