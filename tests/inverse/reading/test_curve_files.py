"""Text files of curves: what is no file, or too large; many curves, many columns; one of several."""

import gzip
import os

import numpy as np
import pytest

import study
from study.inverse import curves as room


def refused(path) -> str:
    with pytest.raises(study.StudyError) as error:
        study.curves(path)
    return "\n".join(error.value.messages)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes")
def test_no_pipe_is_waited_for_and_no_device_read(tmp_path):
    for name in ("a.csv", "a.txt", "a.h5"):
        os.mkfifo(tmp_path / name)
        assert refused(tmp_path / name).endswith(f"{name}: is not a file but a pipe or device")
    assert refused("/dev/zero") == "/dev/zero: is not a file but a pipe or device"


def test_a_file_that_is_too_large(tmp_path, monkeypatch):
    for name in ("a.csv", "a.h5"):
        with open(tmp_path / name, "wb") as file:
            file.truncate(5_500_000_000)  # without a block on disk
        assert "has 5500000000 bytes: must have at most" in refused(tmp_path / name)
    text = b"D [nm],P [nN]\n" + b"1,2\n" * 100
    (tmp_path / "b.csv.gz").write_bytes(gzip.compress(text))
    assert study.curves(tmp_path / "b.csv.gz").sizes["point"] == 100
    (tmp_path / "c.csv.gz").write_bytes(gzip.compress(text)[:-9])
    assert "the packed file is damaged" in refused(tmp_path / "c.csv.gz")
    monkeypatch.setattr(room, "LARGEST_TEXT", len(text) - 1)
    assert "more than 413 bytes once unpacked" in refused(tmp_path / "b.csv.gz")


def test_many_curves_of_unequal_lengths(tmp_path):
    """Each curve looked through all rows: 10,000 curves of 7 points took 15 s."""
    random = np.random.default_rng(0)
    names = random.permutation(np.append(np.arange(3000), random.integers(0, 3000, 9000)))
    depths = np.arange(len(names))
    rows = [f"{name},{depth},{2 * depth}" for name, depth in zip(names, depths, strict=True)]
    (tmp_path / "a.csv").write_text("\n".join(["curve,D [nm],P [nN]", *rows]), encoding="utf-8")
    curves = study.curves(tmp_path / "a.csv")
    labels = list(dict.fromkeys(names.tolist()))
    assert curves.curve.values.tolist() == [str(label) for label in labels]
    for i in (0, 7, 2999):
        depth = curves.D.values[i]
        np.testing.assert_allclose(depth[np.isfinite(depth)], depths[names == labels[i]] * 1e-9, rtol=1e-15)
        alone = study.curves(tmp_path / "a.csv", curve=str(labels[i]))
        np.testing.assert_array_equal(alone.D.values[0], depth[np.isfinite(depth)])


def test_many_headings(tmp_path):
    """Each was counted among all: 200,000 took over a minute."""
    names = [f"q{i}" for i in range(20_000)]
    (tmp_path / "a.csv").write_text(",".join(names) + "\n" + ",".join("1" * len(names)), encoding="utf-8")
    lines = refused(tmp_path / "a.csv").split("\n")
    assert len(lines) == 21 and lines[-1].endswith("and 19980 more")
    (tmp_path / "b.csv").write_text(",".join([*names, "q7"]) + "\n1", encoding="utf-8")
    assert refused(tmp_path / "b.csv").endswith("the heading has q7 twice")


def test_a_wrong_row_behind_many(tmp_path):
    rows = ["1,2"] * 10_500
    for number, wrong, part in ((10_300, "1", "1 fields"), (10_400, "1,x", 'P = "x"'), (2, "1,5,2", "3 fields")):
        text = "\n".join(["D [nm],P [nN]", *rows[: number - 1], wrong, *rows[number:]])
        (tmp_path / "a.csv").write_text(text, encoding="utf-8")
        assert f"row {number}" in refused(tmp_path / "a.csv") and part in refused(tmp_path / "a.csv")


def test_one_of_several(tmp_path):
    text = "curve,D [nm],P [nN]\n2,1,2\n1,5,6\n2,3,4\nleft,7,8\nleft,7,9\n"
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    assert study.curves(tmp_path / "a.csv", curve="1").P.values.tolist() == [[6 * 1e-9]]
    assert study.curves(tmp_path / "a.csv", curve=2).curve.values.tolist() == ["2"], "its name is 2, its number 0"
    assert study.curves(tmp_path / "a.csv", curve=0).curve.values.tolist() == ["2"]
    with pytest.raises(study.StudyError, match='curve = "right": there is 2, 1, left'):
        study.curves(tmp_path / "a.csv", curve="right")
    with pytest.raises(study.StudyError, match="curve = 5: the file has 3 curves, 0 to 2"):
        study.curves(tmp_path / "a.csv", curve=5)
    arrays = {"D": ([0.0, 1.0], "nm"), "P": (np.ones((2, 2)), "nN")}
    assert study.curves(arrays, curve=1).sizes == {"curve": 1, "point": 2}
    with pytest.raises(study.StudyError, match='curve = "b": the curves have no names, give a number'):
        study.curves(arrays, curve="b")
