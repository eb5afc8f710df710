"""Nodes, weights, interpolation and singular product integration on [0, 1]; nothing about contact.

References
----------
Berrut & Trefethen, SIAM Review 46 (2004) 501 (barycentric interpolation).
"""

from functools import lru_cache

import numpy as np
from scipy.special import roots_jacobi

#: Number of panels towards a singularity, each a quarter as long as the one before; and the power m of the last panel,
#: on which the variable is x = t^m: the integrand is smooth in t.
_PANELS, _POWER = 16, 8
#: Numbers of such panels that are used.
_FEWER = (0, 1, 2, 3, 4, 6, 8, 11, _PANELS)
#: Points on a panel that the singularity needs; a polynomial beside it needs more.
_LEAST = 14


@lru_cache(maxsize=64)
def gauss_legendre(n):
    """Gauss-Legendre rule with `n` points on [0, 1]: nodes (n,) and weights (n,), exact to degree 2n - 1."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    return _frozen((nodes + 1) / 2), _frozen(weights / 2)


@lru_cache(maxsize=64)
def radau_nodes(n):
    """Gauss-Radau nodes (n,) on [0, 1], ascending, the last one exactly 1 (weight function 1, exact to degree 2n -
    2)."""
    inner, _ = roots_jacobi(n - 1, 1.0, 0.0)
    return _frozen(np.append((inner + 1) / 2, 1.0))


def barycentric_weights(nodes):
    """Barycentric weights (n,) of `nodes` (n,), scaled by the capacity of [0, 1] so that they neither over- nor
    underflow."""
    return _weights_kept(np.ascontiguousarray(nodes, dtype=float).tobytes())


@lru_cache(maxsize=256)
def _weights_kept(nodes_bytes):
    nodes = np.frombuffer(nodes_bytes)
    difference = nodes[:, None] - nodes[None, :]
    np.fill_diagonal(difference, 1.0)
    scale = np.log(np.abs(difference) * 4.0)
    np.fill_diagonal(scale, 0.0)
    exponent = -scale.sum(axis=1)
    return _frozen(np.prod(np.sign(difference), axis=1) * np.exp(exponent - exponent.max()))


def lagrange(nodes, points):
    """Values (m, n) at `points` (m,) of the Lagrange polynomials of `nodes` (n,)."""
    values = np.asarray(points, dtype=float)[:, None] - nodes[None, :]  # in place from here on
    hit = None if values.all() else values == 0.0
    if hit is not None:
        values[hit] = 1.0
    np.divide(barycentric_weights(nodes), values, out=values)
    values /= values.sum(axis=1, keepdims=True)
    if hit is not None:
        on_node = hit.any(axis=1)
        values[on_node] = hit[on_node]
    return values


def panels_towards(gap, length):
    """How many panels of :func:`log_rule` (...) a singularity `gap` before an interval of `length` asks for: as on the
    others, it is at least a third of the last one away. Of a few numbers only, so that many have the same."""
    with np.errstate(divide="ignore"):
        wanted = np.log(length / (3 * gap)) / np.log(4.0)
    return np.array(_FEWER)[np.minimum(np.searchsorted(_FEWER, wanted), len(_FEWER) - 1)]


@lru_cache(maxsize=64)
def log_rule(n, everywhere=False, panels=_PANELS):
    """Rule on [0, 1] for a logarithm or a root at 0 times a polynomial of degree 2 (n - _LEAST): distances from 0 and
    weights.

    Each panel is a quarter as long as the one before, and on it the polynomial, whose zeros lie densest at an end,
    changes its sign half as often. Relative error below 3^(-2 _LEAST). Where another factor of the integrand is as
    narrow as a film, `everywhere` gives all panels `n` points. Fewer `panels` are for a singularity before 0, at least
    a third of the last one, [0, 4^-panels], away.
    """
    upper, least = 4.0 ** -np.arange(panels), n if everywhere else min(n, _LEAST)
    distance, weight = [], []
    for j, end in enumerate(upper):
        nodes, weights = gauss_legendre(least + -(-(n - least) // 2**j))
        distance.append(end / 4 + 3 / 4 * end * nodes)
        weight.append(3 / 4 * end * weights)
    end = 4.0**-panels
    if panels < _PANELS:
        nodes, weights = gauss_legendre(least + -(-(n - least) // 2**panels))
        return _frozen(np.concatenate([*distance, end * nodes])), _frozen(np.concatenate([*weight, end * weights]))
    last, last_weights = gauss_legendre(least + 8)
    distance.append(end * last**_POWER)
    weight.append(end * _POWER * last ** (_POWER - 1) * last_weights)
    return _frozen(np.concatenate(distance)), _frozen(np.concatenate(weight))


def _frozen(array):
    array.flags.writeable = False
    return array
