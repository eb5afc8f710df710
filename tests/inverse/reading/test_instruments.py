"""Force curves in files of instruments: which are given to afmformats, which part, cantilever and curve."""

import json
import struct
import zipfile

import numpy as np
import pytest

import study
from study.__main__ import main

afmformats = pytest.importorskip("afmformats", reason="pip install 'roughcoat[afm]'")
h5py = pytest.importorskip("h5py")
pytestmark = pytest.mark.filterwarnings("ignore")

HEIGHT = np.linspace(2e-7, -2e-7, 40)  # of the piezo, which goes down to the sample
FORCE = 0.02 * np.maximum(-HEIGHT, 0)
DEPTH = -HEIGHT - FORCE / 0.05  # of a cantilever of 0.05 N/m


def hdf5(path, curves=1, points=40, **metadata):
    """As afmformats exports it: the way back has half the force."""
    kept = np.linspace(0, 39, points).astype(int)
    with h5py.File(path, "w") as file:
        file.attrs["software"], file.attrs["software version"] = "afmformats", "0.18.7"
        for i in range(curves):
            group = file.create_group(str(i))
            group.attrs.update({"imaging mode": "force-distance", "spring constant": 0.05, "enum": i} | metadata)
            group["force"] = (i + 1) * np.append(FORCE[kept], FORCE[kept][::-1] / 2)
            group["height (measured)"] = np.append(HEIGHT[kept], HEIGHT[kept][::-1])
            group["segment"] = np.repeat(np.array([0, 1], np.uint8), points)
    return path


def workshop(path, volts=True, mode="Single", point=1):
    """As AFM Workshop exports it: signals of the detector, 40 nm/V, or forces."""
    last = "T-B(V)" if volts else "Force(nN)"
    signal = FORCE / 0.05 / 40e-9 if volts else FORCE * 1e9
    rows = [f"{-h * 1e9!r},{s!r},{-h * 1e9!r},{s / 2!r}" for h, s in zip(HEIGHT.tolist(), signal.tolist(), strict=True)]
    heading = ["Force-Distance Curve", "File Format:\t3", "", "Date:\tWednesday, August 1, 2018", f"Mode:\t{mode}"]
    heading += [f"Point:\t{point}", f"X, um:\t{point}.0", f"Y, um:\t{point}.0", ""]
    heading += [f"Extend Z-Sense(nm),Extend {last},Retract Z-Sense(nm),Retract {last}"]
    path.write_text("\n".join([*heading, *rows]), encoding="utf-8")
    return path


