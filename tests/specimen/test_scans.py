"""Scans: what files are read as, and what is said about those that cannot be scans."""

import re
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from study import roughness
from study.specimen.scan import UNITS

X = np.arange(20) * 0.5
Z = np.round(np.sin(X) + 0.3 * np.cos(2.7 * X), 6)
TABLE = np.round(np.add.outer(np.sin(np.arange(17)), np.cos(np.arange(19))), 6)


def lines(*columns, separator=" ", mark=".", ending="\n") -> str:
    rows = zip(*columns, strict=True)
    return "".join(separator.join(f"{value:.6f}".replace(".", mark) for value in row) + ending for row in rows)


@pytest.mark.parametrize(
    "text",
    [
        lines(X, Z),
        lines(X, Z, separator=","),
        lines(X, Z, separator=", "),
        lines(X, Z, separator=";", ending=";\r\n"),
        lines(X, Z, separator="\t", mark=","),
        lines(X, Z, separator=" ; ", mark=","),
        lines(X, Z, separator="   ", mark=","),
        "\ufeff# stylus, 2 um tip\nx [um];z [um]\n\n" + lines(X, Z, separator=";") + "\n% the end\n",
        "Profile\nPoints: 20\n" + lines(X, Z, ending=" # point\n"),
        lines(X[::-1], Z[::-1]),
        "\ufeff" + lines(X, Z),
    ],
)
def test_profiles_in_text(tmp_path, text):
    (tmp_path / "scan.csv").write_text(text, encoding="utf-8", newline="")
    scan = roughness.read(tmp_path / "scan.csv", unit="um")
    assert_allclose(scan.z, (Z if text != lines(X[::-1], Z[::-1]) else Z[::-1]) * 1e-6, rtol=1e-14)
    assert_allclose(scan.steps, 0.5e-6, rtol=1e-14)
    assert scan.name == "scan.csv"


@pytest.mark.parametrize("ending", ["txt", "npy"])
def test_columns_rows_and_maps(tmp_path, ending):
    file = tmp_path / f"scan.{ending}"

    def read(table, **more):
        np.save(file, table) if ending == "npy" else np.savetxt(file, table, fmt="%.7f", header="heights in nm")
        return roughness.read(str(file), unit="um", height_unit="nm", **more)

    for table, more in (
        (np.c_[X, Z], {}),
        (Z[:, None], {"dx": 0.5}),
        (Z[None, :], {"dx": 0.5}),
        (np.c_[Z, Z, X], {"columns": (2, 0)}),
        (np.c_[X, Z, X], {"columns": (1,), "dx": 0.5}),
    ):
        scan = read(table, **more)
        assert_allclose(scan.z, Z * 1e-9, rtol=1e-12)
        assert_allclose(scan.steps, 0.5e-6, rtol=1e-12)
    scan = read(TABLE, dx=0.5, dy=0.25)
    assert_allclose(scan.z, TABLE * 1e-9, rtol=1e-12)
    assert_allclose(scan.steps, (0.25e-6, 0.5e-6), rtol=1e-12)
    assert read(TABLE, dx=0.5).steps == (0.5e-6, 0.5e-6)


def test_units_of_a_scan():
    for unit, metres in UNITS.items():
        scan = roughness.height_map(TABLE * 1e-3, dx=2.0, unit=unit, huge=True)  # 36 m, and 1e-15 m
        assert_allclose(scan.z, TABLE * 1e-3 * metres, rtol=1e-14)
        assert_allclose(scan.sizes, (32 * metres, 36 * metres), rtol=1e-14)
    assert_allclose(roughness.profile(Z, x=X, unit="mm", height_unit="µm").z, Z * 1e-6, rtol=1e-14)


def test_positions_written_with_few_digits_are_uniform():
    x = np.round(np.arange(400) * 0.0123, 3)
    assert_allclose(roughness.profile(np.sin(x), x=x, unit="um").steps, 0.0123e-6, rtol=1e-3)


