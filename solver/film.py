"""Films far thinner than the contact: the part of the layered operator that only the edge of the contact feels.

With n' = L(cut η/2) times the half-space taken out, η = h/a, the rest L(kη) - n' is split by a smooth step χ: what lies
below k = cut (in 1/a) is summed as for any layer; beyond, the Bessel functions are plane waves, and the kernel a
convolution:

    ∫ (L(kη) - n')(1 - χ) J0(kx) J0(kx') dk ≈ c(cut |x - x'|)/sqrt(x x'),
    c(τ) = (1/π) ∫ (L(κ cut η) - n')(1 - χ) cos(κτ) dκ/κ.

What is left out is of the order cut⁻² of the effect. Inside the contact the convolution sees a smooth pressure, and
nothing of it remains. It is linear in c, so that it is tabulated like the rest.
"""

from functools import lru_cache

import numpy as np
from scipy.special import erfc, spherical_jn

from .quadrature import gauss_legendre, log_rule

#: Octaves of κ = k/cut above 1 and of τ below 1, and nodes in each panel; the step χ falls between κ = 1/4 and 1.
_OCTAVES, _ORDER = 24, 14
_STEP = 3.4
#: Beyond this τ the convolution is left out.
REACH = 128.0


def step(kappa):
    """χ(κ): 1 below κ = 1/4, 0 above κ = 1."""
    return erfc(_STEP * (np.log2(np.maximum(kappa, 1e-9)) + 1)) / 2


@lru_cache(maxsize=1)
def waves():
    """Nodes κ (G,) of half-octaves, τ (T,) of octaves, and the matrix (T, G) of (1/π) ∫ · cos(κτ) dκ/κ.

    The integral is exact for polynomials over κ on each panel (Filon).
    """
    t, _ = gauss_legendre(_ORDER)
    ends = np.append(0.0, 2.0 ** np.arange(-2, _OCTAVES + 0.25, 0.5))
    low, width = ends[:-1], np.diff(ends)
    kappa = (low[:, None] + width[:, None] * t).ravel()
    stop = 2.0 ** np.arange(-_OCTAVES, np.log2(REACH) + 1)
    start = np.append(0.0, stop[:-1])
    tau = (start[:, None] + (stop - start)[:, None] * _chebyshev_nodes()).ravel()
    degree = np.arange(_ORDER)
    legendre = np.linalg.inv(np.polynomial.legendre.legvander(2 * t - 1, _ORDER - 1))
    bessel = spherical_jn(degree[:, None, None], tau[:, None] * width / 2)
    wave = np.real(np.exp(1j * tau[:, None] * (low + width / 2)) * (1j**degree)[:, None, None])
    matrix = np.einsum("lto,lg->tog", width * bessel * wave, legendre).reshape(len(tau), -1)
    return kappa, tau, matrix / (np.pi * kappa)


def transform(f, level, p):
    """c (b, T) at the nodes τ, from f = (L - n')(1 - χ) (b, G) at the nodes κ, which ends as 1 - n' = -level (b, 1).

    p (b, 1) is the thickness in 1/cut: the end -level (1 - e^-pκ)/κ has the transform -level ln(1 + p²/τ²)/2.
    """
    kappa, tau, matrix = waves()
    return (f - level * np.expm1(-p * kappa)) @ matrix.T - level / (2 * np.pi) * np.log1p((p / tau) ** 2)


def convolution(grid, points, cut):
    """What makes the convolution at `points` (m,) in s of the basis of a mesh of c at the nodes τ: (T, m, n)."""
    x = np.sqrt((1 - points) * (1 + points))
    table = np.zeros((len(waves()[1]), len(points), grid.n))
    for i in range(len(points)):
        s, weight, gap = _around(points[i], x[i], grid.order)
        used = np.flatnonzero(cut * gap < REACH)
        tau, values = cut * gap[used], weight[used, None] * grid.basis(s[used])
        octave, basis = _interpolation(tau)
        for o in np.unique(octave):
            here = octave == o
            table[o * _ORDER : (o + 1) * _ORDER, i] = basis[here].T @ values[here]
    return table


def _around(s, x, order):
    """Nodes s', weights and gaps |x - x'| of ∫ · sqrt(x'/x) dx' over the contact, for a singularity at s."""
    distance, weight = log_rule(14 + order // 2)
    parts = []
    for sign, length in ((-1, s), (1, 1 - s)):
        if length > 0:
            gap = length * distance
            point = s + sign * gap
            other = np.sqrt((1 - point) * (1 + point))
            parts.append((point, length * weight * point / np.sqrt(other * x), gap * (s + point) / (x + other)))
    return tuple(np.concatenate(v) for v in zip(*parts, strict=True))


def _chebyshev_nodes():
    return (1 - np.cos(np.pi * (np.arange(_ORDER) + 0.5) / _ORDER)) / 2


def _interpolation(tau):
    """Octave (m,) of each τ (m,), 0 the one that begins at 0, and the Chebyshev basis there (m, _ORDER)."""
    octave = np.maximum(np.floor(np.log2(tau)).astype(int) + _OCTAVES + 1, 0)
    stop = 2.0 ** (octave - _OCTAVES)
    start = np.where(octave == 0, 0.0, stop / 2)
    distance = ((tau - start) / (stop - start))[:, None] - _chebyshev_nodes()
    distance[distance == 0] = 1e-300
    weights = (-1.0) ** np.arange(_ORDER) * np.sin(np.pi * (np.arange(_ORDER) + 0.5) / _ORDER)
    terms = weights / distance
    return octave, terms / terms.sum(axis=1, keepdims=True)
