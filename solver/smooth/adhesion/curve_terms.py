"""Load and depth at many radii, each as two terms: that of the shape alone, and the pull of the adhesion.

Along the curve of a contact with adhesion P = P₀ - pull_P and D = D₀ - pull_D. All four terms are positive, smooth
functions of the radius. Under :mod:`.jkr` they are proportional to powers of w and E, so they are computed once for the
curves of all works of adhesion.
"""

from typing import NamedTuple

import numpy as np

from ...body import BODIES
from ...body.graded import is_graded
from ...scaling import dimensionless, with_rigid_punch
from ...shapes import shape_of
from ..galerkin import respond
from ..radius import Radii
from ..tabulated_body import where_slow
from .jkr import Jkr
from .maugis import Maugis, ring_stress

#: Two numbers m of sublayers in each octave of a graded layer. The terms are extrapolated from both: errors fall like
#: 1/m².
SUBLAYERS = (4, 8)


class CurveTerms(NamedTuple):
    """P₀, D₀, pull_P and pull_D, in units R = E2* = 1: `values` (4, B, m), and their derivatives `slopes` (4, B, m) by
    the variable of :class:`~..radius.Radii`. NaN where there is no contact."""

    values: np.ndarray
    slopes: np.ndarray


def curve_terms(problem, x):
    """:class:`CurveTerms` of B contacts with w > 0, of one base, shape and law of adhesion, in units R = E2* = 1.

    x : (B, m), the radii, in the variable of :class:`~..radius.Radii`; the value of the problem's control is ignored
    """
    if not is_graded(problem).any():
        return _curve_terms(problem, x)
    few, many = (_curve_terms(problem.but(sublayers=np.full(len(problem), count)), x) for count in SUBLAYERS)
    return CurveTerms(*extrapolated(few, many))


def radii_of(problem, x):
    """The radii (B, m) at x (B, m) of :class:`~..radius.Radii` of B contacts, in units R = E2* = 1."""
    shape, index = shape_of(dimensionless(with_rigid_punch(problem))), np.repeat(np.arange(len(x)), x.shape[1])
    return Radii(shape).at(x.ravel(), index)[0].reshape(x.shape)


def extrapolated(few, many):
    """The arrays of graded layers, extrapolated from those with few and with many sublayers, :data:`SUBLAYERS`."""
    return ((4 * more - less) / 3 for less, more in zip(few, many, strict=True))


def _curve_terms(problem, x):
    rigid = with_rigid_punch(problem)
    part, (rows, points) = dimensionless(rigid), x.shape
    shape, body = shape_of(part), where_slow(BODIES[str(part.base[0])](part))
    index = np.repeat(np.arange(rows), points)
    with np.errstate(all="ignore"):
        a, da = Radii(shape).at(x.ravel(), index)
        values, slopes = _at(part.take(index), shape.take(index), body.take(index), a)
    unit = np.stack([rigid.E2, np.ones(rows)] * 2)[:, :, None]  # R is 1
    return CurveTerms(values.reshape(4, rows, points) * unit, (slopes * da).reshape(4, rows, points) * unit)


def _at(part, shape, body, a):
    """The four terms (4, b), and their derivatives by the radius a (b,)."""
    r, none = respond(shape, body, a), 0 * a
    free, grows = (r.P, r.D), (r.S * r.slope, r.slope)
    word = str(part.adhesion[0])
    if word == "dmt":
        return np.array([*free, 2 * np.pi * part.w_adhesion, none]), np.array([*grows, none, none])
    law = Jkr(shape, body, part.w_adhesion)
    if word == "maugis":
        law = Maugis(shape, body, part.w_adhesion, ring_stress(part))
    state = law.at(a)
    pulls = (r.P - state.P, r.D - state.D), (grows[0] - state.dP, grows[1] - state.dD)
    return np.array([*free, *pulls[0]]), np.array([*grows, *pulls[1]])
