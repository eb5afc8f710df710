"""Lengths that no scan has are refused with the number, before and after the form; the way out is huge=True."""

import numpy as np
import pytest
from surfaces import rough

from study import roughness

Z = rough(64, 8, 1, 1.0)  # rms 1, waves of 8 points and more
TILT = np.add.outer(np.arange(64.0), 2 * np.arange(64.0))

MAKERS = {
    "map": lambda z, dx, folder, **more: roughness.height_map(z, dx=dx, unit="m", **more),
    "profile": lambda z, dx, folder, **more: roughness.profile(z[0], dx=dx, unit="m", **more),
    "npy": lambda z, dx, folder, **more: roughness.read(folder / "a.npy", dx=dx, unit="m", **more),
    "csv": lambda z, dx, folder, **more: roughness.read(folder / "a.csv", dx=dx, unit="m", **more),
}


@pytest.mark.parametrize("maker", MAKERS)
@pytest.mark.parametrize(
    ("dx", "rms", "message"),
    [
        (2.5, 1e-3, "the scan is 158 m long; at most 1 m is taken"),
        (0.016, 1e-3, "the scan is 1.01 m long"),
        (1e-7, 2e-16, r"the heights spread by [12]\.?\d*e-16 m \(rms\); no surface is smoother than 1e-12 m, 1 pm"),
    ],
)
def test_a_scan_of_another_unit_is_refused(tmp_path, maker, dx, rms, message):
    """A reader's bug made a scan 160 m wide, metres taken for nm an rms of 2e-16 m; both passed."""
    z = rms * Z
    np.save(tmp_path / "a.npy", z)
    np.savetxt(tmp_path / "a.csv", z, delimiter=",")
    with pytest.raises(ValueError, match=message) as said:
        MAKERS[maker](z, dx, tmp_path)
    assert "Lengths were taken to be in m, heights in m" in str(said.value) and "or huge=True" in str(said.value)
    scan = MAKERS[maker](z, dx, tmp_path, huge=True)
    assert scan.huge and roughness.measure(scan).Ra > 0


def test_what_the_form_leaves_may_be_too_flat():
    """A tilt of 100 nm hid an rms of 2e-16 m."""
    z = 2e-16 * Z + 1e-9 * TILT
    scan = roughness.height_map(z, dx=1e-7, name="tilted.csv")
    with pytest.raises(
        ValueError, match=r"^tilted.csv: the heights spread by (2|1.99)e-16 m \(rms, plane removed\); .*huge"
    ):
        roughness.measure(scan)
    assert roughness.measure(scan, form="mean").notes
    assert roughness.measure(roughness.height_map(z, dx=1e-7, huge=True)).iso_Ra < 2e-16


@pytest.mark.parametrize("method", ["moments", "summits"])
def test_asperities_of_many_kilometres_are_refused(method):
    """16,600 km were answered."""
    blunt = {"z": 1e-11 * Z, "dx": 5e-3}
    scan = roughness.height_map(**blunt, name="wide.csv")
    for cutoff in (None, 0.02, [0.016, 0.02]):
        with pytest.raises(
            ValueError, match=r"^wide.csv: Ra = \d\.?\d*e\+0[67] m, .*; at most 1000 m is taken.*huge=T"
        ):
            roughness.measure(scan, method=method, cutoff=cutoff)
    taken = roughness.measure(roughness.height_map(**blunt, huge=True), method=method)
    assert taken.Ra > 1e6
    scale = 1.02 * taken.Ra / 1000  # as Ra of 980 m
    assert 970 < roughness.measure(roughness.height_map(scale * blunt["z"], dx=5e-3), method=method).Ra < 990


def test_lengths_just_within_the_limits_are_taken():
    assert roughness.measure(roughness.height_map(1e-3 * Z, dx=0.99 / 63)).Ra < 1
    assert roughness.measure(roughness.height_map(1.01e-12 * Z, dx=1e-7)).iso_Ra < 1e-12


def test_a_tilt_alone_is_nothing_and_no_matter_of_size():
    scan = roughness.height_map(1e-9 * TILT, dx=1e-7, name="flat.csv")
    with pytest.raises(ValueError, match="^flat.csv: nothing is left of the heights: plane removed"):
        roughness.measure(scan)


def test_steep_takes_slopes_and_spans_that_no_instrument_measures(tmp_path):
    """A real scan of cells was refused, without a way out."""
    np.save(tmp_path / "cells.npy", 2e-6 * Z)
    for z, dx, message in (
        (2e-6 * Z, 1e-7, "with an rms slope of [5-9]"),
        (1e-6 * Z + 3e-7 * TILT, 1e-7, "heights span 5.*e-05 m on a scan 6.3e-06 m long"),
    ):
        with pytest.raises(ValueError, match=f"{message}(.|\n)*steep=True"):
            roughness.height_map(z, dx=dx)
        taken = roughness.measure(roughness.height_map(z, dx=dx, steep=True), method="summits")
        assert taken.Nbar > 0
        assert roughness.profile(z[0], dx=dx, steep=True).z.shape == (64,)
    with pytest.raises(ValueError, match=r"cells.npy: .*steep=True"):
        roughness.read(tmp_path / "cells.npy", dx=1e-7, unit="m")
    assert roughness.read(tmp_path / "cells.npy", dx=1e-7, unit="m", steep=True).steps == (1e-7, 1e-7)
    with pytest.raises(ValueError, match="63 m long"):  # one does not stand for the other
        roughness.height_map(50 * Z, dx=1.0, steep=True)


def test_an_asperity_below_the_step_is_doubted():
    """Ra of 40 nm where points are 1 µm apart."""
    sharp, dull = (roughness.measure(roughness.height_map(rms * Z, dx=1e-6, steep=True)) for rms in (1e-5, 1e-8))
    assert sharp.Ra < 1e-6 < dull.Ra
    (note,) = (note for note in sharp.notes if "below the distance of the points, 1 µm" in note)
    assert note.startswith(f"Ra = {sharp.Ra * 1e9:.3g} nm")
    assert not any("below the distance" in note for note in dull.notes)


def test_a_radius_of_a_kilometre_is_that_of_1_nm_in_waves_of_8_mm():
    """As the comment of BLUNTEST says; of an egg carton, whose moments suppose a random surface."""
    wave = np.cos(2 * np.pi * np.arange(256) / 32 + 0.1)
    answer = roughness.measure(roughness.height_map(2e-9 * np.outer(wave, wave), dx=8e-3 / 32, huge=True))
    assert 500 < answer.Ra < 2000
