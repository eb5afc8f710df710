"""The recursion of :mod:`.stack`: it carries the minors x = (UW, WS, -US, WT, TS) of a wave from the bottom of a layer
to its top.

Tractions are in G1, the shear modulus of the top layer, and z = k h_j. In a layer of the shear modulus G, dx/dζ = B x
with g = G1/G, c = g (1 - 2ν)/(2(1 - ν)), d = 2/(g (1 - ν)), e = ν/(1 - ν) and

        [0  0  c  g  0]
        [0  0 -e  1  0]        B⁵ = 4 B³, therefore
    B = [0  2  0  0  g]        exp(zB) = 1 + z B + z²/2 B² + (sinh 2z - 2z)/8 B³ + (cosh 2z - 1 - 2z²)/16 B⁴.
        [d -2e 0  0  c]
        [0  0  d  0  0]

X (B, 5, S, M) has x at M wave numbers (S = 1), or x and its derivative by ln k (S = 2). Only ratios of the minors
count.
"""

from math import factorial
from typing import NamedTuple

import numpy as np

#: Where y = 2z is below 1, sinh y - y = y³/6 (1 + y²/20 + ...) and cosh y - 1 - y²/2 = y⁴/24 (1 + y²/30 + ...) are
#: sums of this many terms. Below are the coefficients in the brackets, the highest first.
_TERMS = 9
_ODD = [6 / factorial(3 + 2 * i) for i in reversed(range(_TERMS))]
_EVEN = [24 / factorial(4 + 2 * i) for i in reversed(range(_TERMS))]


class LayerPowers(NamedTuple):
    """B⁰ to B⁵ of one layer, (B, 6, 5, 5)."""

    powers: np.ndarray

    @classmethod
    def of(cls, g, nu):
        """g : G1/G (B,); nu : Poisson ratio (B,)."""
        B, complement = np.zeros((len(g), 5, 5)), 1 - nu
        B[:, 0, 2] = B[:, 3, 4] = g * (1 - 2 * nu) / (2 * complement)
        B[:, 0, 3] = B[:, 2, 4] = g
        B[:, 1, 2], B[:, 1, 3], B[:, 2, 1] = -nu / complement, 1.0, 2.0
        B[:, 3, 0] = B[:, 4, 2] = 2 / (g * complement)
        B[:, 3, 1] = 2 * B[:, 1, 2]
        two = B @ B
        three = B @ two
        return cls(np.stack([np.broadcast_to(np.eye(5), B.shape), B, two, three, two @ two, 4 * three], axis=1))

    def combined(self, factors, first=0):
        """Σ factor_i B^(first + i) at each wave number, (B, 5, 5, M), with five `factors` (B, 5, M)."""
        return _spread(self.powers[:, first : first + 5], factors)


def _spread(powers, factors):
    """Σ factor_i power_i, (B, ..., M), with five arrays `powers` (B, 5, ...) and `factors` (B, 5, M)."""
    shape = powers.shape[2:]
    flat = powers.reshape(len(powers), 5, -1).transpose(0, 2, 1) @ factors
    return flat.reshape(len(powers), *shape, -1)


def base(g, nu, rigid, slopes, count):
    """X at `count` wave numbers on a half-space with G1/G = g and Poisson ratio nu (B,), or on a rigid base where
    `rigid` (B,). `slopes`: whether X includes the derivative, which is 0."""
    minors = np.stack([3 - 4 * nu, 2 * g * (1 - 2 * nu), 4 * g * (1 - nu), 4 * g * (1 - nu), 4 * g * g], axis=1)
    X = np.zeros((len(g), 5, 1 + slopes, count))
    X[:, :, 0] = np.where(rigid[:, None], [0.0, 0.0, 0.0, 0.0, 1.0], minors)[:, :, None]
    return X


def scaled(X):
    """X over UW - US + TS, so that nothing overflows in many layers. None of the three terms is negative, and they are
    never all 0."""
    return X * (1 / (X[:, 0, 0] + X[:, 2, 0] + X[:, 4, 0]))[:, None, None]


