"""Files of instruments by the package SurfaceTopography: channels, missing points, what it cannot or must not read."""

import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose

from study import roughness

topography = pytest.importorskip("SurfaceTopography", reason="the extra roughcoat[topography]")
# It leaves netCDF files open, which Python says when it collects them.
pytestmark = pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")

Z = np.round(np.random.default_rng(0).normal(size=(40, 48)), 4) * 1e-9  # m, of (y, x)


def igor_wave(data: np.ndarray, labels: list[str], unit: str, steps=(1e-7, 1e-7)) -> bytes:
    """A wave of Igor, version 5, as Asylum Research writes it: the last axis of `data` has the labels."""
    dimensions = [*data.shape, 0, 0, 0][:4]
    names = b"".join(label.encode().ljust(32, b"\0") for label in ["", *labels])
    sizes = [len(names) if axis == data.ndim - 1 else 0 for axis in range(4)]
    wave = struct.pack("<4xIIi h h 6x h 32s 4x 4x", 0, 0, data.size, 2, 0, 1, b"scan")
    wave += struct.pack("<4i 4d 4d", *dimensions, *steps, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
    wave += struct.pack("<4s 4s4s4s4s h 2x dd", unit.encode(), b"m", b"m", b"", b"", 0, 0.0, 0.0)
    wave = wave.ljust(320, b"\0")
    content = data.astype("<f4").tobytes(order="F")

    def header(checksum: int) -> bytes:
        return struct.pack("<hh 4i 4i 4i 3i", 5, checksum, 320 + len(content), *[0] * 7, *sizes, *[0] * 3)

    words = np.frombuffer(header(0) + wave, dtype="<i2").astype(int).sum()
    return header(int(np.int16(-words & 0xFFFF if (-words & 0xFFFF) < 0x8000 else (-words & 0xFFFF) - 0x10000))) + (
        wave + content + names
    )


def netcdf(path, heights, unit="m"):
    topography.Topography(np.ma.masked_invalid(heights.T), (48e-7, 80e-7), unit=unit).to_netcdf(str(path))
    return path


def metropro(counts: np.ndarray, phase_res: int, pixel: float) -> bytes:
    """A map of MetroPro of Zygo, format 1: whole numbers in rows, whose unit follows from a wavelength of 633 nm, the
    factor 0.5, and the resolution of the phase."""
    header, (rows, columns) = bytearray(834), counts.shape
    fields = {0: (">I", 0x881B036F), 4: (">HI", 1, 834), 64: (">4HI", 0, 0, columns, rows, 4 * counts.size)}
    fields |= {164: (">ff", 0.5, 633e-9), 176: (">f", 1.0), 184: (">f", pixel), 218: (">h", phase_res)}
    for place, (form, *values) in fields.items():
        struct.pack_into(form, header, place, *values)
    return bytes(header) + counts.astype(">i4").tobytes()


@pytest.mark.parametrize(("phase_res", "resolution"), [(0, 4096), (1, 32768), (2, 131072)])
def test_metropro(tmp_path, phase_res, resolution):
    """The resolution of the phase, which makes heights 8 or 32 times too small or large; L/N, and not L/(N - 1); points
    that are not measured; rows from the first to the last."""
    unit, file = 0.5 * 633e-9 / resolution, tmp_path / "a.dat"
    counts = np.rint(np.cumsum(Z, axis=1) / Z.std() * 100).astype(int)
    file.write_bytes(metropro(np.where(counts == counts.max(), 2147483640, counts), phase_res, 2.5e-7))
    scan = roughness.read(file, missing="skip")
    assert_allclose(scan.z, np.where(counts == counts.max(), np.nan, counts * unit), rtol=1e-6)
    assert_allclose(scan.steps, 2.5e-7, rtol=1e-6)


def test_missing_points_of_an_instrument(tmp_path):
    """8 of 38 files were refused for them, four with less than 0.25 %."""
    holes = np.where(np.greater(Z, np.sort(Z.ravel())[-5]), np.nan, Z)
    scan = roughness.read(netcdf(tmp_path / "a.nc", holes))
    assert np.isfinite(scan.z).all() and any("4 of 1920 heights (0.21 %)" in note for note in scan.notes)
    assert_allclose(scan.steps, (2e-7, 1e-7), rtol=1e-6)
    with pytest.raises(ValueError, match=r"^a.nc: 4 of 1920 heights are not numbers"):
        roughness.read(tmp_path / "a.nc", missing="refuse")
    scan = roughness.read(netcdf(tmp_path / "b.nc", np.where(Z > 1e-9, np.nan, Z)), missing="skip")
    assert_allclose(scan.z, np.where(Z > 1e-9, np.nan, Z), rtol=1e-6)


def test_a_part_of_an_instruments_map(tmp_path):
    file = netcdf(tmp_path / "a.nc", Z)
    for crop in ((1e-6, 3e-6, 2e-6, 6e-6), ("1 um", "3 um", "2 um", "6000 nm")):
        assert_allclose(roughness.read(file, crop=crop).z, Z[10:31, 10:31], rtol=1e-6)
    with pytest.raises(
        ValueError, match=r"a.nc: crop from 0 to 3 m in x: must rise and lie in the scan, .* to 4.7e-06"
    ):
        roughness.read(file, crop=(0, 3))


def test_lengths_of_an_instrument_may_be_wrong(tmp_path):
    """A reader's bug gave scans 160 m wide."""
    with pytest.raises(ValueError, match=r"a.nc: .*(4.8|4.7) m long, .*|a.nc: the heights spread by"):
        roughness.read(netcdf(tmp_path / "a.nc", Z * 1e-6, unit="m"))
    file = tmp_path / "b.nc"
    topography.Topography(Z.T * 1e9, (48, 80), unit="m").to_netcdf(str(file))
    with pytest.raises(ValueError, match=r"b.nc: the scan is 78 m long; at most 1 m"):
        roughness.read(file)


def test_channels_by_name(tmp_path):
    file = tmp_path / "a.ibw"
    stack = np.stack([Z.T[:40] * 5, Z.T[:40], Z.T[:40]], axis=2)
    file.write_bytes(igor_wave(stack, ["Phase", "Height", "ZSensor"], "m"))
    scan = roughness.read(file, channel="Height")
    assert_allclose(scan.z, Z[::-1, :40], rtol=1e-6)  # those of Igor begin below
    assert scan.notes[0] == "channel 'Height' of 'Phase', 'Height', 'ZSensor'"
    assert "channel 'Height' of" in str(roughness.measure(scan))
    with pytest.raises(ValueError, match="a.ibw: channel = 'Topo', but the file has 'Phase', 'Height', 'ZSensor'"):
        roughness.read(file, channel="Topo")


def test_a_curve_of_force_is_no_map(tmp_path):
    file = tmp_path / "curve0001.ibw"
    file.write_bytes(igor_wave(np.random.default_rng(1).normal(size=(300, 3)), ["Raw", "Defl", "ZSnsr"], "m"))
    with pytest.raises(ValueError, match=r"^curve0001.ibw: a force curve \('Raw', 'Defl', 'ZSnsr'\), not a map of"):
        roughness.read(file)


def test_files_without_lengths_take_them(tmp_path):
    """They had none, and dx was refused: "the format states its lengths itself"."""
    h5py = pytest.importorskip("h5py")
    file = tmp_path / "a.h5"
    with h5py.File(file, "w") as h5:
        h5["topo"], h5["raw"] = Z.T * 1e9, Z.T * 2e9
    with pytest.raises(ValueError, match=r"^a.h5: the file states no distance of its points: give dx \(and dy\) and u"):
        roughness.read(file)
    with pytest.raises(ValueError, match=r"^a.h5: the format states its lengths itself; leave out columns"):
        roughness.read(file, unit="um", dx=1, columns=(0,))
    scan = roughness.read(file, unit="um", height_unit="nm", dx=0.1, dy=0.2, channel="topo")
    assert_allclose(scan.z, Z, rtol=1e-12)
    assert_allclose(scan.steps, (2e-7, 1e-7), rtol=1e-12)
    part = roughness.read(file, unit="um", height_unit="nm", dx=0.1, channel="raw", crop=(1, 3))
    assert_allclose(part.z, 2 * Z[:, 10:31], rtol=1e-12)


@pytest.mark.parametrize("name", ["a.plu", "a.h5", "a.opd", "a.dat", "a.xyz", "a.asc", "a.txt", "a.gz", "a.foo"])
def test_bytes_that_are_nothing(tmp_path, name):
    """A reader without a mark of its format took any bytes for heights; the message listed what each reader said."""
    for size in (2, 512, 2000):
        (tmp_path / name).write_bytes(bytes(i % 251 for i in range(size)))
        with pytest.raises(ValueError, match=f"^{name}: .*SurfaceTopography cannot read it: ") as said:
            roughness.read(tmp_path / name)
        assert "tried" not in str(said.value) and "Reader" not in str(said.value)


def test_an_instruments_file_under_another_ending(tmp_path):
    netcdf(tmp_path / "a.nc", Z)
    for name in ("a.dat", "a.asc", "a.xyz", "a.csv"):
        (tmp_path / name).write_bytes((tmp_path / "a.nc").read_bytes())
        assert_allclose(roughness.read(tmp_path / name).z, Z, rtol=1e-6)


def test_text_under_an_unknown_ending_is_text(tmp_path):
    """SurfaceTopography reads tables as well; their units and factors are looked after here."""
    np.savetxt(tmp_path / "a.foo", Z * 1e9, header="Bit2nm = 2")
    scan = roughness.read(tmp_path / "a.foo", unit="um", height_unit="nm", dx=0.1)
    assert_allclose(scan.z, 2 * Z, rtol=1e-12)
