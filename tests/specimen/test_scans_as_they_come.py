"""Scans as users have them: with spikes, exported with a row of numbers or a heading of Gwyddion, labelled arrays."""

import numpy as np
import pytest
import xarray as xr

from study import roughness

ROWS, COLUMNS = np.meshgrid(np.arange(64.0), np.arange(80.0), indexing="ij")
EGGS = 10 * np.cos(2 * np.pi * ROWS / 16) * np.cos(2 * np.pi * COLUMNS / 16)  # nm, of points 1 µm apart
IN = {"unit": "um", "height_unit": "nm"}


def spiked(z: np.ndarray, method: str, **given) -> tuple[float, bool]:
    """Ra, and whether a few sharp points are said to make it."""
    found = roughness.measure(roughness.height_map(z, dx=1.0, **IN), method=method, **given)
    return found.Ra, any("a few sharp points make Ra" in note for note in found.notes)


@pytest.mark.parametrize("method", ["moments", "summits"])
def test_spikes_are_doubted(method):
    """One of 0.5 µm on bumps of 10 nm made Ra 20 times smaller; a pair of opposite ones had no note at all."""
    Ra, said = spiked(EGGS, method)
    assert not said
    for places in ([(30, 30)], [(30, 30), (11, 50)]):
        z = EGGS.copy()
        for sign, place in zip((1, -1), places, strict=False):
            z[place] += 500 * sign
        less, said = spiked(z, method)
        assert said and less < Ra / 5
        z = np.where(np.abs(z) > 100, 0, z)  # taken out
        assert not spiked(z, method)[1]


@pytest.mark.parametrize("method", ["moments", "summits"])
def test_random_maps_have_no_spikes(method):
    random = np.random.default_rng(3)
    for points in (16, 32, 64, 128):
        frequencies = np.hypot(*np.meshgrid(*[np.fft.fftfreq(points)] * 2))
        for cutoff in (0.1, 0.2, 0.5):
            for _ in range(10):
                noise = np.fft.fft2(random.normal(size=frequencies.shape))
                z = np.fft.ifft2(noise * (frequencies < cutoff) * (frequencies > 0)).real
                try:
                    assert not spiked(z, method)[1], (points, cutoff)
                except ValueError as error:  # too small to have a summit
                    assert "no summits" in str(error) and points == 16


def test_a_row_of_positions_is_none_of_heights(tmp_path):
    """pandas writes the numbers of the columns first, unless told not to."""
    file = tmp_path / "afm.csv"

    def read(rows: np.ndarray) -> np.ndarray:
        np.savetxt(file, rows, delimiter=",", fmt="%.6f")
        return roughness.read(file, dx=1.0, **IN).z

    with pytest.raises(ValueError, match="afm.csv: the first row has equal steps, 0, 1, 2 ...: positions or numbers"):
        read(np.vstack([np.arange(80), EGGS]))
    with pytest.raises(ValueError, match="the first column has equal steps, 6.3, 6.2, 6.1"):
        read(np.column_stack([(63 - np.arange(64)) / 10, EGGS]))
    rows = "".join(f"{i}," + ",".join(map(str, row)) + "\n" for i, row in enumerate(EGGS))
    file.write_text("," + ",".join(map(str, range(80))) + "\n" + rows)  # with its index: the corner is empty
    with pytest.raises(ValueError, match="afm.csv: the first row has equal steps, 0, 1, 2 ...: positions or numbers"):
        roughness.read(file, dx=1.0, **IN)
    np.testing.assert_allclose(read(EGGS), EGGS * 1e-9, atol=1e-15)
    tilted = EGGS * (ROWS > 3) * (COLUMNS > 3) + COLUMNS  # equal steps, not in the first row alone
    np.testing.assert_allclose(read(tilted), tilted * 1e-9, atol=1e-15)


