"""The cells of asperities that feel their bodies, and what is kept of each family: docs/model.md."""

from typing import NamedTuple

import numpy as np

from ...numerics.kept import Kept
from .family import families, kernel_keys, rounded
from .peak import Peaks, peaks
from .rows import of_kernel
from .spot import Cell

__all__ = ["Member", "members", "peaks_of"]

#: Bytes of the peaks that are kept: some 2,000 of families whose largest pressure leaves the middle.
_kept = Kept(2e7)


class Member(NamedTuple):
    """A family: what tells it from others, its :class:`~.spot.Cell`, and its largest radius (unit l); `known` is False
    of a body that no law knows."""

    key: tuple
    cell: Cell
    reach: float
    known: bool


def members(lattice, pitch, kernel, m):
    """The different :class:`Member` of B cases, a list, and the index (B,) of that of each; arguments as of
    :func:`~.family.families`."""
    of_cases, index = families(lattice, pitch, kernel, m)
    first = np.unique(index, return_index=True)[1]
    keys, pitch = kernel_keys(kernel.take(first), m[first]), rounded(pitch[first])
    made = []
    for i, family, key, l_h in zip(first, of_cases, keys, pitch.tolist(), strict=True):
        cell = Cell(lattice, l_h, of_kernel(kernel.take([i]), float(m[i])))
        made.append(Member((lattice, l_h, key), cell, family.reach, family.known))
    return made, index


def peaks_of(member) -> Peaks:
    """The :class:`~.peak.Peaks` of a family, kept for the next time."""
    return _kept.get(member.key, lambda: peaks(member.cell, member.reach))
