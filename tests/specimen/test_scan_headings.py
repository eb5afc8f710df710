"""What headings say of the heights: factors, units, no data, sizes; formats of text that state all their lengths."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_scan_texts import IN, MAP, X40, Y40, P, Z, read, table, text, triples

BODY = text(table(Z))
PROFILE = "".join(f"{height:.4f}\r\n" for height in P)


@pytest.mark.parametrize(
    ("heading", "height_unit", "metres"),
    [
        ("height conversion factor (-> m)=6.3e-008", "m", 6.3e-8),
        ("# height conversion factor (-> um) = 0,05", "um", 5e-8),
        ("Scale factor to nm: 25", "nm", 25e-9),
        ("# Bit2nm = 0.0125", "nm", 0.0125e-9),
        ("Bit2nm=12.5", "nm", 12.5e-9),
        ("z unit: 1e-8 m", "m", 1e-8),
        ("Z units = 2 nm", "nm", 2e-9),
        ("z-unit: 1e-9 m", "nm", 1e-9),
        ("data units: 0.1 nm\nz-scale = 1", "angstrom", 1e-10),
    ],
)
def test_a_factor_that_is_understood_is_applied(tmp_path, heading, height_unit, metres):
    """Without it heights of numbers 63 nm high were a metre high, or the slopes refused in words about the unit."""
    scan = read(tmp_path, f"{heading}\n{BODY}", unit="um", height_unit=height_unit, dx=1.0)
    assert_allclose(scan.z, Z * metres, rtol=1e-9)
    said = [note for note in scan.notes if "heights are multiplied by" in note and "as line 1 says" in note]
    assert bool(said) == (metres not in (1e-9, 1e-10))  # those are height_unit itself
    with pytest.raises(
        ValueError, match=r"^a.txt, line 1: .* of the heights, but height_unit is mm: give height_unit="
    ):
        read(tmp_path, f"{heading}\n{BODY}", unit="mm", dx=1.0)
    of_call = read(tmp_path, f"{heading}\n{BODY}", unit="mm", height_unit="mm", dx=100.0, huge=True)
    assert_allclose(of_call.z, Z * 1e-3, rtol=1e-12)
    assert "heights are in mm, as height_unit says; the factor in line 1 of the heading, " in of_call.notes[0]
    assert of_call.notes[0].endswith(", is not applied") and len(of_call.notes) == 1


@pytest.mark.parametrize(
    "heading",
    [
        *(
            "z-scale=2",
            "Zscale = 1e-6",
            "zscale 1e-6",
            "Multiplier: 10",
            "multiplier;10",
            "Scale factor: 2.5",
            "Mult 3",
        ),
        *('"Scale factor","3"', "1 bit = 0.3 nm", "LSB = 0.3 nm", "Resolution: 0.3 nm/bit", "Z calibration: 12 nm/V"),
        *("ZUnitsPerBit 4e-10", "mm per count: 1e-6", "nm/bit = 0.5", "Height per LSB, 0.3"),
        *("Xscale = 1e-6, Yscale=1e-6, Zscale = 1e-9", "Scale Data = 0.01", "Height scale 0.5 nm", "Z-factor: 1e-3"),
        *("Vertical scale\t2.000", "Height multiplied by 1000", "heights in units of 0.1 nm", "amplification 1000"),
        *("Height [x 1e-8 m]", "z (1e-8 m)", "value * 0.01 um", "Quantisation 0.01 um", "# Z-Faktor = 0,001"),
        *(
            "Skalierung: 0,001",
            "facteur d'échelle = 2",
            "Bit2nm = 2\nz-unit = nm",
            "0.3 um per count: 0.3 um per count",
        ),
        *("Scale factor: 1,000", "Height conversion factor = 6.3e-008", "height factor\t6.3E-8", "Units: 1e-6 m"),
        *(
            "z unit: 2 nm\nz unit: 3 nm",
            "Z sensitivity = 15.2 nm/V",
            "ScaleZ: 1e-3",
            "scale z = 0.5",
            "Z_scale_factor=7",
        ),
    ],
)
def test_a_scale_that_is_not_understood_is_refused(tmp_path, heading):
    for said in (heading, "\n".join("# " + line for line in heading.split("\n"))):
        with pytest.raises(ValueError, match=r"^a.txt, line [12]: .*(take the line out|take out what does not hold)"):
            read(tmp_path, f"{said}\n{BODY}", **MAP)


def test_a_scale_that_is_the_unit_is_no_factor(tmp_path):
    for heading in (
        "z-scale = 1 nm",
        "1 bit = 1 nm",
        "Zscale = 1e-9 m",
        "Scale factor = 1.0",
        "Units: 1e-9 m",
        "LSB: 1 nm",
    ):
        scan = read(tmp_path, f"{heading}\n{BODY}", **MAP)
        assert_allclose(scan.z, Z * 1e-9, rtol=1e-12)
        assert scan.notes == ()


@pytest.mark.parametrize(
    ("heading", "of_heights"),
    [
        ("# Value units: µm", "µm"),
        ("z-unit = um", "um"),
        ("Unit Data = Angstrom", "Angstrom"),
        ('"XY calibration","1000","nm"\n"Unit","µm"', "µm"),
        ("Value units: V", "V"),
        ("heights (Å)", "Å"),
        ("heights [ångström]", "ångström"),
        ("z [pm]", "pm"),
        ("z [A]", "A"),
    ],
)
def test_the_unit_of_the_call_holds_against_the_heading(tmp_path, heading, of_heights):
    """Only the call's own height_unit does, not `unit` in its place; and what is in volts has no heights."""
    if of_heights == "V":
        with pytest.raises(ValueError, match="^a.txt: height_unit is nm, but the heading has V: .*no unit of length"):
            read(tmp_path, f"{heading}\n{BODY}", **MAP)
        return
    scan = read(tmp_path, f"{heading}\n{BODY}", **MAP)
    assert_allclose(scan.z, Z * 1e-9, rtol=1e-12)
    assert scan.notes == (f"heights are in nm, as height_unit says; the heading has {of_heights}",)
    message = f"^a.txt: height_unit is nm, but the heading has {of_heights}: .*Give height_unit='{of_heights}', or heig"
    with pytest.raises(ValueError, match=message):
        read(tmp_path, f"{heading}\n{BODY}", unit="nm", dx=1e3)


