"""The fit of the paper, Section 4.1: A = B Ra (p/E)^β, so that p* = E, A* = B Ra and g = q^β.

λ and p_max are those of the law that is fitted (:mod:`.disc_cell`) at the same pressure.
"""

import numpy as np

from ..parameters import Parameter
from . import disc_cell
from .law import Curve, Law

#: With a small β the pressure at the edge is below the smallest float. _LEAST y is added to q, so that q increases even
#: there. Below _LOST this term changes the digits of q: a case with such a pressure in the centre has no p_max.
_LEAST, _LOST = 1e-295, 1e-270


def _scales(E, Nbar, Ra, B, beta):
    """p*, A*, β, and the ratio of p* to the p* of the fitted law."""
    return E, B * Ra, beta, E / disc_cell.scales(E, Nbar, Ra)[0]


def _curve(y, beta, ratio):
    inverse = 2 / beta
    q = y**inverse
    return Curve(q + _LEAST * y, y * y, inverse * q / y + _LEAST, 2 * y)


def _from_pressure(q, beta, ratio):
    return q ** (beta / 2)


def _area(y, q, beta, ratio):
    return disc_cell.spot_area(disc_cell.spot_from_pressure(ratio * q))


def _peak(y, q, beta, ratio):
    spot = ratio * np.where((q > 0) & (q < _LOST), np.nan, q)
    return disc_cell.spot_peak(disc_cell.spot_from_pressure(spot), spot) / ratio


LAW = Law(
    name="power_law",
    #: B has no unit.
    parameters=disc_cell.PARAMETERS | {"B": Parameter(interval="[1e-8, 1e4]"), "beta": Parameter(interval="[0.01, 1]")},
    scales=_scales,
    curve=_curve,
    area=_area,
    peak=_peak,
    edge=lambda beta, ratio: (1.0, beta),
    from_pressure=_from_pressure,
    guess=lambda q, beta, ratio: np.maximum(q, _LEAST) ** (beta / 2),
    from_displacement=lambda g, beta, ratio: np.sqrt(np.maximum(g, 0.0)),
)
