"""A folder of parts, the files of large results, as one dataset. The attributes of the parts must fit together."""

import os
import re
from dataclasses import replace
from math import prod
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from .access import Unusable
from .examine import Condition, examine
from .netcdf import File, read_lazily, read_together

DIVIDED = "parts"
"""Attribute of a part of large results: number of parts along each dimension that is cut, "h 5, n 2"."""
FIRST = "first_case"
"""Attribute of a part: the number of its first case. Parts of earlier versions lack it."""
NAME = re.compile(r"(\d{12})-([0-9a-f]{16})\.nc")  # of a part: its first case and the digest of the study
REMEDY = "run the study, which computes the right ones"


class PartFile(NamedTuple):
    """A part as its file describes it.

    counts : number of parts along each dimension that is cut
    axes : dimension -> values of its coordinate
    first : number of the first case by the name of the file
    stated : number of the first case by its attribute; None if it has none
    """

    path: Path
    digest: str
    counts: dict[str, int]
    axes: dict[str, np.ndarray]
    first: int
    stated: int | None

    @property
    def size(self) -> int:
        return prod(map(len, self.axes.values()))


def open_parts(folder: Path) -> xr.Dataset:
    """The dataset of all parts in a folder, lazily.

    Raises Unusable unless they are all parts of one study, each in the place that its name says. Parts of earlier
    versions show their place only by their coordinates, which must fit those of the other parts.
    """
    parts = [_described(path) for path in sorted(folder.glob("*.nc"))]
    counts = parts[0].counts
    if len({(part.digest, str(part.counts)) for part in parts}) > 1 or len(parts) != prod(counts.values()):
        raise Unusable(folder, "foreign", f"has {len(parts)} files, not all {prod(counts.values())} parts of one study")
    begin, strangers = 0, _strangers(parts, counts)
    for number, part in enumerate(parts):
        if part.first != begin or part.stated not in (None, begin) or number in strangers:
            raise Unusable(part.path, "misplaced", f"holds other cases than its name says; {REMEDY}")
        begin += part.size
    return opened_together([part.path for part in parts], folder, counts)


def _strangers(parts: list[PartFile], counts: dict[str, int]) -> set[int]:
    """The numbers of the parts whose coordinates do not fit those of the others."""
    numbers, strangers = np.arange(len(parts)).reshape(tuple(counts.values())), set[int]()
    for dim in parts[0].axes:
        cut = np.moveaxis(numbers, [*counts].index(dim), 0) if dim in counts else numbers
        seen = set()
        for row in cut.reshape(counts.get(dim, 1), -1).tolist():  # parts with the same values of this dimension
            values = parts[row[0]].axes[dim]
            strangers |= {number for number in row if not np.array_equal(parts[number].axes.get(dim), values)}
            strangers |= {row[0]} if seen & {*values.tolist()} else set()
            seen |= {*values.tolist()}
    return strangers


def named(condition: Condition) -> Condition:
    """The condition of a file. A sound part of large results is "misplaced" if its name says other cases."""
    name = NAME.fullmatch(condition.path.name)
    if condition.kind != "sound" or not name:
        return condition
    with File(condition.path) as file:
        first = file.attributes.get(FIRST, int(name[1]))
    if (int(first), condition.digest[:16]) == (int(name[1]), name[2]):
        return replace(condition, name="")
    return replace(condition, kind="misplaced", reason="holds other cases than its name says")


def opened_together(paths: list[Path], folder: Path, counts: dict[str, int]) -> xr.Dataset:
    """The dataset of parts that have been checked.

    counts : number of parts along each dimension that is cut
    """
    nested = np.array([os.fspath(path) for path in paths], dtype=object).reshape(tuple(counts.values())).tolist()
    dataset = read_together(nested, folder, list(counts)) if counts else read_lazily(paths[0])
    for name in (DIVIDED, FIRST):
        dataset.attrs.pop(name, None)
    return dataset


def divided(text: str) -> dict[str, int]:
    """The counts in the attribute DIVIDED. Raises ValueError for a text without counts."""
    words = [word.split(" ") for word in text.split(", ") if word]
    return {dim: int(number) for dim, number in words}


def _described(path: Path) -> PartFile:
    """A part by its attributes. Raises Unusable for a file that is not a part of large results."""
    condition = examine(path, most=0)
    condition.raise_if_bad()
    name = NAME.fullmatch(path.name)
    with File(path) as file:
        try:
            axes = {dim: file.read(dim) for dim in condition.sizes}
            counts, stated = divided(str(file.attributes.get(DIVIDED, ""))), file.attributes.get(FIRST)
        except (KeyError, IndexError, ValueError):  # not our results
            axes = {}
    if not axes or not name or not {*counts} <= {*axes}:
        raise Unusable(path, "foreign", "is not a part of the results in this folder; move it away")
    if name[2] != condition.digest[:16]:
        raise Unusable(path, "misplaced", f"holds results of another study than its name says; {REMEDY}")
    return PartFile(path, condition.digest, counts, axes, int(name[1]), None if stated is None else int(stated))
