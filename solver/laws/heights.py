"""The micro laws of spherical asperities of random heights: normal, cut at ±c σ, uniform, and of a histogram.

As in the disc cell, Eqs (6) and (7), a spot feels the others as a mean field: the uniform pressure p outside its cell.
Each summit has its own approach and its own spot, and p is the mean over them: ``spread.py``. A = 0 where the highest
summit just touches. If all heights are equal, σ = 0, the law is the disc cell. Few summits touch at the edge of the
contact: p ~ A^(5/2) there, until A is about σ/c. Without the cut c there would be no highest summit, and so no edge.

q is the root of an equation at each y. So a law is tabulated when it is first used, once for each σ/A* and c. Many
cases with one σ/A* are fast; a batch in which every case has its own waits for as many tables.

On the coated body itself the spots are those of :mod:`.cell.summits`, and each family of bodies has a table of its own.
The table ends at the λ at which the disc cell ends.
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from ..numerics import special
from ..numerics.caches import Cache
from ..numerics.quadrature import gauss_legendre
from ..parameters import Parameter
from . import disc_cell, spread
from .cell import cell_law as cell
from .cell import random_heights as on_body
from .cell.family import different, family
from .cell.summits import SUMMIT, Lookup, summit
from .law import Bound, Curve, Law, where_positive

#: If σ/A* is below this, the power law of small pressures (`edge`) is that of equal heights.
_ALIKE = 0.03
#: Bytes of the tables that are cached, some 4,000 of normal heights, and number of tables that are made at a time.
_MOST_BYTES, _AT_ONCE = 6.5e7, 64
#: Largest relative error of A, λ and p_max that the tables cause (tests/laws/heights/test_heights.py). λ reaches it;
#: the error of A is 5e-6, with uniform heights 3e-5. STEPPED is that of histograms, whose steps make corners in the
#: curves (the error of A is 1e-4); their tables have _FINE times as many knots.
ERROR, STEPPED, _FINE = 2e-4, 5e-4, 4
#: Corners are sharp where few summits stand above many: where a share is over _RARE times the mean of the shares above
#: it. The error then grows as this ratio to the power _SHARPER (tests/laws/heights/test_histograms.py).
_RARE, _SHARPER = 25.0, 1.7
#: Number of points of the quadrature over a density, which for the normal one is exact to rounding
#: (tests/laws/heights/test_touching.py), and number of cases that are computed at a time.
_ENOUGH, _ROWS = 32, 10_000
#: Number of Newton steps from the first guess on a table of a coated body, and the largest change of ln y in a step.
_TO_TABLE, _LONGEST = 4, 3.0

#: Standard deviation σ of the heights, in R; and c, the largest height above the mean, over σ.
SIGMA = Parameter(interval="[0, 10]", powers=(0, 1))
CUT = Parameter(4.0, interval="[3, 5]")
#: Half the width of a uniform density over its standard deviation.
UNIFORM = np.sqrt(3.0)


class Symmetric(NamedTuple):
    """A density of heights from c σ below their mean to c σ above it. x is the depth below the highest summit, over σ;
    the c of B cases is (B, 1).

    shape : (x, c) -> density; any shapes that broadcast
    c : the c of all cases; None: it is the parameter `cut`
    """

    shape: Callable
    c: float | None = None

    fine = 1  # factor of the number of knots of its tables

    @property
    def parameters(self):
        return {"sigma": SIGMA} | ({"cut": CUT} if self.c is None else {})

    def at(self, x, cut):
        return self.shape(x, cut)

    def top(self, cut):
        """The density at x = 0, (B, 1)."""
        return self.shape(np.zeros_like(cut), cut)

    def edges(self, cut):
        """(B, pieces + 1): the x at which its smooth pieces end."""
        return np.concatenate([np.zeros_like(cut), 2 * cut], axis=1)

    def mean(self, cut):
        """The mean x (B, 1)."""
        return cut


class Histogram(NamedTuple):
    """The density of a histogram, with the methods of :class:`Symmetric`. x is in R and σ is 1; c has no meaning, and
    is 0.

    shares : the density in each bin, from the highest summits down
    step : width of a bin
    depth : the mean depth below the highest summit
    """

    shares: tuple[float, ...]
    step: float
    depth: float

    fine, c, parameters = _FINE, 0.0, {}

    def at(self, x, cut):
        return np.array(self.shares)[:, None] * np.ones_like(x)

    def top(self, cut):
        return np.full_like(cut, self.shares[0])

    def edges(self, cut):
        return np.tile(self.step * np.arange(len(self.shares) + 1), (len(cut), 1))

    def mean(self, cut):
        return np.full_like(cut, self.depth)


def _normal(x, cut):
    return np.exp(-((cut - x) ** 2) / 2) / (np.sqrt(2 * np.pi) * special.erf(cut / np.sqrt(2)))


def _uniform(x, cut):
    return np.ones_like(x) / (2 * cut)


_cache = Cache(_MOST_BYTES)


def _tables(density, field, sigma, cut):
    """Tables (G, 2, KNOTS) of ln q and ln λ for the G different pairs of sigma and cut (B, 1), and the index (B,) of
    each case's table. A histogram has _FINE KNOTS knots."""
    # as complex numbers, pairs are sorted in a tenth of the time
    pairs, group = np.unique(np.concatenate([sigma, cut], axis=1).view(complex)[:, 0], return_inverse=True)
    keys = [(density, field, pair.real, pair.imag) for pair in pairs.tolist()]
    tables = _cache.several(keys, lambda missing: _computed(density, field, missing))
    return np.array(tables).reshape(len(keys), 2, spread.KNOTS * density.fine), group.ravel()


