"""Whatever happens to a run, what is on disk is kept, and the next run ends in the dataset of an undisturbed one."""

import errno
import io
import os
import random
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from children import child, computed_in, lines, wait_for
from line_study import present, store_block
from same import assert_same

import study
from study import block_file, join
from study.__main__ import main
from study.block_file import read_block

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals and limits")

CASES, BLOCK = 300, 5
IN_FLIGHT = 4 * 2 * BLOCK  # cases submitted and not stored, for two workers
TEXT = f"""
[model]
micro = "smooth"
n = 0.5
base = "thin_layer"
[axes]
h = [0.001, 0.002, 0.003]
P = {{start = 1e-6, stop = 1e-4, num = {CASES // 3}}}
[numerics]
block = {BLOCK}
[output]
x = 3
"""


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory) -> xr.Dataset:
    folder = tmp_path_factory.mktemp("undisturbed")
    opened = written(folder)
    opened.run()
    return opened.open()


@pytest.fixture
def opened(tmp_path) -> study.Study:
    return written(tmp_path)


def written(folder: Path, text: str = TEXT) -> study.Study:
    (folder / "line.toml").write_text(text, encoding="utf-8")
    return study.load(folder / "line.toml", folder / "results")


def assert_ends_well(opened: study.Study, undisturbed: xr.Dataset, computed: int | None = None) -> None:
    """The next run computes so many cases, gives the dataset of an undisturbed run and leaves nothing else."""
    report = opened.run(workers=2)
    assert report.complete and (computed is None or report.computed == computed)
    assert_same(opened.open(), undisturbed)
    assert [path.name for path in opened.results.rglob("*")] == ["line.nc"]


def cases_on_disk(opened: study.Study) -> set[int]:
    return set(np.flatnonzero(opened.open(partial=True).status.values.ravel() != 127).tolist())


def test_killed_at_ten_random_moments(opened, undisturbed, tmp_path):
    file, before, least = tmp_path / "line.toml", set(), BLOCK
    for attempt in range(10):
        log = tmp_path / f"log{attempt}"
        process = child(file, log, workers=2)
        sign = computed_in if attempt % 2 else lines  # every other time it has begun to compute
        wait_for(lambda log=log, process=process, sign=sign: sign(log) or not process.is_alive())
        process.join(random.uniform(0, 0.15))
        process.kill()
        process.join()
        after, computed = cases_on_disk(opened), computed_in(log)
        assert before <= after, "nothing that was on disk is lost"
        assert not before & set(computed) and len(set(computed)) == len(computed), "nothing is computed twice"
        assert len(set(computed) - after) <= IN_FLIGHT, "a kill costs the blocks in flight"
        before = after
    assert least <= len(before), "the moments were all too early to test anything"
    assert_ends_well(opened, undisturbed, None if opened.status()["state"] == "done" else CASES - len(before))


@pytest.mark.parametrize("at", ["run._finish", "join.create", "run.discard"])
def test_killed_while_the_results_are_written(opened, undisturbed, tmp_path, at):
    process = child(tmp_path / "line.toml", tmp_path / "log", at=at, workers=2)
    process.join(60)
    assert process.exitcode == -signal.SIGKILL
    assert_ends_well(opened, undisturbed, 0)


@pytest.mark.parametrize("signals", [[signal.SIGINT] * 2, [signal.SIGTERM], [signal.SIGTERM, signal.SIGINT]], ids=str)
def test_interrupted_by_signals(undisturbed, tmp_path, signals):
    opened = written(tmp_path, TEXT.replace(f"block = {BLOCK}", "block = 1"))
    command = [sys.executable, "-m", "study", "run", "line.toml", "--workers", "2"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(path or os.getcwd() for path in sys.path)}
    listening = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)}  # ignored in background jobs
    process = subprocess.Popen(command, cwd=tmp_path, env=environment, stderr=subprocess.PIPE, text=True, **listening)
    wait_for(lambda: any(opened.results.rglob("*.block")))
    for number in signals:
        process.send_signal(number)
    _, errors = process.communicate(timeout=60)
    if len(signals) == 1:
        assert "interrupted; finished blocks are kept, the same command" in errors
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert 0 < present(opened) < CASES
    assert not list(tmp_path.glob("results/*.tmp"))
    assert_ends_well(written(tmp_path), undisturbed, CASES - present(opened))


