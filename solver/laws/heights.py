"""The micro law of spherical asperities of random heights: normal, cut at ±c σ.

The mean field is that of the disc cell, Eqs (6), (7): a spot of radius b has the others as the uniform pressure p
outside its cell. A summit that lies ζ A* below the highest has the approach δ - ζ A*, and each its own spot,

    δ/A* - ζ = 1 - v² - 2 k v,   k = 2 q/3,   v = sqrt(1 - (b/B̄)²),
    its load on the area of a cell, over p*:   f = (2/π) (c³ + q (arccos v - v c)),   c = b/B̄,

which are (6) and the load that (7) is the balance of. p is the mean, q = <f> over the density of ζ. A = δ is counted
from the touch of the highest summit. The unknown is that summit's y = cot θ, v = sin θ there; each v is then explicit,
and q the root of <f> = q, whose slope is never 0. One height is the disc cell.

Few summits touch at the edge: p ~ A^(5/2) there, until A is about σ/c. A and y are as smooth there as elsewhere. The
normal density without a cut has no edge. c moves it: the radius a grows with c, and so does D, by c σ, while the
pressures, and the load at a given distance of the mean plane, tend to a limit. Where the highest summit fills its cell,
y is infinite. With σ > A*/c this may be so at a small p, and beyond there is no answer.
"""

from functools import partial

import numpy as np
from scipy.special import erf

from ..numerics.quadrature import gauss_legendre
from ..parameters import Parameter
from . import disc_cell
from .law import Curve, Law, inverse

#: Points over the heights: right to 1e-8 for a normal density that is cut at 5 σ (tests/laws/test_heights.py).
_POINTS = 24
#: Most Newton steps on q, and the relative change that is the last: the next one would be below rounding.
_STEPS, _LAST = 60, 1e-8
#: For σ/A* below this the first guess is that of equal heights.
_ALIKE = 0.03
#: Beyond this y the highest summit fills its cell but for a millionth; no solution is looked for there.
_FULL = 1e3

#: Standard deviation of the heights, in R, and the largest height above the mean over it.
SIGMA = Parameter(interval="[0, 10]", powers=(0, 1))
CUT = Parameter(4.0, interval="[3, 5]")


def _density(x, cut):
    """Density of x = ζ A*/σ, the depth below the highest summit, of the normal density that is cut at ±cut."""
    return np.exp(-((cut - x) ** 2) / 2) / (np.sqrt(2 * np.pi) * erf(cut / np.sqrt(2)))


class _Mean:
    """The means over the heights at y and q (B, m): arrays (B, m)."""

    def __init__(self, field, y, q, sigma, cut):
        tau, weight = gauss_legendre(_POINTS)
        self.v0 = 1 / np.sqrt(1 + y * y)
        self.k = field * (2 / 3) * q
        k, v0 = self.k[..., None], self.v0[..., None]
        touching = ((y * self.v0) ** 2 / (1 + self.v0) * (1 + self.v0 + 2 * self.k))[..., None]  # ζ of the lowest spot
        sigma, cut = sigma[..., None], cut[..., None]
        all_touch = touching >= 2 * cut * sigma
        span = np.where(all_touch, 2 * cut, touching / np.where(sigma > 0, sigma, 1.0))
        x = span * (1 - tau**2)  # f begins as (touching - ζ)^(3/2)
        w = 2 * weight * tau * span * _density(x, cut)
        share = w.sum(axis=-1, keepdims=True)
        self.w = np.where(all_touch, w / share, w)
        self.free = np.where(all_touch, 0.0, 1 - share)[..., 0]  # without contact
        height = sigma * x
        self.v = v0 + height / (k + v0 + np.sqrt((k + v0) ** 2 + height))
        below = np.maximum(touching - sigma * span, 0.0) + sigma * span * tau**2
        self.c2 = below * (1 + self.v) / (1 + self.v + 2 * k)
        self.c = np.sqrt(self.c2)

    def of(self, values):
        """Mean (B, m) of values (B, m, points)."""
        return np.einsum("...k,...k->...", self.w, values)

    def load(self, field):
        """<f> = P - q (1 - S): P and S."""
        own = 1.0
        if field:
            own = self.free + (2 / np.pi) * self.of(np.arctan2(self.v, self.c) + self.v * self.c)
        return (2 / np.pi) * self.of(self.c * self.c2), own

    def slopes(self, field, own):
        """d(q - <f>)/dq, and d<f>/dv of the highest summit."""
        c = self.of(self.c)
        by_q = own - field * (4 / np.pi) * (self.of(self.c * self.v) - self.v0 * c)
        return by_q, -(6 / np.pi) * (self.k + self.v0) * c


