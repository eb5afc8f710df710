"""The families of cells on coated bodies, and their peaks, which are cached: docs/coated_body.md."""

from typing import NamedTuple

from ...numerics.caches import Cache
from .family import different, family
from .peak import peaks, summit_peaks
from .rows import of_kernel
from .spot import Cell
from .summits import SUMMIT

__all__ = ["Member", "members", "peaks_of"]

#: The peaks in use, at most this many bytes: some 2,000 families whose largest pressure leaves the middle.
_peaks = Cache(2e7)


class Member(NamedTuple):
    """A family: the key that tells it from others, its :class:`~.spot.Cell`, and its largest radius, in l.

    usable : False if no law can use the family
    alone : whether its spots have loads of their own (:mod:`.summits`)
    """

    key: tuple
    cell: Cell
    reach: float
    usable: bool
    alone: bool = False


def members(lattice, pitch, kernel, m):
    """The different families of B cases, a list of :class:`Member`, and the index (B,) of each case's family. Arguments
    as in :func:`~.family.families`; the lattice may also be "summit"."""
    alone = lattice == SUMMIT
    lattice = "disc" if alone else lattice
    first, index = different(lattice, pitch, kernel, m)
    distinct = []
    for key, i in first:
        solved = family(key, kernel, m, i)
        cell = Cell(lattice, key[2], of_kernel(kernel.take([i]), float(m[i])))
        distinct.append(Member((*key, alone), cell, solved.reach, solved.usable, alone))
    return distinct, index


def peaks_of(member):
    """The :class:`~.peak.Peaks` of a family, or its :class:`~.peak.SummitPeaks`, from the cache."""
    make = summit_peaks if member.alone else peaks
    return _peaks.get(member.key, lambda: make(member.cell, member.reach))