def test_a_heading_that_contradicts_itself(tmp_path):
    """Two units or factors of the heights are refused until height_unit decides."""
    rows = text(table(np.c_[np.arange(200) * 0.25, P]), ";")
    heading = "Value units: um\nx [um];z [nm]\n"
    with pytest.raises(ValueError, match=r"^a.txt: height_unit is um, but the heading has nm: "):
        read(tmp_path, heading + rows, unit="um")
    for unit, other in (("nm", "um"), ("um", "nm")):
        scan = read(tmp_path, heading + rows, unit="um", height_unit=unit, steep=True)
        assert_allclose(scan.z, P * {"nm": 1e-9, "um": 1e-6}[unit], rtol=1e-12)
        assert scan.notes == (f"heights are in {unit}, as height_unit says; the heading has {other}",)
    factors = "z unit: 2 nm\nz unit: 3 um\n"
    with pytest.raises(ValueError, match=r"^a.txt, line 2: .*makes um of the heights, but height_unit is nm"):
        read(tmp_path, factors + BODY, unit="nm", dx=1e3)
    scan = read(tmp_path, factors + BODY, **MAP)
    assert_allclose(scan.z, Z * 2e-9, rtol=1e-12)
    assert scan.notes[0] == "heights are multiplied by 2 nm, as line 1 says"
    assert scan.notes[1].endswith("the factor in line 2 of the heading, 3 um, is not applied")