def across(X, free, Kn, Kt):
    """X above an interface, from X below it.

    free : (B,) bool, the interface is frictionless
    Kn, Kt : (B, M) or None, normal and tangential compliance of its springs, times G1 k
    """
    if Kn is not None:
        X = _on_springs(X, Kn, Kt)
    if free.any():
        X = np.where(free[:, None, None, None], X[:, [3, 1, 4, 1, 1]] * np.array([1, 0, 1, 0, 0])[:, None, None], X)
    return X


def _on_springs(X, Kn, Kt):
    out = X.copy()
    x, above = X[:, :, 0].transpose(1, 0, 2), out[:, :, 0].transpose(1, 0, 2)
    above[0] += Kn * x[2] + Kt * x[3] + Kn * Kt * x[4]
    above[2] += Kt * x[4]
    above[3] += Kn * x[4]
    if X.shape[2] > 1:  # Kn and Kt are proportional to k
        dx, above = X[:, :, 1].transpose(1, 0, 2), out[:, :, 1].transpose(1, 0, 2)
        above[0] += Kn * (dx[2] + x[2]) + Kt * (dx[3] + x[3]) + Kn * Kt * (dx[4] + 2 * x[4])
        above[2] += Kt * (dx[4] + x[4])
        above[3] += Kn * (dx[4] + x[4])
    return out


def through(layer, z, X):
    """X above a layer, times e^(-2z), from X below it; z (B, M)."""
    out = np.einsum("bijm,bjsm->bism", layer.combined(_exponential(z)), X)
    if X.shape[2] > 1:
        out[:, :, 1] += z[:, None] * (layer.powers[:, 1] @ out[:, :, 0])
    return out


def at_surface(layer, z, X):
    """x4 and x5 above a layer, and their derivatives by ln k, times e^(-2z): (B, 2, S, M). Arguments as those of
    :func:`through`."""
    factors = _exponential(z)
    out = np.einsum("bijm,bjsm->bism", _spread(layer.powers[:, :5, 3:], factors), X)
    if X.shape[2] > 1:
        out[:, :, 1] += z[:, None] * np.einsum("bijm,bjm->bim", _spread(layer.powers[:, 1:, 3:], factors), X[:, :, 0])
    return out


def _exponential(z):
    """Factors (B, 5, M) of B⁰ to B⁴ in exp(zB) e^(-2z)."""
    out = np.empty((len(z), 5, z.shape[1]))
    e = np.exp(-2 * z)
    ze = z * e
    out[:, 0], out[:, 1], out[:, 2] = e, ze, z * ze / 2
    out[:, 3] = (1 - e * e) / 16 - ze / 4
    out[:, 4] = (1 - e) ** 2 / 32 - z * ze / 8
    case, node = np.nonzero(z < 0.5)
    if len(case):
        square = 4 * np.square(z[case, node])
        odd, even = np.polyval(_ODD, square), np.polyval(_EVEN, square)
        out[case, 3, node] = ze[case, node] * square / 24 * odd
        out[case, 4, node] = e[case, node] * square * square / 384 * even
    return out


def numerator(layer, z, X, nu1):
    """x4 - (1 - nu1) x5 at the surface and its derivative by ln k, times e^(-2z), without the part that is exactly 0.

    exp(zB) e^(-2z) is P+ + e^(-2z) [1 - B⁴/16 + z (B - B³/4) + z²/2 (B² - B⁴/4)] + e^(-4z) (B⁴ - 2B³)/32, and
    (0, 0, 0, 1, -(1 - nu1)) P+ = 0.
    """
    e, half = np.exp(-2 * z), z * z / 2
    factors = np.stack([e, z * e, half * e, -e * (z / 4 + e / 16), e * (e / 32 - half / 4 - 1 / 16)], axis=1)
    rows = layer.powers[:, :, 3] - (1 - nu1)[:, None, None] * layer.powers[:, :, 4]
    both = np.einsum("bjm,bjsm->bsm", _spread(rows[:, :5], factors), X)
    turned = np.einsum("bjm,bjm->bm", _spread(rows[:, 1:], factors), X[:, :, 0])
    return both[:, 0], both[:, 1] + z * turned
