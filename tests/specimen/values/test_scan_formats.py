"""netCDF, X3P, SDF, Gwyddion and HDF5: axes by their names, marks and masks, revisions, sets of labels."""

import io
import re
import struct
import zipfile

import netCDF4
import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from study import roughness

UM = 1e-6


@pytest.fixture(scope="module")
def z():
    """Heights (y, x) in µm that are smooth along x alone: exchanged axes change every number."""
    z = np.cumsum(np.random.default_rng(0).normal(size=(64, 96)), axis=1) * 0.2
    return np.round(z - z.mean(axis=1, keepdims=True), 4)


def dataset(z, lateral=("um", "um"), height="um", key="units", positions=True):
    heights = xr.DataArray(z, dims=("y", "x"), attrs={key: height} if height else {})
    if positions:
        for axis, step, unit in zip("yx", (1.0, 0.5), lateral, strict=True):
            points = heights.sizes[axis]
            heights[axis] = (axis, 7 + step * np.arange(points), {key: unit} if unit else {})
    return heights.to_dataset(name="heights")


WRITERS = {
    "classic": {"format": "NETCDF3_64BIT", "engine": "scipy"},
    "version 4": {"format": "NETCDF4", "engine": "netcdf4"},
}


@pytest.mark.parametrize("key", ["unit", "units"])
@pytest.mark.parametrize("how", WRITERS.values(), ids=WRITERS)
def test_axes_of_netcdf_are_those_of_its_dimensions(tmp_path, z, how, key):
    """heights(y, x), 64 × 96, came back as 96 × 64 with steps of 0.667 × 0.75 µm."""
    for name, each in {"yx.nc": dataset(z, key=key), "xy.nc": dataset(z, key=key).transpose("x", "y")}.items():
        each.to_netcdf(tmp_path / name, **how)
        scan = roughness.read(tmp_path / name)
        assert_allclose(scan.z, z * UM, rtol=1e-12)
        assert_allclose(scan.steps, (UM, UM / 2), rtol=1e-12)
        assert roughness.read(tmp_path / name, crop=("7 um", "17 um", "7 um", "27 um")).z.shape == (21, 21)
        same = roughness.read(tmp_path / name, unit="um", height_unit="um")
        assert same.steps == scan.steps, "the units of the file may be given"
    (tmp_path / "a.dat").write_bytes((tmp_path / "yx.nc").read_bytes())
    assert roughness.read(tmp_path / "a.dat").z.shape == (64, 96)


def test_a_length_and_no_positions(tmp_path, z):
    """As SurfaceTopography writes it, `length` is that of as many steps as there are points."""
    with netCDF4.Dataset(tmp_path / "a.nc", "w", format="NETCDF3_64BIT_OFFSET") as file:
        for axis, points, length in (("y", 64, 64.0), ("x", 96, 48.0)):
            file.createDimension(axis, points)
            file.createVariable(axis, "f8", (axis,)).setncatts({"unit": "um", "length": length})
        file.createVariable("heights", "f8", ("y", "x"))[:] = z
        file.createVariable("mask", "i1", ("y", "x"))[:] = np.pad([[1]], ((3, 60), (5, 90)))
    scan = roughness.read(tmp_path / "a.nc", missing="skip")
    assert_allclose(scan.steps, (UM, UM / 2), rtol=1e-12)
    assert np.argwhere(np.isnan(scan.z)).tolist() == [[3, 5]]


def test_what_a_netcdf_file_does_not_state_is_asked_for(tmp_path, z):
    dataset(z, height=None).to_netcdf(tmp_path / "a.nc")
    with pytest.raises(ValueError, match=r"^a.nc: the file states no height_unit: give height_unit$"):
        roughness.read(tmp_path / "a.nc")
    assert_allclose(roughness.read(tmp_path / "a.nc", height_unit="nm").z, z * 1e-9, rtol=1e-12)
    dataset(z, positions=False, height=None).to_netcdf(tmp_path / "b.nc")
    every = r"no unit and no height_unit: give unit, height_unit; and no positions of y and no positions of x: give dx "
    with pytest.raises(ValueError, match=rf"^b.nc: the file states {every}\(and dy\)$"):
        roughness.read(tmp_path / "b.nc")
    with pytest.raises(ValueError, match=r"^b.nc: the file states no positions of y and no positions of x|: give dx"):
        roughness.read(tmp_path / "b.nc", unit="um")
    scan = roughness.read(tmp_path / "b.nc", unit="um", dx=0.5, dy=1)
    assert_allclose(scan.z, z * UM, rtol=1e-12)
    assert_allclose(scan.steps, (UM, UM / 2), rtol=1e-12)


