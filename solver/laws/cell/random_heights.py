"""Asperities of random heights on the coated body itself: means over their spots, as in :mod:`..spread`, with the
approach and load of each spot by :mod:`.summits`.

The mean over the depth ζ of the summits is an integral over the angle θ of their spots, c = b/Bbar = sin θ: the
approach δ - ζ = a(θ) and the load are smooth functions of θ. An equation is solved only for the angles at which pieces
of the density end.
"""

from typing import NamedTuple

import numpy as np

from ...numerics.batch import march
from ...numerics.quadrature import gauss_legendre
from .. import spread
from .summits import at

__all__ = ["angle", "highest", "means", "peak", "table"]

#: Gauss points for spots, on each of the two parts of a piece of the density; and for filled cells. With them the means
#: without a layer are those of :mod:`..spread` to 1e-9 (tests/laws/heights/test_heights_on_body.py).
_SPOTS, _FILLED = 24, 16
#: Largest number of steps of θ² for a given approach, by Newton's method or bisection; the relative change below which
#: a step is the last, since the next would be rounding; and θ² of a filled cell.
_STEPS, _LAST, _FULL = 30, 1e-10, (np.pi / 2) ** 2
#: Newton's method on ln q: the largest number of steps, the relative residual at which it ends, the largest change, and
#: the relative residual above which there is no solution. _AT_A_TIME spots are computed at a time.
_MOST, _CLOSE, _LONGEST, _SOLVED, _AT_A_TIME = 14, 1e-9, 2.0, 1e-6, 2**14
#: Number of the coarse knots that are solved at a time, until the law ends. A value between knots is interpolated from
#: three on each side, so that a table has PAST knots beyond the end of the law. From there on w + q is a power of y
#: with an exponent of at most _SLOWER, so that δ rises.
_AT_FIRST, PAST, _SLOWER = 20, 4, 0.98


class SpotsAtAngles(NamedTuple):
    """Spots at angles θ, under the field k.

    a, da : approach, and da/dθ
    load, more : (pi/2) f is load + q more
    df : df/dθ
    c2 : c²
    """

    a: np.ndarray
    da: np.ndarray
    load: np.ndarray
    more: np.ndarray
    df: np.ndarray
    c2: np.ndarray


def spots(theta, k, values, slopes):
    """:class:`SpotsAtAngles` at the angles theta and fields k. `values`: G, P, B and F there; `slopes`: their
    derivatives by ln c."""
    (G, P, B, F), (dG, dP, dB, dF) = values, slopes
    c, v = np.sin(theta), np.cos(theta)
    v_c, expG, expP = v / np.maximum(c, 1e-300), np.exp(G), np.exp(P)
    a = c * c * expG - 2 * k * (v + B)
    da = c * v * expG * (2 + dG) + 2 * k * (c - dB * v_c)
    more = theta - v * c + F
    df = 2 / np.pi * (c * c * v * expP * (3 + dP) + 1.5 * k * (2 * c * c + dF * v_c))
    return SpotsAtAngles(a, da, c**3 * expP, more, df, c * c)


def angle(approach, k, series):
    """θ of the spot with this approach under the field k: 0 where the summit does not touch, pi/2 where its cell is
    filled.

    series : c -> G, P, B, F and their derivatives by ln c
    """
    (_, _, B0, _), _ = series(np.zeros_like(k))
    (G1, _, B1, _), _ = series(np.ones_like(k))
    below, above = approach <= -2 * k * (1 + B0), approach >= np.exp(G1) - 2 * k * B1
    v, c2 = spread.spot(approach, k)
    # a is nearly linear in θ²
    low, high = np.zeros_like(c2), np.full_like(c2, _FULL)
    share = (approach + 2 * k * (1 + B0)) / (np.exp(G1) + 2 * k * (1 + B0 - B1))
    square = np.where(c2 > 0, np.arctan2(np.sqrt(c2), v) ** 2, _FULL * share)
    ended = below | above
    square = np.where(below, 0.0, np.where(above, _FULL, square))
    for _ in range(_STEPS):
        theta = np.sqrt(square)
        at_theta = spots(theta, k, *series(np.sin(theta)))
        off = np.where(ended, 0.0, at_theta.a - approach)
        low, high = np.where(off < 0, square, low), np.where(off > 0, square, high)
        new = square - off / (at_theta.da / (2 * theta))
        new = np.where((new >= low) & (new <= high), new, (low + high) / 2)
        new = np.where(off == 0, square, new)
        change, square = np.abs(new - square), new
        if not (change > _LAST * square).any():
            break
    return np.sqrt(square)


