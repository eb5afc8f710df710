"""The families of cells on coated bodies, with their peaks, which are kept: docs/model.md."""

from typing import NamedTuple

from ...numerics.kept import Kept
from .family import different, family
from .peak import peaks, summit_peaks
from .rows import of_kernel
from .spot import Cell
from .summits import SUMMIT

__all__ = ["Member", "members", "peaks_of"]

#: Bytes of the peaks that are kept: some 2,000 of families whose largest pressure leaves the middle.
_kept = Kept(2e7)


class Member(NamedTuple):
    """A family: the key that tells it from others, its :class:`~.spot.Cell`, and its largest radius (unit l); `known`
    is False of a body that no law knows. `alone` : its spots have loads of their own (:mod:`.summits`)."""

    key: tuple
    cell: Cell
    reach: float
    known: bool
    alone: bool = False


def members(lattice, pitch, kernel, m):
    """The different :class:`Member` of B cases, a list, and the index (B,) of that of each; arguments as of
    :func:`~.family.families`, where the lattice may be "summit"."""
    alone = lattice == SUMMIT
    lattice = "disc" if alone else lattice
    first, index = different(lattice, pitch, kernel, m)
    distinct = []
    for key, i in first:
        solved = family(key, kernel, m, i)
        cell = Cell(lattice, key[2], of_kernel(kernel.take([i]), float(m[i])))
        distinct.append(Member((*key, alone), cell, solved.reach, solved.known, alone))
    return distinct, index


def peaks_of(member):
    """The :class:`~.peak.Peaks` of a family, or :class:`~.peak.SummitPeaks`, kept for the next time."""
    make = summit_peaks if member.alone else peaks
    return _kept.get(member.key, lambda: make(member.cell, member.reach))
