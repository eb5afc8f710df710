"""The cells below asperities that feel their layers, one for each contact, and the stresses below a spot of a cell."""

from itertools import product
from typing import NamedTuple

import numpy as np

from ...bases import is_stack
from ...body import BODIES
from ...fields.below_spots import EXACT, below_spot, below_summit
from ...kernels.transfer import Layered
from ...kernels.two_layers import layer_modulus
from ...laws.cell.members import Member, members
from ...laws.cell.spot import spots
from ...models.spot_pressure import largest_radius

#: A spot at the edge has no size. This contact fraction stands for it.
_LEAST = 1e-12


class FeltCell(NamedTuple):
    """The cell of one contact, in units E = Ra = l = 1.

    b : (S,), radii of the spots that are known. The first is in the centre; for random heights it is the largest there
    p : nominal pressure in the centre
    layers : :class:`~solver.kernels.transfer.Layered` of the contact
    pitch, unit : the length l in a, and the stress E l/Ra in E2*
    """

    member: Member
    b: np.ndarray
    p: float
    layers: Layered
    pitch: float
    unit: float

    @property
    def h(self):
        return 1 / self.member.cell.pitch

    @property
    def bottom(self):
        """The number of the body, and the depth of its top in l."""
        tops = self.layers.tops(np.array([self.h]))[0]
        return len(tops) - 1, tops[-1]

    def stresses(self, b, r, z, region, last=EXACT):
        """sr, st, sz and trz (4, Z, R) of the cell below a spot of radius b:
        :func:`~solver.fields.below_spots.below_spot` or :func:`~solver.fields.below_spots.below_summit`."""
        cell = self.member.cell
        if self.member.alone:
            return below_summit(cell, b, self.p, self.layers, r, z, region, last)
        return below_spot(cell, spots(cell, [b]), self.layers, r, z, region, last)


def felt_cells(scaled, a, lam, p0):
    """A list with a :class:`FeltCell` for each of B cases whose asperities feel their layers, or None if the law has no
    family for it.

    scaled : the cases in units R = E2* = 1, of any laws; a : (B,), radii of the contacts
    lam : (B, S), λ at S radii, the first of which is the centre; NaN where only the centre is known
    p0 : (B,), nominal pressure in the centre
    """
    cells, stacked = [None] * len(scaled), is_stack(scaled.base)
    pitch, E = 1 / np.sqrt(scaled.Nbar), layer_modulus(scaled.n) / (1 + scaled.m)
    unit = E * pitch / scaled.Ra
    for micro, on_stack in product(dict.fromkeys(scaled.micro.tolist()), (False, True)):
        rows = np.flatnonzero((scaled.micro == micro) & (lam[:, 0] > 0) & np.isfinite(p0) & (stacked == on_stack))
        if not len(rows):
            continue
        part = scaled.take(rows) if on_stack else scaled.take(rows).but(base="layered")
        body = BODIES[str(part.base[0])](part)
        layers = body.kernel
        different, which = members(part.known.laws[micro].cell, pitch[rows] / part.h, layers, part.m)
        largest = largest_radius(part, body, lam[rows, 0], p0[rows])
        for place, (i, member, b) in enumerate(zip(rows, (different[j] for j in which), largest, strict=True)):
            if member.usable:
                others = np.zeros(0) if member.alone or np.isnan(lam[i]).any() else lam[i, 1:]
                radii = np.append(b, np.sqrt(np.maximum(others, _LEAST) / np.pi))
                cells[i] = FeltCell(member, radii, p0[i] / unit[i], layers.take([place]), pitch[i] / a[i], unit[i])
    return cells
