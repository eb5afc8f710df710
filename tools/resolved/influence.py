"""Displacement of an elastic body under square elements of constant pressure: a half-space, and a layer on one.

The half-space has Love's closed form. The layer adds the Hankel transform of its kernel's L - 1, which decays like
e^(-2kh): a smooth function of the distance. The kernel is that of layered_independent.py, which shares nothing with the
solver. E2* = 1.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from layered_independent import kernel, wave_rule
from scipy import fft
from scipy.interpolate import CubicSpline
from scipy.special import j0

#: Knots of the remainder per thickness: with 16 it changes by 2e-6 of its largest value, with 64 by 1e-7.
_KNOTS = 32


class Layer(NamedTuple):
    """Thickness, n = E1*/E2*, the Poisson ratios of layer and half-space, and whether they are bonded."""

    h: float
    n: float
    nu1: float = 0.3
    nu2: float = 0.3
    bonded: bool = False


def coefficients(side: float, count: int, layer: Layer | None = None) -> np.ndarray:
    """Displacement (count + 1, count + 1), over the pressure, in the middle of the element i, j elements away.

    Without a layer the body is a half-space of E* = 1. Johnson, Contact Mechanics (1985), Eq. (3.25).
    """
    away = np.arange(count + 1) * side
    high, low = away + side / 2, away - side / 2
    displacements = (_corner(high, high) - _corner(low, high) - _corner(high, low) + _corner(low, low)) / np.pi
    if layer is None:
        return displacements
    points = np.array([-1.0, 1.0]) * side / np.sqrt(12)  # Gauss points, two along a side
    points_of_elements = away[:, None] + points
    far = np.hypot(points_of_elements[:, None, :, None], points_of_elements[None, :, None, :])
    return displacements / layer.n + side**2 * remainder(far, layer).mean(axis=(2, 3))


def _corner(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """∫∫ of 1/distance to the corner (x, y), for each x and y."""
    x, y = x[:, None], y[None, :]
    return x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))


def remainder(r: np.ndarray, layer: Layer) -> np.ndarray:
    """Displacement at the distance r from a unit force, less that of a half-space of the layer's material:

    1/(π E1* h) ∫₀^∞ (L(u) - 1) J0(u r/h) du.
    """
    reach = r.max() / layer.h
    u, weight = wave_rule(1.0, layer.n, max(2.0, reach))
    weight = weight * kernel(u, layer.n, layer.nu1, layer.nu2, layer.bonded)
    knots = np.linspace(0, reach, 8 + int(_KNOTS * reach))
    table = np.array([j0(u * knot) @ weight for knot in knots])
    return CubicSpline(knots, table)(r / layer.h) / (np.pi * layer.n * layer.h)


def convolution(influence: np.ndarray, even: bool) -> Callable[[np.ndarray], np.ndarray]:
    """The function pressure -> displacement on `count` elements a side, not periodic: padded to twice as many.

    even : whether the pressure is the same on both sides of the two axes, and its argument only the quarter where both
        are positive. Cosine transforms then need a quarter of the numbers
    """
    count = len(influence) - 1
    waves = fft.dctn(influence, type=1)  # of the even kernel of period 2 count
    if even:
        waves, half = waves[:count, :count], count // 2
        return lambda p: fft.idctn(waves * fft.dctn(p, s=(count, count)))[:half, :half]
    waves = np.concatenate([waves, waves[-2:0:-1]])
    return lambda p: fft.irfft2(waves * fft.rfft2(p, s=(2 * count, 2 * count)))[:count, :count]
