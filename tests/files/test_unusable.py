"""Results files and blocks that cannot be used: what is the matter is said, nothing hangs, nothing is destroyed."""

import os
import resource
import subprocess
import sys
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr
from conftest import ROOT
from line_study import load

import study
from study.__main__ import main
from study.files import seal
from study.files.examine import ATTRIBUTE, examine
from study.files.lock import fcntl
from study.files.results_file import write

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX files and locks")


@pytest.fixture
def opened(file) -> study.Study:
    found = load(file)
    found.run()
    return found


def cut_off(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:20_000])


def foreign(path: Path) -> None:
    xr.Dataset({"a": 1.0}).to_netcdf(path)


def renamed(path: Path) -> None:
    with xr.open_dataset(path) as found:
        other = found.load().rename(P="Q")
    del other.attrs[ATTRIBUTE]
    other.to_netcdf(path)


def pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


STRANGE = {
    foreign: "is a netCDF file of another program",
    renamed: "another program has changed it: its dimensions are ['Q'], not ['P']",
    pipe: "is not a file but a pipe or device",
    folder: "is not a file but a folder",
}


@pytest.mark.parametrize("spoil", STRANGE, ids=lambda spoil: spoil.__name__)
def test_what_is_none_of_ours_is_said_and_kept(opened, file, spoil, capsys):
    path = opened.results / "line.nc"
    spoil(path)
    before = path.lstat()
    where = [str(file), "--results", str(opened.results)]
    for command in (["run", *where], ["run", "--force", *where], ["verify", *where]):
        assert main(command) == 1
        said = capsys.readouterr().err
        assert f"{path}: {STRANGE[spoil]}" in said and "--force" not in said and "outdated" not in said
    assert main(["status", *where]) == 0
    assert f"  foreign  \n    {path}: {STRANGE[spoil]}" in capsys.readouterr().out
    with pytest.raises(study.StudyError, match="is not a file|another program"):
        opened.open()
    assert (path.lstat().st_ino, path.lstat().st_mtime_ns) == (before.st_ino, before.st_mtime_ns)


def test_a_file_cut_off_is_said_kept_aside_and_written_again(opened, caplog):
    path = opened.results / "line.nc"
    length = path.stat().st_size - seal.LENGTH
    cut_off(path)
    assert opened.status()["reason"] == f"is damaged: cut off, 20000 bytes of {length}"
    assert opened.run().computed == 0 and opened.verify().kind == "sound"
    assert f"is damaged: cut off, 20000 bytes of {length}; it is written again" in caplog.text
    assert (opened.results / "line.nc.damaged").stat().st_size == 20_000


def test_a_file_that_another_program_has_locked(opened):
    path = opened.results / "line.nc"
    with open(path, "rb") as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        assert opened.status()["state"] == "unreadable"
        for wanted in (opened.run, opened.open):
            with pytest.raises(study.StudyError, match="is open for writing in another program, which has locked it"):
                wanted()
    assert opened.run().computed == 0


@pytest.mark.parametrize("opening", [1, 2], ids=["as they are looked at", "as their statuses are read"])
def test_results_removed_just_as_they_are_opened(opened, monkeypatch, opening):
    """netCDF finds nothing where there was a file a moment before: what is left is the blocks."""
    openings, really = [], netCDF4.Dataset

    def removed(path, mode):
        openings.append(mode)
        if len(openings) == opening:
            path.unlink()
        return really(path, mode)

    monkeypatch.setattr(netCDF4, "Dataset", removed)
    state = opened.status()
    assert (state["state"], state["counts"], len(openings)) == ("partial", {0: 23}, opening)


def test_a_pipe_among_the_blocks_is_passed_by(file):
    opened = load(file)
    blocks = opened.results / ".line.blocks"
    blocks.mkdir(parents=True)
    os.mkfifo(blocks / "0.block")
    assert opened.status()["counts"] == {127: 23}
    assert opened.run(workers=1).computed == 23
    assert opened.clean()[0].startswith(f"{blocks}: nothing to remove"), "no pipe is removed"


def test_full_disk_while_a_small_dataset_is_written(tmp_path):
    """Such as that of the trade-off; nothing is left of it."""
    _, most = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (8000, most))
        with pytest.raises(OSError, match=r"small.nc cannot be written \(NetCDF: HDF error\): is the disk full\?"):
            numbers, path = np.random.default_rng(1).random(5000), tmp_path / "small.nc"
            write(xr.Dataset({"a": ("x", numbers)}, attrs={"study_digest": "1"}), path, examine(path))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, most))
    assert not list(tmp_path.iterdir())


def test_eight_threads_at_once():
    """They solve, run, open, read lazily and ask for the state of studies; a crash ends the process by a signal."""
    command = [sys.executable, str(ROOT / "tools/fuzz/stress_threads.py"), "3"]
    found = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(ROOT)})
    assert (found.returncode, found.stdout.strip()) == (0, ""), found.stderr
