"""What asperities err on a layer that is thin against their pitch: docs/validate.md, A layer that is thin against the
pitch.

The laws of asperities take the layer for a half-space of its own material: L = 1 for waves as long as a cell and
shorter. On a lattice of asperities with the reciprocal vectors k the spots, of radius b and under the nominal pressure
p, are to the first order in L - 1 displaced by δA, and their curvature 1/Ra is less by the part s,

    δA = (2 p/E1*) Σ (L(kh) - 1) F²(kb)/k,   s = (p Ra/E1*) Σ (L(kh) - 1) k F²(kb),   F(x) = 3 (sin x - x cos x)/x³.

A flatter spot under the same load has a largest pressure of p_max (1 - s)^(2/3). The laws say p_max, too much by about
the part exp(_POWER s) - 1, which is right where s is small, large where s is, and never below -1. D is too small by δA.
"""

import numpy as np

from ..body import BODIES
from ..scaling import dimensionless, law_of

#: Layers thicker than the pitch 1/sqrt(Nbar) have no error: nothing was seen in resolved cells (docs/validate.md).
_PITCH = 1.0
#: Rings of reciprocal vectors of the hexagonal lattice i² + i j + j², with how many there are: i² + i j + j² <= _RINGS.
#: Beyond they are as dense as in the plane, and the sum is an integral over ln k up to u = kh = _LAST, where L - 1 is
#: less than 1e-5.
_RINGS, _LAST, _POINTS = 12, 6.0, 16
#: 2/3 and a fifth more: the error of p_max of resolved cells up to 20 % is then 0.6 to 1.25 times this estimate, up to
#: 300 % it is up to 1.7 times (tests/models/test_cell_error.py).
_POWER = 0.8
#: The error is at most this: beyond, p_max says nothing, and neither does the first order.
_MOST = 30.0


def cell_error(problem, solution):
    """(B,) relative error of p_max, or if that is larger of D, because asperities on a layer thinner than their pitch
    feel what lies below; 0 of other cases, and of laws that do not know the asperities. `solution` and problem have one
    unit."""
    error = np.zeros(len(problem))
    on_layer = (problem.base == "layered") | (problem.base == "stack")
    with np.errstate(invalid="ignore", over="ignore"):
        apart = on_layer & (problem.Nbar * problem.h**2 < _PITCH) & np.isfinite(problem.Ra)
    index = np.flatnonzero(apart & np.isfinite(solution.P) & problem.rough())
    if not len(index):
        return error
    scaled = dimensionless(problem.take(index))
    p0 = solution.p0[index] / problem.E2[index]
    D = solution.D[index] / problem.R[index]
    for micro, base in {*zip(scaled.micro.tolist(), scaled.base.tolist(), strict=True)}:
        rows = np.flatnonzero((scaled.micro == micro) & (scaled.base == base))
        error[index[rows]] = of_one_law(scaled.take(rows), p0[rows], D[rows])
    return error


@np.errstate(all="ignore")  # of p(0) that is not known
def of_one_law(part, p0, D):
    """The error (B,) of cases of one law and one base at p(0) and D (B,), in units R = E2* = 1."""
    kernel, spots = BODIES[str(part.base[0])](part).kernel, law_of(part).at(p0[:, None])
    b = np.sqrt(spots.lam[:, 0] / (np.pi * part.Nbar))
    k, weights = _waves(part.Nbar, part.h)
    L1, _ = kernel.decaying_part(k * part.h[:, None])
    x = k * b[:, None]
    F = np.where(x < 0.1, 1 - x * x / 10, 3 * (np.sin(x) - x * np.cos(x)) / x**3)
    summed = weights * L1 * F**2
    deeper = 2 * p0 / kernel.E1 * (summed / k).sum(axis=1)
    flatter = p0 * part.Ra / kernel.E1 * (summed * k).sum(axis=1)
    of_p_max = np.abs(np.expm1(np.minimum(_POWER * flatter, np.log1p(_MOST))))
    of_D = np.abs(deeper / D) / np.maximum(1 + deeper / D, 1.0)
    return np.nan_to_num(np.maximum(of_p_max, np.minimum(of_D, 1.0)), nan=0.0)


def _waves(Nbar, h):
    """Wave numbers (B, M) of the reciprocal lattice and how many there are of each: rings, then the plane."""
    rings, counts = _hexagonal()
    distance = 4 * np.pi / np.sqrt(3) * np.sqrt(Nbar * np.sqrt(3) / 2)  # of reciprocal vectors
    inside = 1 + counts.sum()
    first = np.sqrt(4 * np.pi * Nbar * inside)  # as many vectors are within this in the plane
    t, w = np.polynomial.legendre.leggauss(_POINTS)
    octaves = np.log(np.maximum(_LAST / (first * h), 1.0))
    k = first[:, None] * np.exp(octaves[:, None] * (t + 1) / 2)
    dense = k**2 / (2 * np.pi * Nbar[:, None]) * (octaves[:, None] * w / 2)
    few = distance[:, None] * rings
    return np.concatenate([few, k], axis=1), np.concatenate([np.broadcast_to(counts, few.shape), dense], axis=1)


def _hexagonal():
    """sqrt(i² + i j + j²) of the rings of reciprocal vectors but 0, and the numbers of vectors on them."""
    i = np.arange(-_RINGS, _RINGS + 1)
    square = (i[:, None] ** 2 + i[:, None] * i + i**2).ravel()
    norms, counts = np.unique(square[(square > 0) & (square <= _RINGS)], return_counts=True)
    return np.sqrt(norms), counts
