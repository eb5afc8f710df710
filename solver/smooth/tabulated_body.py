"""A body whose kernel is tabulated once, for the many radii of a search."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from ..body.hankel import Hankel
from ..body.wave_rule import STIFFEST
from ..numerics import batch
from .products import in_blocks

#: Points of a panel. A panel ends at twice the u at which it begins. L - 1 is analytic except near the imaginary axis,
#: so that each term of the Chebyshev series is 5.8 times smaller than the one before.
_POINTS = 20
#: The first panel, from 0, ends below u = 0.15/stiffness, where L is nearly straight. The last panel ends at _END.
_FIRST = tuple(2.0 ** np.floor(np.log2(0.15 / np.array(STIFFEST))))
_END = 32.0


@batch.of_cases
class Tabulated(NamedTuple):
    """A :class:`~..body.hankel.Hankel` body with a table of (L - 1)/(1 + m).

    first : (B,), the u = kh at which the first of p panels ends; beyond the last panel the function is 0
    series : (B, p, _POINTS), Chebyshev series on the panels
    """

    body: Hankel
    first: np.ndarray
    series: np.ndarray

    @classmethod
    def of(cls, body):
        """The body with a table of its kernel, or the body itself if it has no kernel."""
        if body.kernel is None:
            return body
        place = np.minimum(np.searchsorted(STIFFEST, body.kernel.stiffness), len(STIFFEST) - 1)
        first = np.array(_FIRST)[place]
        panels = int(np.log2(_END / first.min())) + 1
        series = np.zeros((len(first), panels, _POINTS))
        nodes, matrix = _chebyshev()
        for kind in np.unique(place).tolist():
            index = np.flatnonzero(place == kind)
            ends = np.append(0.0, _FIRST[kind] * 2.0 ** np.arange(np.log2(_END / _FIRST[kind]) + 1))
            low, width = ends[:-1, None], np.diff(ends)[:, None]
            u = np.tile((low + width * nodes).ravel(), (len(index), 1))
            values = excess(body.take(index), u).reshape(-1, _POINTS)
            series[index, : len(low)] = in_blocks(values, matrix).reshape(len(index), -1, _POINTS)
        return cls(body, first, series)

    @property
    def E(self):
        return self.body.E

    @property
    def h(self):
        return self.body.h

    @property
    def m(self):
        return self.body.m

    @property
    def kernel(self):
        return self.body.kernel

    def softness(self, a):
        return self.body.softness(a)

    def excess(self, u):
        """(L - 1)/(1 + m) (B, M) at u (B, M)."""
        share = u / self.first[:, None]
        panel = np.maximum(np.ceil(np.log2(np.maximum(share, 0.5))), 0.0).astype(int)
        low = np.where(panel > 0, 2.0 ** (panel - 1.0), 0.0)
        local = 2 * (share - low) / np.where(panel > 0, low, 1.0) - 1
        past_end = u >= _END
        rows = np.arange(len(u))[:, None]
        terms = self.series[rows, np.where(past_end, 0, panel)]
        return np.where(past_end, 0.0, _clenshaw(terms, np.where(past_end, 0.0, local)))


def where_slow(body):
    """The body, with a table of its kernel if this is one of many layers, which takes long for each wave."""
    return Tabulated.of(body) if body.kernel is not None and body.kernel.sampler is None else body


def excess(body, u):
    """(L - 1)/(1 + m) (B, M) of a body at u = kh (B, M)."""
    if isinstance(body, Tabulated):
        return body.excess(u)
    out = np.empty(u.shape)
    for group in body.kernel.formulas():
        for low in range(0, len(group), step := max(1, 16384 // u.shape[1])):
            rows = group[low : low + step]
            out[rows] = body.kernel.take(rows).decaying_part(u[rows])[0]
    return out / (1 + body.m[:, None])


@lru_cache(maxsize=1)
def _chebyshev():
    """The Chebyshev nodes of [0, 1], and the matrix that makes coefficients from rows of values (..., n) at them."""
    nodes = (1 - np.cos(np.pi * (np.arange(_POINTS) + 0.5) / _POINTS)) / 2
    return nodes, np.linalg.inv(chebvander(2 * nodes - 1, _POINTS - 1)).T


def _clenshaw(terms, x):
    """Σ terms_i T_i(x), terms (..., n), x (...)."""
    after, now = np.zeros_like(x), terms[..., -1]
    for i in reversed(range(1, terms.shape[-1] - 1)):
        after, now = now, terms[..., i] + 2 * x * now - after
    return terms[..., 0] + x * now - after