def _pressure(field, y, sigma, cut):
    """q (B, m) and the means there."""
    q = np.zeros_like(y)
    for _ in range(_STEPS):
        mean = _Mean(field, y, q, sigma, cut)
        load, own = mean.load(field)
        by_q, _ = mean.slopes(field, own)
        step = (load - q * own) / by_q
        q = np.maximum(q + step, 0.0)
        if not (np.abs(step) > _LAST * q).any():
            break
    return q, mean, own  # the means are those before the last step, which is too small to change them


def _curve(field, y, sigma, cut):
    y = np.where((y > _FULL) & (sigma > 0), np.nan, y)
    q, mean, own = _pressure(field, y, sigma, cut)
    by_q, by_v = mean.slopes(field, own)
    dv = -y * mean.v0**3
    dq = by_v * dv / by_q
    g = (y * mean.v0) ** 2 - 2 * mean.k * mean.v0
    return Curve(q, g, dq, -2 * (mean.v0 + mean.k) * dv - field * (4 / 3) * mean.v0 * dq)


def _guess(q, sigma, cut):
    """The highest summit has a spot at least as large as without a spread, and A is at most c σ more (f is convex)."""
    alike = disc_cell.spot_guess(np.maximum(q, 0.0))
    few = np.sqrt((1.25 * np.pi * sigma / _density(0.0, cut) * np.maximum(q, 0.0)) ** 0.4)
    return np.clip(few, alike, np.hypot(alike, np.sqrt(cut * sigma)))


def _from_pressure(field, q, sigma, cut):
    q = np.asarray(q, dtype=float)

    def value(y):
        """<f> at the wanted q, and its slope: there it is q."""
        mean = _Mean(field, y, np.maximum(np.nan_to_num(q), 0.0), sigma, cut)
        load, own = mean.load(field)
        return load + q * (1 - own), mean.slopes(field, own)[1] * -y * mean.v0**3

    return inverse(value, q, _guess(q, sigma, cut))


def _area(field, y, q, sigma, cut):
    mean = _Mean(field, y, q, sigma, cut)
    return mean.of(mean.c2)


def _peak(field, y, q, sigma, cut):
    """Under the highest summit."""
    return 3 / np.pi / np.sqrt(1 + y**-2.0) + field * (2 / np.pi) * q * np.arctan(y)


def _edge(sigma, cut):
    spread = sigma > _ALIKE
    few = (1.25 * np.pi * sigma / _density(0.0, cut)) ** 0.4
    return np.where(spread, few, (np.pi / 2) ** (2 / 3)), np.where(spread, 0.4, 2 / 3)


def _scales(E, Nbar, Ra, sigma, cut):
    p_star, A_star = disc_cell.scales(E, Nbar, Ra)
    return p_star, A_star, sigma / A_star, cut


def law(name, field=1.0, **known):
    """:class:`~solver.laws.law.Law` of these heights; `field` 0: the asperities do not feel each other."""
    parts = {"curve": _curve, "area": _area, "from_pressure": _from_pressure, "peak": _peak}
    parts = {key: partial(part, field) for key, part in parts.items()}
    parts |= {"edge": _edge, "guess": _guess, "scales": _scales}
    return Law(name=name, parameters=disc_cell.PARAMETERS | {"sigma": SIGMA, "cut": CUT}, rise=1.1, **parts, **known)


LAW = law("normal_heights")
