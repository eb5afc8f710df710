"""A table of the stresses below the spots of a family as functions of their radius, for the largest stress of many
spots.

They are the stresses of the waves G != 0 of a cell (:mod:`~solver.fields.below_spots`) in the layer, over Hertz's
pressure of a lone spot of this radius, 2 b/pi (E = Ra = l = 1). Depths go down to the smaller of 1.5 b and h; radii are
in b.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from ...fields.below_spots import ROUGH
from ...laws.cell.peak import may_leave_the_middle
from ...laws.cell.spot import pieces
from ...numerics.caches import Cache
from ..peaks import chebyshev_nodes

#: Number of radii b of the table up to _SMALL h, where the series are in b; and beyond, where they are in ln b, the
#: number as a polynomial in ln of the largest b/(_SMALL h), with these coefficients.
_SMALL, _FEW, _MORE = 1 / 1.5, 13, (6, 4, 1)
#: Number of depths, the last of which is at _DEEP b or at h; and number of radii from the axis, nodes of the angle
#: arcsin(r/b), if the largest stress may be off the axis. With 40 and 49 the largest stresses are the same to 1e-5
#: (tests/yields/test_felt_spots.py).
_DEPTHS, _DEEP, _RADII = 14, 1.5, 17
#: The reach and the limit are the same if they differ by less than this part.
_SAME = 1e-12
#: The tables in use, at most this many bytes: some 200 tables with radii off the axis.
_cache = Cache(4e7)


class Table(NamedTuple):
    """The stresses sr, st, sz, trz over 2 b/pi below spots with radii up to `reach`, in l. They are at Z depths,
    Chebyshev's nodes from 0 to the :func:`deepest`, and at R such nodes of arcsin(r/b), or only on the axis.

    small, large : Chebyshev series (terms, 4, Z, R), in b up to `limit`, and in ln b beyond
    """

    reach: float
    limit: float
    small: np.ndarray
    large: np.ndarray

    @property
    def shape(self):
        """Numbers of depths and of radii."""
        return self.small.shape[2:]

    def at(self, b):
        """The stresses (B, 4, Z, R) for radii b (B,) up to the reach, in units E = Ra = l = 1."""
        small, b = b <= self.limit, np.minimum(b, self.reach)
        out = np.empty((len(b), *self.small.shape[1:]))
        along = 2 * np.log(b / self.limit) / np.log(max(self.reach / self.limit, 1 + _SAME)) - 1
        for some, x, series in ((small, 2 * b / self.limit - 1, self.small), (~small, along, self.large)):
            if some.any():
                out[some] = np.tensordot(chebvander(x[some], len(series) - 1), series, 1)
        return out * (2 * b / np.pi)[:, None, None, None]


class One(NamedTuple):
    """The `stresses` (4, Z, R) below one spot, in place of a table."""

    stresses: np.ndarray

    @property
    def shape(self):
        return self.stresses.shape[1:]

    def at(self, b):
        return np.repeat(self.stresses[None], len(b), axis=0)


def deepest(b, h):
    """The depth down to which stresses are computed, in any unit of length: the smaller of 1.5 b and h."""
    return np.minimum(_DEEP * b, h)


def table_of(felt):
    """The :class:`Table` of the family of a :class:`~.felt_cells.FeltCell`, from the cache; or the :class:`One` of its
    spot, if that has a load of its own."""
    member = felt.member
    if member.alone:
        rho, z = _places(felt, felt.b[0])
        return One(felt.stresses(felt.b[0], felt.b[0] * rho, z, 0, ROUGH))
    return _cache.get((member.key, *profile_of(felt)), lambda: _table(felt))


def profile_of(felt):
    """The words and numbers of a graded first layer, (); nothing of a uniform one."""
    return () if felt.graded is None else tuple(values[0, 0] for values in felt.graded.graded.values())


def _places(felt, b):
    """Radii from the axis, in b, and depths, in l, at which a table has the stresses below a spot of radius b."""
    off_axis = may_leave_the_middle(felt.member.cell)
    rho = np.sin(np.pi / 4 * (1 + chebyshev_nodes(_RADII))) if off_axis else np.zeros(1)
    return rho, deepest(b, felt.h) * (1 + chebyshev_nodes(_DEPTHS)) / 2


def _table(felt):
    cell, reach = felt.member.cell, felt.member.reach
    limit, N = min(_SMALL * felt.h, reach), pieces(cell, reach)
    count = int(np.polynomial.polynomial.polyval(np.log(reach / limit), _MORE)) if reach > limit else 1
    nodes = [-np.cos(np.pi * (np.arange(terms) + 0.5) / terms) for terms in (_FEW, count)]
    radii = limit * (1 + nodes[0]) / 2, limit * (reach / limit) ** ((1 + nodes[1]) / 2)
    series = []
    for x, b in zip(nodes, radii, strict=True):
        values = []
        for radius in b:
            rho, z = _places(felt, radius)
            values.append(felt.stresses(radius, radius * rho, z, 0, ROUGH, N) / (2 * radius / np.pi))
        matrix = np.linalg.inv(chebvander(x, len(x) - 1))
        series.append(np.tensordot(matrix, np.array(values), 1))
    return Table(reach, limit, *series)
