"""Running a study: resume, interruption, failures, and that no finished result is lost or silently replaced."""

import os
import signal
import subprocess
import sys
import threading
import time
import weakref
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import study
from study import blocks, dataset
from study import run as running
from study.blocks import Blocks, block_path, finished

TEXT = """
[model]
micro = "smooth"
base = "half_space"
[axes]
P = {start = 1e-6, stop = 1e-4, num = 23}
[numerics]
block = 5
[output]
x = 3
"""
COUNT = 5  # blocks


@pytest.fixture
def file(tmp_path) -> Path:
    path = tmp_path / "line.toml"
    path.write_text(TEXT, encoding="utf-8")
    return path


@pytest.fixture
def computed(monkeypatch) -> list:
    """First cases of the blocks that are computed, in the order of their computation."""
    seen, real = [], running.compute

    def compute(definition, start, stop):
        seen.append(start)
        return real(definition, start, stop)

    monkeypatch.setattr(running, "compute", compute)
    return seen


def load(file, **changes) -> study.Study:
    text = TEXT
    for old, new in changes.items():
        text = text.replace(old, new)
    file.write_text(text, encoding="utf-8")
    return study.load(file, file.parent / "results")


def leftovers(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.rglob("*") if path.name != "line.nc")


@pytest.mark.parametrize("workers", [1, 2, 5])
@pytest.mark.parametrize("block", [1, 4, 23, 1000])
def test_blocks_and_workers_do_not_change_the_answer(file, block, workers):
    opened = load(file, **{"block = 5": f"block = {block}"})
    report = opened.run(workers=workers)
    assert (report.cases, report.computed, report.failures, report.counts) == (23, 23, {}, {0: 23})
    whole = study.solve(P=np.linspace(1e-6, 1e-4, 23), micro="smooth", base="half_space", x=3)
    xr.testing.assert_allclose(opened.open(), whole, rtol=1e-12, atol=0)
    assert leftovers(opened.results) == []


def test_rerun_computes_nothing(file, computed):
    opened = load(file)
    opened.run()
    before = (opened.results / "line.nc").read_bytes()
    assert len(computed) == COUNT
    assert load(file).run().computed == 0
    assert len(computed) == COUNT
    assert (opened.results / "line.nc").read_bytes() == before


@pytest.mark.parametrize("workers", [1, 2])
def test_interrupted_run_computes_only_the_missing_blocks(file, computed, monkeypatch, workers):
    opened = load(file)
    real, stored = running.store, []

    def interrupted(the_blocks, i, arrays):
        if len(stored) == 2:
            raise KeyboardInterrupt
        stored.append(i)
        real(the_blocks, i, arrays)

    monkeypatch.setattr(running, "store", interrupted)
    with pytest.raises(KeyboardInterrupt):
        opened.run(workers=workers)
    assert opened.status() | {"path": None} == {"state": "partial", "cases": 23, "blocks": 2, "of": COUNT, "path": None}
    wait_for_quiet(computed)
    part = opened.open(partial=True)
    assert int((part.status == 127).sum()) == 23 - sum(len(range(i * 5, min(i * 5 + 5, 23))) for i in stored)
    assert (part.status.values == 127).tolist() == part.a.isnull().values.tolist()
    monkeypatch.setattr(running, "store", real)
    computed.clear()
    report = opened.run(workers=workers)
    assert sorted(computed) == [5 * i for i in range(COUNT) if i not in stored]
    assert report.computed == 23 - int((part.status != 127).sum())
    assert opened.status()["state"] == "done"
    assert (opened.open().status == 0).all()


def wait_for_quiet(seen: list) -> None:
    """Wait until workers that an interruption left behind have ended their block."""
    count = -1
    while count != len(seen):
        count = len(seen)
        time.sleep(0.05)


def test_other_block_size_does_not_mix_with_blocks_on_disk(file):
    opened = load(file)
    blocks.store(Blocks(opened.definition, opened.results), 0, running.compute(opened.definition, 0, 5))
    other = load(file, **{"block = 5": "block = 10"})
    assert other.definition.digest == opened.definition.digest
    assert other.status()["blocks"] == 0
    other.run()
    assert (other.open().status == 0).all()
    assert opened.status()["state"] == "done"


def test_failing_block_costs_that_block_only(file, monkeypatch):
    real = running.compute

    def compute(definition, start, stop):
        if start == 10:
            raise ZeroDivisionError("on purpose")
        return real(definition, start, stop)

    opened = load(file)
    monkeypatch.setattr(running, "compute", compute)
    report = opened.run(workers=2)
    assert report.failures == {2: "cases 10 to 14: ZeroDivisionError: on purpose"}
    assert report.computed == 18
    assert report.counts == {0: 18, 127: 5}
    assert not report.path.exists()
    assert finished(Blocks(opened.definition, opened.results)) == [0, 1, 3, 4]
    with pytest.raises(study.StudyError, match="does not exist; run the study first"):
        opened.open()
    monkeypatch.setattr(running, "compute", real)
    assert opened.run().computed == 5


