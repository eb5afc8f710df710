"""Large studies in many windows, the parts: the same numbers, what a stop costs, what is never replaced. Large is 40
cases here."""

import os
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from children import PATIENCE, PROCESSES, wait_for
from conftest import ROOT

import study
from study.files import lock
from study.files.access import Unusable
from study.files.results_file import numbers_digest
from study.inputs.reading import from_tables
from study.store import blocks, windows, writer
from study.store.windows import Store
from study.work import cases
from study.work import run as running
from study.work.cases import compute, parcel

AXES = {"P": [1e-5, 3e-5, 2e-5], "h": [0.01, 0.02, 0.03, 0.05, 0.07], "bonding": ["frictionless", "bonded"]}
PLAIN = {
    "model": {"n": 0.5, "Ra": 0.004, "base": "thin_layer"},
    "cases": [{"label": "soft", "Nbar": 250000, "nu1": 0.4}, {"label": "", "micro": "smooth"}],
    "axes": AXES,
    "numerics": {"block": 7},
    "output": {"x": 4},
}
UNITS = {
    "model": {"R": "5 mm", "E1": "2 ± 0.1 GPa", "E2": "200 GPa", "micro": "smooth", "bonding": "bonded"},
    "axes": {"h": ["30 um", "10 um", "20 um"], "P": {"start": "1 mN", "stop": "1 N", "num": 20, "spacing": "log"}},
    "numerics": {"block": 5},
    "output": {"profiles": False, "dtype": "float32"},
}


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """Parts of twenty and ten cases, by turns, each whole before its blocks are put on the disk."""
    monkeypatch.setattr(running, "BRIEF", float("inf"))
    monkeypatch.setattr(windows, "CASES", 40)
    monkeypatch.setattr(windows, "usual_block", lambda grid: 20)
    monkeypatch.setattr(windows, "BLOCKS", 1)


def written(folder, tables=PLAIN, **axes) -> study.Study:
    tables = tables | {"axes": tables["axes"] | axes}
    return study.Study(from_tables(tables, "big", "text", "big.toml"), folder)


def files(folder, pattern="*.nc") -> list[str]:
    return sorted(path.name for path in (folder / "big").glob(pattern))


def on_disk(folder) -> list:
    return list(folder.rglob("*.block"))


@pytest.mark.parametrize("tables", [PLAIN, UNITS], ids=["plain", "units"])
def test_parts_hold_what_one_file_would_hold(tmp_path, monkeypatch, tables):
    large = written(tmp_path / "large", tables)
    report = large.run(workers=2)
    assert report.complete and report.computed == 60 and report.path == tmp_path / "large" / "big"
    assert len(files(tmp_path / "large")) > 2 and not (tmp_path / "large" / "big.nc").exists()
    assert large.status()["state"] == "done" and large.status()["counts"] == {0: 60}
    assert large.verify().kind == "sound" and large.run().computed == 0
    found = large.open()
    assert all(found[name].chunks for name in found.data_vars), "lazily"
    found.load()
    monkeypatch.setattr(windows, "CASES", 60)
    one = written(tmp_path / "one", tables)
    one.run()
    expected = one.open()
    assert {*expected.attrs} == {*found.attrs}
    for name, variable in expected.variables.items():
        assert found[name].dims == variable.dims and found[name].dtype == variable.dtype, name
        assert str(found[name].attrs) == str(variable.attrs), name
        if variable.dtype.kind == "f":  # company in a block changes the last bits, and all of what is a difference
            rtol = 3e-7 if variable.dtype.itemsize == 4 else 1e-12
            atol = 1e-12 * (name in ("error", "profile_error", "residual"))
            np.testing.assert_allclose(found[name], variable, rtol=rtol, atol=atol)
        else:
            np.testing.assert_array_equal(found[name], variable)
    xr.testing.assert_identical(study.open_results(tmp_path / "large" / "big").compute(), found)


