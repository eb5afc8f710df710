"""The section through the layers below one contact on a stack, and the field in it.

A graded layer is cut into uniform sublayers. Displacements and tractions are continuous at their interfaces; the
stresses within the plane are not. So these are computed with the modulus of the layer at the depth itself, and are
continuous too.
"""

from typing import NamedTuple

import numpy as np

from ...body.graded import at_depths, graded_among, sublayers_of
from ...body.stacked import kernel_of, layers_of
from ...kernels.stack import Stack
from .. import normal, sliding
from ..field import integrals
from ..pressure import Pressure

#: Number of sublayers of a graded layer in each octave of the depth, by default; and number of octaves in the first
#: layer. With twice as many, in 5 octaves, the stresses change by about their `error`
#: (tests/stacks/test_stresses_of_stacks.py).
SUBLAYERS, _OCTAVES = 8, 4


#: A depth over that of an interface, up to which it lies in the upper layer: places of extremes may exceed h by their
#: last bits.
INTERFACE = 1 + 1e-14


class Section(NamedTuple):
    """The N layers below one contact; lengths are in a, stresses in the unit of the problem.

    stack : :class:`~solver.kernels.stack.Stack` of one case, with all sublayers; h : (1,), thickness of its first layer
    last : (N,), index of the last sublayer of each layer
    pressure : :class:`~..pressure.Pressure`; mu : >= 0, friction
    residual : (N,), residual stress of each layer
    graded : numbers of the layers, key -> (1, N); None if no layer is graded
    profiles : tables of profiles
    """

    stack: Stack
    h: np.ndarray
    last: np.ndarray
    pressure: Pressure
    mu: float
    residual: np.ndarray
    graded: dict | None
    profiles: dict

    @classmethod
    def of(cls, scaled, a, pressure, mu, residual):
        """The section of one case of a problem in units R = E2* = 1, with the radius a (1,). residual : (N,)"""
        layers = layers_of(scaled)
        sublayers = np.where(scaled.sublayers == 0, SUBLAYERS, scaled.sublayers)
        stack, h = kernel_of(scaled.but(sublayers=sublayers), octaves=_OCTAVES)
        last = np.cumsum(sublayers_of(layers, sublayers, octaves=_OCTAVES)) - 1
        graded = layers if graded_among(layers).any() else None
        return cls(stack, h / a, last, pressure, mu, np.asarray(residual, dtype=float), graded, scaled.known.profiles)

    @property
    def ends(self):
        """(N,), the depth of the interface below each layer."""
        return self.stack.tops(self.h)[0, self.last + 1]

    @property
    def rigid(self):
        return bool(self.stack.rigid[0])

    def numbers(self, z, lower=False):
        """The layer of the depths z (Z,), counted from 0, or N for the body. A depth at an interface belongs to the
        upper layer, or to the lower one if `lower`."""
        return np.searchsorted(self.ends * (1.0 if lower else INTERFACE), z, side="right" if lower else "left")

    def field(self, r, z, number, displacements=True, roughly=False):
        """Name -> (Z, R), at radii r (R,) and depths z (Z,) in the layers `number` (Z,), counted from 0, or N for the
        body. Displacements are times the unit of stress. With mu > 0 there are also the amplitudes of sliding, times
        mu. `displacements`: whether there are displacements, or only stresses."""
        region = self.region_of(z, number)
        here = self.stack, self.h, self.pressure, r, z[None], region, roughly
        G2 = self.stack.shear[0, region][:, None]
        field = {}
        for kind, factor in ((normal, 1.0), (sliding, self.mu)):
            if factor:
                load = kind.LOAD if displacements else kind.LOAD.of_stresses()
                whole = integrals(load, *here)[:, 0]
                field |= {name: factor * values for name, values in kind.components(whole, G2).items()}
        if "ux_0" in field and self.stack.slips[0]:
            field["ux_0"] = np.full_like(field["ux_0"], np.nan)
        if self.graded:
            self._at_their_depth(field, z, number, region)
        return field

    def stresses(self, r, z, number, roughly=False):
        """sr, st, sz, trz (4, S, Z, R), including the residual stresses, for each of the S `signs`."""
        field = self.field(r, z, number, False, roughly)
        sides = [sliding.in_plane(field, sign < 0) for sign in self.signs] if self.mu > 0 else [field]
        stresses = np.array([[side[name] for side in sides] for name in normal.NAMES[:4]])
        stresses[:2] += np.append(self.residual, 0.0)[number][:, None]
        return stresses

    @property
    def signs(self):
        """The signs of x in the plane y = 0, since with sliding the leading and the trailing side differ."""
        return (1.0, -1.0) if self.mu > 0 else (1.0,)

    def region_of(self, z, number):
        """Which sublayer the depths z (Z,) in the layers `number` (Z,) are in, (Z,)."""
        tops = self.stack.tops(self.h)[0]
        first = np.append(0, self.last + 1)
        inner = np.searchsorted(tops, z, side="right") - 1
        return np.clip(inner, first[number], np.append(self.last, self.last[-1] + 1)[number])

    def is_graded(self, number):
        """Whether a layer, or the body, is graded."""
        return bool(self.graded) and number < len(self.last) and bool(graded_among(self.graded)[number])

    def of_depth(self, number, region, z):
        """What makes the stresses that the modulus at depths z (Z,) of a graded layer makes, from those of its
        sublayers `region` (Z,), under the same strains in the plane and the same sz: sr + st is the first times
        sr + st plus the second times sz, and sr - st the third times sr - st; (Z,) each."""
        top, end = np.append(0.0, self.ends)[number : number + 2]
        share = np.clip((z - top) / (end - top), 0.0, 1.0)
        n, nu = (values[0] for values in at_depths(self.graded, number, share[None], self.profiles))
        old, more = self.stack.poisson[0, region], n * (1 - nu) / self.stack.shear[0, region]
        of_strain = (1 + nu) * more / ((1 + old) * (1 - nu))
        return of_strain * (1 - old), 2 * nu / (1 - nu) - 2 * old * of_strain, more

    def _at_their_depth(self, field, z, number, region):
        """Change the stresses of `field` in graded layers to those with the modulus at their depth."""
        for j in np.flatnonzero(graded_among(self.graded)):
            rows = np.flatnonzero(number == j)
            of_total, of_axial, more = (v[:, None] for v in self.of_depth(j, region[rows], z[rows]))
            for end in ("", "_c") if self.mu > 0 else ("",):
                sr, st, sz = (field[f"{name}{end}"][rows] for name in ("sr", "st", "sz"))
                total, difference = of_total * (sr + st) + of_axial * sz, more * (sr - st)
                field[f"sr{end}"][rows] = (total + difference) / 2
                field[f"st{end}"][rows] = (total - difference) / 2
            if self.mu > 0:
                field["srt_s"][rows] *= more