@pytest.mark.parametrize(
    ("name", "content", "arguments", "message"),
    [
        ("a.csv", "", {}, "no line of numbers in it"),
        ("a.csv", "# x z\nnothing\n", {}, "no line of numbers in it"),
        ("a.csv", b"\x00\x01", {}, "not a text file"),
        ("a.csv", lines(X, Z) + "1.0 word\n", {}, "line 21: '1.0 word' has something other than numbers: 'word'"),
        ("a.csv", "0\t0\n1\t1,024\n", {}, "line 2: '1.t1,024' has something other than numbers"),
        ("a.csv", lines(X, Z) + "1.0\n", {}, r"line 21: 1 number\(s\) after lines of 2"),
        ("a.csv", lines(X, Z, separator=";") + "10.0;\n", {}, r"line 21: 1 number\(s\) after lines of 2"),
        ("a.csv", "x;z\n" + lines(X, Z, separator=";") + ";2\n", {}, "1 of 21 positions x are not numbers"),
        ("a.csv", lines(X, Z) + "10.0 nan\n", {}, r"1 of 21 heights are not numbers \(NaN\), the first in row 21"),
        ("a.csv", "x [mm] z [nm]\n" + lines(X, Z), {"unit": None}, r'give unit, .* heading is "x \[mm\] z \[nm\]"'),
        ("a.csv", "# z in nm\n" + lines(Z), {"unit": None, "dx": 1}, r'Its heading is "# z in nm"'),
        ("a.csv", lines(X, Z), {"unit": "inch"}, "the unit 'inch' is unknown; allowed are m, mm, um"),
        ("a.csv", lines(X, Z), {"height_unit": "V"}, "the unit 'V' is unknown"),
        ("a.csv", b"x [\xb5m]\n" + lines(Z).encode(), {"unit": None}, r'heading is "x \[µm\]"'),  # ISO 8859-1
        ("a.csv", lines(Z), {}, r"20 rows of 1 column\(s\); allowed are two columns \(x, z\), one column"),
        ("a.csv", lines(X, Z), {"dx": 0.5}, r"20 rows of 2 column\(s\) with dx = 0.5; allowed are"),
        ("a.csv", lines(X, Z), {"dy": 0.5}, r"20 rows of 2 column\(s\) with dy = 0.5; allowed are"),
        ("a.csv", lines(X, X, Z), {}, r"20 rows of 3 column\(s\); .* columns=\(0, 2\)"),
        ("a.csv", lines(X, Z), {"columns": (0, 2)}, r"columns = \(0, 2\), but the file has the columns 0 to 1"),
        ("a.csv", lines(X, Z), {"columns": (0, 1, 0)}, "allowed are two of them, for x and z, or one"),
        ("a.csv", lines(X, Z), {"columns": "xz"}, "allowed are two of them, for x and z, or one"),
        ("a.csv", lines(X, Z), {"columns": (0, 1.0)}, "allowed are two of them, for x and z, or one"),
        ("a.csv", lines(*TABLE.T), {}, r"a map of 17 × 19 heights: give dx \(and dy\)"),
        ("a.csv", lines(X[:15], Z[:15]), {}, "15 heights; at least 16 in each direction"),
        ("a.csv", lines(*TABLE[:9].T), {"dx": 1}, "9 × 19 heights; at least 16 in each direction"),
        ("a.csv", lines(X**1.1, Z), {}, "positions x are not uniform: they run from 0 to .* at most 0.1 steps"),
        ("a.csv", lines(0 * X, Z), {}, "positions x are not uniform: they run from 0 to 0"),
        ("a.csv", lines(0 * Z + 3.5), {"dx": 1}, "all 20 heights equal 3.5: there is no roughness"),
        ("a.csv", lines(Z), {"dx": 0}, r"the distances of its points are \(0,\); they must be positive"),
        (
            "a.csv",
            lines(X, 100 * Z),
            {},
            "heights span 0.000.* m on a scan 9.5e-06 m long, .* to be in um, heights in um",
        ),
        ("a.csv", lines(X, Z), {"height_unit": "mm"}, "no instrument measures slopes above 3.* heights in mm"),
        ("a.csv", lines(X, 1.5 * X + 0.1 * Z), {}, "heights span .* m on a scan 9.5e-06 m long"),  # no slope above 3
        ("a.csv", lines(np.tile(9 * Z, 9)), {"dx": 1}, "with an rms slope of 3"),  # longer than high
        ("a.npy", b"text", {}, "not a .npy file of real numbers"),
    ],
)
def test_bad_files(tmp_path, name, content, arguments, message):
    file = tmp_path / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ValueError, match=message) as said:
        roughness.read(file, **{"unit": "um"} | arguments)
    assert str(said.value).startswith(name)


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (np.zeros((2, 20, 20)), r"an array of shape \(2, 20, 20\); allowed are one or two"),
        (np.zeros((20, 2), dtype=complex), "not a .npy file of real numbers"),
        (np.array(["a"] * 20), "not a .npy file of real numbers"),
        (np.array([{}] * 20), "not a .npy file of real numbers"),
    ],
)
def test_bad_npy(tmp_path, array, message):
    np.save(tmp_path / "a.npy", array, allow_pickle=True)
    with pytest.raises(ValueError, match=f"^a.npy: {message}"):
        roughness.read(tmp_path / "a.npy", unit="um")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: roughness.profile(Z), "the profile: give either the positions of the points, x, or their distance"),
        (lambda: roughness.profile(Z, x=X, dx=1), "give either the positions"),
        (lambda: roughness.profile(Z, x=X[1:]), r"\(19,\) positions for \(20,\) heights"),
        (lambda: roughness.profile(TABLE, dx=1), r"the heights have shape \(17, 19\); 1 dimension"),
        (lambda: roughness.height_map(Z, dx=1, name="mine"), r"mine: the heights have shape \(20,\); 2 dimension"),
        (lambda: roughness.height_map([["a"]], dx=1), "the heights are not an array of numbers"),
        (lambda: roughness.height_map(np.where(TABLE > 1.9, np.inf, TABLE), dx=1), r"first in row \d+, column \d+"),
    ],
)
def test_bad_arrays(call, message):
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize(
    ("z", "arguments", "message"),
    [
        (Z, {"method": "peaks"}, 'method = \'peaks\'; allowed are "moments" and "summits"'),
        (Z, {"form": "ball"}, "form = 'ball'; allowed are"),
        (Z, {"form": None}, "form = None; allowed are"),
        (Z, {"form": 9.0}, r"form = 9.0 m: a sphere must be larger than the scan, \(9.5,\) m"),
        (Z, {"form": float("nan")}, "form = nan m: a sphere must be larger"),
        (Z, {"cutoff": 1.4}, "cutoff = 1.4 m; it must be finite and at least three steps, 1.5 m"),
        (Z, {"cutoff": float("inf")}, "cutoff = inf m; it must be finite"),
        (Z, {"cutoff": "2 um"}, "cutoff = '2 um': must be a number, in m"),
        (Z, {"cutoff": 2e9}, r"0( × 0)? points are left by a cutoff of 2e\+09 m"),
        (Z, {"cutoff": 1e308}, r"0( × 0)? points are left by a cutoff of 1e\+308 m"),
        (Z, {"cutoff": 2.0}, "14 points are left by a cutoff of 2 m, .* at least 16"),
        (0.1 * X + 3, {}, "nothing is left of the heights: plane removed"),
        (X**2 / 100, {"method": "summits"}, "no summits: none of 20 points is higher than all around it"),
    ],
)
def test_what_cannot_be_measured(z, arguments, message):
    with pytest.raises(ValueError, match=f"^steel: {message}"):
        roughness.measure(roughness.profile(z, x=X, name="steel", huge=True), **arguments)  # 9.5 m long


