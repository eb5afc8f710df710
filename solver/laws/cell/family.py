"""Families of spots on a coated body: one curve each of p, A and p_max over the radius, for all P, Ra and R.

A lattice, a pitch l over h, and the body under the surface, by its kernel and m, define a family. In units E = Ra = l =
1 its spots with radii b from 0 to `reach` have

    p = (4/3) b³ e^P,   A = b² e^G,   p_max = (2 b/pi) e^Q,

where P, G and Q are smooth functions of b/h, each a Chebyshev series in

    v = asinh(b/h)/asinh(reach/h),

which grows as b while b is small compared with h, and as ln b beyond. A single spot without a layer has P = G = Q = 0.

The inverse is a series too: with r = (3 p/4)^(1/3), the radius of a lone spot with this load, ln(b/r) is smooth in
asinh(r/h). It is used only for first guesses, and has few terms.
"""

import hashlib
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ...numerics.caches import Cache
from .rows import of_kernel
from .spot import FEW, POINTS, Cell, pieces, spots

__all__ = ["GUESS", "NUMBERS", "REACH", "Family", "different", "families", "family"]

#: Largest contact fraction of a family. Up to 0.4 it agrees with resolved cells within 1 % in A, λ and p_max, and up to
#: this within 4 % (tests/evidence). Beyond, the spots are not circles.
REACH = 0.55
#: (pitch over h, terms): number of terms of the series with which to begin, up to this pitch over h. It is enough for
#: most layers; with the pitch the layer is felt over more decades of b/h. If one of the last _LAST coefficients of P, G
#: or Q exceeds _SMALL, the number grows by the factor _MORE, up to _ENOUGH. p, A and p_max are then right to 1e-10
#: (tests/laws/cell/test_family.py). _SMALL of Q is larger because of the rounding under hard layers.
_TERMS, _MORE, _ENOUGH = ((2.0, 28), (6.0, 36), (24.0, 48), (80.0, 72), (np.inf, 112)), 1.4, 220
_LAST, _SMALL = 3, (1e-11, 1e-11, 5e-11)
#: Terms below this are rounding, and are dropped at the end of the series.
_ROUNDING = 1e-13
#: The smallest pitch over h, below which no wave feels the body under the layer; and the largest, for which a family
#: takes seconds.
_LEAST, MOST = 0.1, 300.0
#: Number of terms of the inverse, and number of points to which it is fitted. It is right to 1e-3, mostly to 1e-5.
GUESS, _FITTED = 16, 48
#: A pitch over h is rounded to this many binary digits, 6e-14, so that cases of one body at several R share a family.
_DIGITS = 44
#: On a soft layer the disc cell fails at large radii, where its A and p turn negative. Its series ends where
#: A/A_hex - 1 exceeds that without a layer by _SOFT. This radius is searched for among _SCANNED radii.
_SOFT, _SCANNED = 0.1, 24
#: Number of radii among which the largest mean pressure of a spot is searched for.
_LOOKED = 200
#: Beyond the end the second derivatives of P, G and Q decay from their values at the end: with a kink of the slope,
#: contacts that reach beyond would need finer meshes. They decay at least at the rate _SETTLES in ln b, and the slopes
#: change by at most _TURNED, so that p and A rise.
_SETTLES, _TURNED = 4.0, 0.25
#: Number of entries of the matrices that are solved at a time.
_AT_ONCE = 2**20
#: The families in use, at most this many bytes, which is some 10,000 of them.
_cache = Cache(2e7)

#: The numbers of a family before its series, in this order:
#: scale : b/h over b/Bbar
#: width, end : 1/asinh(largest b/h), and the largest b/Bbar, of P, G and Q
#: width_r, end_r : 1/asinh(largest r/h), and the largest r/Bbar, of the inverse
#: slope_*, bend_*, settles : at the end, the first and second derivatives by ln b of P, G and Q; and the rate at which
#: the second derivatives decay beyond it
#: most : the largest p/p* for which the law has numbers
#: turn, top : for disc cells, the b/Bbar from which the mean pressure of a spot falls, and this mean over that of a
#: lone spot of the radius Bbar; the end and 0 if it never falls
#: digest : a number that tells the family from others
NUMBERS = (
    *("scale", "width", "end", "width_r", "end_r", "slope_P", "slope_G", "slope_Q", "bend_P", "bend_G", "bend_Q"),
    *("settles", "most", "turn", "top", "digest"),
)


