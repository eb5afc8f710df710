"""The micro law of a surface itself: the contact of one period of heights, by conjugate gradients.

One period has N × M heights and lies on a body with the kernel L. A pressure with the Fourier amplitudes p(k) moves the
surface by 2 L(k)/k p(k) (E1* = 1); k = 0 is left out, since it belongs to the nominal contact. The solution is a
pressure >= 0 with the mean p whose gap is 0 wherever it is positive (Polonsky and Keer, Wear 231, 1999, 206). It solves
a quadratic program. A step along a conjugate direction costs two Fourier transforms. The residual is divided by the
kernel, so that the number of steps hardly grows with N.

The steps themselves, :func:`pressed_flat`, know no Fourier transforms: the resolved spheres of tools/resolved, which
are not periodic, take them too.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["periodic_rows"]

#: The iteration has ended when the gap under the pressures is at most this part of the range of the heights.
_CLOSED = 1e-9
#: Largest number of steps: a layer of n = 100 takes 2,700 with 256 × 256 points.
_STEPS = 20_000
#: A point that joins the contact has at least this part of the mean pressure. Any number above 0 does.
_JOINS = 1e-12
#: After so many steps on end in which points have joined the gap is not divided by the kernel, until none joins: what
#: is divided may push the same points off again and again (test_a_stack_comes_to_rest of test_scan_law.py).
_SWINGS = 20
#: The preconditioner needs a finite kernel at k = 0. This is its value there over that at the longest wave.
_MEAN = 1.0


def periodic_rows(
    heights: ArrayLike,
    dx: float,
    pressures: ArrayLike,
    kernel: Callable[[np.ndarray], np.ndarray] | None = None,
    dy: float | None = None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Approach, contact fraction and largest pressure of one period of a surface under nominal pressures.

    Parameters
    ----------
    heights : (N, M), summits up, of one period; in any unit of length
    dx, dy : steps of the second and of the first axis, in the same unit, > 0; dy None: dx
    pressures : (n,) nominal pressures over E1*, > 0
    kernel : function of k (W,), in 1/length, that gives L (W,) > 0; None: 1, a half-space of E1*

    Returns
    -------
    A, lam, p_max : (n,) each. A, in the unit of the heights, is the approach from the highest summit, less the mean
        displacement; lam the share of the points that touch; p_max the largest pressure, over E1*. NaN where the
        iteration has not ended

    Raises
    ------
    ValueError : heights, steps or pressures are no such numbers

    Examples
    --------
    >>> x = np.linspace(-0.5, 0.5, 64, endpoint=False)
    >>> A, lam, p_max = periodic_rows(-(x**2 + x[:, None] ** 2) / 2, 1 / 64, [0.01])
    >>> print(f"{A[0]:.4f} {lam[0]:.3f} {p_max[0]:.3f}")
    0.0262 0.121 0.126
    """
    heights = np.asarray(heights, dtype=float)
    pressures = np.atleast_1d(np.asarray(pressures, dtype=float))
    dy = dx if dy is None else dy
    if heights.ndim != 2 or min(heights.shape) < 2 or not np.isfinite(heights).all():
        raise ValueError("heights: must be a table of at least 2 × 2 finite numbers")
    if not (np.isfinite(dx) and dx > 0 and np.isfinite(dy) and dy > 0):
        raise ValueError(f"dx = {dx}, dy = {dy}: must be finite and above 0")
    if pressures.ndim != 1 or not np.all((pressures > 0) & np.isfinite(pressures)):
        raise ValueError("pressures: must be finite and above 0")
    response = response_of(heights.shape, dx, dy, kernel)
    depths, start = heights.max() - heights, None
    rows = np.full((3, len(pressures)), np.nan)
    for i in np.argsort(pressures):
        start = pressures[i] * (np.ones_like(depths) if start is None else start / start.mean())
        start, A, closed = pressed(depths, response, pressures[i], start)
        if closed:
            rows[:, i] = A, np.count_nonzero(start) / start.size, start.max()
    return tuple(rows)


