"""What an earlier results file is taken for, when it may be replaced, and which of its cases serve."""

from dataclasses import replace

import netCDF4
import numpy as np
import pytest
import xarray as xr

import study
from solver import NUMERICS_VERSION
from study.files.examine import Condition, examine
from study.inputs.definition import Definition
from study.inputs.identity import case_keys
from study.inputs.reading import from_tables
from study.store import earlier as module
from study.store.block_file import Damaged
from study.store.blocks import Store, gather, inventory
from study.store.earlier import Earlier, ResultsSource, check_replaceable


def line(P=(1e-6, 2e-6, 3e-6), **output) -> Definition:
    model, axes = {"n": 0.5, "micro": "smooth", "base": "thin_layer"}, {"P": list(P), "h": [0.001, 0.002]}
    return from_tables({"model": model, "axes": axes, "output": {"x": 3} | output}, "line", "", "line")


def earlier(definition: Definition, path) -> Earlier:
    return module.earlier(definition, examine(path))


@pytest.fixture(scope="module")
def ran(tmp_path_factory) -> study.Study:
    found = study.Study(line(), tmp_path_factory.mktemp("results"))
    found.run()
    return found


@pytest.fixture
def results(ran):
    return ran.results / "line.nc"


def test_our_file(ran, results):
    found = earlier(line((2e-6, 9e-6)), results)
    assert (found.condition.kind, found.condition.digest) == ("sound", ran.definition.digest)
    assert (found.numerics, found.cases) == (NUMERICS_VERSION, 6)
    np.testing.assert_array_equal(found.source.keys, case_keys(ran.definition.grid))


@pytest.mark.parametrize("output", [{"x": 5}, {"x": [0, 0.4, 1]}])
def test_our_file_with_other_profiles_serves_nothing(results, output):
    found = earlier(line(**output), results)
    assert found.source is None and found.cases == 6


def test_fewer_outputs_are_served(results):
    for output in ({"profiles": False, "x": 5}, {"profiles": ["lam"]}, {"dtype": "float32"}):
        assert earlier(line(**output), results).source is not None


@pytest.mark.usefixtures("read_in_a_fork")
def test_no_file_and_files_of_others(tmp_path, results):
    nothing = earlier(line(), tmp_path / "none.nc")
    assert (nothing.condition.kind, nothing.cases, nothing.source) == ("missing", 0, None)
    ours = {"study_digest": "d", "numerics_version": NUMERICS_VERSION}
    status = xr.Dataset({"status": ("P", np.zeros(1, np.int8))}, {"P": [1.0]})
    (tmp_path / "junk.nc").write_bytes(b"no netCDF")
    xr.Dataset({"a": 1.0}).to_netcdf(tmp_path / "plain.nc")
    xr.Dataset({"a": 1.0}, attrs={"study_digest": "d"}).to_netcdf(tmp_path / "half.nc")
    status.assign_attrs(ours).to_netcdf(tmp_path / "without_points.nc")
    for name in ("junk", "plain", "half", "without_points"):
        path = tmp_path / f"{name}.nc"
        found = earlier(line(), path)
        assert (found.condition.kind, found.cases, found.source) == ("foreign", 0, None), name
    xr.Dataset({"A_exact": 1.0}, attrs=ours).to_netcdf(tmp_path / "law.nc")
    law = earlier(line(), tmp_path / "law.nc")
    assert (law.condition.digest, law.source, law.cases) == ("d", None, 0)


def replaced(tmp_path, kind="sound", digest="other", force=False, **found) -> None:
    """Ask whether a results file, of the six cases of `line` but for what is `found`, may be replaced by theirs."""
    definition = line()
    keys = case_keys(definition.grid)
    given = {"numerics": NUMERICS_VERSION, "keys": keys, "cases": 6, "identified": True} | found
    condition, known = Condition(tmp_path / "f.nc", kind, "is so and so", digest), given.pop("keys")
    status = np.zeros(6, np.int8)
    given["source"] = None if known is None else ResultsSource(condition.path, definition.grid, known, status, (), None)
    check_replaceable(Store(definition, tmp_path), Earlier(condition, **given), keys, force)


NOTHING = {"numerics": "", "keys": None, "cases": 0, "identified": False}


def test_what_may_be_replaced(tmp_path):
    replaced(tmp_path)
    replaced(tmp_path, keys=case_keys(line().grid)[[3, 1]], cases=2)
    replaced(tmp_path, digest=line().digest, numerics="old", keys=None)
    replaced(tmp_path, "damaged")
    replaced(tmp_path, "damaged", "", **NOTHING)
    replaced(tmp_path, "damaged", line().digest, **NOTHING)
    replaced(tmp_path, force=True, keys=OTHER, cases=2)