class Family(NamedTuple):
    """One family.

    pitch : pitch over h
    reach : the largest radius, in l
    P, G, Q : Chebyshev coefficients, (N,) each; inverse : (GUESS,)
    usable : False if no law can use the family, for example because its pitch is above MOST
    disc : whether its cells are disc cells
    digest : a whole number that no other family has
    numbers : the NUMBERS
    """

    pitch: float
    reach: float
    P: np.ndarray
    G: np.ndarray
    Q: np.ndarray
    inverse: np.ndarray
    usable: bool = True
    disc: bool = False
    digest: float = 0.0
    numbers: np.ndarray | None = None

    @property
    def terms(self):
        return len(self.P)

    def at(self, b):
        """p, A and p_max at radii b of any shape up to the reach, in units E = Ra = l = 1."""
        v = np.arcsinh(b * self.pitch) / np.arcsinh(self.reach * self.pitch)
        P, G, Q = (np.exp(chebyshev.chebval(2 * v - 1, series)) for series in (self.P, self.G, self.Q))
        return 4 / 3 * b**3 * P, b**2 * G, 2 * b / np.pi * Q

    def row(self, terms):
        """The numbers of the family, (len(NUMBERS) + 3 `terms` + GUESS,): NUMBERS, then P, G and Q, each filled up with
        zeros, then the inverse."""
        series = [np.append(row, np.zeros(terms - len(row))) for row in (self.P, self.G, self.Q)]
        return np.concatenate([self.numbers, *series, self.inverse])

    def with_numbers(self):
        """The family with its NUMBERS, whose computation takes a hundred times as long as :meth:`row`. Radii are in
        units of Bbar = 1/sqrt(pi Nbar)."""
        Bbar = 1 / np.sqrt(np.pi)
        scale, end = self.pitch * Bbar, self.reach / Bbar
        end_r = end * np.exp(self.P.sum() / 3)
        beta = scale * end
        along = 2 * beta / np.hypot(1, beta) / np.arcsinh(beta)  # dx/d ln b at the end
        orders = [[chebyshev.chebval(1.0, chebyshev.chebder(v, i)) for v in (self.P, self.G, self.Q)] for i in (1, 2)]
        slopes = along * np.array(orders[0])
        bends = along**2 * np.array(orders[1]) + slopes / (1 + beta**2)
        settles = max(_SETTLES, np.abs(bends).max() / _TURNED)
        widths = 1 / np.arcsinh(scale * end), 1 / np.arcsinh(scale * end_r)
        most = 2 / np.pi * end_r**3 if self.usable else 0.0
        turn = _turn(scale, end, self.P) if self.disc else (end, 0.0)
        numbers = scale, widths[0], end, widths[1], end_r, *slopes, *bends, settles, most, *turn, self.digest
        return self._replace(numbers=np.array(numbers))


def half_space(t):
    """exp(P) of the disc cell on a half-space at t = b/Bbar, Eq. (7), and its logarithmic derivative, dP/d ln t."""
    sin = np.sqrt(1 - t * t)
    whole = np.arccos(t) + t * sin
    return np.pi / 2 / whole, 2 * t**3 / (sin * whole)


def _turn(scale, end, P):
    """t = b/Bbar from which the mean pressure of a spot falls, and this mean there, t exp(P - P0) in the unit of that
    at t = 1."""
    t = np.sinh(np.linspace(0, 1, _LOOKED)[1:] * np.arcsinh(scale * end)) / scale
    x = 2 * np.arcsinh(scale * t) / np.arcsinh(scale * end) - 1
    mean = t * np.exp(chebyshev.chebval(x, P)) / half_space(t)[0]
    falls = np.flatnonzero(np.diff(mean) < 0)
    if not len(falls) or falls[0] == 0:
        return end, 0.0
    at = slice(falls[0] - 1, falls[0] + 2)
    top = np.polyfit(x[at] - x[falls[0]], mean[at], 2)  # the parabola through the largest and its neighbours
    turn = x[falls[0]] - top[1] / (2 * top[0])
    t = np.sinh((turn + 1) / 2 * np.arcsinh(scale * end)) / scale
    return t, t * np.exp(chebyshev.chebval(turn, P)) / half_space(t)[0]