def means(lookup, edges, density, q, delta, sigma):
    """:class:`~..spread.Means` at q and delta (1, m), over the spots of one :class:`~.summits.Lookup`. The other
    arguments are those of :func:`..spread.means`."""
    sigma, delta, q = (values[..., None, None] for values in (sigma, delta, q))
    k, edges = (2 / 3) * q, edges[:, None, :, None]
    (G, P, B, F), _ = lookup.at(np.ones(1))
    filled, touching = np.exp(G) - 2 * k * B, delta + 2 * k * (1 + lookup.at(np.zeros(1))[0][2])
    theta = angle(delta - sigma * edges, k, lookup.at)  # at each edge of a piece
    # in two parts, because the functions of summits are not smooth at the end of their series
    low, high = theta[:, :, 1:], theta[:, :, :-1]
    between = np.clip(np.arcsin(lookup.end), low, high)
    tau, weight = gauss_legendre(_SPOTS)
    of_spots = np.concatenate([low + (between - low) * tau, between + (high - between) * tau], axis=3)
    weight = np.concatenate([(between - low) * weight, (high - between) * weight], axis=3)
    values, slopes = lookup.at(np.sin(of_spots))
    at_spots = spots(of_spots, k, values, slopes)
    x = (delta - at_spots.a) / sigma
    w = weight * at_spots.da / sigma * density(x)

    tau, weight = gauss_legendre(_FILLED)
    full = np.clip((delta - filled) / sigma, edges[:, :, :-1], edges[:, :, 1:])
    x_full = edges[:, :, :-1] + (full - edges[:, :, :-1]) * tau
    w_full = weight * (full - edges[:, :, :-1]) * density(x_full)

    share = (w.sum(axis=(-1, -2)) + w_full.sum(axis=(-1, -2)))[..., None, None]  # share of the summits that touch
    every = touching >= sigma * edges[:, :, -1:]  # where all touch, the share must be exactly 1
    w, w_full = w / np.where(every, share, 1.0), w_full / np.where(every, share, 1.0)
    free = np.where(every, 0.0, 1 - share)[..., 0, 0]

    def of(values, in_filled):
        return (w * values).sum(axis=(-1, -2)) + (w_full * in_filled).sum(axis=(-1, -2))

    stiff = at_spots.df / np.where(at_spots.da > 0, at_spots.da, 1.0)  # d load/d approach; 3/pi in a filled cell
    below = 1 - 2 / np.pi * at_spots.more
    depth = delta - sigma * x_full - np.exp(G)
    of_filled = -2 / np.pi * F - 4 / np.pi * B
    by_field = 4 / 3 * stiff * (np.cos(of_spots) + values[2])  # the change of the load by that of the field, for each q
    return spread.Means(
        of(2 / np.pi * at_spots.load, 2 / np.pi * np.exp(P) + 3 / np.pi * depth),
        free + of(below, of_filled),
        of(at_spots.c2, 1.0),
        of(np.pi / 3 * stiff, 1.0),
        free + of(below - by_field, of_filled),
    )


def pressure(of, y, relief, q=None):
    """q (m,) at y (m,), and λ there, by Newton's method on ln q as in :func:`..spread.pressure`; NaN where it does not
    converge.

    of : (q, δ) -> :class:`~..spread.Means`, (1, m) each; relief : a number; q : the first guess, or None
    """
    if q is None:
        delta, w = spread.depth(y, 0.0, relief)
        at_zero = of(np.full((1, len(y)), 1e-300), delta[None])
        # at this approach, which leaves out the neighbours, their part of the load may exceed all of q
        ratio = np.where(at_zero.rest > 0, at_zero.load / at_zero.rest, np.inf)[0]
        q = np.clip(ratio, 1e-300, w * np.sqrt(delta / relief))
    q, area = q.copy(), np.full(len(y), np.nan)
    low, high = np.zeros(len(y)), np.full(len(y), np.inf)

    def balance(active):
        """q now, the approach δ and w there, the means, and the residual P - q S."""
        now = q[active]
        delta, w = spread.depth(y[active], now, relief)
        means = spread.Means(*(values[0] for values in of(now[None], delta[None])))
        return now, delta, w, means, means.load - now * means.rest

    def step(active):
        now, delta, w, means, more = balance(active)
        solved = np.abs(more) < _CLOSE * now
        area[active[solved]] = means.area[solved]
        low[active] = np.where(more > 0, now, low[active])
        high[active] = np.where(more < 0, now, high[active])
        slope = -means.fall - (6 / np.pi) * means.c * delta / (w + now)  # of P - q S
        new = now * np.exp(np.clip(more / now / -slope, -_LONGEST, _LONGEST))
        astray = (low[active] > 0) & (high[active] < np.inf) & ((new <= low[active]) | (new >= high[active]))
        new = np.where(astray, np.sqrt(low[active]) * np.sqrt(np.where(astray, high[active], 1.0)), new)
        q[active] = np.where(solved, now, new)
        return solved

    left = march(step, np.arange(len(y)), most=_MOST)
    if len(left):
        now, _, _, means, more = balance(left)
        solved = np.abs(more) < _SOLVED * now
        area[left[solved]] = means.area[solved]
        q[left[~solved]] = np.nan
    return q, area


