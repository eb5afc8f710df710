"""The pressure of a smooth contact at any radius, from its solution in the basis.

    p(r) = (E/π) [A/sqrt(a² - r²) + ∫ᵣᵃ F'(t)/sqrt(t² - r²) dt - (1/a) ∫ₓ¹ b'(τ)/sqrt(τ² - x²) dτ],    x = r/a,

with b = Σ bent_m e_m, the second term of the equation. e_m'/τ is a polynomial in τ², and with τ² = x² + v² the last
integral is that of a polynomial in v², from 0 to s = sqrt(1 - x²).
"""

from functools import lru_cache

import numpy as np

from ..numerics.quadrature import gauss_legendre
from ..shapes.shape import column
from .products import in_blocks
from .shape_terms import on_half_space


def pressures_of(shape, response, A, x):
    """p (B, m) at x (m,) with the edge value A (B,). At x = 1 it is 0 if A = 0, else infinite, with the sign of A."""
    inside = x < 1
    s = np.sqrt((1 - x[inside]) * (1 + x[inside]))
    p = np.empty((len(A), len(x)))
    p[:, inside] = without_edge(shape, response, A, x[inside]) + column(A * response.E / (np.pi * response.a)) / s
    p[:, ~inside] = column(np.where(A == 0, 0.0, np.inf * np.sign(A)))
    return p


def without_edge(shape, response, A, x):
    """p (B, m) at x (m,) < 1 without its first term, which is infinite at the edge."""
    bent = response.bent + column(A) * response.flat_bent
    of_layer = _of_basis(bent, response.size, x)
    return (on_half_space(shape, response.a, x) - of_layer / column(response.a)) / column(np.pi / response.E)


def _of_basis(rows, counts, x):
    """Σ_m rows_m ∫ e_m'(τ)/τ dv, (B, m), at x (m,), with `rows` (B, N). Each case sums only over its own number of
    functions, `counts` (B,): so its numbers do not depend on its company."""
    out = np.full((len(rows), len(x)), np.nan)
    out[counts == 0] = 0.0
    for size in np.unique(counts[counts > 0]).astype(int).tolist():
        index = np.flatnonzero(counts == size)
        out[index] = in_blocks(rows[index, :size], _slopes(size, x.tobytes()))
    return out


@lru_cache(maxsize=64)
def _slopes(size, x_bytes):
    """∫ e_m'(τ)/τ dv, (N, m), from v = 0 to s, with τ² = x² + v²."""
    x = np.frombuffer(x_bytes)
    u, w = gauss_legendre(size + 2)
    s = np.sqrt((1 - x) * (1 + x))
    tau = np.sqrt(x[:, None] ** 2 + (s[:, None] * u) ** 2)
    return np.array([values @ w * s for values in _over_tau(tau, size)])


def _over_tau(tau, size):
    """Yield e_m'/τ, m = 0 ... size - 1, by P_n' = P_(n-2)' + (2 n - 1) P_(n-1) for even n, with P_(n-1) from the
    recurrence of P."""
    before, now, slope = np.ones_like(tau), tau, np.zeros_like(tau)  # P_(n-2), P_(n-1)
    for m in range(size):
        yield np.sqrt(4 * m + 1) * slope
        slope = slope + (4 * m + 3) * now / tau
        for step in (2 * m + 1, 2 * m + 2):
            before, now = now, ((2 * step + 1) * tau * now - step * before) / (step + 1)


def pressure_changes(response, A, x):
    """The change of p (B, m) at x (m,) < 1 by the last functions of the basis."""
    changes = response.changes + column(A) * response.flat_changes
    return _of_basis(changes, response.size, x) * column(response.E / (np.pi * response.a))


def flat_pressure(response):
    """p(0) (B,) of a flat punch of radius a, over its depth."""
    bent = _of_basis(response.flat_bent, response.size, np.zeros(1))[:, 0]
    return response.E / (np.pi * response.a) * (1 - bent) / response.flat_D