def families(lattice, pitch, kernel, m):
    """The families of B cases: a list of the different families, and the index (B,) of each case's family.

    lattice : "square", "hex" or "disc"; pitch : (B,), l over h; kernel : :class:`~solver.kernels.kernel.Kernel` of the
    cases; m : (B,), E1*/E3* of an elastic punch
    """
    first, index = different(lattice, pitch, kernel, m)
    return [family(key, kernel, m, i) for key, i in first], index


def different(lattice, pitch, kernel, m):
    """The different families of B cases: a list of pairs, the key of a family and its first case; and the index (B,) of
    each case's family."""
    fields = [field.reshape(len(m), field[:1].size or 1) for field in (rounded(pitch), m, *kernel) if _is_array(field)]
    table = np.concatenate([field.astype(float) for field in fields], axis=1)
    kind = lattice, type(kernel).__name__
    if len(m) and (table == table[:1]).all():  # one family, the most frequent batch: a tenth of the time
        return [((*kind, float(table[0, 0]), table[0].tobytes()), 0)], np.zeros(len(m), dtype=int)
    first = {}
    index = [first.setdefault(row.tobytes(), (len(first), i))[0] for i, row in enumerate(table)]
    return [((*kind, float(table[i, 0]), row), i) for row, (_, i) in first.items()], np.array(index, dtype=int)


def _is_array(field):
    return isinstance(field, np.ndarray)


def family(key, kernel, m, i):
    """The :class:`Family` of case i, cached under this key. It depends on the case alone."""
    digest = float(int.from_bytes(hashlib.blake2b(repr(key).encode(), digest_size=6).digest()))

    def make():
        return Family(*_fields(key[0], key[2], kernel.take([i]), float(m[i])), digest=digest).with_numbers()

    return _cache.get(key, make)


def rounded(pitch):
    """The pitch over h, rounded to _DIGITS binary digits, and at least _LEAST; NaN and infinity stay."""
    mantissa, power = np.frexp(np.maximum(pitch, _LEAST))
    return np.ldexp(np.round(np.ldexp(mantissa, _DIGITS)), power - _DIGITS)


@np.errstate(all="ignore")  # the numbers may be those of no real body
def _fields(lattice, pitch, kernel, m):
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
    return pitch, reach, *series, _inverse(pitch, reach, series[0]), True, lattice == "disc"


def _bare(lattice):
    """The fields of a family that no law can use; its series are those without a layer."""
    cell, reach = Cell(lattice, 1.0), np.sqrt(REACH / np.pi)
    series = _series(cell, reach, pieces(cell, reach))
    return 1.0, reach, *series, _inverse(1.0, reach, series[0]), False, lattice == "disc"


def _series(cell, reach, N):
    """P, G and Q of a cell, (3, N)."""

    def logs(b):
        p, A, p_max = solved(cell, b, N)
        return np.log([p / (4 / 3 * b**3), A / b**2, p_max / (2 * b / np.pi)])

    return chebyshev_series(logs, cell.pitch, reach, np.array(_SMALL))


def chebyshev_series(of, pitch, reach, small, numbers=_TERMS, enough=_ENOUGH):
    """Chebyshev series (K, N) in 2 v - 1 of K functions of the radius, with as many terms as they need.

    of : function of radii b (S,) -> (K, S)
    small : largest size of the last coefficients of a series, over the larger of 1 and its largest coefficient; a
        number or (K,)
    numbers, enough : as _TERMS and _ENOUGH
    """
    terms = next(count for most, count in numbers if pitch <= most)
    while True:
        x = np.cos(np.pi * (np.arange(terms) + 0.5) / terms)
        values = of(np.sinh((x + 1) / 2 * np.arcsinh(reach * pitch)) / pitch)
        series = 2 / terms * values @ np.cos(np.outer(np.arange(terms), np.arccos(x))).T
        series[:, 0] /= 2
        if not np.isfinite(series).all():
            return series
        size = np.maximum(np.abs(series).max(axis=1), 1.0)
        if terms > enough or (np.abs(series[:, -_LAST:]).max(axis=1) < small * size).all():
            needed = np.flatnonzero((np.abs(series) > _ROUNDING).any(axis=0))
            return series[:, : needed[-1] + 1 if len(needed) else 1]
        terms = int(_MORE * terms)