def table(lookup, density, at_x, sigma, relief, lam):
    """(2, KNOTS * fine): ln q and ln λ of one law at the knots of :mod:`..spread`. They end at the contact fraction
    `lam`, or earlier, where q or δ falls or has no solution. From PAST knots beyond the end on, λ is constant and w + q
    a power of y.

    density : edges (1, J + 1) of its pieces, and `fine`, the factor of the number of knots; at_x : x -> density
    """
    (edges, fine), y = density, spread.knots(density[1])
    count = max(1, _AT_A_TIME // (2 * _SPOTS * (edges.shape[1] - 1)))

    def of(q, delta):
        columns = [slice(first, first + count) for first in range(0, q.shape[1], count)]
        parts = [means(lookup, edges, at_x, q[:, some], delta[:, some], sigma) for some in columns]
        return spread.Means(*(np.concatenate(values, axis=1) for values in zip(*parts, strict=True)))

    q_coarse, y_coarse = np.zeros(0), y[:: spread.EVERY * fine]
    while len(q_coarse) < len(y_coarse):
        some = y_coarse[len(q_coarse) : len(q_coarse) + _AT_FIRST]
        q, area = pressure(of, some, relief)
        good = np.append(True, area[:-1] < lam) & np.isfinite(area)
        q_coarse = np.append(q_coarse, q[: np.argmin(good)] if not good.all() else q)
        if not good.all():
            break
    y_fine = y[: len(q_coarse) * spread.EVERY * fine]
    guess, _ = spread.look_up(np.log(q_coarse)[None], np.zeros(1, dtype=int), y_fine[None], spread.EVERY * spread.STEP)
    q, area = pressure(of, y_fine, relief, np.exp(guess[0]))
    delta, w = spread.depth(y_fine, q, relief)
    wrong = ~np.isfinite(area[1:]) | ~(np.diff(q) > 0) | ~(np.diff(delta) > 0)
    last = int(np.argmax(wrong)) if wrong.any() else len(q) - 1
    last = min(last, int(np.searchsorted(area[: last + 1], lam)) - 1 + PAST)
    power = min(np.log((w + q[last]) / (w + q[last - 1])) / (spread.STEP / fine), _SLOWER)
    extended = (w + q[last]) * (y[last + 1 :] / y[last]) ** power - w
    lams = np.append(area[: last + 1], np.full(len(extended), area[last]))
    return np.log([np.append(q[: last + 1], extended), lams])


def highest(rows, q, delta):
    """c = b/Bbar (B, m) of the spot of the highest summit at q and δ (B, m). rows : (B, K), of
    :class:`~.summits.Summit`."""
    return np.sin(_angle_of_highest(rows, q, delta))


def _angle_of_highest(rows, q, delta):

    def series(c):  # the approach has no P and no F
        (G, dG), (B, dB), none = at(rows, 0, c), at(rows, 3, c), np.zeros_like(c)
        return (G, none, B, none), (dG, none, dB, none)

    return angle(delta, (2 / 3) * q, series)


def peak(rows, q, delta):
    """p_max/p* (B, m) under the highest summit at q and δ (B, m). rows : (B, K), of :class:`~.summits.Summit`."""
    k, theta = (2 / 3) * q, _angle_of_highest(rows, q, delta)
    (G, _), (B, _) = (at(rows, which, np.ones_like(q)) for which in (0, 3))
    c, filled = np.sin(theta), np.exp(G) - 2 * k * B
    (Q, _), (D, _) = (at(rows, which, c) for which in (2, 5))
    excess = 1.5 / np.pi * np.maximum(delta - filled, 0.0)
    return 3 / np.pi * c * np.exp(Q) + 2 / np.pi * q * (theta + D) + excess