@pytest.mark.parametrize(
    ("heading", "height_unit"),
    [("z [Å]", "angstrom"), ("z [A\u030a]", "Å"), ("z [\u212b]", "Å"), ("z (ångström)", "angstrom"), ("z [pm]", "pm")]
    + [("z [Angstroms]", "angstrom"), ("Value units: A", "angstrom"), ("z (micron)", "um"), ("z [Nanometers]", "nm")],
)
def test_units_of_a_heading_as_they_are_spelt(tmp_path, heading, height_unit):
    scan = read(tmp_path, f"{heading}\n" + text(table(Z * 64)), unit="um", height_unit=height_unit, dx=1e3)
    metres = {"angstrom": 1e-10, "Å": 1e-10, "pm": 1e-12, "um": 1e-6, "nm": 1e-9}[height_unit]
    assert_allclose(scan.z, Z * 64 * metres, rtol=1e-9)


@pytest.mark.parametrize("heading", ["x;z\num;um", "x (um);z (um)", "x in um;z in µm", "Lateral um;Raw(µm)", "um;um"])
def test_a_row_of_units_counts_without_brackets(tmp_path, heading):
    rows = text(table(np.c_[np.arange(200) * 0.25, P]), ";")
    with pytest.raises(ValueError, match="^a.txt: height_unit is nm, but the heading has (um|µm|Micrometer): "):
        read(tmp_path, f"{heading}\n{rows}", unit="nm")
    scan = read(tmp_path, f"{heading}\n{rows}", **IN)
    assert_allclose(scan.z, P * 1e-9, rtol=1e-12)
    assert len(scan.notes) == 1 and "heights are in nm, as height_unit says; the heading has " in scan.notes[0]


def test_units_of_x_y_and_z(tmp_path):
    rows = text(triples(X40, Y40))
    for units, note in (
        ("mm um nm", "positions are in um, as unit says; the heading has mm"),
        ("um mm nm", "positions are in um, as unit says; the heading has mm"),
        ("um um mm", "heights are in nm, as height_unit says; the heading has mm"),
    ):
        heading = "X[{}] Y[{}] Z[{}]\n".format(*units.split())
        scan = read(tmp_path, heading + rows, **IN)
        assert scan.notes == (note,)
        assert_allclose(scan.z, Z * 1e-9, rtol=1e-12)
        assert_allclose(scan.steps, 1e-6, rtol=1e-12)
    assert read(tmp_path, "X[um] Y[um] Z[nm]\n" + rows, **IN).notes == ()
    with pytest.raises(ValueError, match="^a.txt: unit is um, but the heading has s: .*no unit of length"):
        read(tmp_path, "t[s] Y[um] Z[nm]\n" + rows, **IN)


def test_numbers_for_no_data(tmp_path):
    """ESRI grids: -9999 is no height."""
    grid = "ncols 40\nnrows 40\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n"
    holes = np.where(np.greater(Z, np.sort(Z.ravel())[-3]), -9999, Z)
    for heading in (grid, "# Missing value: -9999\n", "no data = -9999.0\n"):
        scan = read(tmp_path, heading + text(table(holes)), "a.asc", missing="skip", **MAP)
        assert_allclose(scan.z, np.where(holes == -9999, np.nan, Z) * 1e-9, rtol=1e-12)
        assert any("2 heights of -9999 are missing points, as line" in note for note in scan.notes)
    assert np.isfinite(read(tmp_path, "Missing points: 0\n" + BODY, **MAP).z).all()
    for heading, message in (("ncols 41", "40 columns follow"), ("y-pixels = 50", "40 rows follow")):
        with pytest.raises(ValueError, match=f'^a.txt, line 1: "{heading}", but {message}: the file may be cut off'):
            read(tmp_path, f"{heading}\n{BODY}", **MAP)