def solved(cell, b, N):
    """p, A and p_max (3, S) of spots with the radii b (S,), each solved with as many points as it needs."""

    def of(some):
        spot = spots(cell, some, N)
        return spot.p, spot.A, spot.p_max

    return in_groups(cell, b, of, 3)


def in_groups(cell, b, of, count):
    """The results (count, S) of a function `of` that returns `count` arrays (s,) for s radii. It is called with groups
    of radii, all of which need about as many points as the largest of the group."""
    out, beta = np.empty((count, len(b))), b * cell.pitch if cell.L1 is not None else 0 * b
    order, ends = np.argsort(beta), [most for _, most in FEW]
    while len(order):
        first = beta[order[0]]
        # on one panel the radii that need the same number of points; on several panels those up to a fifth larger
        most = next((end for end in ends if first <= end), 1.2 * first)
        some = order[: np.count_nonzero(beta[order] <= most)]
        some = some[: max(1, int(_AT_ONCE / (max(1.0, beta[some[-1]] / 5) * POINTS) ** 2))]
        out[:, some], order = of(b[some]), order[len(some) :]
    return out


def _inverse(pitch, reach, P):
    """Chebyshev coefficients (GUESS,) of ln(b/r), by least squares, in asinh(r/h) over its largest value."""
    v = (1 - np.cos(np.pi * (np.arange(_FITTED) + 0.5) / _FITTED)) / 2
    b = np.sinh(v * np.arcsinh(reach * pitch)) / pitch
    logs = chebyshev.chebval(2 * v - 1, P) / 3
    at = np.arcsinh(b * np.exp(logs) * pitch) / np.arcsinh(reach * np.exp(P.sum() / 3) * pitch)
    return np.linalg.lstsq(chebyshev.chebvander(2 * at - 1, GUESS - 1), -logs)[0]


def _while_like_hex(cell, N, reach):
    """The radius up to which the disc cell on a soft layer has about the same A as the hexagonal lattice; `reach` on
    other layers."""
    hexagonal = cell._replace(lattice="hex")
    of_hex = pieces(hexagonal, reach)
    if not (of_hex.at(np.zeros(1))[0] < pieces(Cell("hex", 1.0), reach).at(np.zeros(1))[0]).all():
        return reach
    b = reach * np.sqrt((1 + np.arange(_SCANNED)) / _SCANNED)
    more = _ratio(cell, N, hexagonal, of_hex, b) - _bare_ratio(b)
    too_soft = np.flatnonzero(~(more <= _SOFT))
    if not len(too_soft):
        return reach
    i = int(too_soft[0])
    low, high = (more[i - 1] if i else 0.0), more[i]
    part = (_SOFT - low) / (high - low) if np.isfinite(high) else 0.0
    lam = (b[i - 1] ** 2 if i else 0.0) * (1 - part) + part * b[i] ** 2
    return float(np.sqrt(lam))


def _ratio(cell, N, hexagonal, of_hex, b):
    """A of a disc cell over that of the hexagonal lattice at radii b; NaN where p, A or p_max of the disc cell is not
    above 0."""
    disc, hexagon = solved(cell, b, N), solved(hexagonal, b, of_hex)
    return np.where((disc > 0).all(axis=0), disc[1] / hexagon[1], np.nan)


def _bare_ratio(b):
    """:func:`_ratio` without a layer."""
    cells = Cell("disc", 1.0), Cell("hex", 1.0)
    return _ratio(cells[0], pieces(cells[0], b.max()), cells[1], pieces(cells[1], b.max()), b)
