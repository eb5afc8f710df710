"""Lengths that the call gives hold in the place of those of the file, and the notes say so."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_scan_formats import UM, dataset, x3p

from study import roughness

Z = np.round(np.cumsum(np.random.default_rng(1).normal(size=(64, 96)), axis=1) * 0.1, 4)


@pytest.mark.parametrize(
    ("arguments", "steps", "size", "notes"),
    [
        ({"unit": "um", "dx": 0.5, "dy": 1}, (UM, UM / 2), 1.0, []),
        ({"dx": 0.25}, (UM / 4, UM / 4), 1.0, ["points are dx = 0.25 and dy = 0.25 um apart, as the call"]),
        ({"unit": "nm", "dx": 250, "dy": 500}, (UM / 2, UM / 4), 1.0, ["points are dx = 250 and dy = 500 nm apart, "]),
        ({"unit": "mm"}, (1e-3, 5e-4), 1.0, ["x and y are in mm, as unit says; the file states um"]),
        ({"height_unit": "nm"}, (UM, UM / 2), 1e-3, ["heights are in nm, as height_unit says; the file states um"]),
    ],
)
def test_lengths_of_netcdf_are_overruled(tmp_path, arguments, steps, size, notes):
    dataset(Z).to_netcdf(tmp_path / "a.nc")
    scan = roughness.read(tmp_path / "a.nc", **arguments, steep=True)
    assert_allclose(scan.steps, steps, rtol=1e-12)
    assert_allclose(scan.z, Z * UM * size, rtol=1e-12)
    assert len(scan.notes) == 1 + len(notes)
    assert all(note.startswith(start) for note, start in zip(scan.notes[1:], notes, strict=True))


def test_lengths_of_x3p_are_overruled(tmp_path):
    """A wrong increment of x could not be mended: "the format states its lengths itself"."""
    path = x3p(tmp_path / "a.x3p", Z)
    scan = roughness.read(path, unit="um", dx=0.25, dy=2)
    assert_allclose(scan.steps, (2 * UM, UM / 4), rtol=1e-12)
    assert_allclose(scan.z, Z * UM, rtol=1e-12)
    assert scan.notes[0] == (
        "points are dx = 0.25 and dy = 2 um apart, as the call says; the file states 5e-07 and 1e-06 m"
    )
    scan = roughness.read(path, unit="um", dx=0.25, crop=(0, 5, 0, 6))
    assert scan.z.shape == (25, 21)


def test_dx_of_a_file_that_states_the_unit_alone(tmp_path):
    """dx in another unit than that of the file was taken for a number of its unit."""
    file = dataset(Z)
    for axis in ("x", "y"):
        file[axis] = (axis, np.full(file.sizes[axis], np.nan), {"units": "um"})
    file.to_netcdf(tmp_path / "a.nc")
    for arguments in ({"dx": 0.5, "dy": 1}, {"dx": 500, "dy": 1000, "unit": "nm"}):
        scan = roughness.read(tmp_path / "a.nc", **arguments)
        assert_allclose(scan.steps, (UM, UM / 2), rtol=1e-12)
        assert_allclose(scan.z, Z * UM, rtol=1e-12)
        assert len(scan.notes) == 1


def test_two_units_of_netcdf_are_settled_by_the_call(tmp_path):
    dataset(Z, lateral=("mm", "um")).to_netcdf(tmp_path / "a.nc")
    with pytest.raises(ValueError, match="^a.nc: x is in um, y in mm: write both in one unit, or give unit, which"):
        roughness.read(tmp_path / "a.nc")
    for arguments, steps, decides in (({"unit": "um"}, (UM, UM / 2), "unit"), ({"dx": 2}, (2 * UM, 2 * UM), "dx")):
        scan = roughness.read(tmp_path / "a.nc", **arguments)
        assert_allclose(scan.steps, steps, rtol=1e-12)
        assert_allclose(scan.z, Z * UM, rtol=1e-12)
        assert scan.notes[1] == f"x is in um, y in mm in the file: {decides} of the call holds for both"


def test_distances_with_a_unit(tmp_path):
    """dx = "400 nm" is .4 in um; without `unit` its unit is that of all lengths."""
    np.savetxt(tmp_path / "map.txt", Z[:20, :18])
    in_um = roughness.read(tmp_path / "map.txt", unit="um", dx=0.4, dy=0.5)
    for lengths in ({"unit": "um", "dx": "400 nm", "dy": "0.5 um"}, {"dx": "0.4 um", "dy": "500 nm"}):
        scan = roughness.read(tmp_path / "map.txt", **lengths)
        np.testing.assert_allclose(scan.steps, in_um.steps, rtol=1e-14)
        np.testing.assert_allclose(scan.z, in_um.z, rtol=1e-14)