def response_of(shape, dx, dy, kernel, mirrored=False):
    """Displacement over pressure for each wave of a period, in the order of `numpy.fft.rfft2`; 0 for k = 0.

    mirrored : whether the period consists of the patch (N, M) and its mirror images; the waves are then in the order of
        `scipy.fft.dctn`
    """
    ky = 2 * np.pi * np.fft.fftfreq(shape[0], dy)
    kx = 2 * np.pi * np.fft.rfftfreq(shape[1], dx)
    if mirrored:
        ky, kx = (np.pi * np.arange(count) / (count * step) for count, step in zip(shape, (dy, dx), strict=True))
    k = np.hypot(ky[:, None], kx)
    waves = k[k > 0]
    L = np.ones_like(waves) if kernel is None else np.asarray(kernel(waves), dtype=float)
    if L.shape != waves.shape or not np.all((L > 0) & np.isfinite(L)):
        raise ValueError("kernel: must give a number above 0 for each k")
    response = np.zeros_like(k)
    response[k > 0] = 2 * L / waves
    return response


def pressed(depths, response, mean, start, mirrored=False):
    """The pressures (N, M) of a period, its approach A, and whether the iteration has ended.

    depths : (N, M), depth of each point below the highest summit
    response, mirrored : as in :func:`response_of`
    mean : mean pressure
    start : (N, M), first pressures, with this mean
    """

    def displacement(p):
        return waves_times(p, response, mirrored)

    return pressed_flat(depths, displacement, mean, start, _CLOSED * np.ptp(depths), division_by(response, mirrored))


def pressed_flat(
    depths: np.ndarray,
    displacement: Callable[[np.ndarray], np.ndarray],
    mean: float,
    start: np.ndarray,
    allowed: float,
    divided: Callable[[np.ndarray], np.ndarray],
) -> tuple[np.ndarray, float, bool]:
    """The pressures (N, M) of a surface, its approach A, and whether the iteration has ended.

    depths : (N, M), depth of each point below the highest point
    displacement : function of the pressures (N, M): the displacement of the surface of the body
    mean : mean pressure
    start : (N, M), first pressures, with this mean
    allowed : largest gap where there is pressure, and largest overlap where there is none
    divided : function of a gap (N, M): roughly the pressures that would close it, up to a factor
    """

    def preconditioned(residual, contact):
        """The residual divided by the kernel, less its mean over the `contact` (N, M) bool; 0 outside."""
        quotient = np.where(contact, residual, 0.0)
        quotient = quotient if swings > _SWINGS else divided(quotient)
        return np.where(contact, quotient - quotient[contact].mean(), 0.0)

    p, direction, before, restart, swings = start, np.zeros_like(start), 1.0, True, 0
    for _ in range(_STEPS):
        touching = p > 0
        gap = displacement(p) + depths
        A = gap[touching].mean()
        residual = gap - A
        if np.abs(residual[touching]).max() <= allowed and residual.min() >= -allowed:
            return p, A, True
        if np.count_nonzero(touching) == 1:  # its gap is that of all that touch: no direction leads away from it
            touching = touching | (residual < 0)
        z = preconditioned(residual, touching)
        now = (residual * z)[touching].sum()
        direction = np.where(touching, z + (0.0 if restart else now / before) * direction, 0.0)
        before = now
        along = displacement(direction)
        along = along - along[touching].mean()
        step = (residual * direction)[touching].sum() / (along * direction)[touching].sum()
        p = np.maximum(p - step * direction, 0.0)
        joins = (p == 0) & (residual < 0)
        restart = bool(joins.any())
        swings = swings + 1 if restart else 0
        if restart:
            # the same step for the points that join: with one pressure for all, points on hard layers would join and
            # leave for ever
            joining = -step * preconditioned(residual, touching | joins)
            p = np.where(joins, np.maximum(joining, _JOINS * mean), p)
        p = p * (mean / p.mean())
    return p, np.nan, False


def division_by(response, mirrored=False):
    """A function that divides the waves of a field (N, M) by a response of :func:`response_of`."""
    inverse = np.where(response > 0, 1 / np.where(response > 0, response, 1.0), 0.0)
    inverse[0, 0] = _MEAN / response.max()
    return lambda field: waves_times(field, inverse, mirrored)


def waves_times(field, factors, mirrored):
    """A field (N, M) after its waves, in the order of :func:`response_of`, have been multiplied by `factors`."""
    if mirrored:
        from scipy.fft import dctn, idctn  # imports scipy.special, half of the time of `import solver`

        return idctn(dctn(field) * factors)
    return np.fft.irfft2(np.fft.rfft2(field) * factors, s=field.shape)
