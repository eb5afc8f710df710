"""Heights of surfaces whose asperities are known: random ones, and lattices of paraboloids."""

import numpy as np

ELL = 1e-6  # correlation length of the random surfaces, m
SLOPE = 0.1  # their rms slope


def random_surface(points: int, steps_per_length: int, dimensions: int = 2, seed: int = 1) -> tuple[np.ndarray, float]:
    """Heights of a periodic Gaussian surface of correlation m0 exp(-r²/(2 ELL²)), m0 = (SLOPE ELL)², and their step.

    Its moments: m2 = m0/ELL², m4 = 3 m0/ELL⁴, so α = 3.
    """
    power = spectrum(points, steps_per_length, dimensions)
    white = np.random.default_rng(seed).normal(size=power.shape)
    z = np.fft.ifftn(np.fft.fftn(white) * np.sqrt(power / power.mean())).real
    return SLOPE * ELL * z, ELL / steps_per_length


def spectrum(points: int, steps_per_length: int, dimensions: int) -> np.ndarray:
    q = 2 * np.pi * np.fft.fftfreq(points) * steps_per_length  # in 1/ELL
    return np.exp(-sum(np.meshgrid(*(q**2,) * dimensions)) / 2)


def lattice(cells: int, points: int, step: float, radius: float, shift: float) -> np.ndarray:
    """Paraboloids -r²/(2 radius) on a square lattice of cells x cells, and a point more at each border."""
    x = (np.arange(-1, cells * points + 1) + 0.5 + shift) * step
    pitch = points * step
    u = (x % pitch) - pitch / 2
    return -np.add.outer(u**2, u**2) / (2 * radius)


def rough(points: int = 256, shortest: float = 12.0, seed: int = 0, rms: float = 50e-9) -> np.ndarray:
    """Heights of a Gaussian surface, (points, points), with all waves of at least so many points, equally strong."""
    random, k = np.random.default_rng(seed), np.fft.fftfreq(points)
    white = np.fft.fft2(random.standard_normal((points, points)))
    z = np.fft.ifft2(white * (np.hypot(*np.meshgrid(k, k)) < 1 / shortest)).real
    return rms * z / z.std()
