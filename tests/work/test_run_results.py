"""What a run does to results: none that is finished is lost or silently replaced, and little is held in memory."""

import os
import threading
import weakref
from types import SimpleNamespace

import netCDF4
import numpy as np
import pytest
import xarray as xr
from line_study import leftovers, load, store_block

import study
from study.commands.computing import state_line
from study.files import netcdf, results_file
from study.files.examine import examine
from study.work import cases


def test_results_of_another_definition_are_kept(file):
    load(file).run()
    before = (file.parent / "results" / "line.nc").read_bytes()
    other = load(file, **{"num = 23": "num = 24"})
    assert (other.status()["state"], other.status()["counts"]) == ("outdated", {0: 2, 127: 22})
    assert "outdated (2 of 24 cases can be used again)" in state_line(other.definition, other.status())
    with pytest.raises(study.StudyError, match="holds results of another definition.*--force replaces them"):
        other.run()
    with pytest.raises(study.StudyError, match="holds results of another definition"):
        other.open()
    assert (file.parent / "results" / "line.nc").read_bytes() == before
    assert other.run(force=True).computed == 22, "the two ends are the same cases"
    assert other.open().sizes["P"] == 24


def test_results_that_are_removed_while_one_asks_for_them(file, monkeypatch):
    load(file).run()

    def removed(path):
        path.unlink(missing_ok=True)
        raise FileNotFoundError(path)

    monkeypatch.setattr("study.store.window_files.statuses", removed)
    assert load(file).status()["state"] == "partial"


@pytest.mark.parametrize(("content", "what"), [(b"", "is empty"), (b"no netCDF", "is not a netCDF file")])
def test_a_file_that_is_no_result_is_kept(file, content, what):
    opened = load(file)
    opened.results.mkdir()
    (opened.results / "line.nc").write_bytes(content)
    with pytest.raises(study.StudyError, match=f"line.nc: {what}; move it away"):
        opened.run()
    assert (opened.results / "line.nc").read_bytes() == content


def test_unwritable_folder_is_found_before_computing(file, computed):
    (file.parent / "results").write_text("in the way", encoding="utf-8")
    with pytest.raises(study.StudyError, match="results: cannot be written: is a file, not a folder"):
        load(file).run()
    assert computed == []


@pytest.mark.parametrize("failure", [OSError("disk full"), KeyboardInterrupt()])
def test_failed_write_leaves_the_old_file_and_no_litter(file, monkeypatch, failure):
    opened = load(file)
    opened.run()
    found, path = opened.open(), opened.results / "line.nc"
    before = path.read_bytes()

    def replace(*_):
        raise failure

    monkeypatch.setattr(os, "replace", replace)
    with pytest.raises(type(failure)):
        results_file.write(found, path, examine(path))
    assert path.read_bytes() == before
    assert leftovers(opened.results) == []


def test_a_reader_keeps_its_file_while_it_is_replaced(file):
    opened = load(file)
    opened.run()
    with xr.open_dataset(opened.results / "line.nc") as reader:
        load(file, **{"num = 23": "num = 2"}).run(force=True)
        assert reader.a.load().sizes["P"] == 23


def test_netcdf_is_touched_by_the_main_thread_only(file, monkeypatch):
    threads = set()
    monkeypatch.setattr(xr, "open_dataset", recorded(xr.open_dataset, threads))
    monkeypatch.setattr(netcdf, "netCDF4", SimpleNamespace(Dataset=recorded(netCDF4.Dataset, threads)))
    load(file).run(workers=3)
    load(file, **{"num = 23": "num = 45"}).run(workers=3)
    assert threads == {threading.main_thread()}


def recorded(function, threads: set):
    def call(*arguments, **options):
        threads.add(threading.current_thread())
        return function(*arguments, **options)

    return call


def test_memory_is_bounded(file, monkeypatch):
    """A stored block is forgotten: of 60 one is alive, and the one that is being stored. How many results of processes
    may wait is left to test_here_and_apart.py."""
    alive, most, real = weakref.WeakSet(), [], cases.compute

    class Arrays(dict):
        __hash__ = object.__hash__

    def compute(wanted):
        found = Arrays(real(wanted))
        alive.add(found)
        most.append(len(alive))
        return found

    monkeypatch.setattr(cases, "compute", compute)
    load(file, **{"num = 23": "num = 300"}).run(workers=2)
    assert len(most) == 60
    assert max(most) <= 2


def test_a_case_that_failed_is_not_computed_again_unless_asked(file, monkeypatch):
    """Of a case in two blocks the one that ended better is what a run takes."""
    real = cases.compute

    def compute(wanted):
        return (found := real(wanted)) | {"status": np.where(found["P"] == 1e-6, 3, 0).astype(np.int8)}

    monkeypatch.setattr(cases, "compute", compute)
    load(file).run()
    other = load(file, **{"num = 23": "num = 24"})
    assert other.status()["counts"] == {0: 1, 3: 1, 127: 22}
    monkeypatch.setattr(cases, "compute", real)
    store_block(other, 0, 5)
    assert other.status()["counts"] == {0: 6, 127: 18}
    assert other.dry_run().present == 6
    assert other.run(force=True).counts == {0: 24}