def instrument(monkeypatch, **found):
    """A SurfaceTopography that reads every file as this."""
    known = {"unit": "nm", "is_uniform": True, "dim": 2, "pixel_size": np.array([2.0, 4.0])}
    topography = SimpleNamespace(**known | found)
    topography.to_unit = lambda unit: SimpleNamespace(
        **vars(topography)
        | {"pixel_size": topography.pixel_size * 1e-9, "heights": lambda: topography.heights() * 1e-9}
    )
    monkeypatch.setitem(sys.modules, "SurfaceTopography", SimpleNamespace(read_topography=lambda path: topography))


def test_instruments(monkeypatch):
    """Maps of SurfaceTopography have x first; heights that it has not are masked."""
    instrument(monkeypatch, heights=lambda: TABLE.T)
    scan = roughness.read("a.opd")
    assert_allclose(scan.z, TABLE * 1e-9, rtol=1e-14)
    assert_allclose(scan.steps, (4e-9, 2e-9), rtol=1e-14)
    instrument(monkeypatch, heights=lambda: Z, unit=None, dim=1, pixel_size=0.5)
    assert_allclose(roughness.read("a.sur", unit="um").steps, 0.5e-6, rtol=1e-14)
    instrument(monkeypatch, heights=lambda: Z, unit=None, dim=1, is_uniform=False, positions=lambda: X)
    assert_allclose(roughness.read("a.sur", unit="um").steps, 0.5e-6, rtol=1e-14)
    with pytest.raises(ValueError, match=r"a.sur: the file states no unit of length; give unit"):
        roughness.read("a.sur")
    instrument(monkeypatch, heights=lambda: np.ma.masked_greater(TABLE.T, 1.9))
    with pytest.raises(ValueError, match=r"a.x3p: \d+ of 323 heights are not numbers"):
        roughness.read("a.x3p")
    with pytest.raises(ValueError, match=r"a.x3p: the format states its lengths itself; leave out columns"):
        roughness.read("a.x3p", columns=(0,))
    instrument(monkeypatch, heights=lambda: TABLE.T)
    same = roughness.read("a.opd", unit="nm", height_unit="nm", dx=2.0, dy=4.0)
    assert_allclose(same.z, TABLE * 1e-9, rtol=1e-14)
    assert_allclose(same.steps, (4e-9, 2e-9), rtol=1e-14)
    assert same.notes == ()
    scan = roughness.read("a.opd", unit="um", height_unit="um", dx=3.0)
    assert_allclose(scan.z, TABLE * 1e-6, rtol=1e-14)
    assert_allclose(scan.steps, (3e-6, 3e-6), rtol=1e-14)
    assert scan.notes == (
        "heights are in um, as height_unit says; the file states nm",
        "points are dx = 3 and dy = 3 um apart, as the call says; the file states 2 and 4 nm",
    )

    def failing(path):
        raise RuntimeError("no topography\nat all")

    monkeypatch.setattr(sys.modules["SurfaceTopography"], "read_topography", failing)
    with pytest.raises(ValueError, match=re.escape("a.x3p: SurfaceTopography cannot read it: no topography") + "$"):
        roughness.read("a.x3p")