def test_the_heading_of_gwyddion_says_the_unit_of_heights(tmp_path):
    """Its text has µm in the width and m in the heights: taken for µm, Ra was a million times too large."""
    file = tmp_path / "gwy.txt"
    heading = "Channel: Height\nWidth: 80.0 µm\nHeight: 64.0 µm\nValue units: m"
    np.savetxt(file, EGGS * 1e-9, header=heading, encoding="utf-8")
    with pytest.raises(ValueError, match='height_unit is um, but the heading has m: "# Value units: m"'):
        roughness.read(file, unit="um", dx=1.0)
    scan = roughness.read(file, unit="um", height_unit="m", dx=1.0)
    np.testing.assert_allclose(scan.z, EGGS * 1e-9, rtol=1e-12)
    assert "heights are in" not in " ".join(scan.notes)
    scan = roughness.read(file, unit="um", height_unit="um", dx=1.0, huge=True)
    np.testing.assert_allclose(scan.z, EGGS * 1e-15, rtol=1e-12)
    assert "heights are in um, as height_unit says; the heading has m" in scan.notes
    np.savetxt(file, EGGS, header="Value units: V")
    with pytest.raises(ValueError, match="height_unit is um, but the heading has V"):
        roughness.read(file, unit="um", dx=1.0)


def test_a_heading_has_a_unit_for_each_column(tmp_path):
    """Heights in nm were taken for µm, since x has these."""
    file, z = tmp_path / "profile.csv", EGGS[5]
    np.savetxt(file, np.c_[np.arange(80), z, z], delimiter=";", header="x [um];z [nm];raw [mm]", comments="")
    for columns, own in (((0, 1), "nm"), ((0, 2), "mm")):
        with pytest.raises(ValueError, match=f"height_unit is um, but the heading has {own}: "):
            roughness.read(file, unit="um", columns=columns)
    scan = roughness.read(file, unit="um", height_unit="nm", columns=(0, 1))
    np.testing.assert_allclose(scan.z, z * 1e-9, rtol=1e-12)
    np.savetxt(file, z, header="z [nm]")  # it was refused: dx is in µm
    np.testing.assert_allclose(roughness.read(file, unit="um", height_unit="nm", dx=1).z, z * 1e-9, rtol=1e-12)
    with pytest.raises(ValueError, match="height_unit is um, but the heading has nm"):
        roughness.read(file, unit="um", dx=1)


def test_coordinates_of_a_labelled_map():
    """Points twice as far apart along y, of which only dx was given, made N̄ twice too large."""
    z = xr.DataArray(EGGS, {"y": 2 * np.arange(64.0), "x": np.arange(80.0)})
    with pytest.raises(ValueError, match="the coordinates of z have steps of 1 along x, 2 along y: give dy"):
        roughness.height_map(z, dx=1.0, **IN)
    assert roughness.height_map(z, dx=1.0, dy=2.0, **IN).steps == (2e-6, 1e-6)
    assert roughness.height_map(z.assign_coords(y=np.arange(64)), dx=0.5, **IN).steps == (5e-7, 5e-7)


def test_what_is_no_scan_and_no_plain_number():
    with pytest.raises(ValueError, match="give a scan: that of study.roughness.read, or of height_map or profile"):
        roughness.measure(EGGS)
    nm, um = (xr.DataArray(size, attrs={"units": unit}) for size, unit in ((500.0, "nm"), (10.0, "um")))
    with pytest.raises(ValueError, match="height is in nm: give numbers, all lengths in one unit"):
        roughness.cap_radius(nm, um)
    with pytest.raises(ValueError, match="pitch is in um: give numbers"):
        roughness.square_lattice(um)


@pytest.mark.parametrize("separator", [";", "\t", " "])
def test_a_first_line_of_whole_numbers_shows_no_decimal_mark(tmp_path, separator):
    """A spreadsheet writes 0 as "0", also where 0.5 is "0,5"."""
    x, z = np.arange(20) / 2, np.sin(np.arange(20.0))
    rows = [f"{one:.4g}{separator}{other:.4g}".replace(".", ",") for one, other in zip(x, z, strict=True)]
    (tmp_path / "scan.csv").write_text("\n".join(["x z", *rows]), encoding="utf-8")
    assert rows[0] == f"0{separator}0"
    np.testing.assert_allclose(roughness.read(tmp_path / "scan.csv", unit="um").z, z * 1e-6, rtol=1e-3)
