"""Where memory is short there is one message, nothing is called damaged, and nothing is computed again for it."""

import re

import numpy as np
import pytest
import xarray as xr
from line_study import load, store_block

from study.__main__ import main
from study.files import access, netcdf
from study.files.examine import examine
from study.files.results_file import write
from study.store.windows import Store
from study.work import cases


def no_memory(*_, **__):
    raise np._core._exceptions._ArrayMemoryError((10**9,), np.dtype(float))


SAID = "there is not enough memory (Unable to allocate 7.45 GiB for an array with shape (1000000000,) and data type"


@pytest.fixture
def line(file):
    found = load(file)
    found.run(workers=1)
    return found


@pytest.mark.parametrize("command", ["run", "status", "clean"])
def test_a_block_is_not_damaged(file, line, monkeypatch, capsys, command):
    (line.results / "line.nc").unlink()
    before = sorted(path.name for path in Store(line.definition, line.results).folder.iterdir())
    with monkeypatch.context() as patched:
        patched.setattr("study.store.block_file.np.load", no_memory)
        assert main([command, str(file), "--results", str(line.results)]) == 1
        said = capsys.readouterr().err
        assert said.startswith(f"{file}: {SAID}") and said.count("\n") == 1, said
    assert sorted(path.name for path in Store(line.definition, line.results).folder.iterdir()) == before
    assert line.run().computed == 0


@pytest.mark.parametrize("command", ["run", "status", "verify", "table", "plot --x P --y a"])
def test_a_results_file_is_not_damaged(file, line, monkeypatch, capsys, command):
    monkeypatch.chdir(file.parent)
    words = [*command.split(), "line.toml"]
    with monkeypatch.context() as patched:
        patched.setattr(netcdf.File, "read", no_memory)
        patched.setattr("study.files.results_file.read", no_memory)
        assert main(words) == 1
        said = capsys.readouterr().err
        assert said.startswith(f"line.toml: {SAID}") and said.count("\n") == 1, said
    assert main(words) == 0 and not list(line.results.glob("*.damaged"))


@pytest.mark.parametrize("reading", [True, False], ids=["read", "opened"])
def test_an_error_of_hdf5_is_no_damage_where_the_file_is_whole_and_memory_short(line, monkeypatch, reading):
    def fails(*_):
        raise RuntimeError("NetCDF: HDF error") if reading else OSError(-101, "NetCDF: HDF error")

    monkeypatch.setattr(access, "NEEDED", 1 << 62)
    monkeypatch.setattr(netcdf, "_attributes" if reading else "locked", fails if reading else netcdf.locked)
    if not reading:
        monkeypatch.setattr("netCDF4.Dataset", fails)
    with pytest.raises(MemoryError, match=re.escape(str(line.results / "line.nc"))):
        line.verify()
    monkeypatch.setattr(access, "NEEDED", 1)
    assert line.verify().kind == "damaged", "of a file that is whole, but HDF5 cannot take"


def test_a_want_of_memory_is_no_full_disk(tmp_path, monkeypatch):
    def fails(*_):
        raise RuntimeError("NetCDF: HDF error")

    dataset, path = xr.Dataset({"a": ("x", np.ones(5))}, attrs={"study_digest": "1"}), tmp_path / "small.nc"

    def written(self, *_):
        with self._access():
            fails()

    monkeypatch.setattr(netcdf.File, "write", written)
    monkeypatch.setattr(access, "NEEDED", 1 << 62)
    with pytest.raises(MemoryError, match=r"small.nc cannot be written: NetCDF: HDF error"):
        write(dataset, path, examine(path))
    monkeypatch.setattr(access, "NEEDED", 1)
    with pytest.raises(OSError, match=r"small.nc cannot be written \(NetCDF: HDF error\)$"):
        write(dataset, path, examine(path))
    assert not list(tmp_path.iterdir())


def test_a_block_that_takes_too_much_says_how_to_take_less(file, monkeypatch, capsys):
    monkeypatch.setattr(cases, "compute", no_memory)
    assert main(["run", str(file), "--workers", "1", "--results", str(file.parent / "there")]) == 1
    said = capsys.readouterr().err
    assert "MemoryError: Unable to allocate 7.45 GiB" in said and "_ArrayMemoryError" not in said
    assert "a smaller `block` of [numerics] takes less" in said


def refused(path):
    raise PermissionError(13, "Permission denied", str(path))


def test_a_block_that_cannot_be_read_now_is_kept_by_clean(file, monkeypatch):
    line = load(file)
    store_block(line, 0, 5)
    folder = Store(line.definition, line.results).folder
    monkeypatch.setattr("study.store.blocks.read_block", refused)
    line.clean()
    assert len(list(folder.glob("*.block"))) == 1
