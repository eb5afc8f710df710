"""A rough sphere with every asperity resolved: the contact of both scales at once, by conjugate gradients."""

from typing import NamedTuple

import numpy as np
from conjugate_gradients import pressed
from scipy import fft


class Resolved(NamedTuple):
    """Depth D, pressure (n, n) at the middles of the elements, their positions (n,) and their side; R = E = 1."""

    D: float
    p: np.ndarray
    middle: np.ndarray
    side: float


def resolved(pitch, Ra, P, half, points, start=None, tolerance=1e-5) -> Resolved:
    """The sphere r²/2 with paraboloids of radius Ra on a square lattice, pressed on a half-space by P.

    Square elements of constant pressure (Johnson 1985, 3.25) over a square of 2 `half`, `points` a side, not periodic:
    the kernel is padded to twice the size. tests/conjugate_gradients.py solves it, from the pressure `start`.
    """
    side = 2 * half / points
    middle = (np.arange(points) + 0.5) * side - half
    x, y = np.meshgrid(middle, middle, indexing="ij")
    beside = [v - np.round(v / pitch) * pitch for v in (x, y)]
    height = (x**2 + y**2) / 2 + (beside[0] ** 2 + beside[1] ** 2) / (2 * Ra)

    def corner(x, y):
        return x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))

    far = np.meshgrid(*2 * [np.arange(-points, points) * side], indexing="ij")
    right, top, left, bottom = far[0] + side / 2, far[1] + side / 2, far[0] - side / 2, far[1] - side / 2
    kernel = corner(right, top) - corner(left, top) - corner(right, bottom) + corner(left, bottom)
    kernel = fft.rfft2(fft.ifftshift(kernel / np.pi))

    def displaced(p):
        return fft.irfft2(kernel * fft.rfft2(p, s=(2 * points, 2 * points)))[:points, :points]

    if start is None:
        start = np.where(np.hypot(x, y) < 0.8 * half, 1.0, 0.0)
    D, p = pressed(displaced, height, start, P / (2 * half) ** 2, tolerance)
    return Resolved(D, p, middle, side)


def cell_means(found: Resolved, pitch) -> tuple[np.ndarray, np.ndarray]:
    """Distance from the middle, and mean pressure, of each cell of the lattice that is touched; ascending distance."""
    which = np.round(found.middle / pitch).astype(int)
    which -= which.min()
    count = which.max() + 1
    place = (which[:, None] * count + which[None, :]).ravel()
    load = np.bincount(place, found.p.ravel(), count**2) * found.side**2 / pitch**2
    at = (np.arange(count) - (count - 1) / 2) * pitch
    r = np.hypot(at[:, None], at[None, :]).ravel()
    touched = load > 0
    order = np.argsort(r[touched])
    return r[touched][order], load[touched][order]


def width(r, p, area) -> float:
    """sqrt(5/2 <r²>) of a pressure at r: the contact radius of Hertz's."""
    return float(np.sqrt(2.5 * (p * r**2 * area).sum() / (p * area).sum()))
