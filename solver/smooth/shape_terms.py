"""The terms of the equation that depend on the indenter's shape: F(a) - F(t) in the basis, and the pressure of a
half-space.

Both are integrals over t between the kinks of the shape. From a kink b, and from t = 0 unless the shape is smooth in
r², the variable is y, t = b + (c - b) y², where c is the next kink or a: F is smooth in y.
"""

from functools import lru_cache

import numpy as np

from ..numerics.quadrature import gauss_legendre, log_rule, panels_towards
from ..shapes.shape import column
from .products import in_blocks

#: Points of a rule in addition to those for the basis.
_MORE = 20
#: Lengths of panels are rounded up to multiples of 1/_PARTS.
_PARTS = 8
#: Points of a rule for the pressure: on a subpanel towards a singularity, and for a shape without one.
_NEAR, _SMOOTH = 22, 40
#: Number of values that are computed together.
_TOGETHER = 1_000_000
_EPS = np.finfo(float).eps


def panel_ends(shape, a):
    """Yield pairs: places (b,) in the batch, and the ends (b, K + 2) of their panels from 0 to a, over a: 0, the kinks
    inside the contact, 1."""
    kinks = np.sort(shape.kinks() / column(a), axis=1)
    counts = (kinks < 1).sum(axis=1)
    for count in np.unique(counts).tolist():
        index = np.flatnonzero(counts == count)
        inner = kinks[index][:, :count]
        yield index, np.hstack([np.zeros((len(index), 1)), inner, np.ones((len(index), 1))])


def lifted_drop(shape, a, size):
    """F(a) - F(t) in the basis of `size` functions, (B, N)."""
    out = np.empty((len(a), size))
    even = shape.even
    for index in (np.flatnonzero(even), np.flatnonzero(~even)):
        if len(index):
            part = _even_drop if even[index[0]] else _kinked_drop
            step = max(1, _TOGETHER // (max(8, shape.kinks().shape[1]) * (size + _MORE)))
            for low in range(0, len(index), step):
                rows = index[low : low + step]
                out[rows] = part(shape.take(rows), a[rows], size)
    return out


def _even_drop(shape, a, size):
    tau, weighted = _even_rule(size)
    return in_blocks(shape.lifted(column(a)) - shape.lifted(column(a) * tau), weighted)


@lru_cache(maxsize=32)
def _even_rule(size):
    """Points τ (Q,), and the basis there times weights (Q, N), for even functions of τ."""
    x, w = gauss_legendre(2 * (size + _MORE))
    tau, w = 2 * x[len(x) // 2 :] - 1, 2 * w[len(x) // 2 :]
    return tau, (legendre(tau, size) * w).T


def _kinked_drop(shape, a, size):
    out = np.empty((len(a), size))
    for index, ends in panel_ends(shape, a):
        counts = _MORE + np.ceil(2 * size * longest(np.arccos(ends))).astype(int)
        for count in np.unique(counts).tolist():
            rows = np.flatnonzero(counts == count)
            out[index[rows]] = _in_panels(shape.take(index[rows]), a[index[rows]], ends[rows], size, count)
    return out


def longest(angles):
    """The length of the longest panel between these angles (B, K), over a right angle, rounded up to eighths. It is the
    share of a basis function's waves on that panel."""
    widths = np.abs(np.diff(angles, axis=1)).max(axis=1)
    return np.ceil(_PARTS * widths / (np.pi / 2) - _EPS * _PARTS) / _PARTS


def _in_panels(shape, a, ends, size, count):
    """As :func:`lifted_drop`, on panels with these ends, of `count` points each."""
    y, w = gauss_legendre(count)
    radius, low, width = column(a), ends[:, :-1, None], np.diff(ends, axis=1)[:, :, None]
    tau = (low + width * y**2).reshape(len(a), -1)
    drop = (width * (2 * y * w)).reshape(len(a), -1) * (shape.lifted(radius) - shape.lifted(radius * tau))
    return np.stack([(values * drop).sum(axis=1) for values in functions(tau, size)], axis=1)


def functions(tau, size):
    """Yield e_m at τ, m = 0 ... size - 1."""
    before, now, step = np.zeros_like(tau), np.ones_like(tau), 0
    for m in range(size):
        yield np.sqrt(4 * m + 1) * now
        for _ in range(2):
            before, now = now, ((2 * step + 1) * tau * now - step * before) / (step + 1)
            step += 1


def legendre(tau, size):
    """e_m (N, Q) at τ (Q,)."""
    return np.array(list(functions(tau, size)))


def on_half_space(shape, a, x):
    """∫ F'(t)/sqrt(t² - r²) dt, (B, m), from r to a, at r = ax with x (m,) < 1: the pressure of a half-space times π/E.
    It is infinite at r = 0 under a pointed tip."""
    out = np.empty((len(a), len(x)))
    even = shape.even
    for index in (np.flatnonzero(even), np.flatnonzero(~even)):
        if len(index):
            part = _smooth_pressure if even[index[0]] else _kinked_pressure
            step = max(1, _TOGETHER // (500 * max(1, len(x))))
            for low in range(0, len(index), step):
                rows = index[low : low + step]
                out[rows] = part(shape.take(rows), a[rows], x)
    out[np.ix_(shape.pointed, x == 0)] = np.inf
    return out


def _smooth_pressure(shape, a, x):
    """The integral by t² = r² + y², if F'/t is smooth."""
    u, w = gauss_legendre(_SMOOTH)
    s = np.sqrt((1 - x) * (1 + x))
    tau = np.sqrt(x[:, None] ** 2 + (s[:, None] * u) ** 2)
    t = column(a) * tau.ravel()
    return ((shape.lifted_slope(t) / t).reshape(len(a), len(x), -1) @ w) * column(a) * s


def _kinked_pressure(shape, a, x):
    """The integral by panels beyond r, in y, t = start + width y². The start is the lower end of the panel or r. The
    other of the two is a singularity, of F' or of 1/sqrt(t² - r²): the nearer it is, the more subpanels there are."""
    out = np.zeros((len(a), len(x)))
    for index, ends in panel_ends(shape, a):
        for low, high in zip(ends.T[:-1], ends.T[1:], strict=True):
            start = np.maximum(low[:, None], x)
            width = high[:, None] - start
            counts = panels_towards(np.sqrt(np.abs(x - low[:, None]) / np.maximum(width, _EPS)), 1.0)
            for count in np.unique(counts[width > 0]).tolist():
                case, column_of_x = np.nonzero((counts == count) & (width > 0))
                pairs = start[case, column_of_x], width[case, column_of_x], x[column_of_x]
                rows = index[case]
                out[rows, column_of_x] += _on_panel(shape.take(rows), a[rows], *pairs, count)
    return out


def _on_panel(shape, a, start, width, x, count):
    """The integrals (b,) over one panel each, with `count` subpanels."""
    y, w = log_rule(_NEAR, everywhere=True, panels=count)
    above = width[:, None] * y**2  # t - start, over a
    tau = start[:, None] + above
    roots = np.sqrt(((start - x)[:, None] + above) * (tau + x[:, None]))  # sqrt(t² - r²), over a
    values = width[:, None] * shape.lifted_slope(a[:, None] * tau) * (2 * y * w / roots)
    return np.where(np.isfinite(values), values, 0.0).sum(axis=1)
