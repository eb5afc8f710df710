"""Spikes are taken out where `despike` says from how many robust deviations on, and named where it does not."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from surfaces import random_surface

from study import roughness

PLACES = [(0, 0), (0, 40), (30, 0), (63, 63), (17, 23), (18, 23), (50, 8)]  # corners, borders, a pair
RANDOM = np.random.default_rng(5)


def spiked(z: np.ndarray, size: float) -> np.ndarray:
    z = z.copy()
    for i, place in enumerate(PLACES):
        z[place] += size * (-1) ** (i % 2)
    return z


def test_spikes_become_missing_points():
    z, step = random_surface(64, 8)
    bad = spiked(z, 20 * z.std())
    clean = roughness.height_map(z, dx=step)
    scan = roughness.height_map(bad, dx=step, missing="skip", despike=8, steep=True)
    assert {tuple(place) for place in np.argwhere(np.isnan(scan.z))} == set(PLACES)
    assert_allclose(scan.z[~np.isnan(scan.z)], bad[~np.isnan(scan.z)], rtol=0, atol=0)
    assert scan.notes[0] == "despike took out 7 points, which count as missing"
    filled = roughness.measure(roughness.height_map(bad, dx=step, despike=8))
    as_it_is = roughness.measure(roughness.height_map(bad, dx=step, steep=True))
    right = roughness.measure(clean)
    assert_allclose([filled.Ra, filled.Nbar], [right.Ra, right.Nbar], rtol=0.05)
    assert as_it_is.Ra < 0.3 * right.Ra  # it stays off without a word


def test_a_slope_is_no_spike_and_coarse_steps_are_none():
    y, x = np.mgrid[:64, :64]
    tilted = 50.0 * x - 30.0 * y + RANDOM.normal(size=(64, 64))  # nm, of points 1 µm apart
    scan = roughness.height_map(spiked(tilted, 100.0), dx=1, unit="um", height_unit="nm", despike=8, missing="skip")
    assert {tuple(place) for place in np.argwhere(np.isnan(scan.z))} == set(PLACES)
    steps = np.where(x < 32, 0.0, 1.0)  # most points are their neighbours' median
    steps[20, 20] = 500.0
    scan = roughness.height_map(steps, dx=1, unit="um", height_unit="nm", despike=20, missing="skip")
    assert np.argwhere(np.isnan(scan.z)).tolist() == [[20, 20]]
    filled = roughness.height_map(steps, dx=1, unit="um", height_unit="nm", despike=20)
    assert filled.notes[0] == "despike took out 1 point, which counts as missing"


def test_spikes_of_a_profile_and_beside_missing_points():
    z = np.cumsum(RANDOM.normal(size=200)) + 0.5 * np.arange(200.0)
    z[[0, 70, 150]] += 60.0
    z[71] = np.nan
    scan = roughness.profile(z, dx=1.0, unit="um", height_unit="nm", despike=10, missing="skip")
    assert np.flatnonzero(np.isnan(scan.z)).tolist() == [0, 70, 71, 150]
    wave = 1e3 * np.sin(np.arange(200) / 20)  # without any noise
    assert np.isfinite(roughness.profile(wave, dx=1.0, unit="um", height_unit="nm", despike=10, missing="skip").z).all()


def test_what_despike_refuses(tmp_path):
    z = RANDOM.normal(size=(32, 32))
    for wrong in (0, -3, "5", True, np.nan, np.inf):
        with pytest.raises(ValueError, match="^the map: despike = .*: must be a positive number of robust deviations"):
            roughness.height_map(z, dx=1, despike=wrong)
    np.savetxt(tmp_path / "a.txt", z)
    with pytest.raises(ValueError, match=r"^a.txt: \d+ of 1024 .*\(despike took out \d+ points, which count as miss"):
        roughness.read(tmp_path / "a.txt", unit="um", height_unit="nm", dx=1, despike=1)
    z[3, 3] = np.inf
    with pytest.raises(ValueError, match="1 of 1024 heights are infinite"):
        roughness.height_map(z, dx=1, despike=5)


def test_heights_far_from_gaussian_are_named():
    """p_max of scans with spikes was 1.7 to 13 times too small, and no note said so."""

    def said(z, **reading):
        notes = roughness.measure(roughness.height_map(z, dx=step, steep=True, **reading), form="mean").notes
        return [note for note in notes if note.startswith("Sku = ")]

    z, step = random_surface(64, 8)
    assert not said(z)
    bad = spiked(z, 20 * z.std())
    kurtosis = np.mean((bad - bad.mean()) ** 4) / bad.var() ** 2
    (note,) = said(bad)
    assert float(note.split()[2].rstrip(",")) == pytest.approx(kurtosis, rel=0.05)
    assert "p_max" in note and "despike=5" in note
    assert not said(bad, despike=8)