def test_channels_of_a_text(tmp_path):
    """Both were stacked to a map of 80 × 40."""
    both = f"# Channel: Topography\n# Value units: nm\n{BODY}# Channel: Phase\n# Value units: deg\n{BODY}"
    with pytest.raises(ValueError, match="^a.txt: the file has the channels 'Topography', 'Phase': choose one with"):
        read(tmp_path, both, **MAP)
    scan = read(tmp_path, both, channel="Topography", **MAP)
    assert scan.z.shape == (40, 40) and scan.notes == ("channel 'Topography'",)
    for channel, message in (
        ("Phase", "height_unit is nm, but the heading has deg"),
        ("Z", "has 'Topography', 'Phase'"),
    ):
        with pytest.raises(ValueError, match=message):
            read(tmp_path, both, channel=channel, **MAP)
    with pytest.raises(ValueError, match="channel = 'Z', but the file has none by name"):
        read(tmp_path, BODY, channel="Z", **MAP)


WYKO = "Wyko ASCII Data File Format\t0\t{}\t1\nX Size\t40\nY Size\t40\nBlock Name\tType\tLength\tValue\n"
WYKO += "Wavelength\t7\t4\t5.5e+002\nAspect\t7\t4\t1\nPixel_size\t7\t4\t1e-3\nMult\t6\t2\t2\nRAW_DATA\t3\t6400\n"
ZYGO = 'Zygo XYZ Data File - Format 1\n0 3 0 0 "Tue Aug 25"\n0 0 40 40 1 255\n10 20 40 40\n""\n""\n""\n'
ZYGO += '0 0 6.328e-07 0.5 1 0 {} 1787677163\n3 2 0 0 0 666666 0 ""\n0 0 1 33 0 0\n1 5 0\n#\n'


def test_interferometers(tmp_path):
    """Wyko: heights in wavelengths. Zygo: x, y of pixels, z in µm, No Data."""
    for in_nm, metres in ((0, 275e-9), (1, 1e-9)):
        scan = read(tmp_path, WYKO.format(in_nm) + text(table(Z), "\t"), "a.asc", unit="um", height_unit="nm", dx=1e3)
        assert_allclose(scan.z, Z * metres, rtol=1e-9)
    for in_nm, message in ((0, "give height_unit='nm'"), (1, "Give height_unit='nm'")):
        with pytest.raises(ValueError, match=message):
            read(tmp_path, WYKO.format(in_nm) + text(table(Z), "\t"), "a.asc", unit="um", dx=1e3)
    for in_nm, said in ((0, "the factor in line 5 of the heading, 275 nm, is not applied"), (1, "the heading has nm")):
        content = WYKO.format(in_nm) + text(table(Z), "\t")
        scan = read(tmp_path, content, "a.asc", unit="um", height_unit="angstrom", dx=1e3)
        assert_allclose(scan.z, Z * 1e-10, rtol=1e-9)
        assert scan.notes == (f"heights are in angstrom, as height_unit says; {said}",)
    rows = triples(X40 + 10, Y40 + 20, Z * 1e-2)
    rows[3][2] = "No Data"
    scan = read(tmp_path, ZYGO.format("5e-7") + text(rows) + "#\n", "a.xyz", missing="skip")
    assert np.isnan(scan.z).sum() == 1
    assert_allclose(scan.z[1:], Z[1:] * 1e-8, rtol=1e-3)
    assert_allclose(scan.steps, 5e-7, rtol=1e-9)
    with pytest.raises(ValueError, match="a.xyz: the file states its lengths itself; leave out columns"):
        read(tmp_path, ZYGO.format("5e-7") + text(rows), "a.xyz", columns=(0, 1, 2))
    scan = read(tmp_path, ZYGO.format("5e-7") + text(rows), "a.xyz", unit="um", dx=0.4, missing="skip")
    assert_allclose(scan.steps, 4e-7, rtol=1e-9)
    assert scan.notes[0] == (
        "points are dx = 0.4 and dy = 0.4 um apart, as the call says; the file states 5e-07 and 5e-07 m"
    )
    scan = read(tmp_path, ZYGO.format("5e-7") + text(rows), "a.xyz", height_unit="nm", missing="skip")
    assert_allclose(scan.z[1:], Z[1:] * 1e-11, rtol=1e-3)
    assert scan.notes[0] == "heights are in nm, as height_unit says; the heading has um"
    with pytest.raises(ValueError, match="a.xyz: x and y are numbers of pixels, .* give dx and unit"):
        read(tmp_path, ZYGO.format("0") + text(rows), "a.xyz", unit="um")
    assert read(tmp_path, ZYGO.format("0") + text(rows), "a.xyz", unit="um", dx=2.0).steps == (2e-6, 2e-6)