def _computed(density, field, keys):
    """The tables of these keys, some at a time: fine ones are larger, and their densities have more pieces."""
    tables, at_once = [], _AT_ONCE // density.fine**2
    for begin in range(0, len(keys), at_once):
        s, c = np.array([key[2:] for key in keys[begin : begin + at_once]]).T[:, :, None]
        at = partial(density.at, cut=c[..., None, None])
        several = spread.tables(density.edges(c), at, field, s, _relief(density, s, c), density.fine)
        tables += [table.copy() for table in np.moveaxis(several, 1, 0)]
    return tables


def _relief(density, sigma, cut):
    return density.mean(cut) * sigma + 1 / 3


def _looked_up(density, field, which, y, sigma, cut):
    """q (B, m) if `which` is 0, λ (B, m) if it is 1; and the derivative of its logarithm by ln y."""
    table, group = _tables(density, field, np.where(sigma > 0, sigma, 1.0), cut)
    step = spread.STEP * spread.KNOTS / table.shape[-1]
    value, slope = spread.look_up(np.ascontiguousarray(table[:, which]), group, y, step)
    return np.exp(value), slope


def _curve(density, field, y, sigma, cut):
    q, slope = _looked_up(density, field, 0, np.minimum(y, spread.LAST), sigma, cut)
    relief = _relief(density, sigma, cut)
    if (y > spread.LAST).any():
        q, slope = spread.extrapolated(y, q, slope, relief)
    (delta, w), dq = spread.depth(y, q, relief), slope * q / y
    spots = Curve(q, delta, dq, 2 * delta / y * (1 - y * dq / (w + q)))
    if (sigma > 0).all():
        return spots
    return Curve(
        *(np.where(sigma > 0, rough, level) for rough, level in zip(spots, disc_cell.spot_curve(y), strict=True))
    )


def _guess(density, field, q, sigma, cut):
    """y with q(y) = q, roughly. It follows from an A by the power law of small pressures, which is kept between the A
    of equal heights and that plus the depth of the mean plane."""
    level = disc_cell.spot_guess(np.maximum(q, 0.0))
    alike = disc_cell.spot_curve(np.maximum(level, 1e-300)).g
    power_law = (1.25 * np.pi * sigma / density.top(cut) * np.maximum(q, 0.0)) ** 0.4
    delta = np.clip(power_law, alike, alike + density.mean(cut) * sigma)
    return np.where(sigma > 0, spread.unknown(delta, q, _relief(density, sigma, cut)), level)


def _area(density, field, y, q, sigma, cut):
    area = np.minimum(_looked_up(density, field, 1, y, sigma, cut)[0], 1.0)
    return np.where(sigma > 0, area, disc_cell.spot_area(y))


def _peak(density, field, y, q, sigma, cut):
    """p_max/p* under the highest summit. Where its cell is filled, the middle of a flat punch adds its pressure."""
    delta, k = spread.depth(y, q, _relief(density, sigma, cut))[0], field * (2 / 3) * q
    v, c2 = spread.spot(delta, k)
    c = np.sqrt(c2)
    peak = 3 / np.pi * c + field * (2 / np.pi) * q * np.arctan2(c, v) + 1.5 / np.pi * np.maximum(delta - 1, 0.0)
    return np.where(sigma > 0, peak, disc_cell.spot_peak(y, q))


def _edge(density, field, sigma, cut):
    spread_out = sigma > _ALIKE
    gamma = (1.25 * np.pi * sigma / density.top(cut)) ** 0.4
    return np.where(spread_out, gamma, (np.pi / 2) ** (2 / 3)), np.where(spread_out, 0.4, 2 / 3)


