"""HDF5 files of data sets without lengths, read without another package."""

import sys

import netCDF4
import numpy as np
import pytest
from numpy.testing import assert_allclose

from study import roughness

Z = np.round(np.random.default_rng(2).normal(size=(40, 48)), 4)  # nm, of (y, x)
LENGTHS = {"unit": "um", "height_unit": "nm", "dx": 0.1, "dy": 0.2}


@pytest.fixture(autouse=True)
def without_surfacetopography(monkeypatch):
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)


def hdf5(path, **maps):
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("i", 48), file.createDimension("j", 40)
        for name, z in maps.items():
            file.createVariable(name, z.dtype, ("i", "j"))[:] = z.T
        file.createVariable("rating", "f8", ("i",))[:] = 1.0
    return path


def test_one_data_set(tmp_path):
    path = hdf5(tmp_path / "a.h5", topo=Z)
    scan = roughness.read(path, **LENGTHS)
    assert_allclose(scan.z, Z * 1e-9, rtol=1e-12)
    assert_allclose(scan.steps, (2e-7, 1e-7), rtol=1e-12)
    assert scan.notes == ("channel 'topo'",)
    assert roughness.read(path, **LENGTHS, crop=(1, 3)).z.shape == (40, 21)


def test_several_data_sets_and_labels(tmp_path):
    """The labels came first, and were taken for heights."""
    path = hdf5(tmp_path / "a.h5", aa_labels=(Z > 1).astype(int), image=Z)
    every = r"the file states no distance of its points: give dx \(and dy\) and unit, and height_unit .*; and "
    named = "the file has the data sets 'aa_labels', 'image': choose the heights with channel="
    for arguments, message in (
        ({}, every + named),
        ({"unit": "um"}, every + named),
        (LENGTHS, named),
        (LENGTHS | {"channel": "aa_labels"}, "channel 'aa_labels' of 'aa_labels', 'image' has labels, which are not"),
        (LENGTHS | {"channel": "Image"}, "channel = 'Image', but the file has 'aa_labels', 'image'"),
        (LENGTHS | {"columns": (0,)}, "the format states its lengths itself; leave out columns"),
    ):
        with pytest.raises(ValueError, match=f"^a.h5: {message}"):
            roughness.read(path, **arguments)
    scan = roughness.read(path, **LENGTHS, channel="image")
    assert_allclose(scan.z, Z * 1e-9, rtol=1e-12)


def test_hdf5_without_a_map(tmp_path):
    with pytest.raises(ImportError, match=r"^a.h5: .h5 is neither text"):
        roughness.read(hdf5(tmp_path / "a.h5"))