def spoil(path: Path, how: str) -> None:
    """Damage a file."""
    data = bytearray(path.read_bytes())
    if how == "bit flipped":
        place = random.randrange(len(data))
        data[place] ^= 1 << random.randrange(8)
    path.write_bytes({"truncated": data[:-100], "emptied": b"", "bit flipped": data}[how])


@pytest.mark.parametrize("how", ["truncated", "emptied", *["bit flipped"] * 5])
def test_a_damaged_block_is_computed_again(opened, undisturbed, how):
    paths = [store_block(opened, start, start + BLOCK) for start in range(0, CASES, 50)]
    spoil(paths[3], how)
    assert_ends_well(opened, undisturbed, CASES - (len(paths) - 1) * BLOCK)


def test_a_block_damaged_after_the_inventory_stops_the_results(opened, undisturbed, monkeypatch):
    real = join.gather

    def gather(store, known, start, stop):
        spoil(known.files[7], "bit flipped")
        return real(store, known, start, stop)

    monkeypatch.setattr(join, "gather", gather)
    with pytest.raises(block_file.Damaged, match="is no whole block; the same command computes its cases again"):
        opened.run()
    monkeypatch.undo()
    assert_ends_well(opened, undisturbed, BLOCK)


def test_a_block_of_another_study_is_not_taken_for_one_of_this(opened, undisturbed, tmp_path):
    paths = [store_block(opened, start, start + BLOCK) for start in range(0, CASES, 50)]
    (tmp_path / "other").mkdir()
    other = written(tmp_path / "other", TEXT.replace("n = 0.5", "n = 0.6"))
    paths[0].write_bytes(store_block(other, 0, BLOCK).read_bytes())
    assert_ends_well(opened, undisturbed, CASES - (len(paths) - 1) * BLOCK)


def test_nothing_executable_is_read(opened, undisturbed, tmp_path):
    """A block with a right checksum and columns of Python objects is refused like a damaged one."""
    path = store_block(opened, 0, BLOCK)
    data = path.read_bytes()[: -block_file.CHECK].replace(b'"<f8"', b'"|O"', 1)
    path.write_bytes(data + block_file.checksum_of(data))
    with pytest.raises(block_file.Damaged):
        read_block(path)
    assert_ends_well(opened, undisturbed, CASES)


def full_disk(limit: int):
    """No file may grow beyond `limit` bytes in this process: a write fails, as on a full disk, even for root."""
    _, most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, most))


@pytest.mark.parametrize(("limit", "kept"), [(500, 0), (8000, CASES)], ids=["of a block", "of the results"])
def test_full_disk(opened, undisturbed, capsys, tmp_path, limit, kept):
    command = ["run", str(tmp_path / "line.toml"), "--results", str(opened.results)]
    try:
        full_disk(limit)
        code = main(command)
    finally:
        full_disk(resource.RLIM_INFINITY)
    assert code == 1
    errors = capsys.readouterr().err.splitlines()
    assert len([line for line in errors if "cases" not in line]) == 1, errors
    assert "File too large" in errors[-1] or "is the disk full?" in errors[-1]
    assert present(opened) == kept
    assert not list(opened.results.rglob("*.tmp"))
    assert_ends_well(opened, undisturbed, CASES - kept)


