"""What is on the disk in a results file: checksums of netCDF, fill values, and that damage is noticed."""

import netCDF4
import numpy as np
import pytest
import xarray as xr

import solver
import study
from study.data import derived
from study.files import results_file
from study.files.examine import examine
from study.inputs.reading import from_tables

TABLES = {
    "model": {"base": "thin_layer", "h": 0.02, "n": 0.5, "Nbar": 250000, "Ra": 0.004},
    "axes": {"P": [1e-5, 2e-5, 4e-5], "nu1": [0.2, 0.3]},
    "output": {"x": 5},
}
FLOATS = {"a", "D", "p0", "p_max", "Ar_An", "A0", "dP_dD", "lam0", "error", "profile_error",
          "model_error", "residual", "p", "lam"}  # fmt: skip
SCALE = {"R": 5e-3, "E2_star": 2e11}


@pytest.fixture(scope="module")
def opened(tmp_path_factory) -> study.Study:
    found = study.Study(from_tables(TABLES, "small", "text", "small"), tmp_path_factory.mktemp("results"))
    found.run()
    return found


@pytest.fixture(scope="module")
def solved() -> xr.Dataset:
    return study.solve(**TABLES["model"], **TABLES["axes"], x=5)


@pytest.fixture(params=["run", "write"])
def path(request, opened, solved, tmp_path):
    """A results file of either writer, one's own to damage."""
    copy = tmp_path / "copy.nc"
    if request.param == "run":
        copy.write_bytes((opened.results / "small.nc").read_bytes())
    else:
        results_file.write(solved, copy, examine(copy))
    return copy


def test_all_but_single_numbers_have_checksums_and_all_but_profiles_is_compressed(path):
    with netCDF4.Dataset(path) as file:
        filters = {name: variable.filters() for name, variable in file.variables.items()}
        dims = {name: variable.dimensions for name, variable in file.variables.items()}
        types = {name: variable.dtype for name, variable in file.variables.items()}
    assert all(found["fletcher32"] for name, found in filters.items() if dims[name] and types[name] is not str)
    assert all(dims[name] for name in ("P", "nu1", "x", "a", "status")) and not dims["h"]
    for name in ("p", "lam"):
        assert filters[name]["fletcher32"] and not filters[name]["zlib"], name
    for name in ("a", "error", "status", "validity", "nodes_used"):
        assert filters[name]["zlib"] and filters[name]["shuffle"] and filters[name]["complevel"] == 1, name


def test_fill_values_and_types_in_the_file(path):
    with netCDF4.Dataset(path) as file:
        fills = {name: getattr(variable, "_FillValue", None) for name, variable in file.variables.items()}
        types = {name: variable.dtype for name, variable in file.variables.items()}
    assert {name for name, fill in fills.items() if fill is not None} == FLOATS
    assert all(np.isnan(fills[name]) and types[name] == "f8" for name in FLOATS)
    whole = {"status": "i1", "model_used": "i1", "nodes_used": "i2", "iterations": "i4", "validity": "i4"}
    assert {name: types[name].str[1:] for name in whole} == whole


def test_what_is_stored_is_what_the_solver_gave(solved, path):
    found = study.open_results(path)
    given = {name: found[name].values.ravel() for name in ("P", "nu1")}
    shape = {"P": np.repeat(given["P"], 2), "nu1": np.tile(given["nu1"], 3)}
    answer = solver.solve(solver.Problem.of(**TABLES["model"], **shape), found.x.values)
    for name in (*FLOATS - {"lam0", "residual"}, "status", "model_used", "iterations"):
        expected = getattr(answer, name)
        # cases in company, up to the order of their sums; errors are differences of such
        np.testing.assert_allclose(found[name].values.reshape(expected.shape), expected, rtol=1e-11, atol=1e-13)
    np.testing.assert_array_equal(found.nodes_used.values.ravel(), answer.nodes)
    np.testing.assert_array_equal(found.lam0, found.lam.sel(x=0))


@pytest.mark.parametrize("place", [0, 0.5, 1], ids=["first", "middle", "last"])
def test_a_flipped_byte_of_a_profile_is_noticed(path, place):
    raw = study.open_results(path).p.values.astype("<f8").tobytes()
    data = bytearray(path.read_bytes())
    assert data.count(raw) == 1, "the profile lies in the file as it is"
    data[data.index(raw) + int(place * (len(raw) - 1))] ^= 1
    path.write_bytes(data)
    with pytest.raises(study.StudyError, match=f"{path}: is damaged: its bytes are not those that were written"):
        study.open_results(path)


def filled(found: xr.Dataset | xr.DataArray, path) -> tuple[set, set]:
    """Coordinates, and other variables, that a plain `to_netcdf` gives a _FillValue."""
    found.to_netcdf(path)
    with netCDF4.Dataset(path) as file:
        names = {name for name, variable in file.variables.items() if "_FillValue" in variable.ncattrs()}
    return names & set(found.coords), names - set(found.coords)


def test_a_user_writes_no_fill_value_on_coordinates(solved, tmp_path):
    """CF forbids it there; where a case may have no numbers, NaN is the fill value."""
    for found in (solved, solved.where(solved.status == 0), solved.sel(P=[2e-5]), study.to_physical(solved, **SCALE)):
        coordinates, data = filled(found, tmp_path / "file.nc")
        assert (coordinates, data & FLOATS) == (set(), FLOATS)
    assert filled(solved, tmp_path / "file.nc")[1] == FLOATS, "none for whole numbers"
    mean = derived.mean_pressure(solved)
    for found in (mean, study.to_physical(mean.to_dataset(), **SCALE)):
        assert filled(found, tmp_path / "file.nc") == (set(), {"p_mean"})


def test_nor_from_what_was_opened(opened, monkeypatch, tmp_path):
    assert filled(opened.open(), tmp_path / "file.nc") == (set(), FLOATS)
    assert filled(study.to_physical(opened.open(), **SCALE), tmp_path / "file.nc") == (set(), FLOATS)
    monkeypatch.setattr(results_file, "LAZY", 0)
    assert filled(opened.open(), tmp_path / "file.nc") == (set(), FLOATS)
    elsewhere = study.Study(opened.definition, tmp_path)
    assert filled(elsewhere.open(partial=True), tmp_path / "file.nc") == (set(), FLOATS)


def test_units_of_a_lazily_opened_file_are_converted_lazily(opened, monkeypatch):
    monkeypatch.setattr(results_file, "LAZY", 0)
    found = study.to_physical(opened.open(), **SCALE)
    assert found.p.chunks and found.a.chunks
    np.testing.assert_allclose(found.p, opened.open().p * 2e11, rtol=1e-15, atol=0)  # one rounding


def test_coordinates_are_those_of_the_study(opened):
    with netCDF4.Dataset(opened.results / "small.nc") as file:
        assert file["P"][:].tolist() == [1e-5, 2e-5, 4e-5]
        assert file["x"][:].tolist() == [0, 0.25, 0.5, 0.75, 1]
        assert file["h"][...].item() == 0.02
        assert set(file["a"].coordinates.split()) >= {"h", "n", "rtol", "accuracy", "base"}
