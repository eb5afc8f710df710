"""Results files that can be verified: damage is noticed, never given out as right, and the file is written again."""

import os
import shutil
import subprocess
import sys

import netCDF4
import numpy as np
import pytest
from conftest import ROOT
from line_study import load
from same import assert_same

import study
from study.__main__ import main
from study.files import results_file
from study.files.examine import ATTRIBUTE, FORMER, Sums, contents, examine
from study.files.netcdf import File

ONE = '[model]\nmicro = "smooth"\nbase = "thin_layer"\nP = 1e-5\nh = 0.02\nn = 0.5\n[output]\nx = 3\n'
BYTES = "is damaged: its bytes are not those that were written"
CHANGED = "is damaged, or another program has changed it: its numbers are not those that were written"


@pytest.fixture(scope="module")
def one(tmp_path_factory) -> study.Study:
    """A study of one case: its numbers are scalars, which netCDF stores without a checksum."""
    folder = tmp_path_factory.mktemp("one")
    (folder / "one.toml").write_text(ONE, encoding="utf-8")
    found = study.load(folder / "one.toml", folder / "results")
    found.run()
    return found


@pytest.fixture
def opened(one, tmp_path) -> study.Study:
    """A copy to damage."""
    shutil.copytree(one.results, tmp_path / "results")
    shutil.copy(one.results.parent / "one.toml", tmp_path)
    return study.Study(one.definition, tmp_path / "results")


def flip(path, number: float, byte: int = 6) -> None:
    """One bit of the only such number in a file: 0.02 becomes 0.0161."""
    old, data = np.array(number, "<f8").tobytes(), path.read_bytes()
    assert data.count(old) == 1
    path.write_bytes(data.replace(old, old[:byte] + bytes([old[byte] ^ 4]) + old[byte + 1 :]))


@pytest.mark.parametrize("name", ["h", "a"])
def test_one_flipped_bit_is_noticed_and_mended(one, opened, name, tmp_path, capsys, caplog):
    path = opened.results / "one.nc"
    flip(path, one.open()[name].item())
    command = [str(tmp_path / "one.toml"), "--results", str(opened.results)]
    assert main(["verify", *command]) == main(["verify", str(path)]) == 1
    assert capsys.readouterr().err == f"{path}: {BYTES}\n" * 2
    for read in (opened.open, lambda: study.open_results(path)):
        with pytest.raises(study.StudyError, match=f"{path}: {BYTES}"):
            read()
    assert main(["status", *command]) == 0
    assert capsys.readouterr().out.endswith(f"  damaged  \n    {path}: {BYTES}\n")
    damaged = path.read_bytes()
    assert opened.run().computed == 0, "the numbers are in the block"
    assert f"{path}: {BYTES}; it is written again, {path}.damaged keeps it" in caplog.text
    assert_same(opened.open(), one.open())
    assert (opened.results / "one.nc.damaged").read_bytes() == damaged
    assert opened.verify().kind == "sound" and opened.run().counts == {}


def number(file) -> None:
    file["a"][...] = 2 * file["a"][...]


def coordinate(file) -> None:
    file["h"][...] = 0.03


def text(file) -> None:
    file["bonding"][0] = b"F"


def fill_value_of_a_number(file) -> None:
    file["a"].missing_value = file["a"][...]


def name(file) -> None:
    file.renameVariable("p0", "p_max_0")


def dimension(file) -> None:
    file.renameDimension("x", "r")


def title(file) -> None:
    file.title = "another"


def more(file) -> None:
    file.createVariable("mine", "f8", ())[...] = 1.0


CHANGES = [number, coordinate, text, fill_value_of_a_number, name, dimension, title, more]


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__)
def test_what_another_program_changes_is_noticed_by_the_digest(one, opened, change):
    """All is as netCDF writes it, with the checksums of netCDF and no seal."""
    path = opened.results / "one.nc"
    with netCDF4.Dataset(path, "a") as file:
        file.set_auto_chartostring(False)
        change(file)
    assert examine(path).reason == CHANGED
    with pytest.raises(study.StudyError, match=CHANGED):
        study.open_results(path)
    assert opened.run().computed == 0 and opened.verify().kind == "sound"
    assert_same(opened.open(), one.open())


def test_who_computed_it_and_when_is_not_in_the_digest(one, opened):
    """So two runs of one study have the same."""
    path = opened.results / "one.nc"
    with netCDF4.Dataset(path, "a") as file:
        file.history, file.created = "ncatted", "yesterday"
    assert opened.verify().kind == "sound"
    path.unlink()
    opened.run()
    assert results_file.numbers_digest(path) == results_file.numbers_digest(one.results / "one.nc")


def test_a_missing_file_is_written_again(one, opened):
    (opened.results / "one.nc").unlink()
    report = opened.run()
    assert report.complete and report.computed == 0
    assert_same(opened.open(), one.open())