def test_xarray_opens_the_parts_lazily(tmp_path):
    written(tmp_path, UNITS, h=["10 um", "20 um", "30 um"]).run()
    with xr.open_mfdataset(str(tmp_path / "big" / "*.nc")) as found:
        assert found.a.sizes == {"h": 3, "P": 20} and found.a.chunks and (found.status == 0).all()
        assert (found.h.diff("h") > 0).all() and (found.a.diff("P") > 0).all()


def test_no_key_of_a_case_is_made(tmp_path, monkeypatch):
    monkeypatch.setattr(blocks, "case_keys", lambda *_: 1 / 0)
    large = written(tmp_path)
    assert large.status()["state"] == "new" and large.dry_run().present == 0
    assert large.run(workers=1).complete and large.dry_run().present == 60
    assert "the study is kept in parts, which stay" in large.clean()[0] and large.status()["state"] == "done"


def test_a_stopped_run_goes_on_with_the_parts_that_are_missing(tmp_path, monkeypatch):
    real, seen = cases.compute, []

    def counted(task):
        seen.append(task.first)
        if len(seen) == 8:
            raise KeyboardInterrupt
        return real(task)

    monkeypatch.setattr(cases, "compute", counted)
    large = written(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        large.run(workers=1)
    done = len(files(tmp_path))
    assert 0 < done < 4 and large.status()["state"] == "partial"
    cost, left = large.dry_run(), [60, 40, 30, 10][done]
    assert (cost.present, large.status()["counts"]) == (60 - left, {0: 60 - left, 127: left})
    with pytest.raises(study.StudyError, match=f"{done} of 4 parts are there; run the study first"):
        large.open()
    with pytest.raises(Unusable, match=f"has {done} files, not all 4 parts"):
        study.open_results(tmp_path / "big")
    assert large.run(workers=1).computed == left


def test_a_damaged_part_is_computed_again_and_kept(tmp_path, caplog):
    large = written(tmp_path)
    large.run()
    path = tmp_path / "big" / files(tmp_path)[1]
    data = path.read_bytes()
    path.write_bytes(data[:5000] + bytes([data[5000] ^ 1]) + data[5001:])
    assert large.verify().kind == "damaged" and large.verify().path == path
    assert large.run().computed == 10 and "is damaged; it is computed again" in caplog.text
    assert files(tmp_path, "*.damaged") == [f"{path.name}.damaged"] and large.verify().kind == "sound"


def test_parts_of_another_definition_are_replaced_by_force_alone(tmp_path):
    written(tmp_path).run()
    before, edited = files(tmp_path), written(tmp_path, P=[1e-5, 3e-5, 4e-5])
    with pytest.raises(study.StudyError, match="holds 4 parts of another definition.*--force removes them"):
        edited.run()
    assert edited.dry_run().refused and edited.status()["state"] == "outdated" and files(tmp_path) == before
    assert edited.run(force=True).complete and not {*files(tmp_path)} & {*before}


def test_a_block_that_fails_costs_that_block_only(tmp_path, monkeypatch):
    real = cases.compute
    monkeypatch.setattr(cases, "compute", lambda task: real(task) if task.first != 20 else 1 / 0)
    large = written(tmp_path)
    report = large.run(workers=1)
    assert list(report.failures.values()) == ["cases 20 to 26: ZeroDivisionError: division by zero"]
    assert not report.complete and report.computed == 53 and report.counts == {0: 53, 127: 7}
    assert large.status()["counts"] == {0: 53, 127: 7} and large.dry_run().present == 53
    monkeypatch.setattr(cases, "compute", real)
    assert large.run(workers=1).computed == 7 and large.verify().kind == "sound" and not on_disk(tmp_path)


def test_shares_of_a_batch_system_and_cases_that_are_tried_again(tmp_path, monkeypatch):
    real = cases.compute

    def failing(task):
        return (found := real(task)) | {"status": np.full_like(found["status"], 3)}

    monkeypatch.setattr(cases, "compute", failing)
    large = written(tmp_path)
    report = large.run(part=(1, 2))
    assert report.computed == 40 and not report.complete
    monkeypatch.setattr(cases, "compute", real)
    report = large.run(part=(2, 2))
    assert report.computed == 20 and report.complete and report.counts == {0: 20, 3: 40}
    assert large.run(retry=(3,)).counts == {0: 60}


def test_windows_that_take_long_have_their_blocks_on_the_disk(tmp_path, monkeypatch):
    """Until they are whole; the results are the same."""
    written(tmp_path / "brief").run(workers=1)
    monkeypatch.setattr(running, "BRIEF", 0)
    most, real = [], running.add
    monkeypatch.setattr(running, "add", lambda *given: (real(*given), most.append(len(on_disk(tmp_path)))))
    written(tmp_path / "long").run(workers=1)
    assert max(most) == 3 and not on_disk(tmp_path), "twenty cases in blocks of seven"
    assert files(tmp_path / "brief") == files(tmp_path / "long")
    digests = [numbers_digest(tmp_path / word / "big") for word in ("brief", "long")]
    assert digests[0] == digests[1]


@pytest.mark.parametrize("first", [27, 44], ids=["within a window", "of the last but one"])
def test_a_run_goes_on_with_blocks_of_another_size(tmp_path, monkeypatch, first):
    """What is on the disk is found by the keys of the cases."""
    monkeypatch.setattr(running, "BRIEF", 0)
    real = cases.compute
    monkeypatch.setattr(cases, "compute", lambda task: real(task) if task.first < first else 1 / 0)
    large = written(tmp_path)
    there = large.run(workers=1).computed
    assert there == first and large.status()["counts"] == {0: there, 127: 60 - there}
    monkeypatch.setattr(cases, "compute", real)
    report = written(tmp_path, PLAIN | {"numerics": {"block": 3}}).run(workers=1)
    assert report.computed == 60 - there and report.complete
    assert large.verify().kind == "sound" and not on_disk(tmp_path)


def test_a_damaged_block_of_a_window_is_computed_again(tmp_path, monkeypatch, caplog):
    monkeypatch.setattr(running, "BRIEF", 0)
    real = cases.compute
    monkeypatch.setattr(cases, "compute", lambda task: real(task) if task.first < 14 else 1 / 0)
    large = written(tmp_path)
    assert large.run(workers=1).counts == {0: 14, 127: 46}
    path = on_disk(tmp_path)[0]
    path.write_bytes(path.read_bytes()[:-1])
    monkeypatch.setattr(cases, "compute", real)
    assert large.run(workers=1).computed == 53 and f"{path}: is not a complete block" in caplog.text
    assert large.verify().kind == "sound" and not on_disk(tmp_path)


def test_what_appears_in_the_place_of_a_part_stays(tmp_path, monkeypatch):
    real = cases.compute
    path = windows.windows_of(Store(written(tmp_path).definition, tmp_path))[3].path

    def compute(task):
        if task.first == 57:
            path.write_text("precious")
        return real(task)

    monkeypatch.setattr(cases, "compute", compute)
    with pytest.raises(
        study.StudyError, match="appeared or changed while its results were computed, and is left as it is"
    ):
        written(tmp_path).run(workers=1)
    assert path.read_text(encoding="utf-8") == "precious" and len(files(tmp_path)) == 4
    path.unlink()
    monkeypatch.setattr(cases, "compute", real)
    assert written(tmp_path).run(workers=1).computed == 10


def test_a_window_of_which_all_is_on_the_disk_is_written(tmp_path, monkeypatch):
    """A run was killed between its last block and its results."""
    monkeypatch.setattr(running, "BRIEF", 0)
    large, real = written(tmp_path), writer.put
    monkeypatch.setattr(writer, "put", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        large.run(workers=1)
    monkeypatch.setattr(writer, "put", real)
    assert large.status()["counts"] == {0: 20, 127: 40} and not files(tmp_path)
    assert large.run(workers=1).computed == 40 and large.verify().kind == "sound" and not on_disk(tmp_path)


def test_without_locks_the_second_run_ends_well_too(tmp_path, monkeypatch):
    """One that has written a window removes its blocks, also those of the other."""
    monkeypatch.setattr(running, "BRIEF", 0)
    monkeypatch.setattr(lock, "fcntl", None)
    large, real = written(tmp_path), running.add

    def add(*given):
        real(*given)
        monkeypatch.setattr(running, "add", real)
        assert written(tmp_path).run(workers=1).computed == 53

    monkeypatch.setattr(running, "add", add)
    report = large.run(workers=1)
    assert report.complete and report.computed == 60 and not on_disk(tmp_path)
    assert large.verify().kind == "sound"


def test_an_edit_that_makes_a_study_small_takes_the_blocks_of_windows(tmp_path, monkeypatch):
    real = cases.compute
    monkeypatch.setattr(cases, "compute", lambda task: real(task) if task.first < 14 else 1 / 0)
    written(tmp_path).run(workers=1)
    monkeypatch.setattr(cases, "compute", real)
    few = written(tmp_path, P=[1e-5])
    assert few.dry_run().present == few.status()["cases"] - few.status()["counts"][127] == 10
    assert few.run(workers=1).computed == 10 and few.status()["counts"] == {0: 20}


KILLED = """
import time, sys
sys.path[:0] = {path!r}
from study.work import cases, run
import test_parts
from study.store import windows
run.BRIEF = {brief}
windows.CASES, windows.usual_block, windows.BLOCKS = 40, (lambda grid: 20), 1
real = cases.compute
cases.compute = lambda task: (time.sleep(60 * (task.first > 30)), real(task))[1]
test_parts.written(__import__("pathlib").Path({folder!r})).run(workers=1)
"""


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize(("brief", "there"), [(1e9, 30), (0, 37)], ids=["the window", "the block"])
def test_a_killed_run_loses_what_is_in_work_only(tmp_path, brief, there):
    """The window, while it is in memory alone; else the block."""
    path = [str(ROOT), *sys.path]
    script = KILLED.format(path=path, folder=str(tmp_path), brief=brief)
    process = subprocess.Popen([sys.executable, "-c", script], cwd=tmp_path)
    wait_for(lambda: len(files(tmp_path)) == 2 and len(on_disk(tmp_path)) == (there > 30))
    process.kill()
    process.wait(PATIENCE)
    large = written(tmp_path)
    assert large.status()["counts"] == {0: there, 127: 60 - there} and large.run().computed == 60 - there
    assert large.verify().kind == "sound" and not list(tmp_path.rglob("*.tmp")) and not on_disk(tmp_path)


def peak_of_a_run(folder, points: int, answers) -> None:
    """Peak memory of a run in parts whose solver gives every block the same numbers."""
    import resource

    windows.CASES, windows.PART = 1000, 2_000_000
    model, axes = {"micro": "smooth", "base": "half_space"}, {"P": {"start": 1e-6, "stop": 1e-4, "num": points}}
    tables = {"model": model, "axes": axes | {"m": {"start": 0.0, "stop": 1.0, "num": 500}}}
    large = study.Study(from_tables(tables | {"output": {"profiles": False}}, "large", "", "large"), folder)
    solved = compute(parcel(large.definition, np.arange(8000)))
    cases.compute = lambda task: {name: array[: task.last - task.first + 1] for name, array in solved.items()}
    large.run(workers=1)
    answers.put(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024))


@pytest.mark.skipif(sys.platform == "win32", reason="getrusage")
def test_memory_does_not_grow_with_the_cases(tmp_path):
    """The keys alone would take 16 bytes a case, and a run that has them some 100: 40 MB of 400,000."""
    answers, found = PROCESSES.Queue(), []
    for points in (200, 1000):
        process = PROCESSES.Process(target=peak_of_a_run, args=(tmp_path / str(points), points, answers))
        process.start()
        found.append(answers.get(timeout=PATIENCE))
        process.join()
    assert found[1] - found[0] < 10 * 400_000
