"""What an earlier results file is taken for, when it may be replaced, and which of its cases serve."""

import netCDF4
import numpy as np
import pytest
import xarray as xr

import study
from solver import NUMERICS_VERSION
from study.files.examine import Condition, examine
from study.spec.definition import Definition, from_tables
from study.store import earlier as module
from study.store.block_file import read_block
from study.store.blocks import Store, inventory
from study.store.earlier import Earlier, adopt, check_replaceable
from study.store.keys import case_keys


def line(P=(1e-6, 2e-6, 3e-6), **output) -> Definition:
    model, axes = {"n": 0.5, "micro": "smooth", "base": "thin_layer"}, {"P": list(P), "h": [0.001, 0.002]}
    return from_tables({"model": model, "axes": axes, "output": {"x": 3} | output}, "line", "", "line")


def earlier(definition: Definition, path) -> Earlier | None:
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
    np.testing.assert_array_equal(found.keys, case_keys(ran.definition.grid))


@pytest.mark.parametrize("output", [{"x": 5}, {"x": [0, 0.4, 1]}])
def test_our_file_with_other_profiles_serves_nothing(results, output):
    found = earlier(line(**output), results)
    assert found.keys is None and found.cases == 6


def test_fewer_outputs_are_served(results):
    for output in ({"profiles": False, "x": 5}, {"profiles": ["lam"]}, {"dtype": "float32"}):
        assert earlier(line(**output), results).keys is not None


def test_no_file_and_files_of_others(tmp_path, results):
    assert earlier(line(), tmp_path / "none.nc") is None
    ours = {"study_digest": "d", "numerics_version": NUMERICS_VERSION}
    status = xr.Dataset({"status": ("P", np.zeros(1, np.int8))}, {"P": [1.0]})
    (tmp_path / "junk.nc").write_bytes(b"no netCDF")
    xr.Dataset({"a": 1.0}).to_netcdf(tmp_path / "plain.nc")
    xr.Dataset({"a": 1.0}, attrs={"study_digest": "d"}).to_netcdf(tmp_path / "half.nc")
    status.assign_attrs(ours).to_netcdf(tmp_path / "without_points.nc")
    for name in ("junk", "plain", "half", "without_points"):
        path = tmp_path / f"{name}.nc"
        found = earlier(line(), path)
        assert (found.condition.kind, found.cases, found.keys) == ("foreign", 0, None), name
    xr.Dataset({"A_exact": 1.0}, attrs=ours).to_netcdf(tmp_path / "law.nc")
    law = earlier(line(), tmp_path / "law.nc")
    assert (law.condition.digest, law.keys, law.cases) == ("d", None, 0)


def replaced(tmp_path, kind="sound", digest="other", force=False, **found) -> None:
    """Ask whether a results file, of the six cases of `line` but for what is `found`, may be replaced by theirs."""
    definition = line()
    keys = case_keys(definition.grid)
    given = {"numerics": NUMERICS_VERSION, "keys": keys, "cases": 6, "grid": definition.grid} | found
    condition = Condition(tmp_path / "f.nc", kind, "is so and so", digest)
    check_replaceable(Store(definition, tmp_path), Earlier(condition, **given), keys, force)


NOTHING = {"numerics": "", "keys": None, "cases": 0, "grid": None}


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
            {"kind": "damaged", "grid": None},
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


@pytest.fixture
def wider(ran, tmp_path):
    """A study of four of the cases and two new ones, the store, and what there is: one of the four as a block."""
    made = Store(line((3e-6, 5e-6, 1e-6)), tmp_path)
    made.folder.mkdir()
    adopt(made, inventory(made), earlier(made.definition, ran.results / "line.nc"), ())
    (block,) = made.folder.iterdir()
    return made, read_block(block)


def test_cases_of_an_earlier_file_become_blocks_once(ran, wider):
    store, block = wider
    given = store.definition.grid
    assert inventory(store).missing.tolist() == [2, 3], "the new load"
    rows = [np.flatnonzero((block.keys == key).all(axis=1)).tolist() for key in case_keys(given)[[0, 1, 4, 5]]]
    assert sorted(sum(rows, [])) == [0, 1, 2, 3]
    old = ran.open().sel(P=[3e-6, 1e-6]).a.values.ravel()
    np.testing.assert_array_equal(block.arrays["a"][sum(rows, [])], old)
    adopt(store, inventory(store), earlier(store.definition, ran.results / "line.nc"), ())
    assert len(list(store.folder.iterdir())) == 1, "what is in blocks already is not copied again"


def test_cases_of_a_status_to_be_tried_again_are_not_adopted(ran, tmp_path):
    path = tmp_path / "line.nc"
    path.write_bytes((ran.results / "line.nc").read_bytes())
    with netCDF4.Dataset(path, "a") as file:
        file["status"][0, :] = [3, 5]
        file.delncattr("checksums")
    store = Store(line((1e-6, 3e-6)), tmp_path)
    store.folder.mkdir()
    adopt(store, inventory(store), earlier(store.definition, path), (3,))
    assert inventory(store).status.tolist() == [127, 5, 0, 0]


@pytest.mark.parametrize("at_once", [1, 3])
def test_a_large_file_is_read_in_parts(ran, tmp_path, monkeypatch, at_once):
    monkeypatch.setattr(module, "AT_ONCE", at_once)
    store = Store(line((3e-6, 2e-6)), tmp_path)
    store.folder.mkdir()
    adopt(store, inventory(store), earlier(store.definition, ran.results / "line.nc"), ())
    blocks = [read_block(path) for path in store.folder.iterdir()]
    assert len(blocks) > 1 and max(len(block.keys) for block in blocks) <= at_once
    found = study.Study(store.definition, tmp_path)
    assert found.run().computed == 0
    xr.testing.assert_equal(found.open(), ran.open().sel(P=[3e-6, 2e-6]))