def _touching(density, A, sigma=1.0, cut=None, **_):
    """Share of the summits that are at most A below the highest, by quadrature over each piece of the density. It has
    the shape to which A and the parameters broadcast."""
    A, sigma, cut = np.broadcast_arrays(A, sigma, density.c if cut is None else cut)
    with np.errstate(all="ignore"):
        depths, cuts = (A / sigma).reshape(-1, 1), cut.reshape(-1, 1)
    (t, weights), shares = gauss_legendre(_ENOUGH), []
    for rows in (slice(first, first + _ROWS) for first in range(0, max(1, len(cuts)), _ROWS)):
        depth, c = depths[rows], cuts[rows]
        edges = density.edges(c)
        width = np.clip(depth, edges[:, :-1], edges[:, 1:]) - edges[:, :-1]
        at = density.at((edges[:, :-1, None] + width[:, :, None] * t)[:, None], c[:, :, None, None])
        shares.append(((at @ weights)[:, 0] * width).sum(axis=1))
    return np.concatenate(shares).reshape(A.shape)


def _scales(density, field, E, Nbar, Ra, sigma=1.0, cut=None):
    p_star, A_star = disc_cell.scales(E, Nbar, Ra)
    return p_star, A_star, sigma / A_star, density.c if cut is None else cut


class _Body(NamedTuple):
    """The functions of the law of a density of heights on the coated body. Its `own` numbers are sigma/A* and cut, (B,
    1) each, the rows of the disc cell, and the rows of summits."""

    density: object

    def bound(self, law, kernel, m, h, E, Nbar, Ra, sigma=1.0, cut=None):
        """:class:`~solver.laws.law.Bound` of the cases."""
        p_star, A_star, sigma, cut = _scales(self.density, 1.0, E, Nbar, Ra, sigma, cut)
        with np.errstate(all="ignore"):
            keys, index = different("disc", 1 / (h * np.sqrt(Nbar)), kernel, m)
        cells = [family(key, kernel, m, i) for key, i in keys]
        summits = [summit(key, disc, kernel, m, i) for (key, i), disc in zip(keys, cells, strict=True)]
        numbers = [(v * np.ones(np.shape(E)))[:, None] for v in (sigma, cut)]
        return Bound(law, p_star, A_star, (*numbers, cell.stacked(cells, index), cell.stacked(summits, index)))

    def tables(self, sigma, cut, rows, summits):
        """As :func:`_tables`; there is a table for each family with each sigma and cut."""
        numbers = np.concatenate([np.where(sigma > 0, sigma, 1.0), cut, cell.number(rows, "digest")], axis=1)
        if len(numbers) and (numbers == numbers[0]).all():
            triples, first, group = numbers[:1], [0], np.zeros(len(numbers), dtype=int)
        else:
            triples, first, group = np.unique(numbers, axis=0, return_index=True, return_inverse=True)
        keys = [(self.density, "body", *triple) for triple in triples.tolist()]

        def computed(missing):
            at = [keys.index(key) for key in missing]
            return [self._table(triples[i], rows[first[i]], summits[first[i]]) for i in at]

        tables = _cache.several(keys, computed)
        return np.array(tables).reshape(len(keys), 2, spread.KNOTS * self.density.fine), group.ravel()

    def _table(self, numbers, row, summit):
        sigma, cut = numbers[:2, None, None]
        at, relief = partial(self.density.at, cut=cut[..., None, None]), float(_relief(self.density, sigma, cut)[0, 0])
        lam = cell.number(row[None], "end")[0, 0] ** 2
        return on_body.table(Lookup(summit), (self.density.edges(cut), self.density.fine), at, sigma, relief, lam)

    def looked_up(self, which, y, *own):
        """As :func:`_looked_up`."""
        table, group = self.tables(*own)
        value, slope = spread.look_up(np.ascontiguousarray(table[:, which]), group, y, spread.STEP / self.density.fine)
        return np.exp(value), slope

    def curve(self, y, *own):
        sigma, cut, rows, _ = own
        q, slope = self.looked_up(0, np.minimum(y, spread.LAST), *own)
        relief = _relief(self.density, sigma, cut)
        if (y > spread.LAST).any():
            q, slope = spread.extrapolated(y, q, slope, relief)
        (delta, w), dq = spread.depth(y, q, relief), slope * q / y
        spots = Curve(q, delta, dq, 2 * delta / y * (1 - y * dq / (w + q)))
        if (sigma > 0).all():
            return spots
        level = cell.spot_curve(y, rows)
        return Curve(
            *(np.where(sigma > 0, of_spots, of_level) for of_spots, of_level in zip(spots, level, strict=True))
        )

    def guess(self, q, *own):
        """As :func:`_guess`, followed by Newton steps on the table."""
        sigma, cut, rows, _ = own
        level = cell.spot_guess(q, rows)
        alike = cell.spot_curve(np.maximum(level, 1e-300), rows).g
        power_law = (1.25 * np.pi * sigma / self.density.top(cut) * np.maximum(q, 0.0)) ** 0.4
        delta = np.clip(power_law, alike, alike + self.density.mean(cut) * sigma)
        y = np.maximum(spread.unknown(delta, q, _relief(self.density, sigma, cut)), 1e-300)
        (table, group), goal = self.tables(*own), np.log(np.maximum(q, 1e-300))
        table = np.ascontiguousarray(table[:, 0])
        for _ in range(_TO_TABLE):
            now, slope = spread.look_up(table, group, y, spread.STEP / self.density.fine)
            y = y * np.exp(np.clip((goal - now) / slope, -_LONGEST, _LONGEST))
        return where_positive(q, np.where(sigma > 0, y, level))

    def area(self, y, q, *own):
        area = np.minimum(self.looked_up(1, y, *own)[0], 1.0)
        return np.where(own[0] > 0, area, cell.spot_area(y, q, own[2]))

    def peak(self, y, q, *own):
        """p_max/p* under the highest summit."""
        sigma, cut, rows, summits = own
        delta = spread.depth(y, q, _relief(self.density, sigma, cut))[0]
        return np.where(sigma > 0, on_body.peak(summits, q, delta), cell.spot_peak(y, q, rows))

    def spot(self, y, q, *own):
        """b/Bbar of the spot of the highest summit."""
        sigma, cut, _, summits = own
        delta = spread.depth(y, q, _relief(self.density, sigma, cut))[0]
        return np.where(sigma > 0, on_body.highest(summits, q, delta), y)

    def edge(self, sigma, cut, *_):
        return _edge(self.density, 1.0, sigma, cut)

    def end(self, *own):
        """The largest q of the table, at which its λ ends."""
        table, group = self.tables(*own)
        last = np.argmax(np.diff(table[:, 1], axis=1) == 0, axis=1) - on_body.PAST
        most = np.exp(table[np.arange(len(table)), 0, last])[group, None]
        of_level = cell.number(own[2], "most")
        return np.where(of_level > 0, np.where(own[0] > 0, most, of_level), 0.0)