def test_results_of_another_definition_are_kept(file):
    load(file).run()
    before = (file.parent / "results" / "line.nc").read_bytes()
    other = load(file, **{"num = 23": "num = 24"})
    assert other.status()["state"] == "outdated"
    with pytest.raises(study.StudyError, match="holds results of another definition.*--force replaces them"):
        other.run()
    with pytest.raises(study.StudyError, match="holds results of another definition"):
        other.open()
    assert (file.parent / "results" / "line.nc").read_bytes() == before
    assert other.run(force=True).computed == 24
    assert other.open().sizes["P"] == 24


@pytest.mark.parametrize("content", [b"", b"no netCDF"])
def test_a_file_that_is_no_result_is_kept(file, content):
    opened = load(file)
    opened.results.mkdir()
    (opened.results / "line.nc").write_bytes(content)
    with pytest.raises(study.StudyError, match="holds results of no study known here"):
        opened.run()
    assert (opened.results / "line.nc").read_bytes() == content


def test_unwritable_folder_is_found_before_computing(file, computed):
    (file.parent / "results").write_text("in the way", encoding="utf-8")
    with pytest.raises(study.StudyError, match="results: cannot be written: File exists"):
        load(file).run()
    assert computed == []


def test_damaged_block_is_computed_again(file, computed):
    opened = load(file)
    parts = Blocks(opened.definition, opened.results)
    for i in range(COUNT):
        blocks.store(parts, i, blocks.compute(opened.definition, *blocks.bounds(parts, i)))
    block_path(parts, 3).write_bytes(block_path(parts, 3).read_bytes()[:100])
    report = opened.run()
    assert report.failures == {3: "the block on disk cannot be read; run again to compute it"}
    assert computed == []
    assert opened.run().failures == {}
    assert computed == [15]


@pytest.mark.parametrize("failure", [OSError("disk full"), KeyboardInterrupt()])
def test_failed_write_leaves_the_old_file_and_no_litter(file, monkeypatch, failure):
    opened = load(file)
    opened.run()
    found, path = opened.open(), opened.results / "line.nc"
    before = path.read_bytes()

    def replace(*_):
        raise failure

    monkeypatch.setattr(dataset.os, "replace", replace)
    with pytest.raises(type(failure)):
        dataset.write(found, path)
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
    for owner, name in ((xr, "open_dataset"), (xr.Dataset, "to_netcdf")):
        monkeypatch.setattr(owner, name, recorded(getattr(owner, name), threads))
    load(file).run(workers=3)
    assert threads == {threading.main_thread()}


def test_memory_is_bounded(file, monkeypatch):
    """A stored block is forgotten: of 60 never more than a few are alive."""
    alive, most, real = weakref.WeakSet(), [], running.compute

    class Arrays(dict):
        __hash__ = object.__hash__

    def compute(definition, start, stop):
        found = Arrays(real(definition, start, stop))
        alive.add(found)
        most.append(len(alive))
        return found

    monkeypatch.setattr(running, "compute", compute)
    load(file, **{"num = 23": "num = 300"}).run(workers=2)
    assert len(most) == 60
    assert max(most) <= 8


def recorded(function, threads: set):
    def call(*arguments, **options):
        threads.add(threading.current_thread())
        return function(*arguments, **options)

    return call


def test_blocks_of_a_killed_run_are_removed_when_the_results_are_there(file):
    opened = load(file)
    opened.run()
    parts = Blocks(opened.definition, opened.results)
    blocks.store(parts, 0, blocks.compute(opened.definition, 0, 5))
    opened.run()
    assert leftovers(opened.results) == []


# a test run in the background of a shell ignores SIGINT, and so would its children
LISTENING = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from study.__main__ import main
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_interrupt_from_the_keyboard(file):
    load(file, **{"num = 23": "num = 600"})
    command = [
        sys.executable,
        "-c",
        LISTENING,
        "run",
        str(file),
        "--results",
        str(file.parent / "results"),
        "--workers",
        "2",
    ]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment)
    opened = study.load(file, file.parent / "results")
    deadline = time.monotonic() + 30
    while not opened.status()["blocks"] and time.monotonic() < deadline:
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "the same command goes on from there" in errors
    assert "Traceback" not in errors
    state = opened.status()
    assert 0 < state["blocks"] < state["of"]
    assert not [name for name in leftovers(opened.results) if name.endswith(".tmp")]
    assert opened.run().computed == 600 - 5 * state["blocks"]
