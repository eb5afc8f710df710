"""What is read as a table of one's own: regular files of a table's size, and none that a results file names."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr
from test_own_table import CASE, table  # noqa: F401

import study
from solver import laws
from solver.laws import own_table
from study.inputs.lexicon import lexicon_in

PATIENCE = 120  # seconds: a file without an end, or a pipe without a writer, is never read to its end


def refused(name: str) -> str:
    """The message about a table that cannot be used."""
    with pytest.raises(study.StudyError) as error:
        study.solve(P=1e-5, **CASE, micro=f"table:{name}")
    (message,) = error.value.messages
    assert message.startswith(f"solve: micro: {name}: "), message
    return message.removeprefix(f"solve: micro: {name}: ")


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="POSIX devices")
def test_devices_pipes_and_folders_are_refused(table):  # noqa: F811
    """/dev/zero took all memory, and a pipe was waited for."""
    table()
    os.mkfifo("pipe")
    Path("folder.csv").mkdir()
    Path("link.csv").symlink_to("/dev/zero")
    names = ("/dev/zero", "pipe", "link.csv", "/dev/null", "/dev/stdin")
    script = f"""
import study
for name in {names}:
    try:
        study.solve(P=1e-5, base="half_space", micro="table:" + name)
    except ValueError as error:
        print(error)
"""
    command = [sys.executable, "-c", script]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    said = subprocess.run(command, **pipes, timeout=PATIENCE, text=True).stdout.splitlines()
    for line, name in zip(said, names, strict=True):
        assert f"{name}: is not a file but a pipe or device: a table is a text file of numbers" in line
    assert refused("folder.csv") == "is not a file but a folder: a table is a text file of numbers"
    Path("to_mine.csv").symlink_to("mine.csv")
    assert study.solve(P=1e-5, **CASE, micro="table:to_mine.csv").status == 0


def test_a_study_file_cannot_name_a_device_either(table):  # noqa: F811
    Path("s.toml").write_text('[model]\nbase = "half_space"\nP = 1e-5\nmicro = "table:/dev/zero"\n', encoding="utf-8")
    with pytest.raises(study.StudyError, match=r"^s.toml: micro: /dev/zero: is not a file but a pipe or device"):
        study.load("s.toml")


@pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="files of /proc")
def test_files_of_the_system_are_as_empty_as_they_say(table):  # noqa: F811
    """They have 0 bytes, and some of them have no end."""
    table("")
    assert refused("mine.csv") == refused("/proc/self/environ")


def test_large_files_are_refused_by_their_size(table, monkeypatch):  # noqa: F811
    with open("large.csv", "wb") as file:
        file.truncate(3_000_000_000)  # without a block on disk
    assert refused("large.csv") == "has 3000000000 bytes: must have at most 10000000, some 100,000 rows"
    name, size = table(), Path("mine.csv").stat().st_size
    monkeypatch.setattr(own_table, "LARGEST", size)
    assert study.solve(P=1e-5, **CASE, micro=name).status == 0, "as large as the largest"
    monkeypatch.setattr(own_table, "LARGEST", size - 1)
    assert refused("mine.csv").startswith(f"has {size} bytes: must have at most")


def test_a_file_that_becomes_a_pipe_is_not_waited_for(table, monkeypatch):  # noqa: F811
    table()
    os.mkfifo("pipe")
    monkeypatch.setattr(Path, "stat", lambda self, **_: os.stat("mine.csv"))
    assert refused("pipe").startswith("is not a file but a pipe or device")


def test_a_home_that_is_not_there_and_a_cell_without_an_end(table):  # noqa: F811
    """Both were tracebacks."""
    assert "home directory" in refused("~nobody_of_this_name/mine.csv")
    table("p,A,lam,p_max\n" + "1" * 200_000)
    assert refused("mine.csv").startswith("field larger than field limit")


def test_opening_results_reads_no_table(table):  # noqa: F811
    """Neither that of a file of ours, nor what another file says: it could name any file of the reader."""
    name = table()
    study.Study(study.api.read(_study(name)), Path("results")).run()
    others = xr.open_dataset("results/s.nc").load().drop_attrs(deep=False)
    lines = [laws.identity(own_table.read(name)), "table:/dev/zero 0", "table:pipe 0"]
    lines.append(f"table:{Path('mine.csv').absolute()} 0")
    others.assign_attrs(micro_laws="\n".join(lines)).to_netcdf("others.nc")
    os.mkfifo("pipe")
    for file in ("results/s.nc", "others.nc"):
        found = study.open_results(file)
        assert found.status == 0 and lexicon_in(found).known.is_package
        assert "table:mine.csv" in str(study.summary(found)), "and its words are as they were"


def _study(name: str) -> Path:
    file = Path("s.toml")
    file.write_text(f'[model]\nh = 0.02\nn = 0.5\nP = 1e-5\nmicro = "{name}"\n', encoding="utf-8")
    return file