def test_disk_full_half_way(opened, undisturbed, monkeypatch):
    flushed, real = [], os.fsync

    def fsync(file):
        flushed.append(file)
        if len(flushed) > 3:
            raise OSError(errno.ENOSPC, "No space left on device")
        real(file)

    monkeypatch.setattr(os, "fsync", fsync)
    with pytest.raises(OSError, match="No space left on device"):
        opened.run(workers=2)
    monkeypatch.undo()
    assert present(opened) == 3 * BLOCK
    assert_ends_well(opened, undisturbed, CASES - 3 * BLOCK)


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="a folder where nobody may write")
def test_read_only_folder(opened, undisturbed, capsys, tmp_path):
    assert main(["run", str(tmp_path / "line.toml"), "--results", "/proc/self/results"]) == 1
    assert capsys.readouterr().err == "/proc/self/results: cannot be written: No such file or directory\n"
    assert_ends_well(opened, undisturbed, CASES)


def test_folder_becomes_read_only(opened, undisturbed, tmp_path, capsys, monkeypatch):
    store_block(opened, 0, BLOCK)

    def replace(*_):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(os, "replace", replace)
    assert main(["run", str(tmp_path / "line.toml"), "--results", str(opened.results)]) == 1
    assert "Read-only file system" in capsys.readouterr().err
    monkeypatch.undo()
    assert_ends_well(opened, undisturbed, CASES - BLOCK)


@pytest.mark.parametrize("locks", [True, False])
def test_two_runs_at_once(opened, undisturbed, tmp_path, locks):
    logs = [tmp_path / "one", tmp_path / "two"]
    runs = [child(tmp_path / "line.toml", log, locks=locks, workers=2) for log in logs]
    for process in runs:
        process.join(60)
    assert [process.exitcode for process in runs] == [0, 0]
    computed = [case for log in logs for case in computed_in(log)]
    assert set(computed) == set(range(CASES))
    if locks:
        assert len(computed) == CASES
        ends = sorted(lines(log)[-1] for log in logs)
        assert ends == ["ended", "nothing to do"], "the second waits and finds all done"
    assert_ends_well(opened, undisturbed, 0)


def test_parts_at_once(opened, undisturbed, tmp_path):
    logs = [tmp_path / f"part{i}" for i in range(3)]
    runs = [child(tmp_path / "line.toml", log, part=(i + 1, 3), workers=1) for i, log in enumerate(logs)]
    for process in runs:
        process.join(60)
    assert [process.exitcode for process in runs] == [0, 0, 0]
    assert sorted(case for log in logs for case in computed_in(log)) == list(range(CASES))
    assert opened.status()["state"] == "done", "the last one has written the results"
    assert_ends_well(opened, undisturbed, 0)


def test_a_lazy_reader_keeps_its_file_while_it_is_replaced(opened, undisturbed, monkeypatch, tmp_path):
    monkeypatch.setattr(study.api, "LAZY", 0)
    opened.run()
    reader = opened.open()
    assert reader.p.chunks
    written(tmp_path, TEXT.replace("num = 100", "num = 2")).run(force=True)
    assert_same(reader.load(), undisturbed)


def test_a_clock_that_jumps(opened, undisturbed, monkeypatch, tmp_path):
    path = store_block(opened, 0, BLOCK)
    os.utime(path, (2e9, 2e9))
    later = store_block(opened, BLOCK, 2 * BLOCK)
    os.utime(later, (1, 1))
    random_time = random.Random(1)
    monkeypatch.setattr(time, "time", lambda: random_time.uniform(0, 4e9))
    shown = io.StringIO()
    opened.run(workers=2, stream=shown)
    assert shown.getvalue().startswith(f"line: {CASES} of {CASES} cases, 0 failed, ") and "-" not in shown.getvalue()
    monkeypatch.undo()
    assert_ends_well(opened, undisturbed, 0)


@pytest.mark.parametrize("name", ["..", "../up", "a/b", ".hidden", "a b", "-x", "nul\0"])
def test_names_of_studies_cannot_leave_the_folder(tmp_path, name, capsys):
    assert main(["run", str(tmp_path / f"{name}.toml"), "--results", str(tmp_path / "results")]) == 2
    assert [path.name for path in tmp_path.iterdir()] == []
