"""The cells of asperities that feel their bodies, and what is kept of each family: docs/model.md."""

from typing import NamedTuple

from ...numerics.kept import Kept
from .family import different, family
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
    first, index = different(lattice, pitch, kernel, m)
    made = []
    for key, i in first:
        own = family(key, kernel, m, i)
        made.append(Member(key, Cell(lattice, key[1], of_kernel(kernel.take([i]), float(m[i]))), own.reach, own.known))
    return made, index


def peaks_of(member) -> Peaks:
    """The :class:`~.peak.Peaks` of a family, kept for the next time."""
    return _kept.get(member.key, lambda: peaks(member.cell, member.reach))
