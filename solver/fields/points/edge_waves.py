"""The short waves of a pressure, which only its edge produces: p^(k) = Re[f(k) e^(ik)] with a slowly varying f.

Multiply by a Bessel function, J_m(kr) = Re H_m(kr). Beside the edge the product is a slowly varying part and a part
like e^(ik(1 + r)), whose integral over a smooth window of short waves vanishes:

    p^(k) J_m(kr)  ->  Re[f(k) e^(ik) conj H_m(kr)]/2.

Away from the edge the integral of the first part vanishes as well. So the number of waves that a thin film needs grows
only with the number of octaves between a and h.
"""

import numpy as np

from ...numerics import special
from ...numerics.caches import Cache
from ..pressure import edge_rule

#: In each octave above LEAST f is the polynomial through _NODES Chebyshev points. Its error is at most 4e-11 of the
#: largest p^, as large as the error of the transform itself (tests/fields/points/test_edge_waves.py).
_NODES, LEAST = 20, 128.0
#: The window rises like the normal distribution about MIDDLE with the width _WIDTH. It reduces the part that is left
#: out, and everything farther from the edge than _AWAY/_WIDTH, to e^(-_AWAY²/4). Each octave has such a window.
_WIDTH, _AWAY = 40.0, 10.6
MIDDLE, LAST = LEAST + 4.5 * _WIDTH, LEAST + 9 * _WIDTH
#: Terms of the asymptotic series of H_0 and H_1, from x = 100 on.
_TERMS = 7
#: The tables of f that were formed, at most 50 MB.
_tables = Cache(5e7)


def have_edge_waves(mesh):
    """Whether only the edge produces short waves: the mesh has no narrow panels elsewhere."""
    return edge_rule(mesh, LEAST) is not None


def of_edge(pressure, k):
    """f (B, K) at ascending k >= LEAST."""
    waves, octave = np.empty((len(pressure.values), len(k)), dtype=complex), np.floor(np.log2(k / LEAST)).astype(int)
    for number in np.unique(octave):
        some, first = octave == number, LEAST * 2.0**number
        nodal = _tables.get((pressure.mesh, number), lambda: _table(pressure.mesh, first))  # noqa: B023
        rows = np.polynomial.chebyshev.chebvander(2 * k[some] / first - 3, _NODES - 1) @ _INVERSE
        waves[:, some] = (pressure.values @ nodal.T) @ rows.T
    return waves if pressure.A is None else waves - 1j * pressure.A[:, None] / k


def transform(pressure, k):
    """p^(k) (B, K) at ascending k (K,)."""
    if not have_edge_waves(pressure.mesh):
        return pressure.transform(k)
    short = np.searchsorted(k, LEAST)
    waves = np.empty((len(pressure.values), len(k)))
    waves[:, :short] = pressure.transform(k[:short])
    waves[:, short:] = (of_edge(pressure, k[short:]) * np.exp(1j * k[short:])).real
    return waves


_AT = -np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
_INVERSE = np.linalg.inv(np.polynomial.chebyshev.chebvander(_AT, _NODES - 1))


def _table(mesh, first):
    """The matrix (_NODES, n) from values at the nodes to f at the Chebyshev points of the octave that begins at
    `first`."""
    k = first * (1.5 + 0.5 * _AT)
    s, weight = edge_rule(mesh, first)
    x, table = np.sqrt((1 - s) * (1 + s)), np.zeros((_NODES, mesh.n), dtype=complex)
    for part in np.array_split(np.arange(len(s)), len(s) // 2000 + 1):
        z = k[:, None] * x[part]
        table += ((special.j0(z) + 1j * special.y0(z)) * (weight * s)[part]) @ mesh.basis(s[part])
    return table * np.exp(-1j * k)[:, None]


def longer(k):
    """The weights (K,), from 1 down to 0, of waves k in the sums that serve all radii."""
    return special.ndtr((MIDDLE - k) * (np.sqrt(2) / _WIDTH))


def last_octave(r):
    """The number (P,) of the last octave of short waves that counts at radii r (P,); -1 if none does."""
    away = np.maximum(np.abs(1 - r), 1e-12)
    return np.floor(np.log2(_AWAY / (_WIDTH * away))).astype(int)


def shorter(k, octave):
    """The weights (O, K) of waves k >= LEAST up to the end of each octave (O,)."""
    ends = 2.0 ** np.minimum(octave + 1, 60)[:, None]
    return special.ndtr((MIDDLE - k / ends) * (np.sqrt(2) / _WIDTH)) - longer(k)


def bessels(k, r, f, most):
    """The slowly varying parts (P, K) of p^ J_m at radii r (P,), a list over m from 0 to `most` + 2; f (P, K) includes
    its window."""
    x, phase = r[:, None] * k, (1 - r)[:, None] * k
    y = 1 / x
    slow = f * (np.cos(phase) + 1j * np.sin(phase)) * (np.sqrt(y / (2 * np.pi)) * np.exp(0.25j * np.pi))
    J = [(slow * (1j**m * _hankel(m, y))).real for m in (0, 1)]
    for m in range(1, most + 2):
        J.append(2 * m * y * J[m] - J[m - 1])
    return J


def _hankel(m, y):
    """The factor P - iQ of conj H_m(1/y), a series in y."""
    term, total = 1.0, 1.0
    for j in range(1, _TERMS + 1):
        term = term * ((4 * m * m - (2 * j - 1) ** 2) / (8 * j) * -1j) * y
        total = total + term
    return total
