"""Families of spots on a coated body: one curve of p, A and p_max over the radius, for all P, Ra and R of a body.

A family is a lattice, a pitch l over h, and what lies under the surface: its kernel and m. In units E = Ra = l = 1 its
spots of the radii b from 0 to the `reach` have

    p = (4/3) b³ e^P,   A = b² e^G,   p_max = (2 b/pi) e^Q,

in which P, G and Q are smooth functions of b/h, each a Chebyshev series in

    v = asinh(b/h)/asinh(reach/h),

which grows as b while b is small against h, and as ln b beyond. On its own a spot has P = G = Q = 0.

The inverse is a series too: with r = (3 p/4)^(1/3), the radius of a lone spot with this load, ln(b/r) is smooth in
asinh(r/h). It is used for first guesses alone, and has few terms.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ...numerics.kept import Kept
from .rows import of_kernel
from .spot import FEW, Cell, pieces, spots

__all__ = ["GUESS", "NUMBERS", "REACH", "Family", "families", "family", "kernel_keys"]

#: Largest contact fraction of a family. Resolved cells have A, λ and p_max within 1 % up to 0.4, and within 4 % up to
#: this (tests/evidence); beyond, the spots are no circles.
REACH = 0.55
#: Numbers of terms of the series, first by the pitch over h up to which each serves most layers: the layer is felt over
#: more and more decades of b/h. Where the last _LAST coefficients of P, G or Q exceed these, there are more terms, up
#: to _ENOUGH: 1e-10 of p, A and p_max (tests/laws/cell/test_family.py). Q is that noisy of hard layers.
_TERMS, _MORE, _ENOUGH = ((2.0, 28), (6.0, 36), (24.0, 48), (80.0, 72), (np.inf, 112)), 1.4, 220
_LAST, _SMALL = 3, (1e-11, 1e-11, 5e-11)
#: What follows is left out of the series: rounding.
_ROUNDING = 1e-13
#: The least pitch over h, below which no wave feels what lies under the layer; and the largest, of which a family takes
#: seconds.
_LEAST, MOST = 0.1, 300.0
#: Number of terms of the inverse, and of points to which it is fitted: it is right to 1e-3, mostly to 1e-5.
GUESS, _FITTED = 16, 48
#: A pitch over h is rounded to so many binary digits, 6e-14: cases of one body at several R then have one family.
_DIGITS = 44
#: On a soft layer a disc cell goes wrong: its series ends where A/A_hex - 1 exceeds that without a layer by _SOFT
#: (CELL.md: A and p turn negative later). It is looked for at _SCANNED radii.
_SOFT, _SCANNED = 0.1, 24
#: Radii are solved so many numbers of their matrices at a time.
_AT_ONCE = 2**20
#: Bytes of the families that are kept: some 10,000 of them.
_kept = Kept(2e7)

#: The numbers of a family before its series, in their order: b/h over b/Bbar, 1/asinh and the largest b/Bbar of P, G
#: and Q; 1/asinh and the largest r/Bbar of the inverse; the slopes by ln b at the end of P, G and Q; the largest p/p*
#: that the law knows.
NUMBERS = ("scale", "width", "end", "width_r", "end_r", "slope_P", "slope_G", "slope_Q", "most")


class Family(NamedTuple):
    """Series of P, G and Q, Chebyshev coefficients (N,) each, and of the inverse (GUESS,); pitch over h, and the
    largest radius (unit l). `known` is False of a family that no law has: a pitch above MOST."""

    pitch: float
    reach: float
    P: np.ndarray
    G: np.ndarray
    Q: np.ndarray
    inverse: np.ndarray
    known: bool = True

    def at(self, b):
        """p, A and p_max at radii b of any shape up to the reach, in units E = Ra = l = 1."""
        v = np.arcsinh(b * self.pitch) / np.arcsinh(self.reach * self.pitch)
        P, G, Q = (np.exp(chebyshev.chebval(2 * v - 1, series)) for series in (self.P, self.G, self.Q))
        return 4 / 3 * b**3 * P, b**2 * G, 2 * b / np.pi * Q

    def row(self, terms):
        """The numbers of the family, (len(NUMBERS) + 3 `terms` + GUESS,): NUMBERS, then the series, zeros behind each.
        Radii are in units of Bbar = 1/sqrt(pi Nbar)."""
        Bbar = 1 / np.sqrt(np.pi)
        scale, end = self.pitch * Bbar, self.reach / Bbar
        end_r = end * np.exp(self.P.sum() / 3)
        along = 2 * scale * end / np.hypot(1, scale * end) / np.arcsinh(scale * end)  # dx/d ln b at the end
        slopes = [along * chebyshev.chebval(1.0, chebyshev.chebder(series)) for series in (self.P, self.G, self.Q)]
        widths = 1 / np.arcsinh(scale * end), 1 / np.arcsinh(scale * end_r)
        most = 2 / np.pi * end_r**3 if self.known else 0.0
        series = [np.append(one, np.zeros(terms - len(one))) for one in (self.P, self.G, self.Q)]
        return np.concatenate([[scale, widths[0], end, widths[1], end_r, *slopes, most], *series, self.inverse])


def kernel_keys(kernel, m):
    """What tells the bodies of B cases apart: (B,) list of bytes."""
    size = len(m)
    fields = [np.asarray(field).reshape(size, -1) for field in [m, *kernel] if isinstance(field, np.ndarray)]
    table = np.concatenate([field.astype(float) for field in fields], axis=1)
    return [type(kernel).__name__.encode() + row.tobytes() for row in table]


def families(lattice, pitch, kernel, m):
    """The families of B cases: a list of different ones, and the index (B,) of that of each case.

    lattice : "square", "hex" or "disc"; pitch : (B,), l over h; kernel : :class:`~solver.kernels.kernel.Kernel` of the
    cases; m : (B,), E1*/E3* of an elastic punch
    """
    pitch = rounded(pitch)
    keys = [(lattice, float(l_h), key) for l_h, key in zip(pitch, kernel_keys(kernel, m), strict=True)]
    first = {}
    index = np.array([first.setdefault(key, (len(first), i))[0] for i, key in enumerate(keys)], dtype=int)
    return [family(key, kernel, m, i) for key, (_, i) in first.items()], index


def family(key, kernel, m, i):
    """The :class:`Family` of case i with this key, kept for the next time. It is a function of the case alone."""
    return _kept.get(key, lambda: Family(*_made(key[0], key[1], kernel.take([i]), float(m[i]))))


def rounded(pitch):
    """The pitch over h to _DIGITS binary digits, and at least _LEAST; NaN and infinity stay."""
    mantissa, power = np.frexp(np.maximum(pitch, _LEAST))
    return np.ldexp(np.round(np.ldexp(mantissa, _DIGITS)), power - _DIGITS)


@np.errstate(all="ignore")  # of bodies that are none
def _made(lattice, pitch, kernel, m):
    """The fields of a :class:`Family`."""
    if not pitch <= MOST:
        return _bare(lattice)
    cell, reach = Cell(lattice, pitch, of_kernel(kernel, m)), np.sqrt(REACH / np.pi)
    N = pieces(cell, reach)
    if not np.isfinite(N.coefficients).all():
        return _bare(lattice)
    if lattice == "disc":
        reach = _while_like_hex(cell, N, reach)
    series = _series(cell, reach, N)
    if not np.isfinite(series).all():  # where p, A or p_max are not above 0
        return _bare(lattice)
    return pitch, reach, *series, _inverse(pitch, reach, series[0])


def _bare(lattice):
    """The fields of a family that no law has: the numbers are those without a layer."""
    cell, reach = Cell(lattice, 1.0), np.sqrt(REACH / np.pi)
    series = _series(cell, reach, pieces(cell, reach))
    return 1.0, reach, *series, _inverse(1.0, reach, series[0]), False


def _series(cell, reach, N):
    """P, G and Q of a cell, as many terms as they need."""
    terms = next(count for most, count in _TERMS if cell.pitch <= most)
    while True:
        x = np.cos(np.pi * (np.arange(terms) + 0.5) / terms)
        b = np.sinh((x + 1) / 2 * np.arcsinh(reach * cell.pitch)) / cell.pitch
        p, A, p_max = solved(cell, b, N)
        series = _chebyshev(np.log([p / (4 / 3 * b**3), A / b**2, p_max / (2 * b / np.pi)]))
        if not np.isfinite(series).all():
            return series
        if terms > _ENOUGH or (np.abs(series[:, -_LAST:]).max(axis=1) < _SMALL).all():
            needed = np.flatnonzero((np.abs(series) > _ROUNDING).any(axis=0))
            return series[:, : needed[-1] + 1]
        terms = int(_MORE * terms)


def _chebyshev(values):
    """Chebyshev coefficients (..., n) of values (..., n) at the n nodes of :func:`_series`, descending."""
    n = values.shape[-1]
    angles = np.outer(np.arange(n), np.pi * (np.arange(n) + 0.5) / n)
    coefficients = 2 / n * values @ np.cos(angles).T
    coefficients[..., 0] /= 2
    return coefficients


def solved(cell, b, N):
    """p, A and p_max (3, S) of the radii b (S,), each with as many points as it needs."""
    out, beta = np.empty((3, len(b))), b * cell.pitch if cell.L1 is not None else 0 * b
    order, ends = np.argsort(beta), [most for _, most in FEW]
    while len(order):
        first = beta[order[0]]
        # those up to the next number of points; of more than one panel those up to a fifth wider
        most = next((end for end in ends if first <= end), 1.2 * first)
        count = np.count_nonzero(beta[order] <= most)
        size = max(1.0, beta[order[count - 1]] / 5) * 24
        count = min(count, max(1, int(_AT_ONCE / size**2)))
        some, order = order[:count], order[count:]
        spot = spots(cell, b[some], N)
        out[:, some] = spot.p, spot.A, spot.p_max
    return out


def _inverse(pitch, reach, P):
    """Chebyshev coefficients (GUESS,) of ln(b/r) in asinh(r/h) over its largest value, by least squares."""
    v = (1 - np.cos(np.pi * (np.arange(_FITTED) + 0.5) / _FITTED)) / 2
    b = np.sinh(v * np.arcsinh(reach * pitch)) / pitch
    logs = chebyshev.chebval(2 * v - 1, P) / 3
    at = np.arcsinh(b * np.exp(logs) * pitch) / np.arcsinh(reach * np.exp(P.sum() / 3) * pitch)
    return np.linalg.lstsq(chebyshev.chebvander(2 * at - 1, GUESS - 1), -logs)[0]


def _while_like_hex(cell, N, reach):
    """The radius up to which the disc cell on a soft layer has an A like that of the hexagonal lattice; `reach` on
    others."""
    hexagonal = cell._replace(lattice="hex")
    of_hex = pieces(hexagonal, reach)
    if not (of_hex.at(np.zeros(1))[0] < pieces(Cell("hex", 1.0), reach).at(np.zeros(1))[0]).all():
        return reach
    b = reach * np.sqrt((1 + np.arange(_SCANNED)) / _SCANNED)
    more = _ratio(cell, N, hexagonal, of_hex, b) - _bare_ratio(b)
    beyond = np.flatnonzero(~(more <= _SOFT))
    if not len(beyond):
        return reach
    i = int(beyond[0])
    low, high = (more[i - 1] if i else 0.0), more[i]
    part = (_SOFT - low) / (high - low) if np.isfinite(high) else 0.0
    lam = (b[i - 1] ** 2 if i else 0.0) * (1 - part) + part * b[i] ** 2
    return float(np.sqrt(lam))


def _ratio(cell, N, hexagonal, of_hex, b):
    """A of a disc cell over that of the hexagonal lattice at radii b, NaN where that of the disc cell or p is not
    above 0."""
    disc, hexagon = solved(cell, b, N), solved(hexagonal, b, of_hex)
    return np.where((disc > 0).all(axis=0), disc[1] / hexagon[1], np.nan)


def _bare_ratio(b):
    """:func:`_ratio` without a layer."""
    cells = Cell("disc", 1.0), Cell("hex", 1.0)
    return _ratio(cells[0], pieces(cells[0], b.max()), cells[1], pieces(cells[1], b.max()), b)
