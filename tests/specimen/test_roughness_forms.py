"""Numbers for the roughness tools in every form: whole numbers, lists, and arrays that have a unit of their own."""

import numpy as np
import pytest
import xarray as xr

from study import roughness

Z = np.cos(np.arange(64) / 3)


@pytest.mark.parametrize("kind", [np.int8, np.uint8])
def test_whole_numbers_do_not_overflow(kind):
    """1/20² was 1/144 of uint8, and negative of int8."""
    assert roughness.square_lattice(kind(20)) == roughness.square_lattice(np.array([20], kind))[0] == 1 / 400
    assert roughness.area_fraction(0.1, kind(20)) == roughness.area_fraction(0.1, 20.0)
    assert roughness.cap_radius(kind(4), kind(40)) == (1600 / 4 + 16) / 8
    assert roughness.square_lattice(np.array([100_000], np.int32)) == 1e-10


def test_lists_are_arrays():
    """They were a TypeError."""
    assert roughness.cap_radius([1, 2], 20).tolist() == roughness.cap_radius(np.array([1.0, 2.0]), 20).tolist()
    expected = [roughness.area_fraction(0.1, 5.0), roughness.area_fraction(0.2, 5.0)]
    assert roughness.area_fraction([0.1, 0.2], 5).tolist() == expected


def test_heights_with_a_unit_are_in_it():
    """Their numbers were taken in m, the default: all slopes are the same, so nothing looked wrong."""
    pint = pytest.importorskip("pint").UnitRegistry()
    for own in (pint.Quantity(Z, "um"), xr.DataArray(Z, dims="x", attrs={"units": "um"})):
        with pytest.raises(ValueError, match="profile: z is in .*, but must be numbers in m: give the numbers, and"):
            roughness.profile(own, dx=1.0)
        with pytest.raises(ValueError, match="profile: x is in .*, but must be numbers in m: give the numbers, and"):
            roughness.profile(Z, x=own)
    taken = roughness.profile(xr.DataArray(Z, dims="x", attrs={"units": "µm"}), dx=1, unit="um")
    assert taken.z.tolist() == roughness.profile(Z, dx=1, unit="um").z.tolist()


def test_a_labelled_map_is_turned_by_its_dimensions():
    z = np.outer(Z, Z[:32])
    turned = roughness.height_map(xr.DataArray(z.T, dims=("x", "y")), dx=2.0, dy=1.0, huge=True)
    assert turned.z.tolist() == z.tolist() and turned.steps == (1.0, 2.0)


def test_true_is_no_radius():
    with pytest.raises(ValueError, match="form = True; allowed are"):
        roughness.measure(roughness.profile(Z, dx=1.0, unit="mm"), form=True)
