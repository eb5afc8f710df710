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

from .quadrature import gauss_legendre, lagrange, log_rule

#: Octaves of κ = k/cut above 1 and of τ below 1; the step χ falls between κ = 1/4 and 1.
_OCTAVES = 24
#: Nodes in each half-octave of κ and in each octave of τ: under a film n times stiffer than its base, what is wrong in
#: c comes back in the pressure more than n times as large.
_KAPPA, _TAU = 14, 20
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
    t, _ = gauss_legendre(_KAPPA)
    ends = np.append(0.0, 2.0 ** np.arange(-2, _OCTAVES + 0.25, 0.5))
    low, width = ends[:-1], np.diff(ends)
    kappa = (low[:, None] + width[:, None] * t).ravel()
    stop = 2.0 ** np.arange(-_OCTAVES, np.log2(REACH) + 1)
    start = np.append(0.0, stop[:-1])
    tau = (start[:, None] + (stop - start)[:, None] * _chebyshev_nodes()).ravel()
    degree = np.arange(_KAPPA)
    legendre = np.linalg.inv(np.polynomial.legendre.legvander(2 * t - 1, _KAPPA - 1))
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
    """What makes the convolution at `points` (m,) in s of the basis of a mesh of c at the nodes τ: (T, m, n).

    Panel by panel: a rule that runs across the ends of panels is good for smooth pressures only, and what it makes of
    the others leaves the discrete equation of a stiff film with pressures that are not there.
    """
    x = np.sqrt((1 - points) * (1 + points))
    table = np.zeros((len(waves()[1]), len(points), grid.n))
    s, weights = grid.rule(12 + grid.order // 2)
    plain = s, weights, grid.basis(s)
    for i in range(len(points)):
        shift, weight, basis = _around(points[i], grid, *plain)
        point = points[i] + shift
        other = np.sqrt((1 - point) * (1 + point))
        tau = cut * np.abs(shift) * (points[i] + point) / (x[i] + other)
        used = np.flatnonzero(tau < REACH)
        values = (weight * point / np.sqrt(other * x[i]))[used, None] * basis[used]  # of ∫ · sqrt(x'/x) dx'
        octave, interpolation = _interpolation(tau[used])
        for o in np.unique(octave):
            here = octave == o
            table[o * _TAU : (o + 1) * _TAU, i] = interpolation[here].T @ values[here]
    return table


def _around(s, grid, points, weights, basis):
    """Shifts s' - s (g,), weights and basis (g, n) of ∫ · ds' over the contact, for a singularity at s.

    Panels farther from it than their length have the plain rule, whose points, weights and basis are given.
    """
    low, high = np.array(grid.breaks[:-1]), np.array(grid.breaks[1:])
    far = np.maximum(low - s, s - high) >= high - low
    plain = np.repeat(far, len(points) // len(far))
    parts = [(points[plain] - s, weights[plain], basis[plain])]
    distance, weight = log_rule(14 + grid.order // 2)
    for i in np.flatnonzero(~far):
        own = slice(i * grid.order, (i + 1) * grid.order)
        for sign, start, stop in ((-1, max(s - high[i], 0.0), s - low[i]), (1, max(low[i] - s, 0.0), high[i] - s)):
            if stop > start:
                shift, values = sign * (start + (stop - start) * distance), np.zeros((len(distance), grid.n))
                values[:, own] = lagrange(grid.s[own], s + shift)
                parts.append((shift, (stop - start) * weight, values))
    return tuple(np.concatenate(part) for part in zip(*parts, strict=True))


def _chebyshev_nodes():
    return (1 - np.cos(np.pi * (np.arange(_TAU) + 0.5) / _TAU)) / 2


def _interpolation(tau):
    """Octave (m,) of each τ (m,), 0 the one that begins at 0, and the Chebyshev basis there (m, _TAU)."""
    octave = np.maximum(np.floor(np.log2(tau)).astype(int) + _OCTAVES + 1, 0)
    stop = 2.0 ** (octave - _OCTAVES)
    start = np.where(octave == 0, 0.0, stop / 2)
    distance = ((tau - start) / (stop - start))[:, None] - _chebyshev_nodes()
    distance[distance == 0] = 1e-300
    weights = (-1.0) ** np.arange(_TAU) * np.sin(np.pi * (np.arange(_TAU) + 0.5) / _TAU)
    terms = weights / distance
    return octave, terms / terms.sum(axis=1, keepdims=True)
