"""A rough sphere with every asperity resolved: the contact of both scales at once, by conjugate gradients."""

from itertools import product
from typing import NamedTuple

import numpy as np
from influence import Layer, coefficients, convolution

from solver.laws.cell.periodic import division_by, pressed_flat, response_of

#: Yastrebov, Anciaux and Molinari, Tribology International 114 (2017) 161: a contact made of elements is too large by
#: this factor times the length of its edge along the elements, times their side, if they lie on the edge at random.
OUTSIDE = (np.pi - 1 + np.log(2)) / 24


class Punch(NamedTuple):
    """The sphere r²/2 with paraboloids of radius Ra on a square lattice, one in the middle; R = 1.

    heights : of the summits (cells, cells) above their mean plane, cells odd; None: all of one height
    """

    pitch: float
    Ra: float
    heights: np.ndarray | None = None


class Resolved(NamedTuple):
    """Depth D of the mean plane of the summits, pressure (n, n) at the middles of the elements, their positions (n,)
    and their side; R = E2* = 1."""

    D: float
    p: np.ndarray
    middle: np.ndarray
    side: float


def resolved(punch: Punch, P, half, points, layer: Layer | None = None, start=None, tolerance=1e-6) -> Resolved:
    """The punch pressed by P on a half-space, or on a layer on one.

    Square elements of constant pressure cover a square of side 2 `half`, `points` a side, not periodic; for summits of
    one height a quarter of them is enough. The solver of scans solves it, from the pressure `start` (points,
    points), until the gap
    under the pressure is within `tolerance` of the depth of a smooth sphere on a half-space. A gap is divided by the
    waves of a half-space, as if the square were periodic; that changes the number of steps alone.
    """
    side = 2 * half / points
    middle = (np.arange(points) + 0.5) * side - half
    even = punch.heights is None
    part = slice(points // 2, None) if even else slice(None)
    displaced = convolution(coefficients(side, points, layer), even)
    x, y = np.meshgrid(middle[part], middle[part], indexing="ij")
    start = np.where(np.hypot(x, y) < 0.8 * half, 1.0, 0.0) if start is None else start[part, part]
    mean, allowed = P / (2 * half) ** 2, tolerance * (9 * P**2 / 16) ** (1 / 3)
    divided = division_by(response_of(x.shape, side, side, None, even), even)
    p, D, ended = pressed_flat(height(punch, x, y), displaced, mean, start * (mean / start.mean()), allowed, divided)
    assert ended, "conjugate gradients did not end"
    if even:
        p = np.pad(p, [(points // 2, 0)] * 2, mode="symmetric")
    return Resolved(D, p, middle, side)


def height(punch: Punch, x, y) -> np.ndarray:
    """Height of the punch over the mean summit in the middle, where the mean surface of the summits is lowest."""
    macro = (x**2 + y**2) / 2
    if punch.heights is None:
        near = [v - np.round(v / punch.pitch) * punch.pitch for v in (x, y)]
        return macro + (near[0] ** 2 + near[1] ** 2) / (2 * punch.Ra)
    summits = np.pad(punch.heights, 1, constant_values=-np.inf)  # there are none outside the lattice
    return macro + asperities(x, y, punch.pitch, punch.Ra, summits)


def asperities(x, y, pitch, Ra, summits) -> np.ndarray:
    """Height of the lowest of the paraboloids nearby over their mean plane. summits : (n, n) heights; the middle one is
    above x = y = 0, and a row surrounds those of the cells on each side."""
    near, middle = [np.round(v / pitch).astype(int) for v in (x, y)], len(summits) // 2

    def paraboloid(i, j):
        squared_distance = (x - i * pitch) ** 2 + (y - j * pitch) ** 2
        return squared_distance / (2 * Ra) - summits[i + middle, j + middle]

    return np.min([paraboloid(near[0] + i, near[1] + j) for i, j in product((-1, 0, 1), repeat=2)], axis=0)


def cell_means(contact: Resolved, pitch) -> tuple[np.ndarray, np.ndarray]:
    """Distance from the middle, and mean pressure, of each cell of the lattice; ascending distance."""
    which = np.round(contact.middle / pitch).astype(int)
    which -= which.min()
    count = which.max() + 1
    place = (which[:, None] * count + which[None, :]).ravel()
    load = np.bincount(place, contact.p.ravel(), count**2) * contact.side**2 / pitch**2
    at = (np.arange(count) - (count - 1) / 2) * pitch
    r = np.hypot(at[:, None], at[None, :]).ravel()
    order = np.argsort(r, kind="stable")
    return r[order], load[order]


def real_area(contact: Resolved) -> float:
    """Area of the elements with pressure, less their excess over the edge of the contact."""
    touched = contact.p > 0
    edge = sum(np.count_nonzero(np.diff(touched, axis=axis)) for axis in (0, 1))
    return (np.count_nonzero(touched) - OUTSIDE * edge) * contact.side**2


def touched_share(pressure) -> float:
    """Share of the elements of a period with pressure, less their excess over the edges of the spots."""
    touched = pressure > 0
    edge = sum(np.count_nonzero(touched != np.roll(touched, 1, axis)) for axis in (0, 1))
    return (np.count_nonzero(touched) - OUTSIDE * edge) / touched.size


def width(r, p, area) -> float:
    """sqrt(5/2 <r²>) of a pressure at r, which is the contact radius for Hertz's pressure."""
    return float(np.sqrt(2.5 * (p * r**2 * area).sum() / (p * area).sum()))
