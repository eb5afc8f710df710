"""A random self-affine surface: heights of a power spectrum, Gaussian, one period of them."""

from typing import Any

import numpy as np

from ..quantities import has_unit, quantity
from ..scan import Scan, height_map, number

__all__ = ["self_affine"]


def self_affine(
    shape: tuple[int, int],
    dx: Any,
    *,
    hurst: float,
    rms: Any,
    longest: Any = None,
    shortest: Any = None,
    seed: int = 0,
) -> Scan:
    """One period of a random surface with the spectrum C(q) ~ q^(-2 - 2H) between two wavelengths, and 0 elsewhere.

    The Fourier amplitudes of white Gaussian noise are multiplied by √C(q): the heights are Gaussian.

    Parameters
    ----------
    shape : (ny, nx), number of points along y and x, at least 16 each
    dx : distance between points. All lengths are numbers in m, or texts with units such as "0.1 um"
    hurst : Hurst exponent H, in (0, 1]
    rms : root mean square of the heights, > 0
    longest, shortest : wavelengths between which the surface has waves; by default a quarter of the shorter side, and
        four points
    seed : of the random numbers: one seed, one surface

    Returns
    -------
    Scan : in m. It is one period: pass `periodic="given"` beside it

    Raises
    ------
    ValueError : numbers out of these bounds, or no wave between the two lengths

    Examples
    --------
    >>> scan = self_affine((64, 64), "0.1 um", hurst=0.8, rms="10 nm", seed=1)
    >>> print(f"{scan.z.std():.3g}", scan.z.shape)
    1e-08 (64, 64)
    """
    if not 0 < hurst <= 1:
        raise ValueError(f"self_affine: hurst = {hurst}: must be in (0, 1]")
    if len(shape) != 2 or min(shape) < 16:
        raise ValueError(f"self_affine: shape = {shape}: must be two numbers, at least 16 each")
    step, height = _length("dx", dx), _length("rms", rms)
    long = min(shape) * step / 4 if longest is None else _length("longest", longest)
    short = 4 * step if shortest is None else _length("shortest", shortest)
    q = np.hypot(*np.meshgrid(*(2 * np.pi * np.fft.fftfreq(count, step) for count in shape), indexing="ij"))
    waves = (q >= 2 * np.pi / long * (1 - 1e-9)) & (q <= 2 * np.pi / short * (1 + 1e-9)) & (q > 0)
    if not waves.any():
        raise ValueError(f"self_affine: no wave of {shape[0]} × {shape[1]} points is between {short:g} and {long:g} m")
    amplitudes = np.where(waves, np.where(waves, q * step, 1.0) ** (-1 - hurst), 0.0)
    noise = np.random.default_rng(seed).normal(size=shape)
    z = np.fft.ifft2(np.fft.fft2(noise) * amplitudes).real
    return height_map(z * (height / z.std()), dx=step, name=f"self-affine surface of the seed {seed}")


def _length(name: str, value: Any) -> float:
    """A length in m, > 0."""
    value = quantity(f"self_affine: {name}", value, "m").value if has_unit(value) else value
    value = number(f"self_affine: {name}", value, "m")
    if not 0 < value < np.inf:
        raise ValueError(f"self_affine: {name} = {value}: must be > 0 and finite")
    return float(value)