SDF = "aBCR-1.0\nManufacID = x\nNumPoints = {}\nNumProfiles = {}\nXscale = 1e-6\nYscale = {}\nZscale = 1e-9\n"
SDF += "Zresolution = -1\nCompression = 0\nDataType = {}\nCheckType = 0\n*\n"
SMD = "ISO 5436-2:2012\0f\0\r\nPRF\0 1 ISO5436\0\r\n"
SMD += "CX\0 I\0 200 mm\0 1.0e0 D\0 2.5e-4 \r\nCZ\0 A\0 200 nm\0 1.0e0 D\0\r\n\x03\r\n"
SMD += "DATE: 1-May-2020\0\r\n\x03\r\n" + PROFILE + "\x03\r\n12345\r\n\x03\r\n\x1a"
PRF = "1 2\r\nSG2004 0.0e+000 PRF\r\nCX M 2.0e+002 MM 1.0e+000 D\r\nCZ M 2.0e+002 MM 1.0e-006 L\r\nEOR\r\n"
PRF += "STYLUS_RADIUS 0.0 MM\r\nSPACING CX 2.5e-004\r\nEOR\r\n" + PROFILE + "EOR\r\nEOF\r\n"


def test_formats_that_state_their_lengths(tmp_path):
    """SDF with its Zscale, SMD and PRF: of ISO 25178-71, ISO 5436-2 and softgauges."""
    for name in ("a.sdf", "a.txt"):
        scan = read(tmp_path, SDF.format(40, 40, "2e-6", 7) + BODY + "*\nComment = none\n*\n", name)
        assert_allclose(scan.z, Z * 1e-9, rtol=1e-12)
        assert scan.steps == (2e-6, 1e-6)
    whole = [[f"{value:.0f}"] for value in P * 1e3]
    whole[7] = ["-32768"]
    scan = read(tmp_path, SDF.format(200, 1, 0, 5) + text(whole) + "*\n", "a.sdf", huge=True)
    assert_allclose(np.delete(scan.z, 7), np.delete(P, 7) * 1e-6, atol=1e-9)
    assert any("1 of 200" in note for note in scan.notes)
    finer = PRF.replace("MM 1.0e+000", "MM 5.0e-001").replace("2.5e-004", "5.0e-004")  # the factor of x
    for name, content in (("a.smd", SMD), ("a.prf", PRF), ("b.prf", finer)):
        scan = read(tmp_path, content, name)
        assert_allclose(scan.z, P * 1e-9, rtol=1e-9)
        assert_allclose(scan.steps, 0.25e-6, rtol=1e-12)
        scan = read(tmp_path, content, name, unit="um", dx=1, height_unit="m", steep=True, huge=True)
        assert_allclose(scan.z, P * 1e-9, rtol=1e-9)
        assert_allclose(scan.steps, 1e-6, rtol=1e-12)
        assert scan.notes == ("points are dx = 1 um apart, as the call says; the file states 2.5e-07 m",)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (SDF.format(40, 41, "2e-6", 7) + BODY, "1600 heights, but the heading says 41 × 40"),
        (SDF.format(40, 40, "2e-6", 7).replace("Xscale", "Xstep") + BODY, "the SDF heading has no number for 'xscale'"),
        (SDF.format(40, 40, "2e-6", 7).replace("1e-9", "0") + BODY, "Zscale = 0 must be positive"),
        (SDF.format(40, 40, "2e-6", 7) + BODY.replace("0.1257", "word"), "something other than numbers and Bad"),
        (SMD.replace("I\0 200", "A\0 200").replace("2.5e-4", ""), "needs lines CX with a step and CZ"),
        (SMD.replace("200 nm", "200 V"), "needs lines CX with a step and CZ"),
        (SMD.replace("200 nm", "201 nm"), "200 heights, but the heading says 201"),
    ],
)
def test_formats_that_are_not_right(tmp_path, content, message):
    with pytest.raises(ValueError, match=f"^a.sdf: .*{message}"):
        read(tmp_path, content, "a.sdf")