def test_a_missing_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    with pytest.raises(
        ImportError, match=r"a.gwy: .gwy is neither text .*.csv.* nor .npy.*'roughcoat\[topography\]'.*CSV"
    ):
        roughness.read("a.gwy")


def test_the_real_extra(tmp_path):
    """A netCDF file that SurfaceTopography writes and reads."""
    topography = pytest.importorskip("SurfaceTopography")
    topography.Topography(TABLE.T * 1e-9, (19e-8, 34e-8), unit="m").to_netcdf(str(tmp_path / "a.nc"))
    scan = roughness.read(tmp_path / "a.nc")
    assert_allclose(scan.z, TABLE * 1e-9, rtol=1e-6)
    assert_allclose(scan.steps, (2e-8, 1e-8), rtol=1e-6)
    (tmp_path / "a.opd").write_bytes(b"nothing of the kind")
    with pytest.raises(ValueError, match="a.opd: SurfaceTopography cannot read it"):
        roughness.read(tmp_path / "a.opd")


def test_heights_under_a_mask_are_no_heights():
    z = np.random.default_rng(0).normal(size=(32, 32))
    z[3, 4] = 9e9
    with pytest.raises(ValueError, match="1 of 1024 heights are not numbers .NaN., the first in row 4, column 5"):
        roughness.height_map(np.ma.masked_greater(z, 1e9), dx=1, unit="um", missing="refuse")


def test_words_for_an_argument():
    """spacing, step and pixel were refused without a word of dx."""
    for function in (roughness.read, roughness.height_map, roughness.profile):
        for word in ("spacing", "step", "pixel", "Pixel_size"):
            with pytest.raises(TypeError, match=f"^{function.__name__} takes no {word}; did you mean dx[?]$"):
                function(Z, **{word: 1.0})
        with pytest.raises(TypeError, match="unexpected keyword argument 'colour'"):
            function(Z, colour=1)
    assert roughness.read.__doc__.startswith("A profile or a map of heights from a file.")
