"""Stresses below the spots of a family by their radius: a table, for the largest stress of many spots.

They are those of the waves G != 0 of a cell (:mod:`~solver.fields.below_spots`), in the layer, over Hertz's pressure of
a lone spot of the radius, 2 b/pi (E = Ra = l = 1), at depths down to 1.5 b or h, whichever is less, and at radii in b.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from ...fields.below_spots import ROUGH, below_spot
from ...laws.cell.peak import may_leave_the_middle
from ...laws.cell.spot import pieces, spots
from ...numerics.kept import Kept
from ..peaks import chebyshev_nodes

#: Radii of the table below _SMALL h, in b, and by powers of ln(b/(_SMALL h)) beyond, in that.
_SMALL, _FEW, _MORE = 1 / 1.5, 13, (6, 4, 1)
#: Depths, the last at _DEEP b or at h; and radii from the axis, in angles arcsin(r/b), if the largest stress may be
#: beside it. With 40 and 49 the largest stresses are the same to 1e-5 (tests/yields/test_felt_spots.py).
_DEPTHS, _DEEP, _RADII = 14, 1.5, 17
#: Where the reach and the limit differ by less, they are the same.
_SAME = 1e-12
#: Bytes of the tables that are kept: some 200 with radii beside the axis.
_kept = Kept(4e7)


class Table(NamedTuple):
    """Below spots of radii up to `reach` (unit l): sr, st, sz, trz over 2 b/pi at Z depths, nodes of Chebyshev with
    both ends between 0 and the :func:`deepest`, and at R such nodes of arcsin(r/b), or on the axis alone.

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
        """The stresses (B, 4, Z, R) at radii b (B,) up to the reach, E = Ra = l = 1."""
        few, b = b <= self.limit, np.minimum(b, self.reach)
        out = np.empty((len(b), *self.small.shape[1:]))
        along = 2 * np.log(b / self.limit) / np.log(max(self.reach / self.limit, 1 + _SAME)) - 1
        for some, x, series in ((few, 2 * b / self.limit - 1, self.small), (~few, along, self.large)):
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
    """The depth down to which stresses are looked at, of any unit: 1.5 b, or h where that is less."""
    return np.minimum(_DEEP * b, h)


def table_of(felt):
    """The :class:`Table` of the family of a :class:`~.felt_cells.FeltCell`, kept for the next time; or :class:`One`, of
    its spot, if that has a load of its own."""
    member = felt.member
    if member.alone:
        rho, z = _places(member.cell, felt.b[0])
        return One(felt.stresses(felt.b[0], felt.b[0] * rho, z, 0, ROUGH))
    return _kept.get(member.key, lambda: _made(member.cell, felt.layers, member.reach))


def _places(cell, b):
    """Radii from the axis in b, and depths in l, at which a table has the stresses below a spot of radius b."""
    beside = may_leave_the_middle(cell)
    rho = np.sin(np.pi / 4 * (1 + chebyshev_nodes(_RADII))) if beside else np.zeros(1)
    return rho, deepest(b, 1 / cell.pitch) * (1 + chebyshev_nodes(_DEPTHS)) / 2


def _made(cell, layers, reach):
    limit, N = min(_SMALL / cell.pitch, reach), pieces(cell, reach)
    count = int(np.polynomial.polynomial.polyval(np.log(reach / limit), _MORE)) if reach > limit else 1
    nodes = [-np.cos(np.pi * (np.arange(terms) + 0.5) / terms) for terms in (_FEW, count)]
    radii = limit * (1 + nodes[0]) / 2, limit * (reach / limit) ** ((1 + nodes[1]) / 2)
    series = []
    for x, b in zip(nodes, radii, strict=True):
        values = []
        for radius in b:
            spot, (rho, z) = spots(cell, [radius], N), _places(cell, radius)
            values.append(below_spot(cell, spot, layers, radius * rho, z, 0, ROUGH) / (2 * radius / np.pi))
        matrix = np.linalg.inv(chebvander(x, len(x) - 1))
        series.append(np.tensordot(matrix, np.array(values), 1))
    return Table(reach, limit, *series)