def test_a_file_of_an_earlier_version_is_used_but_cannot_be_verified(one, opened, capsys):
    """It has no digest, and its cases are not in blocks. It is not written anew."""
    path = opened.results / "one.nc"
    shutil.rmtree(opened.results / ".one.blocks")
    with netCDF4.Dataset(path, "a") as file:
        file.delncattr(ATTRIBUTE)
        file.setncattr(FORMER, "@title 0123\n=checksums 4567\n")
    before = path.read_bytes()
    assert main(["verify", str(path)]) == 1
    assert "xarray or an earlier version wrote it, without a digest to compare" in capsys.readouterr().out
    assert opened.status()["state"] == "done" and opened.run().counts == {}
    assert path.read_bytes() == before and FORMER not in opened.open().attrs
    assert_same(opened.open(), one.open())


def test_exit_codes_of_verify(opened, tmp_path, capsys):
    assert main(["verify", str(opened.results / "one.nc")]) == 0
    assert capsys.readouterr().out.endswith("one.nc: verified: every number is as it was written\n")
    assert main(["verify", str(tmp_path / "none.nc")]) == 2
    assert main(["verify", str(opened.results / "one.nc"), str(tmp_path / "one.toml"), "--results", "none"]) == 2


def test_lazily_read_chunks_are_verified_and_the_file_is_named(file, monkeypatch):
    """By netCDF. The digest of a large file is left to `verify`."""
    monkeypatch.setattr("study.store.writer.CHUNK", 5)
    line = load(file)
    line.run()
    flip(line.results / "line.nc", line.open().p.values[7, 1], byte=3)
    assert line.verify().kind == "damaged"
    monkeypatch.setattr("study.store.window_files.LAZY", 0)
    monkeypatch.setattr(results_file, "LAZY", 0)
    for found in (line.open(), study.open_results(line.results / "line.nc")):
        with pytest.raises(study.StudyError, match=r"line.nc: is damaged: a part of it cannot be read \(NetCDF: HDF"):
            found.p.compute()
        assert found.p.isel(P=slice(10, 23)).compute().notnull().all()


def test_the_digest_stays_in_the_file(opened, tmp_path):
    found = opened.open()
    found.isel(x=[0, 2]).to_netcdf(tmp_path / "part.nc")
    assert ATTRIBUTE not in found.attrs
    assert examine(tmp_path / "part.nc").kind == "unverified"


def test_digests_do_not_depend_on_the_pieces(opened):
    numbers, found = np.arange(22.0).reshape(11, 2), set()
    with File(opened.results / "one.nc") as file:
        for pieces in ([11], [4, 4, 3], [1, 2, 8], [3, 3, 3, 2]):
            sums = Sums()
            for piece in np.split(numbers, np.cumsum(pieces)[:-1]):
                sums.add("p", piece)
            found.add(sums.digest(file))
    assert len(found) == 1


def test_a_damaged_file_behind_a_symbolic_link_is_kept_and_mended_there(one, opened, tmp_path):
    path, there = opened.results / "one.nc", tmp_path / "disk" / "large.nc"
    there.parent.mkdir()
    path.rename(there)
    path.symlink_to(there)
    flip(there, one.open().a.item())
    damaged = there.read_bytes()
    (there.parent / ".large.nc.01234567.tmp").touch()  # of a run that was killed
    opened.run()
    assert path.is_symlink() and sorted(os.listdir(there.parent)) == ["large.nc", "large.nc.damaged"]
    assert (there.parent / "large.nc.damaged").read_bytes() == damaged
    assert_same(opened.open(), one.open())


def test_a_sample_of_random_flips():
    """The whole of it is `make fuzz`."""
    command = [sys.executable, "-W", "ignore", str(ROOT / "tools/fuzz/fuzz_files.py"), "20", "3"]
    found = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(ROOT)})
    assert found.returncode == 0, found.stdout + found.stderr
    assert "0 faults in 20 flips" in found.stdout and "'damaged'" in found.stdout and "'block'" in found.stdout


def test_the_order_in_which_a_file_has_them_does_not_count(tmp_path):
    """Variables and attributes may change places when another program copies a file."""
    digests = []
    for names in (("a", "b"), ("b", "a")):
        with netCDF4.Dataset(tmp_path / f"{names[0]}.nc", "w") as file:
            file.createDimension("n", 3)
            for name in names:
                variable = file.createVariable(name, "f8", ("n",))
                variable[:] = [1.0, 2.0, 3.0]
                variable.setncatts(dict.fromkeys(names, name))
            file.setncatts(dict.fromkeys(names, "text"))
        with File(tmp_path / f"{names[0]}.nc") as opened:
            digests.append(contents(opened))
    assert digests[0] == digests[1]
