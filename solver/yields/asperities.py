"""Whether elastic asperities would yield: the stress on the axis of a spot, which has two scales.

Near the surface the stress is the sum of two parts: that of the nominal pressure p, and that of the spot's own pressure
less p, which decays within a pitch. In the disc cell the pressure of the spot is
p0s sqrt(1 - ρ²/b²) + (2 p/pi) arctan sqrt((b² - ρ²)/(B̄² - b²)), p0s = 2 E b/(pi Ra). So Abel's φ (docs/stresses.md) is
p0s t/b + (2 p/pi) t/sqrt(B̄² - t²), t < b.
"""

import numpy as np
from numpy.typing import ArrayLike

from ..numerics.quadrature import gauss_legendre

#: Points over t = B̄ sin(angle). At the depths _DEPTHS the integrals are then right to 1e-11.
POINTS = 20
#: Depths z/b among which the largest stress is searched for; and number of rounds, each with nine depths around the
#: best one; a parabola follows. The references agree to 3e-9 (tests/yields/test_asperities.py). A lone spot yields at
#: 0.38 b for nu = 0, and at 0.55 b for nu = 1/2.
_DEPTHS, _ROUNDS = np.linspace(0.2, 1.4, 9), 4
#: Number of spots at a time, which take some MB.
_AT_ONCE = 1000
#: Steps of Newton's method, which starts below the root, where the equation is concave.
_STEPS = 10


def hertz_part(p_max: ArrayLike, p: ArrayLike, E: ArrayLike, Nbar: ArrayLike, Ra: ArrayLike):
    """Hertz's part p0s of the largest real pressure p_max = p0s + (2 p/pi) arcsin(c), and c = b/B̄ of the spot.

    p : nominal pressure; p_max and p in the unit of E, the modulus that the asperities feel. The arguments broadcast
    """
    alone = 2 * np.asarray(E) / (np.pi * np.sqrt(np.pi * np.asarray(Nbar)) * Ra)  # p0s = alone c
    angle = 0 * (alone + p_max + p)
    for _ in range(_STEPS):
        missing = p_max - alone * np.sin(angle) - 2 / np.pi * p * angle
        angle = np.clip(angle + missing / (alone * np.cos(angle) + 2 / np.pi * p), 0.0, np.pi / 2)
    return alone * np.sin(angle), np.sin(angle)


@np.errstate(all="ignore")  # without a spot the stress is NaN
def stress_on_axis(nu: ArrayLike, c: ArrayLike, ratio: ArrayLike, tension: ArrayLike = 0.0) -> np.ndarray:
    """Largest |sr - sz| over p0s on the axis of a spot, from 0.2 b to 1.4 b: the stress of von Mises and Tresca there.

    Parameters
    ----------
    nu : Poisson ratio
    c : b/B̄, in (0, 1]
    ratio : p/p0s
    tension : sr - sz of the contact as a whole, over p0s, beyond that in the centre of a half-space, sr = st =
        -(1 + 2 nu) p/2, sz = -p

    Returns
    -------
    numpy.ndarray : of the shape to which the arguments broadcast
    """
    arrays = np.broadcast_arrays(*(np.asarray(array, dtype=float) for array in (nu, c, ratio, tension)))
    flat = [array.reshape(-1, 1) for array in arrays]
    rows = (slice(first, first + _AT_ONCE) for first in range(0, len(flat[0]), _AT_ONCE))
    parts = [_largest([array[some] for array in flat]) for some in rows]
    return np.concatenate([*parts, np.zeros(0)]).reshape(arrays[0].shape)


def _largest(spots):
    z, step = _DEPTHS + 0 * spots[0], _DEPTHS[1] - _DEPTHS[0]
    for _ in range(_ROUNDS):
        top = np.take_along_axis(z, _difference(z, *spots).argmax(axis=1)[:, None], axis=1)
        z, step = top + step * np.linspace(-1, 1, 9), step / 4
    value = _difference(z, *spots)
    place = np.clip(value.argmax(axis=1)[:, None], 1, 7)
    left, middle, right = (np.take_along_axis(value, place + i, axis=1)[:, 0] for i in (-1, 0, 1))
    bend = 2 * middle - left - right
    top = middle + (right - left) ** 2 / np.where(bend > 0, 8 * bend, np.inf)
    return np.maximum(top, value.max(axis=1))


def _difference(z, nu, c, ratio, tension):
    """|sr - sz| (B, Z) over p0s at the depths z (B, Z) in b: (1 - 2 nu) E_0/2 + 1.5 F_0 for the spot, less that for p
    on the disc of the cell, plus that for p everywhere."""
    x, weight = gauss_legendre(POINTS)
    angle = np.arcsin(c) * x
    t = np.sin(angle) / c
    density = (t * np.cos(angle) / c + 2 / np.pi * ratio * t) * np.arcsin(c) * weight
    square, z = (t * t)[:, None], z[..., None]
    kernel = density[:, None] * t[:, None] / (z * z + square)
    E, F = kernel.sum(axis=2), (kernel * 2 * z * z / (z * z + square)).sum(axis=2)
    z = z[..., 0]
    cos = z / np.hypot(1 / c, z)
    cell = (1 - 2 * nu) / 2 * E + 1.5 * F - ratio * ((1 + nu) * cos - 1.5 * cos**3)
    return np.abs(cell + tension)
