"""The micro law of a surface itself: the contact of one period of heights, by conjugate gradients.

One period of N × M heights on a body with the kernel L: a pressure of the Fourier amplitudes p(k) moves its surface by
2 L(k)/k p(k) (E1* = 1), without k = 0, whose part is the nominal contact's. The pressure sought is >= 0, has the mean
p, and makes the gap 0 where it presses (Polonsky and Keer, Wear 231, 1999, 206). That is a quadratic program, whose
steps along conjugate directions cost two Fourier transforms each. The residual is divided by the kernel, so that the
number of steps hardly grows with N.

The steps themselves, :func:`pressed_flat`, know no Fourier transforms: the resolved spheres of tools/resolved, which
are not periodic, take them too.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["periodic_rows"]

#: A solution has been found when the gap under the pressures is this part of the range of the heights.
_CLOSED = 1e-9
#: Most steps: a layer of n = 100 takes 2,700 at 256 × 256 points.
_STEPS = 20_000
#: A point that joins the contact has at least this part of the mean pressure: any that is not 0.
_JOINS = 1e-12
#: After so many steps on end in which points have joined the gap is not divided by the kernel, until none joins: what
#: is divided may push the same points off again and again (test_a_stack_comes_to_rest of test_scan_law.py).
_SWINGS = 20
#: The kernel at k = 0, which the preconditioner needs to be a number, over its value at the longest wave.
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
    """Displacement over pressure of the waves of a period, as `numpy.fft.rfft2` has them; 0 of k = 0.

    mirrored : the period is the patch (N, M) beside its mirror images, of waves as `scipy.fft.dctn` has them
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

    depths : (N, M), of the surface below its highest summit; response, mirrored : of :func:`response_of`; mean : of the
    pressure; start : (N, M), pressures to begin with, of this mean
    """

    def moved(p):
        return waves_times(p, response, mirrored)

    return pressed_flat(depths, moved, mean, start, _CLOSED * np.ptp(depths), division_by(response, mirrored))


def pressed_flat(
    depths: np.ndarray,
    moved: Callable[[np.ndarray], np.ndarray],
    mean: float,
    start: np.ndarray,
    allowed: float,
    divided: Callable[[np.ndarray], np.ndarray],
) -> tuple[np.ndarray, float, bool]:
    """The pressures (N, M) of a surface, its approach A, and whether the iteration has ended.

    depths : (N, M), of the surface below its highest point
    moved : pressures -> displacement of the body
    mean : of the pressure; start : (N, M), pressures to begin with, of this mean
    allowed : largest gap where there is pressure, and largest overlap where there is none
    divided : a gap -> about the pressures that would close it, up to a factor
    """

    def eased(residual, pressed_on):
        """The residual divided by the kernel, where there is contact, without its mean there."""
        quotient = np.where(pressed_on, residual, 0.0)
        quotient = quotient if swings > _SWINGS else divided(quotient)
        return np.where(pressed_on, quotient - quotient[pressed_on].mean(), 0.0)

    p, direction, before, restart, swings = start, np.zeros_like(start), 1.0, True, 0
    for _ in range(_STEPS):
        touching = p > 0
        gap = moved(p) + depths
        A = gap[touching].mean()
        residual = gap - A
        if np.abs(residual[touching]).max() <= allowed and residual.min() >= -allowed:
            return p, A, True
        if np.count_nonzero(touching) == 1:  # its gap is that of all that touch: no direction leads away from it
            touching = touching | (residual < 0)
        z = eased(residual, touching)
        now = (residual * z)[touching].sum()
        direction = np.where(touching, z + (0.0 if restart else now / before) * direction, 0.0)
        before = now
        along = moved(direction)
        along = along - along[touching].mean()
        step = (residual * direction)[touching].sum() / (along * direction)[touching].sum()
        p = np.maximum(p - step * direction, 0.0)
        apart = (p == 0) & (residual < 0)
        restart = bool(apart.any())
        swings = swings + 1 if restart else 0
        if restart:
            # the same step with the points that join: one pressure for all makes hard layers come and go for ever
            joining = -step * eased(residual, touching | apart)
            p = np.where(apart, np.maximum(joining, _JOINS * mean), p)
        p = p * (mean / p.mean())
    return p, np.nan, False


def division_by(response, mirrored=False):
    """A function that divides the waves of a field (N, M) by a response of :func:`response_of`."""
    inverse = np.where(response > 0, 1 / np.where(response > 0, response, 1.0), 0.0)
    inverse[0, 0] = _MEAN / response.max()
    return lambda field: waves_times(field, inverse, mirrored)


def waves_times(field, factors, mirrored):
    """A field (N, M) whose waves, of :func:`response_of`, have been multiplied by factors."""
    if mirrored:
        from scipy.fft import dctn, idctn  # imports scipy.special, half of the time of `import solver`

        return idctn(dctn(field) * factors)
    return np.fft.irfft2(np.fft.rfft2(field) * factors, s=field.shape)
