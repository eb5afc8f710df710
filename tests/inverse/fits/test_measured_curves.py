"""What `study.curves` takes, and what it says of what it cannot take."""

import numpy as np
import pytest
import xarray as xr

import study

NM = 1e-9


def read(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "curve.csv"
    path.write_bytes(text.encode(encoding))
    return study.curves(path)


TEXTS = {
    "commas": "D [nm],P [nN]\n1,2\n3,4\n",
    "parentheses and semicolons": "D (nm);P (nN)\n1;2\n3;4\n",
    "tabs": "D [nm]\tP [nN]\n1\t2\n3\t4\n",
    "spaces": "D [nm]  P [nN]\n1 2\n3   4\n",
    "quoted": '"D [nm]", "P [nN]"\n"1", "2"\n"3", "4"\n',
    "comments and empty lines": "# made by us\nD [nm],P [nN]\n\n1,2\n# half way\n3,4\n",
    "the other way round, other units": "P [pN],D [um]\n2000,0.001\n4000,0.003\n",
    "byte order mark": "\ufeffD [nm],P [nN]\n1,2\n3,4\n",
}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_text(tmp_path, text):
    curves = read(tmp_path, text)
    assert curves.D.dims == curves.P.dims == ("curve", "point")
    np.testing.assert_allclose(curves.D, [[1 * NM, 3 * NM]], rtol=1e-15)
    np.testing.assert_allclose(curves.P, [[2 * NM, 4 * NM]], rtol=1e-15)
    assert curves.D.attrs["units"] == "m" and curves.P.attrs["units"] == "N"


def test_what_is_no_number_is_no_point(tmp_path):
    curves = read(tmp_path, "D [nm],P [nN]\nnan,2\n3,\ninf,1\n--,5\n7,8\n")
    kept = np.isfinite(curves.D.values) & np.isfinite(curves.P.values)
    assert kept.tolist() == [[False, False, False, False, True]]


def test_several_curves_in_a_file_keep_their_names(tmp_path):
    curves = read(tmp_path, "curve,D [nm],P [nN]\nleft,1,2\nright,5,6\nleft,3,4\n")
    assert curves.curve.values.tolist() == ["left", "right"]
    np.testing.assert_allclose(curves.D, [[1 * NM, 3 * NM], [5 * NM, np.nan]], rtol=1e-15)


WRONG = {
    "D,P\n1,2\n": ("D has no unit", "P has no unit"),
    "D [N],P [nN]\n1,2\n": ("D", "is a force: must be a length"),
    "depth [nm],P [nN]\n1,2\n": ('"depth" is not a column of curves', "call it D (depth), P (load)", "leave it out"),
    "D [nm],D [nm],P [nN]\n1,2,3\n": ("D twice",),
    "D [nm],P [nN]\n": ("no row",),
    "D [nm]\n1\n": ("two columns are needed",),
    "D [nm];P [nN]\n1,5;2\n": ("row 1", '"1,5"', "decimal point"),
    "D [nm],P [nN]\n1,2\nx,3\n": ("row 2", "D", '"x"'),
    "D [nm],P [nN]\n1,2\n3\n": ("row 2", "1 fields", "2"),
    "1,2\n3,4\n": ("headings with units",),
    "curve,D [nm],P [nN]\n1,2,3\n,4,5\n": ("row 2", "curve is empty"),
    "": ("is empty",),
}


@pytest.mark.parametrize("text", WRONG)
def test_wrong_text(tmp_path, text):
    with pytest.raises(study.StudyError) as error:
        read(tmp_path, text)
    assert "curve.csv" in str(error.value)
    for part in WRONG[text]:
        assert part in str(error.value)


def test_files_that_are_not_there_or_no_text(tmp_path):
    with pytest.raises(study.StudyError, match="nothing.csv: there is no such file"):
        study.curves(tmp_path / "nothing.csv")
    with pytest.raises(study.StudyError, match="is a folder: name a file in it"):
        study.curves(tmp_path)
    with pytest.raises(study.StudyError, match="cannot be read as text: save it as CSV, in UTF-8"):
        read(tmp_path, "D [nm],P [nN]\n1,2\n", "utf-16")


def test_a_micro_sign_of_another_encoding(tmp_path):
    text = "D [µm],P [nN]\n1,2\n3,4\n"
    for encoding in ("utf-8", "latin-1"):
        np.testing.assert_allclose(read(tmp_path, text, encoding).D.values, [[1e-6, 3e-6]], rtol=1e-15)


def test_arrays_and_datasets():
    arrays = {"D": ([1.0, 3.0], "nm"), "P": ([[2.0, 4.0], [5.0, 6.0]], "nN")}
    curves = study.curves(arrays)
    assert dict(curves.sizes) == {"curve": 2, "point": 2}
    assert study.curves(curves).identical(curves)
    single = xr.Dataset({"D": ("point", [1.0, 3.0], {"units": "nm"}), "P": ("point", [2.0, 4.0], {"units": "nN"})})
    assert study.curves(single).P.values.tolist() == curves.P.values[:1].tolist()
    turned = curves.transpose("point", "curve").assign_coords(curve=["a", "b"])
    assert study.curves(turned).D.values.tolist() == curves.D.values.tolist()
    assert study.curves(turned).curve.values.tolist() == ["a", "b"]
    masked = np.ma.masked_array([1.0, 3.0], [False, True])
    assert np.isnan(study.curves({"D": (masked, "nm"), "P": ([2.0, 4.0], "nN")}).D.values).tolist() == [[False, True]]


@pytest.mark.parametrize(
    ("source", "part"),
    [
        ({"D": [1.0], "P": [2.0]}, "must be (array, unit)"),
        ({"D": ([1.0], ""), "P": ([2.0], "nN")}, "D has no unit"),
        ({"D": ([1.0, 2.0], "nm"), "P": ([2.0], "nN")}, "unequal numbers of points: D 2, P 1"),
        ({"D": (np.ones((2, 2)), "nm"), "P": (np.ones((3, 2)), "nN")}, "unequal numbers of curves: D 2, P 3"),
        ({"D": ([1.0, 2.0, 3.0], "nm"), "P": ([2.0, 3.0], "nN")}, "unequal numbers of points: D 3, P 2"),
        ({"D": (["x"], "nm"), "P": ([2.0], "nN")}, "D: could not convert"),
        ({"D": (np.ones((2, 2, 2)), "nm"), "P": ([1.0, 2.0], "nN")}, "D has 3 dimensions"),
        (xr.Dataset({"D": ("i", [1.0], {"units": "m"}), "P": ("i", [1.0], {"units": "N"})}), "the dimension i"),
        (None, "or a Dataset, not None"),
        (3.0, "or a Dataset, not 3.0"),
        (np.ones((2, 2)), '"P": (array, "nN")}, or a Dataset, not a ndarray'),
        (["a.csv", "b.csv"], "or a Dataset, not a list"),
    ],
)
def test_wrong_arrays(source, part):
    with pytest.raises(study.StudyError) as error:
        study.curves(source)
    assert part in str(error.value)