def _of_heights(name, density, **rest):
    """`on_body` of :class:`~solver.laws.law.Law`."""
    body = _Body(density)
    parts = {part: getattr(body, part) for part in ("curve", "area", "peak", "edge", "guess", "end", "spot")}
    return partial(body.bound, Law(name=f"{name}_on_body", scales=partial(_scales, density, 1.0), **parts, **rest))


def law(name, density, field=1.0, **rest):
    """:class:`~solver.laws.law.Law` of heights with this density. `field` 0: the asperities do not feel each other."""
    parts = {"curve": _curve, "area": _area, "peak": _peak, "edge": _edge, "guess": _guess, "scales": _scales}
    parts = {key: partial(part, density, field) for key, part in parts.items()}
    rest = {"error": ERROR, "touching": partial(_touching, density), "rise": 1.1, "corners": True} | rest
    rest["parameters"] = disc_cell.PARAMETERS | density.parameters
    felt = {"on_body": _of_heights(name, density, **rest), "cell": SUMMIT} if field else {}
    return Law(name=name, **felt, **parts, **rest)


def histogram(name, z, share, version):
    """:class:`~solver.laws.law.Law` of summits with the heights z (n,), in R, and their shares `share` (n,). z ascends
    in equal steps. Around each z is a bin as wide as a step, in which the heights are evenly spread."""
    step = (z[-1] - z[0]) / (len(z) - 1)
    depth, shares = (z[-1] - z)[::-1] + step / 2, (share / (share.sum() * step))[::-1]
    bins = Histogram(tuple(shares.tolist()), step, float(depth @ shares * step))
    above = (np.cumsum(share[::-1]) / np.arange(1, len(z) + 1))[-2::-1]  # the mean above each share except the last
    sharp = max(1.0, (share[:-1] / above).max() / _RARE)
    return law(name, bins, version=version, error=STEPPED * sharp**_SHARPER)


NORMAL, EVEN = Symmetric(_normal), Symmetric(_uniform, UNIFORM)
LAW = law("normal_heights", NORMAL, version="2")
UNIFORM_LAW = law("uniform_heights", EVEN)