def test_a_part_of_a_scan(tmp_path):
    rows = text(table(np.c_[5 + np.arange(200) * 0.25, P]))
    for crop in ((10, 40), ("10 um", "0.04 mm")):
        assert_allclose(read(tmp_path, rows, crop=crop, **IN).z, P[20:141] * 1e-9, rtol=1e-12)
    part = read(tmp_path, BODY.replace("0.1257", "Bad"), crop=(10, 30, 5, 35), **MAP)  # cuts the missing point away
    assert part.notes == () and part.z.shape == (31, 21)
    assert_allclose(part.z, Z[5:36, 10:31] * 1e-9, rtol=1e-12)
    grid = read(tmp_path, text(triples(X40 + 100, Y40 - 100)), crop=(110, 130, -95, -65), **IN)
    assert_allclose(grid.z, Z[5:36, 10:31] * 1e-9, rtol=1e-12)
    for crop, message in (
        ((0, 100), "must rise and lie in the scan, which goes from 0 to 39 um"),
        ((30, 10), "must rise and lie in the scan"),
        ((10, 20), r"crop from 10 to 20 um in x keeps 11 points; at least 16 are needed"),
        ((0, 30, 0, 5), "crop from 0 to 5 um in y keeps 6 points"),
        ((0, 30, 5), r"crop = \(0, 30, 5\); allowed is \(x0, x1\), or \(x0, x1, y0, y1\)"),
        ((0, "30"), "crop = '30': must be a number, in um"),
        (("0 um", "3 N"), 'crop = "3 N" is a force'),
        ((0, float("nan")), "must rise and lie in the scan"),
    ):
        with pytest.raises(ValueError, match=f"^a.txt: .*{message}"):
            read(tmp_path, BODY, crop=crop, **MAP)


@pytest.mark.parametrize(
    ("heading", "dx", "said"),
    [
        ("Width: 40.0 µm\nHeight: 40 µm", 1.0, []),
        ("Width: 40.0 µm\nHeight: 40 µm", 40 / 39, ["1 um a point, but dx is 1.0256 um", "but dy is 1.0256 um"]),
        ("# Width: 40000 nm", 1.0, []),
        ("pixel size=3.69862e-007 m", 0.369862, []),
        ("pixel size=3.69862e-007 m", 0.38, ['line 1 has "pixel size=3.69862e-007 m", 0.36986 um a point, but dx is']),
        ("Height: 12 V\nWidth: 4", 1.0, []),
    ],
)
def test_distances_of_a_heading_are_compared(tmp_path, heading, dx, said):
    """L/(N - 1) in the place of L/N made slopes 2.5 % too small, and the heading had L."""
    scan = read(tmp_path, f"{heading}\n{BODY}", unit="um", height_unit="nm", dx=dx)
    assert len(scan.notes) == len(said)
    assert all(part in note for part, note in zip(said, scan.notes, strict=True))
    assert_allclose(scan.steps, dx * 1e-6, rtol=1e-12)
