"""Spots of asperities of random heights in the mean field of the disc cell: their means, and tables of them.

All is in units p* and A*, with q = p/p* and k = 2 q/3. A summit that lies ζ below the highest has the approach δ - ζ.
Where 0 < δ - ζ + 2 k and δ - ζ < 1 it has a spot of radius c = b/B̄, with v = sqrt(1 - c²),

    δ - ζ = 1 - v² - 2 k v,   its load on the area of a cell:   f = (2/π) (c³ + q (arccos v - v c)),

which are (6) and the load that (7) is the balance of. At δ - ζ = 1 the spot fills its cell. From there on the cell is
pressed like a flat punch of its size, f = 2/π + q + (3/π) (δ - ζ - 1): f and its first two derivatives by δ go over
into each other, and at full contact, where all cells are filled, δ is the mean relief <ζ> + 1/3, as it must be.
p is the mean, q = <f> over the density of ζ. With 1 - f the share of q alone, S, this is P = q S without cancellation.

The unknown is y = sqrt(δ) (1 + q): δ = (y/(1 + q))² is then explicit, and P - q S falls with q at any y.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.quadrature import gauss_legendre

#: Points over the heights of each piece, of spots and of filled cells.
_SPOTS, _FILLED = 24, 16
#: Most Newton steps on ln q, the change that is the last, since the next would be below rounding, and the largest.
_STEPS, _LAST, _NEAR, _LONGEST = 60, 1e-9, 1e-6, 2.0
#: Knots of a table: ln y from the first on. A quintic through six of them errs by less than 5e-6 of q and 2e-4 of λ.
FIRST, STEP, KNOTS = np.log(1e-4), 0.025, 672


#: Every so many knots are solved first, and the others begin between them: that takes half the time.
_EVERY = 6


class Means(NamedTuple):
    """At q and δ: P and S of the module, λ, the mean of c, and d(q - <f>)/dq at constant δ; arrays of one shape."""

    load: np.ndarray
    rest: np.ndarray
    area: np.ndarray
    c: np.ndarray
    fall: np.ndarray


def means(edges, density, field, q, delta, sigma):
    """:class:`Means` at q and delta (B, m).

    edges : (B, J + 1), ends of the pieces of the density: depth below the highest summit over sigma
    density : (x (B, m, J, n)) -> of the depths x; field : 0 if asperities do not feel each other; sigma : (B, 1)
    """
    low, high = (edges[:, None, part, None] for part in (slice(None, -1), slice(1, None)))
    sigma, delta, q = sigma[..., None, None], delta[..., None, None], q[..., None, None]
    k, one = field * (2 / 3) * q, np.where(sigma > 0, sigma, 1.0)
    full, touching = (delta - 1) / one, (delta + 2 * k) / one
    begin, end = np.clip(full, low, high), np.clip(touching, low, high)

    tau, weight = gauss_legendre(_SPOTS)
    x = end - (end - begin) * np.sin(np.pi / 2 * tau) ** 2  # f begins as (touching - ζ)^(3/2), v as sqrt(1 - δ + ζ)
    w = np.pi / 2 * weight * np.sin(np.pi * tau) * (end - begin) * density(x)
    depth = delta - sigma * x
    v = np.clip((1 - depth) / (k + np.sqrt(np.maximum(k * k + 1 - depth, 0.0))), 0.0, 1.0)
    c2 = np.clip((depth + 2 * k) * (1 + v) / (1 + v + 2 * k), 0.0, 1.0)
    c = np.sqrt(c2)

    tau, weight = gauss_legendre(_FILLED)
    x_full = low + (begin - low) * tau
    w_full = weight * (begin - low) * density(x_full)
    excess = delta - sigma * x_full - 1

    share = (w.sum(axis=(-1, -2)) + w_full.sum(axis=(-1, -2)))[..., None, None]
    every = touching >= edges[:, None, -1:, None]
    w, w_full = w / np.where(every, share, 1.0), w_full / np.where(every, share, 1.0)
    free = np.where(every, 0.0, 1 - share)[..., 0, 0]  # without contact

    def of(values, filled=0.0):
        return (w * values).sum(axis=(-1, -2)) + (w_full * filled).sum(axis=(-1, -2))

    arc = np.arctan2(v, c) if field else np.pi / 2
    rest = free + of((2 / np.pi) * (arc + field * v * c), 1 - field)
    fall = free + of((2 / np.pi) * (arc - field * v * c), 1 - field)
    load = of((2 / np.pi) * c * c2, 2 / np.pi + (3 / np.pi) * excess)
    return Means(load, rest, of(c2, 1.0), of(c, 1.0), fall)


def pressure(edges, density, field, y, sigma, relief, q=None):
    """q (B, m) at y (B, m) > 0, and :class:`Means` there: Newton's method on ln q.

    relief : (B, 1), the limit of δ; q : to begin with, if something is known
    """
    if q is None:
        at = means(edges, density, field, np.zeros_like(y), y * y, sigma)
        q = np.clip(at.load / at.rest, 1e-300, y / np.sqrt(relief))
    low, high = np.zeros_like(y), np.full_like(y, np.inf)
    for _ in range(_STEPS):
        delta = (y / (1 + q)) ** 2
        at = means(edges, density, field, q, delta, sigma)
        more = at.load > q * at.rest
        low, high = np.where(more, q, low), np.where(more, high, q)
        slope = -at.fall - (6 / np.pi) * at.c * delta / (1 + q)  # of P - q S
        step = np.clip((at.load / q - at.rest) / -slope, -_LONGEST, _LONGEST)
        new = q * np.exp(step)
        astray = (low > 0) & (high < np.inf) & (np.abs(step) > _NEAR) & ((new <= low) | (new >= high))
        step = np.where(astray, np.log(np.sqrt(low * np.where(astray, high, 1.0)) / q), step)
        q = q * np.exp(step)
        if np.abs(step).max() <= _LAST:
            break
    return q, at


def _weights():
    """(6, 6): powers of t in [0, 1] -> weights of the values at -2, ..., 3 in the quintic whose values and first two
    derivatives at 0 and 1 are those of the five values around each."""
    first = np.array([1, -8, 0, 8, -1]) / 12
    second = np.array([-1, 16, -30, 16, -1]) / 12
    hermite = np.array([
        [1, 0, 0, -10, 15, -6], [0, 1, 0, -6, 8, -3], [0, 0, 0.5, -1.5, 1.5, -0.5],
        [0, 0, 0, 10, -15, 6], [0, 0, 0, -4, 7, -3], [0, 0, 0, 0.5, -1, 0.5],
    ])  # fmt: skip
    rows = np.zeros((6, 6))  # value, first and second derivative at 0, then at 1; by the six values
    for end in (0, 1):
        rows[3 * end, 2 + end] = 1
        rows[3 * end + 1, end : end + 5] = first
        rows[3 * end + 2, end : end + 5] = second
    return rows.T @ hermite


_WEIGHTS = _weights()


def look_up(table, group, y, step=STEP):
    """ln of what `table` (G, n) is of, and its derivative by ln y: (B, m) at y (B, m) of the laws `group` (B,).
    The knots are `step` apart. Beyond the ends it goes on as a straight line."""
    place, count = (np.log(y) - FIRST) / step, table.shape[1]
    knot = np.clip(place.astype(int), 2, count - 4)
    t = np.clip(place - knot, 0.0, 1.0)
    start = knot + count * group[:, None]
    around = [table.ravel()[start + beside] for beside in range(-2, 4)]
    value, slope = np.zeros_like(t), np.zeros_like(t)
    for row in _WEIGHTS.T[::-1]:  # Horner's scheme
        slope = slope * t + value
        value = value * t + sum(weight * one for weight, one in zip(row, around, strict=True) if weight)
    return value + slope * (place - knot - t), slope / step


def tables(edges, density, field, sigma, relief):
    """(2, G, KNOTS): ln q and ln λ at the knots of G laws; arguments as those of :func:`pressure`."""
    y = np.exp(FIRST + STEP * np.arange(KNOTS)) * np.ones((len(sigma), 1))
    few, _ = pressure(edges, density, field, y[:, ::_EVERY], sigma, relief)
    guess, _ = look_up(np.log(few), np.arange(len(y)), y, _EVERY * STEP)
    q, at = pressure(edges, density, field, y, sigma, relief, np.exp(guess))
    return np.log(np.stack([q, at.area]))