@pytest.mark.parametrize(
    ("change", "arguments", "part"),
    [
        ({}, {"dy": 0.5}, "give dx beside dy, both in the place of what the file states"),
        ({}, {"columns": (0,)}, "leave out columns"),
        ({}, {"channel": "height"}, "channel = 'height', but the file has 'heights'"),
        ({"height": "V"}, {}, "heights is in 'V', which is not a unit of length"),
        ({"lateral": ("mm", "um")}, {}, "x is in um, y in mm: write both in one unit"),
    ],
)
def test_netcdf_that_is_refused(tmp_path, z, change, arguments, part):
    dataset(z, **change).to_netcdf(tmp_path / "a.nc")
    with pytest.raises(ValueError, match=f"^a.nc: .*{re.escape(part)}"):
        roughness.read(tmp_path / "a.nc", **arguments)


def test_netcdf_of_several_variables_and_unequal_steps(tmp_path, z):
    several = dataset(z).rename(heights="topo").assign(phase=lambda each: each.topo * 2)
    several.to_netcdf(tmp_path / "a.nc")
    with pytest.raises(ValueError, match=r"^a.nc: the file has 'topo', 'phase' over x and y: choose the heights with"):
        roughness.read(tmp_path / "a.nc")
    assert_allclose(roughness.read(tmp_path / "a.nc", channel="topo").z, z * UM, rtol=1e-12)
    crooked = dataset(z)
    crooked.assign_coords(x=("x", np.geomspace(1, 9, 96), {"units": "um"})).to_netcdf(tmp_path / "b.nc")
    with pytest.raises(ValueError, match=r"^b.nc: the positions x have no equal steps"):
        roughness.read(tmp_path / "b.nc")


MAIN = """<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1><Revision>{revision}</Revision>
<FeatureType>SUR</FeatureType><Axes><CX><AxisType>I</AxisType><DataType>D</DataType><Increment>5e-7</Increment>
<Offset>0</Offset></CX><CY><AxisType>I</AxisType><DataType>D</DataType><Increment>1e-6</Increment></CY>
<CZ><AxisType>A</AxisType><DataType>{kind}</DataType><Increment>{scale}</Increment><Offset>{offset}</Offset></CZ></Axes>
</Record1><Record2><Date>2020-01-01T00:00:00</Date>{instrument}</Record2><Record3><MatrixDimension><SizeX>96</SizeX>
<SizeY>{rows}</SizeY><SizeZ>1</SizeZ></MatrixDimension><DataLink><PointDataLink>bindata/data.bin</PointDataLink>{valid}
</DataLink></Record3></p:ISO5436_2>"""


def x3p(path, heights, kind="D", scale=1e-6, offset=0.0, revision="ISO5436 - 2000", instrument="", valid=None):
    types = {"D": "<f8", "F": "<f4", "L": "<i4", "I": "<i2"}
    link = "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>" if valid is not None else ""
    about = {"kind": kind, "scale": scale, "offset": offset, "revision": revision, "instrument": instrument}
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("main.xml", MAIN.format(**about, valid=link, rows=len(heights)))
        archive.writestr("bindata/data.bin", np.asarray(heights).astype(types[kind]).tobytes())
        if valid is not None:
            archive.writestr("bindata/valid.bin", np.packbits(valid.ravel(), bitorder="little").tobytes())
    return path


INSTRUMENTS = ("", "<Instrument/>", "<Instrument><Manufacturer>x</Manufacturer><Model/></Instrument>")


@pytest.mark.parametrize("instrument", INSTRUMENTS)
@pytest.mark.parametrize("revision", ["ISO5436 - 2000", "ISO5436 - 2020", "ISO25178-72:2017"])
def test_x3p_of_any_revision_and_instrument(tmp_path, z, revision, instrument):
    """They were a TypeError text, and "Revision should be"."""
    scan = roughness.read(x3p(tmp_path / "a.x3p", z, revision=revision, instrument=instrument))
    assert_allclose(scan.z, z * UM, rtol=1e-12)
    assert_allclose(scan.steps, (UM, UM / 2), rtol=1e-12)


def test_x3p_of_whole_numbers_with_points_that_are_not_valid(tmp_path, z):
    valid = np.arange(z.size).reshape(z.shape) % 977 != 5
    whole = np.round(z * 1e4)
    for kind, heights in {"L": whole, "I": np.clip(whole, -32768, 32767)}.items():
        path = x3p(tmp_path / f"{kind}.x3p", heights, kind=kind, scale=1e-10, offset=2e-6, valid=valid)
        scan = roughness.read(path, missing="skip")
        assert_allclose(scan.z, np.where(valid, heights * 1e-10 + 2e-6, np.nan), rtol=1e-9)
    assert_allclose(roughness.read(x3p(tmp_path / "p.x3p", z[:1])).z, z[0] * UM, rtol=1e-12)


