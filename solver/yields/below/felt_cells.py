"""The cells below asperities that feel their layers, one for each contact, and the stresses below a spot of a cell."""

from itertools import product
from typing import NamedTuple

import numpy as np

from ...bases import is_stack
from ...body import BODIES
from ...body.graded import graded_first, sublayers_of
from ...fields.below_spots import EXACT, below_spot, below_summit
from ...fields.stacks.section import Section
from ...kernels.transfer import Layered
from ...laws.cell.members import Member, members
from ...laws.cell.spot import spots
from ...models.spot_pressure import largest_radius
from ...scaling import felt_body, felt_sublayers, of_one_law

#: A spot at the edge has no size. This contact fraction stands for it.
_LEAST = 1e-12


class FeltCell(NamedTuple):
    """The cell of one contact, in units E = Ra = l = 1.

    b : (S,), radii of the spots that are known. The first is in the centre; for random heights it is the largest there
    p : nominal pressure in the centre
    layers : :class:`~solver.kernels.transfer.Layered` of the contact. A graded layer is cut into sublayers there
    pitch, unit : the length l in a, and the stress E l/Ra in E2*
    graded : :class:`~...fields.stacks.section.Section` of these layers, lengths in l, if the first is graded, or None
    """

    member: Member
    b: np.ndarray
    p: float
    layers: Layered
    pitch: float
    unit: float
    graded: Section | None = None

    @property
    def tops(self):
        """The depth of the top of each region, sublayers included."""
        return self.layers.tops(np.array([1 / self.member.cell.pitch]))[0]

    @property
    def below(self):
        """The number of the region below the first layer, all its sublayers included."""
        return 1 if self.graded is None else int(self.graded.last[0]) + 1

    @property
    def h(self):
        """Thickness of the first layer."""
        return self.tops[self.below]

    @property
    def bottom(self):
        """The number of the body, and the depth of its top in l."""
        return len(self.tops) - 1, self.tops[-1]

    def stresses(self, b, r, z, region, last=EXACT, N=None):
        """sr, st, sz and trz (4, Z, R) of the cell below a spot of radius b, at depths z (Z,).

        region : of :attr:`layers`; 0 is the whole first layer
        last : largest kh of the waves, with the thickness h of the first layer or sublayer
        N : the pieces of the kernel, :func:`~solver.laws.cell.spot.pieces`, if the caller has them
        """
        if region or self.graded is None:
            return self._in_region(b, r, z, region, last, N)
        sublayers, stresses = self.graded.region_of(z, np.zeros(len(z), dtype=int)), np.empty((4, len(z), len(r)))
        for j in np.unique(sublayers):
            rows = np.flatnonzero(sublayers == j)
            # waves reach the top of a sublayer with e^(-k top)
            least = last * min(1.0, self.tops[1] / max(self.tops[j], self.tops[1]))
            sr, st, *others = self._in_region(b, r, z[rows], int(j), least, N)
            of_total, of_axial, more = (v[:, None] for v in self.graded.of_depth(0, sublayers[rows], z[rows]))
            total, difference = of_total * (sr + st) + of_axial * others[0], more * (sr - st)
            stresses[:, rows] = (total + difference) / 2, (total - difference) / 2, *others
        return stresses

    def _in_region(self, b, r, z, region, last, N):
        """:func:`~solver.fields.below_spots.below_spot` or :func:`~solver.fields.below_spots.below_summit`."""
        cell = self.member.cell
        if self.member.alone:
            return below_summit(cell, b, self.p, self.layers, r, z, region, last)
        return below_spot(cell, spots(cell, [b], N), self.layers, r, z, region, last)


def felt_cells(scaled, a, lam, p0):
    """A list with a :class:`FeltCell` for each of B cases whose asperities feel their layers, or None if the law has no
    family for it.

    scaled : the cases in units R = E2* = 1, of any laws; a : (B,), radii of the contacts
    lam : (B, S), λ at S radii, the first of which is the centre; NaN where only the centre is known
    p0 : (B,), nominal pressure in the centre
    """
    cells, pitch = [None] * len(scaled), 1 / np.sqrt(scaled.Nbar)
    for rows, part, graded in _alike(scaled, (lam[:, 0] > 0) & np.isfinite(p0)):
        body = felt_body(part) if graded else BODIES[str(part.base[0])](part)
        layers, unit = body.kernel, body.E * pitch[rows] / part.Ra
        different, which = members(part.known.laws[str(part.micro[0])].cell, pitch[rows] / body.h, layers, body.m)
        largest = largest_radius(part, body, lam[rows, 0], p0[rows])
        for place, (i, member, b) in enumerate(zip(rows, (different[j] for j in which), largest, strict=True)):
            if member.usable:
                others = np.zeros(0) if member.alone or np.isnan(lam[i]).any() else lam[i, 1:]
                radii = np.append(b, np.sqrt(np.maximum(others, _LEAST) / np.pi))
                alone, p, scale = layers.take([place]), p0[i] / unit[place], (pitch[i] / a[i], unit[place])
                section = _section(part.take([place]), alone, member) if graded else None
                cells[i] = FeltCell(member, radii, p, alone, *scale, section)
    return cells


def _alike(scaled, some):
    """Yield, of cases `some` (B,) bool that share a law and a kind of body: their indices, the cases, and whether the
    first layer is graded."""
    stacked, graded = is_stack(scaled.base), graded_first(scaled)
    for micro, on_stack, cut in product(dict.fromkeys(scaled.micro.tolist()), (False, True), (False, True)):
        rows = np.flatnonzero(some & (scaled.micro == micro) & (stacked == on_stack) & (graded == cut))
        if len(rows):
            part = scaled.take(rows) if on_stack else scaled.take(rows).but(base="layered")
            for few in of_one_law(part) if cut else [np.arange(len(rows))]:
                yield rows[few], part.take(few), cut


def _section(case, stack, member):
    """The layers below the asperities of one case, as :class:`FeltCell` has them if the first is graded."""
    layers, sublayers, octaves = felt_sublayers(case)
    last = np.cumsum(sublayers_of(layers, sublayers, octaves=octaves)) - 1
    h = np.array([1 / member.cell.pitch])
    return Section(stack, h, last, None, 0.0, np.zeros(len(last)), layers, case.known.profiles)
