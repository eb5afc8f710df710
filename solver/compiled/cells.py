"""Families of cells on the coated body in the form of the core: polynomials on pieces, where the bits of a number give
the piece in which it lies.

A piece is one of PIECES equal parts of an octave of z = 1 + kappa y; kappa is such that the last octave ends where the
series of the family end. Near y = 0 all pieces have about the same width and far from it their width grows like y, as
suits functions of b/h.
"""

import numpy as np

from ..laws.cell.cell_law import exponent, number, settled_slope, spot_guess
from ..laws.cell.family import NUMBERS
from ..numerics.caches import Cache

#: As in batch.h: the pieces in an octave, and the coefficients of each polynomial for exp(P), exp(G) and exp(Q). The
#: polynomials for the first guess have half as many. All agree with the series to 1e-13 (tests/compiled/test_cells.py).
PIECES, ROW = 32, 8
#: The least number of octaves.
_OCTAVES = 2
#: Families for later calls, at most 40 MB.
_cache = Cache(4e7)


def cells_of(rows):
    """The families of B cases, a list of arrays, from the rows (B, K) of their law; and for each case the address of
    its family, (B,) integers."""
    digests, first, index = np.unique(number(rows, "digest")[:, 0], return_index=True, return_inverse=True)
    families = [
        _cache.get((digest, rows.shape[1]), lambda i=i: _family(rows[i : i + 1]))
        for digest, i in zip(digests.tolist(), first, strict=True)
    ]
    addresses = np.array([family.ctypes.data for family in families], dtype=np.int64)
    return families, np.ascontiguousarray(addresses[index])


@np.errstate(all="ignore")
def _family(row):
    """The numbers of a family in the order of batch.h, from its row (1, K)."""
    numbers = dict(zip(NUMBERS, row[0], strict=False))
    scale, end, end_r = numbers["scale"], numbers["end"], numbers["end_r"]

    def of(which):
        return lambda y: np.exp(exponent(row, which, y)[0])

    def ratio(r):
        return spot_guess(2 / np.pi * r**3, row) / r

    kappa, octaves = _octaves(scale, end)
    kappa_r, octaves_r = _octaves(scale, end_r)
    P, G, Q = (_polynomials(of(which), kappa, octaves, ROW) for which in range(3))
    inverse = _polynomials(ratio, kappa_r, octaves_r, ROW // 2)
    slopes = [numbers[f"{name}_{of}"] for name in ("slope", "bend") for of in "PGQ"]
    slope_r = 3 / (3 + settled_slope(row)[0, 0]) - 1
    tops = [np.nextafter(2.0**count, 0.0) for count in (octaves, octaves_r)]
    header = [kappa, end, tops[0], kappa_r, end_r, tops[1], *slopes, numbers["settles"], slope_r, 0.0, 0.0]
    header[-2] = len(header) + P.size + G.size
    header[-1] = header[-2] + Q.size
    return np.concatenate([header, np.concatenate([P, G], axis=1).ravel(), Q.ravel(), inverse.ravel()])


def _octaves(scale, end):
    """kappa, and the number of octaves of 1 + kappa y for y from 0 to `end`."""
    octaves = max(_OCTAVES, int(np.ceil(np.log2(1 + scale * end))))
    return (2.0**octaves - 1) / end, octaves


def _polynomials(of, kappa, octaves, count):
    """Coefficients (PIECES * octaves, count) of polynomials for the function `of` y, in ascending powers of t; t runs
    from -1 to 1 on each piece."""
    piece = np.arange(PIECES * octaves)
    low, width = 2.0 ** (piece // PIECES) * (1 + piece % PIECES / PIECES), 2.0 ** (piece // PIECES) / PIECES
    nodes = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    y = (low[:, None] - 1 + width[:, None] * (nodes + 1) / 2) / kappa
    return np.linalg.solve(np.vander(nodes, increasing=True), of(y.reshape(1, -1)).reshape(y.shape).T).T
