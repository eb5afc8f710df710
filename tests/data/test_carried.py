"""Coordinates that DataArrays bring: they go on into the results and into netCDF, or it is said that they do not."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import study

PLAIN = {"n": 0.5, "micro": "smooth", "x": 2, "workers": 1}
BALL = {"R": "5 mm", "E2": "210 GPa", "E1": "200 GPa", "micro": "smooth", "x": 2, "workers": 1}
RUNS = pd.MultiIndex.from_tuples([("ann", 1), ("bob", 1), ("ann", 2)], names=["operator", "run"])


def loads(**coords) -> xr.DataArray:
    """Three measured loads over the dimension `batch`, and what is known of them."""
    return xr.DataArray([1e-5, 2e-5, 4e-5], {"batch": ["x", "y", "z"]} | coords, "batch")


def both_ways(P: xr.DataArray, h=0.02, size: str = "2 um"):
    """The contacts of these loads without units, and of loads in N that are as many."""
    yield study.solve(**PLAIN, P=P, h=h)
    yield study.solve(**BALL, P=(P * 1e5).assign_attrs(units="N"), h=size)


def test_they_are_in_the_results_and_in_their_file(tmp_path):
    """They vanished without a word."""
    when = pd.to_datetime(["2026-01-02", "2026-01-03", "NaT"])
    P = loads(
        operator=("batch", ["ann", "bob", "ann"]), when=("batch", when), wear=("batch", [1.0, np.nan, 3.0]), lab="B12"
    )
    P.batch.attrs, P.wear.attrs = {"long_name": "batch of the supplier"}, {"units": "mg"}
    P.wear.encoding = {"zlib": True, "chunksizes": (77,), "_FillValue": -1.0}  # of a file that was larger
    for found in both_ways(P):
        for name in ("operator", "when", "wear", "lab", "batch"):
            assert found[name].variable.identical(P[name].variable), name
            assert name in found.a.coords
        found.to_netcdf(tmp_path / "found.nc")
        again = xr.load_dataset(tmp_path / "found.nc")
        assert {*again.coords} == {*found.coords}
        xr.testing.assert_equal(again.drop_vars("when"), found.drop_vars("when"))
        assert found.sel(batch="y").operator == "bob" and found.sel(batch="y").lab == "B12"


def test_also_along_the_parameter_itself(tmp_path):
    P = xr.DataArray([1.0, 2.0], {"P": [1.0, 2.0], "operator": ("P", ["ann", "bob"])}, "P", attrs={"units": "N"})
    found = study.solve(**BALL, P=P, h=["2 um", "3 um"])
    assert found.sel(P="2 N").operator == "bob" and found.operator.dims == ("P",) and found.a.dims == ("P", "h")


def test_levels_of_an_index_are_coordinates(tmp_path):
    """The index itself cannot be stored: xarray refused to write the results."""
    P = xr.DataArray([1e-5, 2e-5, 4e-5], {"batch": RUNS}, "batch")
    for found in both_ways(P):
        assert found.operator.values.tolist() == ["ann", "bob", "ann"] and found.run.values.tolist() == [1, 1, 2]
        assert "batch" not in found.coords and found.a.dims == ("batch",)
        found.to_netcdf(tmp_path / "found.nc")
        assert xr.load_dataset(tmp_path / "found.nc").operator.values.tolist() == ["ann", "bob", "ann"]
        assert found.set_xindex(["operator", "run"]).sel(operator="bob").a.values == found.a.values[1]
    with pytest.raises(study.StudyError, match="h has other values of batch"):
        study.solve(**PLAIN, P=P, h=1000 * P[::-1])


def test_two_parameters_may_share_them():
    P = loads(operator=("batch", ["ann", "bob", "ann"]))
    assert study.solve(**PLAIN, P=P, h=1000 * P).operator.values.tolist() == ["ann", "bob", "ann"]


@pytest.mark.parametrize(
    ("coords", "h", "said"),
    [
        ({"k": ("batch", [1, 2, 3])}, 0.02, "k of P: the results have something else of this name, rename it"),
        ({"status": ("batch", [1, 2, 3])}, 0.02, "status of P: the results have"),
        ({"x": ("batch", [1, 2, 3])}, 0.02, "x of P: the results have"),
        ({"punch": "mine"}, 0.02, "punch of P: the results have"),
        ({"h": 7.0}, 0.02, "h of P: the results have"),
        ({"ball": 3}, xr.DataArray([0.02, 0.03], {"ball": [1, 2]}, "ball"), "ball of P: the results have"),
        ({"by": "ann"}, xr.DataArray([0.02], {"by": "bob"}, "ball"), "by: P and h have other values of it"),
    ],
)
def test_what_is_left_out_is_said(coords, h, said):
    with pytest.warns(UserWarning, match=f"^a coordinate is left out, {said}"):
        found = study.solve(**PLAIN, P=loads(**coords), h=h)
    name = next(iter(coords))
    assert name not in found.coords or not found[name].identical(loads(**coords)[name])


def test_those_of_earlier_results_say_nothing_of_others():
    """Their h, base and so on are inputs of other contacts: a half-space has no thickness."""
    earlier = study.solve(**BALL, P=["1 N", "2 N"], h=["2 um", "3 um"], nu1="0.3 ± 0.02").assign_coords(batch="x")
    found = study.solve(R="5 mm", E2="210 GPa", base="half_space", micro="smooth", P=earlier.P, x=2)
    theirs = {"P", "x", "R", "E2", "nu2", "m", "base", "micro", "nu1", "bonding"}
    assert {*found.coords} == theirs | {"batch"}
    assert study.solve(**BALL, P=earlier.a.P, h="2 um").P.values.tolist() == [1.0, 2.0]
    assert study.solve(**BALL, P=earlier.isel(h=0).a.P, h="2 um").batch == "x"


@pytest.mark.parametrize(
    "labels",
    [
        *([1.0, np.nan, 3.0], [np.nan] * 3, [None, "y", "z"], np.array([np.nan, "y", 3], dtype=object)),
        *(pd.to_datetime(["2026-01-02", "NaT", "2026-01-03"]), np.array([pd.NA, 1, 2], dtype=object)),
    ],
    ids=str,
)
def test_a_missing_label_is_the_same_in_two_parameters(labels):
    """Of one parameter alone it was said that another one had other values."""
    P = loads().assign_coords(batch=labels)
    for found in both_ways(P):
        pd.testing.assert_index_equal(found.indexes["batch"], P.indexes["batch"])
    assert study.solve(**PLAIN, P=P, h=P * 1000).sizes["batch"] == 3
    units = {"P": (P * 1e5).assign_attrs(units="N"), "h": (P * 1e5).assign_attrs(units="um")}
    assert study.solve(**BALL, **units).sizes["batch"] == 3
    if len({*map(str, labels)}) > 1:
        with pytest.raises(study.StudyError, match="h has other values of batch"):
            study.solve(**PLAIN, P=P, h=P[::-1] * 1000)
        with pytest.raises(study.StudyError, match="h has other values of batch"):
            study.solve(**BALL, **units | {"h": units["h"][::-1]})