OTHER = case_keys(line((7e-6,)).grid)
SOME = case_keys(line().grid)


@pytest.mark.parametrize(
    ("found", "message"),
    [
        ({"numerics": "old"}, f"f.nc: holds results of version old of the numerics, this is {NUMERICS_VERSION}: --for"),
        ({"keys": np.concatenate([SOME, OTHER[:1]]), "cases": 7}, "1 of its 7 cases are not in this one: --force repl"),
        ({"keys": OTHER, "cases": 2}, "2 of its 2 cases are not in this one"),
        ({"keys": None}, "holds results of another definition .* 6 of its 6 cases are not in this one"),
        ({"keys": None, "cases": 0}, "holds results of another definition"),
    ],
)
def test_what_may_not(tmp_path, found, message):
    with pytest.raises(study.StudyError, match=message):
        replaced(tmp_path, **found)


@pytest.mark.parametrize(
    ("found", "message"),
    [
        (
            {"kind": "damaged", "identified": False},
            "f.nc: is so and so; which cases it holds cannot be told: run the study as",
        ),
        (
            {"kind": "damaged", "keys": OTHER, "cases": 2},
            "is so and so; 2 of its 2 cases are not in this one: run the s",
        ),
        ({"kind": "foreign", "force": True}, "f.nc: is so and so; move it away, or use --results DIR"),
        ({"kind": "unreadable", "force": True}, "f.nc: is so and so; move it away, or use --results DIR"),
    ],
)
def test_nobody_is_invited_to_destroy_what_is_damaged_or_not_ours(tmp_path, found, message):
    with pytest.raises(study.StudyError, match=message) as caught:
        replaced(tmp_path, **found)
    assert "--force" not in str(caught.value)


@pytest.mark.parametrize("chunk", [1, 3, 8192])
def test_cases_of_an_earlier_file_are_read_from_it(ran, tmp_path, monkeypatch, chunk):
    """In another order, beside cases that are new, whatever the windows in which the file is read."""
    monkeypatch.setattr("study.files.examine.CHUNK", chunk)
    store = Store(line((3e-6, 5e-6, 1e-6)), tmp_path)
    source = earlier(store.definition, ran.results / "line.nc").source
    known = inventory(store, source)
    assert known.status.tolist() == [0, 0, 127, 127, 0, 0], "the new load"
    found, old = gather(store, known, 1, 6), ran.open()
    assert found["status"].tolist() == [0, 127, 127, 0, 0]
    np.testing.assert_array_equal(found["P"], [3e-6, np.nan, np.nan, 1e-6, 1e-6])
    for name in ("a", "p", "nodes_used"):
        expected = np.concatenate([old[name].sel(P=load).values for load in (3e-6, 1e-6)])[1:]
        np.testing.assert_array_equal(found[name][[0, 3, 4]], expected, name)
    with pytest.raises(Damaged, match="has been replaced while its cases were read"):
        replace(source, seen=None).read(np.array([0]))


def test_a_run_takes_them_and_leaves_the_file_alone_until_the_end(ran, tmp_path, computed):
    (tmp_path / "line.nc").write_bytes((ran.results / "line.nc").read_bytes())
    found = study.Study(line((3e-6, 2e-6, 1e-6, 5e-6)), tmp_path)
    assert found.run(workers=1).computed == 2
    assert len(computed) == 1, "in one block"
    xr.testing.assert_equal(found.open().a[:3], ran.open().a.sel(P=[3e-6, 2e-6, 1e-6]))
    assert study.Study(line((1e-6,)), tmp_path).run(force=True).computed == 0


@pytest.mark.usefixtures("read_in_a_fork")
def test_cases_of_a_status_to_be_tried_again_are_missing(ran, tmp_path):
    path = tmp_path / "line.nc"
    path.write_bytes((ran.results / "line.nc").read_bytes())
    with netCDF4.Dataset(path, "a") as file:
        file["status"][0, :] = [3, 5]
        file.delncattr("checksums")
    store = Store(line((1e-6, 3e-6)), tmp_path)
    source = earlier(store.definition, path).source
    assert inventory(store, source, retry=(3,)).status.tolist() == [127, 5, 0, 0]
    assert inventory(store, source).status.tolist() == [3, 5, 0, 0]
