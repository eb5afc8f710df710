"""The data to try are what their docstrings say, and give the known answers back."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study

GEL = {"R": "5 um", "nu1": 0.49, "h": "1.5 um", "E2": "70 GPa", "nu2": 0.2, "bonding": "bonded", "micro": "smooth"}


def heights() -> np.ndarray:
    """The heights of the scan, nm, from their spectrum: flat for waves above 6 µm, ~ q^-1.8 in amplitude below."""
    q = np.hypot(np.fft.fftfreq(96, 0.25)[:, None], np.fft.fftfreq(96, 0.25))
    amplitudes = np.where((q > 0) & (q <= 0.5), np.maximum(q, 1 / 6) ** -1.8, 0)
    z = np.fft.ifft2(np.fft.fft2(np.random.default_rng(67).standard_normal((96, 96))) * amplitudes).real
    return z * 50 / z.std()


def loads(depths: np.ndarray) -> np.ndarray:
    """The loads of the curve, nN, at depths in nm."""
    exact = study.solve(**GEL, E1="5 kPa", D=[f"{depth} nm" for depth in depths], profiles=False).P.values
    return 1e9 * exact + 0.003 * np.random.default_rng(1).standard_normal(len(depths))


def test_the_scan():
    scan = study.roughness.read(study.samples.scan())
    assert_allclose(scan.z, 1e-9 * heights(), rtol=0, atol=0.6e-10)
    assert_allclose(scan.steps, 0.25e-6, rtol=1e-12)
    assert scan.z.std() == pytest.approx(50e-9, rel=1e-4)
    slope = np.fft.ifft(np.fft.fft(scan.z) * 2j * np.pi * np.fft.fftfreq(96, 0.25e-6)).real
    assert slope.std() == pytest.approx(0.0432, abs=5e-5)


def test_the_curve():
    rows = np.loadtxt(study.samples.curve(), delimiter=",", skiprows=2)
    assert_allclose(rows[:, 0], np.arange(1, 101), rtol=0, atol=0)
    assert_allclose(rows[:, 1], loads(rows[:, 0]), rtol=0, atol=0.6e-6)
    fitted = study.fit(study.samples.curve(), **GEL, free=["E1"])
    assert fitted.E1_low < 5000 < fitted.E1_high and fitted.E1_spread < 50
