"""Write solver/laws/lattices.csv: equal paraboloids on a square and a hexagonal lattice, pressed on a half-space.

In units E = Ra = l = 1, l = 1/sqrt(Nbar): a rigid surface, r²/2 about each point of the lattice, under the mean
pressure p. A is its approach, the mean displacement of the half-space dropped; lam is the share of the area in contact,
p_max the pressure under a summit.
The pressures belong to equal steps of t, the variable of the law (tabulated.py), and to three small values of t.

- Small spots ("series"): the field of the other spots about a summit is a sum of even powers of r, whose coefficients
  are lattice sums times the moments of the pressure; a circular spot has a closed form in such a field (Sneddon 1965).
  The neglected terms, of the order (b/l)^5, make the spot not round, and change A and p_max by their square.
- Larger ones ("cell"): conjugate gradients of Polonsky and Keer (Wear 231, 1999, 206) on a grid over a quarter of the
  periodic cell, the displacement 2 p/k by cosine transforms. The edge of the contact is where cosh(2π p/J) comes down
  to 1 along rays: there p falls as a root, and near full contact as (J/2π) arccosh(x/w) at a distance x from a ridge
  with the change of slope J, along which there is a gap of 2 w.

The columns *_change are the relative changes from a grid of half as many points a side: bounds of the table's errors.
Eleven minutes on one processor: ``python tools/references/make_lattices.py``.
"""

from functools import cache
from math import comb, factorial
from pathlib import Path

import mpmath as mp
import numpy as np
from scipy import fft
from scipy.ndimage import map_coordinates
from scipy.optimize import brentq

FILE = Path(__file__).resolve().parents[2] / "solver/laws/lattices.csv"
COLUMNS = ("lattice", "p", "A", "lam", "p_max", "A_change", "lam_change", "p_max_change", "by")
SIDES = {"square": (1.0, 1.0), "hex": (np.sqrt(2 / np.sqrt(3)), np.sqrt(2 * np.sqrt(3)))}
#: Points along half a side of the cells on the finest grid; grids of half as many also have nearly square meshes.
POINTS = {"square": (512, 512), "hex": (384, 672)}
#: The values of t, up to 0.76; and the largest spot of the series.
T, ROUND = (0.002, 0.005, 0.01, *(round(0.02 * i, 2) for i in range(1, 39))), 0.2
#: Terms of the series, and the change of pressure that ends an iteration.
TERMS, CLOSED = 12, 1e-9
#: The edge along a ray: a polynomial of this degree through cosh(2π p/J) at these distances inside, in meshes.
INSIDE, DEGREE = np.linspace(4, 12, 9), 2


@cache
def lattice_sum(lattice, s):
    """Sum of 1/R^s over the other points; for s = 1 less its integral (by continuation of the zeta functions)."""
    x = mp.mpf(s) / 2
    if lattice == "square":
        return float(4 * mp.zeta(x) * mp.power(4, -x) * (mp.zeta(x, mp.mpf(1) / 4) - mp.zeta(x, mp.mpf(3) / 4)))
    three = mp.power(3, -x) * (mp.zeta(x, mp.mpf(1) / 3) - mp.zeta(x, mp.mpf(2) / 3))
    return float(6 * mp.zeta(x) * three / mp.mpf(SIDES["hex"][0]) ** s)


def series(lattice, b):
    """p, A, lam, p_max of round spots of radius b: the shape under a summit is r²/2 plus the others' sum_k f_k r^2k."""
    orders = range(TERMS + 1)
    k, i = np.arange(1, TERMS + 1), np.arange(TERMS + 1)
    depth = np.array([4**j * factorial(j) ** 2 / factorial(2 * j) for j in orders])
    arm, field = depth / (2 * i + 1), np.array([lattice_sum(lattice, 2 * j + 1) for j in orders]) / np.pi / depth**2
    depth = depth[1:]
    # moments of r^2i of the pressure under the shape r^2k, and their contribution to the shape
    moments = 4 * k * depth * b ** (2.0 * k + 2 * i[:, None] + 1) * arm[:, None] / (2 * k + 2 * i[:, None] + 1)
    shape = [[field[n + j] * comb(n + j, n) ** 2 if n + j <= TERMS else 0.0 for j in orders] for n in orders[1:]]
    powers = np.linalg.solve(np.eye(TERMS) - np.array(shape) @ moments, 0.5 * (k == 1))
    even = moments @ powers
    A = (powers * depth * b ** (2.0 * k)).sum() + (field * even).sum()
    return even[0], A, np.pi * b * b, (powers * depth * 2 * k / (2 * k - 1) * b ** (2.0 * k - 1)).sum() / np.pi


def quarter(lattice, shape):
    """Height, wave number of the cosines and weight of the points of a quarter of the cell, ends included."""
    axes = [np.linspace(0, side / 2, n + 1) for side, n in zip(SIDES[lattice], shape, strict=True)]
    x, y = np.meshgrid(*axes, indexing="ij")
    height = (x**2 + y**2) / 2
    if lattice == "hex":
        height = np.minimum(height, ((x - x.max()) ** 2 + (y - y.max()) ** 2) / 2)
    waves = (np.pi / axis[-1] * np.arange(len(axis)) for axis in axes)
    ends = (np.where(np.isin(np.arange(n + 1), (0, n)), 0.5, 1.0) / n for n in shape)
    return height, np.hypot(*np.meshgrid(*waves, indexing="ij")), np.outer(*ends)