def igor(path):
    """As Asylum Research writes it: the way down and the way back in one wave, without a mark where it turns."""
    there_and_back = np.append(HEIGHT, HEIGHT[::-1])
    deflection = np.append(FORCE, FORCE[::-1] / 2) / 0.05
    data, labels = np.stack([-there_and_back, deflection, -there_and_back], axis=1), ["Raw", "Defl", "ZSnsr"]
    said = {
        "ScanSize": 1,
        "ImagingMode": "Contact",
        "NumPtsPerSec": 1,
        "InvOLS": 4e-8,
        "TriggerChannel": "Raw",
        "InputTime": 1,
    }
    said |= {"SpringConstant": 0.05, "ApproachVelocity": 1, "RetractVelocity": 1, "MicroscopeModel": "MFP3D"}
    said |= {"Version": 1, "Date": "2018-08-01", "Time": "1:07:47 PM"}
    note = "\r".join(f"{key}: {value}" for key, value in said.items()).encode()
    names = b"".join(label.encode().ljust(32, b"\0") for label in ["", *labels])
    wave = struct.pack("<4xIIi h h 6x h 32s 4x 4x", 0, 0, data.size, 2, 0, 1, b"curve")
    wave += struct.pack("<4i 4d 4d", *data.shape, 0, 0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
    wave += struct.pack("<4s 4s4s4s4s h 2x dd", b"m", b"s", b"", b"", b"", 0, 0.0, 0.0)
    wave, content = wave.ljust(320, b"\0"), data.astype("<f4").tobytes(order="F")
    sizes = [320 + len(content), 0, len(note), 0, 0, 0, 0, 0, 0, len(names), 0, 0, 0, 0, 0]
    head = struct.pack("<hH15i", 5, 0, *sizes)
    words = int(np.frombuffer(head + wave, dtype="<i2").astype(int).sum())
    head = head[:2] + struct.pack("<H", -words & 0xFFFF) + head[4:]
    path.write_bytes(head + wave + content + note + names)
    return path


def refused(path, **options):
    with pytest.raises(study.StudyError) as error:
        study.curves(path, **options)
    (line,) = error.value.messages
    assert "\n" not in line and path.name in line
    return line


def test_a_file_without_a_curve_is_said_in_a_line(tmp_path, capsys):
    """The errors of afmformats are BaseExceptions: they went through `except Exception`, with 40 lines of traceback."""
    for name in ("no.h5", "no.jpk-force", "no.jpk-qi-series", "no.tab", "no.ibw", "no.zip"):
        with h5py.File(tmp_path / name, "w") as file:
            file["rating"] = np.zeros(20)
        assert "afmformats cannot read it: " in refused(tmp_path / name)
    assert main(["fit", str(tmp_path / "no.h5"), "R=5um", "free=E2", "base=half_space", "micro=smooth"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and "afmformats cannot read it: Could not determine file format" in said


def test_an_interrupt_is_no_error_of_a_file(tmp_path, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(afmformats, "load_data", interrupted)
    with pytest.raises(KeyboardInterrupt):
        study.curves(hdf5(tmp_path / "a.h5"))


def test_the_approach_or_the_retraction(tmp_path):
    path = hdf5(tmp_path / "a.h5")
    approach, retraction = (study.curves(path, part=part) for part in ("approach", "retraction"))
    np.testing.assert_allclose(approach.D, [DEPTH], rtol=1e-12)
    np.testing.assert_allclose(retraction.P, [FORCE[::-1] / 2], rtol=1e-12)
    np.testing.assert_allclose(retraction.D, [(-HEIGHT - FORCE / 0.1)[::-1]], rtol=1e-12)
    assert study.curves(path).identical(approach)
    with pytest.raises(study.StudyError, match='curves: part = "retract": must be one of approach, retraction'):
        study.curves(path, part="retract")


def test_igor_has_both_ways_in_one(tmp_path):
    """afmformats calls all of it the approach, and the fit took the way back for it too."""
    path = igor(tmp_path / "a.ibw")
    approach, retraction = (study.curves(path, part=part) for part in ("approach", "retraction"))
    np.testing.assert_allclose(approach.P, [FORCE], rtol=1e-6, atol=1e-15)
    np.testing.assert_allclose(approach.D, [DEPTH], rtol=1e-6, atol=1e-15)
    np.testing.assert_allclose(retraction.P[0, -39:], FORCE[::-1][1:] / 2, rtol=1e-6, atol=1e-15)


@pytest.mark.parametrize("make", [hdf5, igor])
def test_another_cantilever_than_the_file_has(tmp_path, make):
    """afmformats refuses it here (NotImplementedError). The force is spring constant times bending."""
    path = make(tmp_path / f"a.{'ibw' if make is igor else 'h5'}", **({} if make is igor else {"sensitivity": 4e-8}))
    softer = study.curves(path, spring_constant="25 pN/nm")
    np.testing.assert_allclose(softer.P, [FORCE / 2], rtol=1e-6, atol=1e-15)
    np.testing.assert_allclose(softer.D, [DEPTH], rtol=1e-6, atol=1e-15, err_msg="it bends as much")
    bent = study.curves(path, sensitivity=8e-8)
    np.testing.assert_allclose(bent.P, [FORCE * 2], rtol=1e-6, atol=1e-15)
    np.testing.assert_allclose(bent.D, [-HEIGHT - FORCE * 2 / 0.05], rtol=1e-6, atol=1e-15)


def test_a_sensitivity_that_the_file_does_not_have(tmp_path):
    path = hdf5(tmp_path / "a.h5")
    assert refused(path, sensitivity="40 nm/V").endswith("state the sensitivity that its force was computed with")


def test_files_that_do_not_have_the_cantilever(tmp_path):
    """Six real files were lost."""
    path = workshop(tmp_path / "a.csv")
    said = refused(path)
    assert 'no sensitivity and no spring_constant: give sensitivity="45 nm/V", spring_constant="0.05 N/m"' in said
    curve = study.curves(path, spring_constant="0.05 N/m", sensitivity="40 nm/V")
    np.testing.assert_allclose(curve.P, [FORCE], rtol=1e-9)
    np.testing.assert_allclose(curve.D, [HEIGHT * -1 - FORCE / 0.05], rtol=1e-9, atol=1e-18)
    path = workshop(tmp_path / "b.csv", volts=False)
    assert "no spring constant: give spring_constant=" in refused(path)
    np.testing.assert_allclose(study.curves(path, spring_constant=0.05).D, curve.D, rtol=1e-9, atol=1e-18)


def test_a_map_in_a_zip_and_one_of_its_curves(tmp_path):
    with zipfile.ZipFile(tmp_path / "map.zip", "w") as archive:
        for point in (1, 2):
            name = f"{point}.csv"
            archive.write(workshop(tmp_path / name, volts=False, mode="Mapping", point=point), name)
    assert study.curves(tmp_path / "map.zip", spring_constant=0.05).sizes == {"curve": 2, "point": 40}
    path = hdf5(tmp_path / "map.h5", curves=3)
    every = study.curves(path)
    for curve in (0, 2, -1):
        assert study.curves(path, curve=curve).identical(every.isel(curve=[curve]))
    assert refused(path, curve=3).endswith("curve = 3: the file has 3 curves, 0 to 2")
    assert refused(hdf5(tmp_path / "a.h5"), curve="x").endswith('curve = "x": the file has one curve, 0')


def test_text_of_instruments_and_ours(tmp_path):
    """NT-MDT writes three bare columns: height [nm], signal on the way down, and on the way back [nA]."""
    nm, signal = (HEIGHT[::-1] * 1e9).tolist(), (FORCE[::-1] / 0.05 / 40).tolist()
    rows = [f"{h!r}\t{s * 1e9!r}\t{s * 5e8!r}" for h, s in zip(nm, signal, strict=True)]
    (tmp_path / "a.txt").write_text("\n".join(rows), encoding="utf-8")
    curve = study.curves(tmp_path / "a.txt", spring_constant="0.05 N/m", sensitivity="40 m/A")
    assert curve.P.max() == pytest.approx(FORCE.max(), rel=1e-9)
    assert "the first line must have headings with units" in refused(tmp_path / "a.txt")
    for name in ("ours.txt", "ours.csv", "ours.dat"):
        (tmp_path / name).write_text("D [nm],P [nN]\n1,2\n3,4\n", encoding="utf-8")
        assert study.curves(tmp_path / name).sizes["point"] == 2
    assert "part is for files of instruments" in str(
        pytest.raises(study.StudyError, study.curves, tmp_path / "ours.txt", part="retraction").value
    )


@pytest.mark.parametrize("name", ["a.spm", "a.dat", "a.000"])
def test_what_afmformats_does_not_read_is_not_given_to_it(tmp_path, name):
    (tmp_path / name).write_bytes(b"\\*Force file list\0\0")
    assert "cannot be read as text" in refused(tmp_path / name)


def test_files_of_one_point_are_said(tmp_path):
    assert "the curve has 1 point in its approach" in refused(hdf5(tmp_path / "a.h5", points=1))
    assert "each of the 2 curves has 1 point" in refused(hdf5(tmp_path / "b.h5", curves=2, points=1))
    (tmp_path / "a.csv").write_text("D [nm],P [nN]\n1,2\n", encoding="utf-8")
    assert "has one row" in refused(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("options", "part"),
    [
        ({"spring_constant": 0}, "spring_constant = 0: must be above 0, in N/m"),
        ({"spring_constant": "5 mN"}, "spring_constant"),
        ({"sensitivity": "45 nm"}, "sensitivity"),
        ({"sensitivity": True}, "sensitivity = True: must be a number of m/V"),
        ({"spring_constant": "-1 N/m"}, "must be above 0"),
    ],
)
def test_a_cantilever_that_is_none(options, part):
    with pytest.raises(study.StudyError) as error:
        study.curves({"D": ([0.0, 1.0], "nm"), "P": ([0.0, 1.0], "nN")}, **options)
    assert part in str(error.value) and len(error.value.messages) == 1


def test_in_a_terminal(tmp_path, capsys):
    path = str(hdf5(tmp_path / "map.h5", curves=2))
    call = ["R=5um", "E_punch=rigid", "nu2=0.5", "base=half_space", "micro=smooth", "free=E2", "--json"]
    numbers = {}
    for name, words in {"first": ["curve=0"], "back": ["curve=0", "part=retraction"], "second": ["curve=1"]}.items():
        main(["fit", path, *words, *call])
        numbers[name] = json.loads(capsys.readouterr().out)["E2"]["value"]
    assert numbers["back"] < numbers["first"] < numbers["second"]
    assert main(["fit", path, "curve=2", *call]) == 2
    assert "curve = 2: the file has 2 curves, 0 to 1" in capsys.readouterr().err
    assert main(["fit", path, "curve=0", "curve=1", *call]) == 2
    assert "curve is given twice" in capsys.readouterr().err
