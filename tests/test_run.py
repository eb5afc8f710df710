"""Running a study: resume, interruption, failures, and that no finished result is lost or silently replaced."""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import weakref
from pathlib import Path
from types import SimpleNamespace

import netCDF4
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from same import assert_same_numbers

import study
from study import blocks, dataset, join, order, reuse
from study import run as running
from study.blocks import parcel
from study.definition import from_tables
from study.store import Store, add, inventory

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
    seen, real = [], blocks.compute

    def compute(wanted):
        seen.append(wanted.first)
        return real(wanted)

    monkeypatch.setattr(blocks, "compute", compute)
    return seen


def store_block(opened, start: int, stop: int) -> Path:
    """Compute and store the cases start <= i < stop, as a run that ends there would have."""
    store, index = Store(opened.definition, opened.results), np.arange(start, stop)
    store.folder.mkdir(parents=True, exist_ok=True)
    known = inventory(store)
    add(store, known, index, blocks.compute(parcel(opened.definition, index)))
    return known.files[-1]


def present(opened) -> int:
    """Cases on disk before the results file is written."""
    return opened.status()["cases"] - opened.status()["counts"].get(127, 0)


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
    real, stored = running.add, []

    def interrupted(store, known, index, arrays):
        if len(stored) == 2:
            raise KeyboardInterrupt
        stored.append(index[0] // 5)
        real(store, known, index, arrays)

    monkeypatch.setattr(running, "add", interrupted)
    with pytest.raises(KeyboardInterrupt):
        opened.run(workers=workers)
    done = sum(len(range(i * 5, min(i * 5 + 5, 23))) for i in stored)
    expected = {"state": "partial", "cases": 23, "counts": {0: done, 127: 23 - done}, "path": None}
    assert opened.status() | {"path": None} == expected
    wait_for_quiet(computed)
    part = opened.open(partial=True)
    assert int((part.status == 127).sum()) == 23 - done
    assert (part.status.values == 127).tolist() == part.a.isnull().values.tolist()
    monkeypatch.setattr(running, "add", real)
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


def test_blocks_on_disk_serve_another_block_size(file, computed):
    opened = load(file)
    store_block(opened, 0, 5)
    computed.clear()
    other = load(file, **{"block = 5": "block = 9"})
    assert other.definition.digest == opened.definition.digest
    assert other.run().computed == 18
    assert computed == [5, 14]
    assert (other.open().status == 0).all()
    assert opened.status()["state"] == "done"


def test_failing_block_costs_that_block_only(file, monkeypatch):
    real = blocks.compute

    def compute(wanted):
        if wanted.first == 10:
            raise ZeroDivisionError("on purpose")
        return real(wanted)

    opened = load(file)
    monkeypatch.setattr(blocks, "compute", compute)
    litter = Store(opened.definition, opened.results).folder / ".line.nc.killed.tmp"
    litter.parent.mkdir(parents=True)
    litter.touch()
    report = opened.run(workers=2)
    assert not litter.exists()
    assert report.failures == {2: "cases 10 to 14: ZeroDivisionError: on purpose"}
    assert report.computed == 18
    assert report.counts == {0: 18, 127: 5}
    assert not report.path.exists()
    assert not report.complete
    assert np.flatnonzero(opened.open(partial=True).status == 127).tolist() == [10, 11, 12, 13, 14]
    with pytest.raises(study.StudyError, match="does not exist; run the study first"):
        opened.open()
    monkeypatch.setattr(blocks, "compute", real)
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
    assert other.run(force=True).computed == 22, "the two ends are the same cases"
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
    monkeypatch.setattr(xr, "open_dataset", recorded(xr.open_dataset, threads))
    for module in (join, reuse):
        monkeypatch.setattr(module, "netCDF4", SimpleNamespace(Dataset=recorded(netCDF4.Dataset, threads)))
    load(file).run(workers=3)
    load(file, **{"num = 23": "num = 45"}).run(workers=3)
    assert threads == {threading.main_thread()}


def test_memory_is_bounded(file, monkeypatch):
    """A stored block is forgotten: of 60 never more than a few are alive."""
    alive, most, real = weakref.WeakSet(), [], blocks.compute

    class Arrays(dict):
        __hash__ = object.__hash__

    def compute(wanted):
        found = Arrays(real(wanted))
        alive.add(found)
        most.append(len(alive))
        return found

    monkeypatch.setattr(blocks, "compute", compute)
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
    store_block(opened, 0, 5)
    opened.run()
    assert leftovers(opened.results) == []


@settings(max_examples=15, deadline=None)
@given(data=st.data())
def test_random_blocks_orders_workers_and_parts_give_the_same_dataset(data):
    axes = {"P": [1e-6, 3e-6, 5e-6, 9e-6], "h": [0.001, 0.002, 0.003], "nu1": [0.2, 0.3], "bonding": ["bonded"]}
    model = {"micro": "smooth", "n": 0.5, "base": "thin_layer"}
    shuffled = {name: data.draw(st.permutations(axes[name])) for name in data.draw(st.permutations(list(axes)))}
    tables = {"model": model, "axes": shuffled, "numerics": {"block": data.draw(st.integers(1, 30))}}
    tables |= {"output": {"x": 3}}
    parts, workers = data.draw(st.integers(1, 4)), data.draw(st.integers(1, 3))
    with tempfile.TemporaryDirectory() as folder:
        opened = study.Study(from_tables(tables, "random", "", "random"), Path(folder))
        for part in data.draw(st.permutations(range(parts))):
            report = opened.run(workers=workers, part=(part + 1, parts))
        assert report.complete and leftovers(Path(folder)) == ["random.nc"]
        found = opened.open()
    whole = study.solve(**axes, **model, x=3)
    assert_same_numbers(found.sel({name: whole[name] for name in axes}).transpose(*whole.dims), whole)


def failing(monkeypatch, first: int) -> None:
    """The second case of the block that begins with `first` ends with status 3, diverged, without numbers."""
    real = blocks.compute

    def compute(wanted):
        found = real(wanted)
        if wanted.first == first:
            found["status"][1] = 3
            found["a"][1] = np.nan
        return found

    monkeypatch.setattr(blocks, "compute", compute)


def test_a_failed_case_does_not_stop_the_others_unless_asked(file, monkeypatch, computed):
    failing(monkeypatch, 5)
    report = load(file).run(workers=1, fail_fast=True)
    assert report.failures == {1: "case 6: diverged"}
    assert not report.complete and report.computed < 23
    report = load(file).run(workers=1)
    assert report.complete and report.counts == {0: 22, 3: 1}
    assert set(computed) == {0, 5, 10, 15, 20}
    assert computed.count(0) == computed.count(5) == 1, "what was stored before the stop is kept, the failed case too"


@pytest.mark.parametrize("ended", [True, False])
def test_retry_computes_the_cases_of_a_status_again(file, monkeypatch, ended):
    opened = load(file)
    with monkeypatch.context() as patched:
        failing(patched, 5)
        opened.run(workers=1, fail_fast=not ended)
    assert opened.status()["state"] == ("done" if ended else "partial")
    assert opened.status()["counts"][3] == 1
    if ended:
        assert opened.run(retry=(1, 2)).counts == {}, "no case has this status"
    missing = opened.status()["counts"].get(127, 0)
    report = opened.run(retry=(3, 2))
    assert (report.computed, report.counts, report.complete) == (missing + 1, {0: 23}, True)
    whole = study.solve(P=np.linspace(1e-6, 1e-4, 23), micro="smooth", base="half_space", x=3)
    assert_same_numbers(opened.open(), whole)
    assert opened.run(retry=(3,)).counts == {}, "nothing to do"


def test_a_block_size_of_one_part_does_not_change_which_cases_it_has(file):
    whole = np.arange(23)
    shares = [np.concatenate([*blocks.cut(whole, 5, (i, 3)), []]) for i in (1, 2, 3)]
    assert sorted(np.concatenate(shares).tolist()) == whole.tolist()
    later = np.concatenate(blocks.cut(whole[whole % 2 == 0], 5, (2, 3)))
    assert set(later) == {case for case in shares[1] if case % 2 == 0}
    assert [len(block) for block in blocks.cut(whole, 5)] == [5, 5, 5, 5, 3]


def test_a_large_study_asks_first(file, monkeypatch, computed):
    monkeypatch.setattr(order, "LARGE", 400)
    opened = load(file)
    with pytest.raises(
        study.StudyError, match=r"^line: 23 cases: about \d+ s, at most .* on disk; --yes computes them$"
    ):
        opened.run()
    assert not opened.results.joinpath("line.nc").exists() and computed == [], "nothing but a sample is computed"
    assert opened.run(yes=True).computed == 23


def test_dry_run_says_what_is_there_and_writes_nothing(file):
    opened = load(file)
    cost = opened.dry_run()
    assert (cost.cases, cost.present) == (23, 0) and cost.seconds > 0
    assert cost.size == 8 * 23 * (16 + 2 * 3) and cost.memory > cost.size
    assert not opened.results.exists()
    store_block(opened, 0, 5)
    assert opened.dry_run().present == 5
    opened.run()
    before = sorted(opened.results.rglob("*"))
    cost = opened.dry_run()
    assert (cost.present, cost.seconds) == (23, 0.0)
    assert load(file, **{"num = 23": "num = 45"}).dry_run().present == 23
    assert sorted(opened.results.rglob("*")) == before


def test_estimated_time_is_of_the_order_of_the_run(file):
    opened = load(file, **{"num = 23": "num = 20000", "block = 5": "block = 2000"})
    cost = opened.dry_run(workers=1)
    begun = time.perf_counter()
    blocks.compute(parcel(opened.definition, np.arange(20000)))
    assert 0.02 < cost.seconds / (time.perf_counter() - begun) < 50


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
    while not present(opened) and time.monotonic() < deadline:
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "the same command goes on from there" in errors
    assert "Traceback" not in errors
    done = present(opened)
    assert 0 < done < 600
    assert not [name for name in leftovers(opened.results) if name.endswith(".tmp")]
    assert opened.run().computed == 600 - done