def cell(lattice, p, shape, q=None):
    """A, lam, p_max and the pressure at the points of a quarter of the cell, ends included; `q` : first pressure."""
    height, wave, weight = quarter(lattice, shape)
    compliance = np.divide(2.0, wave, out=np.zeros_like(wave), where=wave > 0) / (4 * shape[0] * shape[1])

    def displaced(q):
        return fft.dctn(compliance * fft.dctn(q, type=1), type=1)

    q = np.full_like(height, p) if q is None else q * (p / (weight * q).sum())
    way, size, conjugate = np.zeros_like(q), 1.0, 0.0
    for _ in range(1000):
        inside, gap = q > 0, displaced(q) + height
        counted = weight * inside
        approach = (counted * gap).sum() / counted.sum()
        gap -= approach
        old_size, size = size, (counted * gap**2).sum()
        way = np.where(inside, gap + conjugate * size / old_size * way, 0.0)
        change = displaced(way)
        change -= (counted * change).sum() / counted.sum()
        step = (counted * gap * way).sum() / (counted * change * way).sum()
        old, q = q, np.maximum(q - step * way, 0.0)
        returning = (q == 0) & (gap < 0)
        conjugate = 0.0 if returning.any() else 1.0
        q = np.where(returning, q - step * gap, q)
        q *= p / (weight * q).sum()
        if (weight * np.abs(q - old)).sum() < CLOSED * p:
            return approach, area(lattice, q), q[0, 0], q
    raise ArithmeticError(f"{lattice}, p = {p}: conjugate gradients did not end")


def full_contact(lattice, fine=8):
    """p_max - p at full contact: the pressure that flattens the relief, on grids of `fine`/2 and `fine` times as many
    points as POINTS/2, extrapolated (of second order)."""
    pressures = []
    for factor in (fine // 2, fine):
        height, wave, _ = quarter(lattice, tuple(factor * np.array(POINTS[lattice]) // 2))
        pressure = -fft.dctn(wave / 2 * fft.dctn(height, type=1), type=1)
        pressures.append(pressure[0, 0] / (4 * np.prod(np.array(height.shape) - 1)))
    return pressures[1] + (pressures[1] - pressures[0]) / 3


def area(lattice, q):
    """Share of the area in contact, from the radius of the spot along rays over the least angle of symmetry."""
    steps = [side / 2 / (n - 1) for side, n in zip(SIDES[lattice], q.shape, strict=True)]
    mesh, angle = max(steps), np.pi / (6 if lattice == "hex" else 4)
    points, weights = np.polynomial.legendre.leggauss(48)
    # cut off far inside the edge: otherwise rounding and waves would be large there
    falling = np.cosh(np.minimum(2 * np.pi * q / SIDES[lattice][0], 12.0)) - 1
    falling = np.pad(falling, ((6, 0), (6, 0)), mode="reflect")
    radii = np.arange(0, 0.75 / mesh, 0.5) * mesh
    total = 0.0
    for theta, w in zip(angle * (points + 1) / 2, weights * angle / 2, strict=True):
        way = np.cos(theta) / steps[0], np.sin(theta) / steps[1]
        outside = map_coordinates(falling, [v * radii + 6 for v in way], order=1, mode="nearest") == 0
        last = radii[np.argmax(outside)] if outside.any() else radii[-1]
        inside = map_coordinates(falling, [v * (last - mesh * INSIDE) + 6 for v in way], order=3, mode="nearest")
        roots = np.roots(np.polyfit(-INSIDE, inside, DEGREE))
        edge = last + mesh * roots[np.argmin(np.abs(roots))].real
        total += 2 * np.pi / angle * w * edge**2 / 2
    return total


def finer(q):
    """The pressure on a grid of twice as many points."""
    at = np.meshgrid(*(np.linspace(0, n - 1, 2 * n - 1) for n in q.shape), indexing="ij")
    return map_coordinates(q, at, order=1)


def small(lattice, p):
    """A, lam, p_max of small spots under the pressure p."""

    def too_large(b):
        return np.log(series(lattice, b)[0] / p)

    return series(lattice, brentq(too_large, 0.5 * np.cbrt(p), 1.2 * np.cbrt(p), xtol=1e-15))[1:]


def large(lattice, p):
    """A, lam, p_max on a grid that is refined step by step, and their relative changes in the last step."""
    fine, q, levels = np.array(POINTS[lattice]), None, []
    for parts in (8, 4, 2, 1):
        *values, q = cell(lattice, p, tuple(fine // parts), q if q is None else finer(q))
        levels.append(values)
    change = np.abs(np.divide(*levels[-2:]) - 1)
    return values, change


def rows(lattice):
    """The rows of one lattice, as texts."""
    p_star = 2 / (3 * np.sqrt(np.pi))
    for t in T:
        p = p_star * t**3 / (1 - t)
        by = "series" if p < series(lattice, ROUND)[0] else "cell"
        values, change = (small(lattice, p), np.zeros(3)) if by == "series" else large(lattice, p)
        numbers = [*(f"{v:.10g}" for v in (p, *values)), *(f"{v:.1e}" for v in change)]
        yield ",".join([lattice, *numbers, by])
        print(lattice, t, *numbers, flush=True)


def main():
    """Write the table."""
    text = "\n".join([",".join(COLUMNS), *(row for lattice in SIDES for row in rows(lattice)), ""])
    FILE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
