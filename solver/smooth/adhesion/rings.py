"""Rings of attraction at many radii and of many widths: separately the part of the shape and that of the attraction.

Under :mod:`.maugis` the load, the depth and the gap at the outer edge of a ring are linear in the stress σ₀:

    P = P₀ + σ₀ load,    D = D₀ + σ₀ depth,    w/σ₀ = gap + σ₀ opening.

So the rings of a body are computed once for the curves of all works of adhesion and all stresses.
"""

from typing import NamedTuple

import numpy as np

from ...body import BODIES
from ...body.graded import is_graded
from ...scaling import dimensionless, with_rigid_punch
from ...shapes import shape_of
from ..radius import Radii
from ..tabulated_body import where_slow
from .curve_terms import SUBLAYERS, extrapolated
from .maugis import Maugis

#: σ₀/E of the two rings that give the parts. To the last digit, only the shape counts with the first and only the
#: attraction with the second, so no digits are lost by subtraction.
_WEAK, _STRONG = 1e-30, 1e30


class Rings(NamedTuple):
    """gap, opening, load and depth (B, m), in units R = E2* = 1; NaN where there is no such ring."""

    gap: np.ndarray
    opening: np.ndarray
    load: np.ndarray
    depth: np.ndarray


def rings(problem, x, width):
    """:class:`Rings` of B contacts of one base and shape, in units R = E2* = 1.

    x : (B, m), the radii, in the variable of :class:`~..radius.Radii`; the value of the problem's control is ignored
    width : (B, m), widths c - a of the rings. If the profile ends at the distance d beyond the edge of the contact, the
        ring is d width/(d + width) wide instead
    """
    if not is_graded(problem).any():
        return _rings(problem, x, width)
    return Rings(*extrapolated(*(_rings(problem.but(sublayers=np.full(len(problem), n)), x, width) for n in SUBLAYERS)))


def _rings(problem, x, width):
    rigid = with_rigid_punch(problem)
    part, index = dimensionless(rigid), np.repeat(np.arange(len(problem)), x.shape[1])
    shape, body = shape_of(part), where_slow(BODIES[str(part.base[0])](part))
    with np.errstate(all="ignore"):
        a, _ = Radii(shape).at(x.ravel(), index)
        left, width = shape.most()[index] - a, width.ravel()
        over = np.log(np.where(np.isfinite(left), width * left / (width + left), width) / a)
        every = np.tile(index, 2)
        sigma = np.repeat([_WEAK, _STRONG], len(a)) * body.E[every]
        ring = Maugis(shape.take(every), body.take(every), np.ones_like(sigma), sigma).ring(*np.tile([a, over], 2))
        gap, opening = (ring.w / sigma).reshape(2, -1)
        load, depth, sigma = (values.reshape(2, -1)[1] for values in (ring.P, ring.D, sigma))
        unit = rigid.E2[index]  # of stresses
        parts = gap, opening / (sigma * unit), load / sigma, depth / (sigma * unit)
    return Rings(*(values.reshape(x.shape) for values in parts))
