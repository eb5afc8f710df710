"""Disks that are full and folders where nobody may write: what is on disk is kept, and the next run ends well."""

import errno
import os
import resource
import stat
from pathlib import Path

import numpy as np
import pytest
from interrupted_study import BLOCK, CASES, assert_ends_well, written
from line_study import present, store_block

import study
from study.__main__ import main
from study.store.block_file import Block, write_block

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX limits")


@pytest.fixture
def opened(tmp_path) -> study.Study:
    return written(tmp_path)


def full_disk(limit: int):
    """No file may grow beyond `limit` bytes in this process: a write fails, as on a full disk, even for root."""
    _, most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, most))


@pytest.mark.parametrize(("limit", "kept"), [(500, 0), (8000, CASES)], ids=["of a block", "of the results"])
def test_full_disk(opened, undisturbed, capsys, tmp_path, limit, kept):
    command = ["run", str(tmp_path / "line.toml"), "--results", str(opened.results), "--workers", "1"]
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


def test_disk_full_within_an_array(tmp_path):
    """Of which numpy says only "100000 requested and 999 written", if the array is larger than the buffer."""
    block = Block({}, np.zeros((100_000, 2), np.uint64), {})
    try:
        full_disk(8000)
        with pytest.raises(OSError, match=r"some.block cannot be written \(.*\): is the disk full\?"):
            write_block(tmp_path / "some.block", block)
    finally:
        full_disk(resource.RLIM_INFINITY)
    assert not list(tmp_path.iterdir())


def test_disk_full_half_way(opened, undisturbed, monkeypatch):
    flushed, real = [], os.fsync

    def fsync(file):
        flushed.extend([file] * stat.S_ISREG(os.fstat(file).st_mode))
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


def test_a_table_that_a_full_disk_cuts_off_is_written_again(tmp_path, capsys):
    """An empty file that is younger than its inputs would be up to date for ever."""
    command = ["table", "--run", "table1", "--tables", str(tmp_path)]
    try:
        full_disk(0)
        assert main(command) == 1
    finally:
        full_disk(resource.RLIM_INFINITY)
    assert "File too large" in capsys.readouterr().err and not list(tmp_path.iterdir())
    assert main(command) == 0
    assert all(path.stat().st_size for path in tmp_path.iterdir()) and len(capsys.readouterr().out.split()) == 3


def test_folder_becomes_read_only(opened, undisturbed, tmp_path, capsys, monkeypatch):
    store_block(opened, 0, BLOCK)

    def replace(*_):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(os, "replace", replace)
    assert main(["run", str(tmp_path / "line.toml"), "--results", str(opened.results), "--workers", "1"]) == 1
    assert "Read-only file system" in capsys.readouterr().err
    monkeypatch.undo()
    assert_ends_well(opened, undisturbed, CASES - BLOCK)