def test_x3p_that_is_refused(tmp_path, z):
    x3p(tmp_path / "a.x3p", z)
    with pytest.raises(ValueError, match=r"^a.x3p: the format states its lengths itself; leave out columns, channel"):
        roughness.read(tmp_path / "a.x3p", columns=(0,), channel="z")
    x3p(tmp_path / "b.x3p", z[:, :90])
    with pytest.raises(ValueError, match=r"^b.x3p: bindata/data.bin of the X3P file has 46080 bytes"):
        roughness.read(tmp_path / "b.x3p")
    packed = io.BytesIO((tmp_path / "a.x3p").read_bytes())
    with zipfile.ZipFile(packed) as source, zipfile.ZipFile(tmp_path / "c.x3p", "w") as archive:
        archive.writestr("main.xml", source.read("main.xml"))
    with pytest.raises(ValueError, match=r"^c.x3p: the X3P file is damaged: There is no item named"):
        roughness.read(tmp_path / "c.x3p")


@pytest.mark.parametrize(("kind", "scale"), [("<f8", 1e-6), ("<f8", 1.0), ("<f4", 1e-6), ("<f4", 1e-9)])
def test_holes_of_a_binary_sdf_are_the_largest_number(tmp_path, z, kind, scale):
    """Holes of -1.8e308 made heights that span 1.8e302 m."""
    pytest.importorskip("SurfaceTopography", reason="the extra roughcoat[topography]")
    heights = (z * UM / scale).astype(kind)
    heights[3, 4] = -np.finfo(kind).max
    head = struct.pack(
        "<8s10s12s12sHHddddBBB",
        b"bISO-1.0",
        b"x",
        b"0",
        b"0",
        96,
        64,
        5e-7,
        1e-6,
        scale,
        -1,
        0,
        7 if kind == "<f8" else 3,
        0,
    )
    (tmp_path / "a.sdf").write_bytes(head + heights.tobytes())
    scan = roughness.read(tmp_path / "a.sdf", missing="skip")
    assert np.argwhere(np.isnan(scan.z)).tolist() == [[3, 4]]
    assert any("1 of 6144 heights are larger than any" in note for note in scan.notes)
    assert_allclose(np.nan_to_num(scan.z), np.where(np.isnan(scan.z), 0, z * UM), rtol=1e-6)


@pytest.mark.parametrize("mark", [1.70141e38, -3.4028234e38, 1.7976931348623157e308])
def test_the_largest_number_is_no_height_in_text_either(tmp_path, z, mark):
    marked = np.where(np.arange(z.size).reshape(z.shape) == 100, mark, z)
    np.savetxt(tmp_path / "a.txt", marked)
    np.save(tmp_path / "a.npy", marked)
    for name in ("a.txt", "a.npy"):
        scan = roughness.read(tmp_path / name, unit="um", dx=0.5, missing="skip")
        assert np.argwhere(np.isnan(scan.z)).tolist() == [[1, 4]]


def gwyddion(path, heights, mask=None, unit="m"):
    """As Gwyddion writes it: a container of fields, the mask beside the data."""

    def item(key, kind, content):
        return key.encode() + b"\0" + kind.encode() + content

    def thing(name, *items):
        content = b"".join(items)
        return name.encode() + b"\0" + struct.pack("<I", len(content)) + content

    def field(values):
        sizes = [item("xres", "i", struct.pack("<i", 96)), item("yres", "i", struct.pack("<i", 64))]
        sizes += [item("xreal", "d", struct.pack("<d", 48e-6)), item("yreal", "d", struct.pack("<d", 64e-6))]
        units = [
            item(f"si_unit_{axis}", "o", thing("GwySIUnit", item("unitstr", "s", word.encode() + b"\0")))
            for axis, word in (("xy", "m"), ("z", unit))
        ]
        data = np.asarray(values, "<f8")
        return thing("GwyDataField", *sizes, *units, item("data", "D", struct.pack("<I", data.size) + data.tobytes()))

    items = [item("/0/data", "o", field(heights)), item("/0/data/title", "s", b"Height\0")]
    items += [item("/0/mask", "o", field(mask))] if mask is not None else []
    path.write_bytes(b"GWYP" + thing("GwyContainer", *items))
    return path


@pytest.mark.parametrize(("unit", "size"), [("m", 1.0), ("nm", 1e9)])
def test_a_mask_of_gwyddion_marks_and_its_heights_are_taken(tmp_path, z, unit, size):
    """14 % marked grains were refused as missing; with "skip" the spread was that of what lies between them."""
    pytest.importorskip("SurfaceTopography", reason="the extra roughcoat[topography]")
    for mask in (z > 1, z > z.max() - 0.2):
        scan = roughness.read(gwyddion(tmp_path / "a.gwy", z * UM * size, mask, unit))
        assert_allclose(scan.z, z * UM, rtol=1e-12)
        assert_allclose(scan.steps, (UM, UM / 2), rtol=1e-12)  # L/N
        assert any(f"{mask.sum()} of 6144 points are under a mask of Gwyddion" in note for note in scan.notes)
        bare = roughness.read(gwyddion(tmp_path / "b.gwy", z * UM * size, None, unit))
        assert_allclose(scan.z, bare.z, rtol=1e-12)


def test_missing_points_that_gwyddion_has_replaced(tmp_path, z):
    """It puts the mean of the others there, and a mask over them."""
    pytest.importorskip("SurfaceTopography", reason="the extra roughcoat[topography]")
    mask = z > 1
    path = gwyddion(tmp_path / "a.gwy", np.where(mask, z[~mask].mean(), z) * UM, mask)
    scan = roughness.read(path, missing="skip")
    assert (np.isnan(scan.z) == mask).all() and "the points under the mask have the mean height" in scan.notes[1]


def test_a_file_of_labels_and_an_image(tmp_path, z):
    """The labels came first, and were taken for heights."""
    pytest.importorskip("SurfaceTopography", reason="the extra roughcoat[topography]")
    h5py = pytest.importorskip("h5py")
    file, lengths = tmp_path / "a.h5", {"unit": "um", "dx": 0.5, "dy": 1}
    with h5py.File(file, "w") as h5:
        h5["aa_labels"], h5["image"] = (z.T > 1).astype(int) + (z.T > 2), z.T
    with pytest.raises(ValueError, match=r"has the data sets 'aa_labels', 'image': choose the heights with channel="):
        roughness.read(file, **lengths)
    with pytest.raises(ValueError, match=r"channel 'aa_labels' of .* has labels, which are not heights"):
        roughness.read(file, **lengths, channel="aa_labels")
    assert_allclose(roughness.read(file, **lengths, channel="image").z, z * UM, rtol=1e-12)


def test_a_factor_makes_metres_of_a_phase(tmp_path, z):
    """ "data unit=rad" above it was taken for the unit of the heights, and no height_unit was right."""
    heading = "h=64 w=96\npixel size=3.69862e-007 m\ndata unit=rad\nheight conversion factor (-> m)=2.91818e-008\n"
    np.savetxt(tmp_path / "phase.txt", z, header=heading.strip(), comments="")
    scan = roughness.read(tmp_path / "phase.txt", unit="m", dx=3.69862e-7)
    assert_allclose(scan.z, z * 2.91818e-8, rtol=1e-12)
    with pytest.raises(ValueError, match=r"makes m of the heights, but height_unit is um: give height_unit='m'"):
        roughness.read(tmp_path / "phase.txt", unit="um", dx=0.369862)
    assert roughness.read(tmp_path / "phase.txt", unit="um", height_unit="m", dx=0.369862).z.shape == z.shape


def test_all_lengths_that_a_text_lacks_are_asked_for_at_once(tmp_path, z):
    """unit led to dx, dx to height_unit, one message after the other."""
    heading = "pixel size=3.69862e-007 m\ndata unit=rad\nheight conversion factor (-> m)=2.91818e-008"
    np.savetxt(tmp_path / "phase.txt", z, header=heading, comments="")
    np.savetxt(tmp_path / "column.txt", z[0], header="Value units: nm")
    for name, arguments, asked in (
        ("phase.txt", {}, r"give unit, .*\. Also give dx \(and dy\), .*, and height_unit='m', as the heading has it"),
        ("phase.txt", {"dx": 1}, r"give unit, .* Also give height_unit='m', as the heading has it\. Its heading is"),
        ("phase.txt", {"height_unit": "m"}, r"give unit, .* Also give dx \(and dy\), the distance of points\. Its"),
        ("phase.txt", {"unit": "um"}, r"a map of 64 × 96 heights: give dx \(and dy\), .*; and height_unit='m', as the"),
        ("phase.txt", {"unit": "m"}, r"a map of 64 × 96 heights: give dx \(and dy\), their distance$"),
        (
            "column.txt",
            {},
            r"give unit, .* Also give dx, the distance of points, and height_unit='nm', as the heading has",
        ),
    ):
        with pytest.raises(ValueError, match=f"^{name}: {asked}"):
            roughness.read(tmp_path / name, **arguments)
