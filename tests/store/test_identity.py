"""What is in a part, a block or a results file decides whether it counts, not its name: copied, swapped and foreign
files are noticed by every command. Large is 40 cases here."""

import os
import shutil
from dataclasses import replace

import netCDF4
import numpy as np
import pytest
import xarray as xr
from test_parts import PLAIN, UNITS, files, small, written

import study
from study.__main__ import main
from study.figures.registry import open_studies
from study.files.examine import ATTRIBUTE, FORMER, contents
from study.files.netcdf import File
from study.files.parts_folder import FIRST
from study.files.results_file import numbers_digest
from study.files.seal import seal
from study.store import windows
from study.store.block_file import read_block, write_block
from study.store.blocks import gather, inventory, lost_cases
from study.store.windows import Store

__all__ = ["small"]  # the fixture: parts of twenty and ten cases, by turns
TOML = """
[model]
R = "5 mm"
E1 = "2 GPa"
E2 = "200 GPa"
micro = "smooth"
bonding = "bonded"
[axes]
h = ["30 um", "10 um", "20 um", "15 um"]
P = {start = "1 mN", stop = "1 N", num = 15, spacing = "log"}
[output]
profiles = false
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The folder of the four parts of a study, "mine", beside its study file."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(TOML, encoding="utf-8")
    study.load("mine.toml").run(workers=1)
    return tmp_path / "results" / "mine"


def names(folder) -> list[str]:
    return sorted(path.name for path in folder.glob("*.nc"))


def copy(folder) -> None:
    first, second, *_ = names(folder)
    shutil.copy(folder / first, folder / second)


def swap(folder) -> None:
    first, second, *_ = names(folder)
    os.rename(folder / first, folder / "aside")
    os.rename(folder / second, folder / first)
    os.rename(folder / "aside", folder / second)


def part_of_another(folder) -> None:
    """Of the same size, of another study."""
    text = TOML.replace("2 GPa", "3 GPa", 1)
    (folder.parent.parent / "other.toml").write_text(text, encoding="utf-8")
    study.load("other.toml", "elsewhere").run(workers=1)
    other = folder.parent.parent / "elsewhere" / "other"
    shutil.copy(other / names(other)[1], folder / names(folder)[1])


def without_first_case(folder) -> None:
    """As an earlier version wrote them, and swapped."""
    as_before(folder)
    swap(folder)


def as_before(folder) -> None:
    for name in names(folder):
        data = xr.load_dataset(folder / name)
        assert data.attrs.pop(FIRST) is not None
        with netCDF4.Dataset(folder / name, "a") as file:
            file.delncattr(FIRST)
            file.delncattr(ATTRIBUTE)
        with File(folder / name) as file:
            digest = contents(file)
        with netCDF4.Dataset(folder / name, "a") as file:
            file.setncattr(ATTRIBUTE, digest)
        seal(folder / name)


@pytest.mark.parametrize("spoil", [copy, swap, part_of_another, without_first_case], ids=lambda spoil: spoil.__name__)
def test_a_part_with_other_cases_is_no_part(folder, spoil, capsys, caplog):
    right = study.load("mine.toml").open().load()
    spoil(folder)
    large = study.load("mine.toml")
    assert large.status()["state"] == "partial" and large.status()["counts"][127] >= 15 and large.status()["reason"]
    assert large.verify().kind == "misplaced"
    assert main(["verify", "mine.toml"]) == 1 and "verified" not in "".join(capsys.readouterr())
    with pytest.raises(study.StudyError, match="these cases|another definition|first_case"):
        large.open()
    if spoil is not without_first_case:  # then each has its own coordinates, in another order
        with pytest.raises(study.StudyError, match="than its name says"):
            study.open_results(folder)
    report = large.run(workers=1)
    assert report.computed >= 15 and report.complete and "it is computed again" in caplog.text
    xr.testing.assert_equal(large.open().load(), right)
    assert large.verify().kind == "sound" and list(folder.glob("*.misplaced"))
    assert main(["status", "mine.toml"]) == 0 and " done " in capsys.readouterr().out


def test_parts_of_an_earlier_version_are_known_by_their_coordinates(folder):
    right = study.load("mine.toml").open().load()
    as_before(folder)
    large = study.load("mine.toml")
    assert large.status()["state"] == "done" and large.verify().kind == "sound" and large.run().computed == 0
    for found in (large.open(), study.open_results(folder)):
        xr.testing.assert_identical(found.load(), right)


def test_a_copied_part_is_told_by_its_path_too(folder, capsys):
    path = folder / names(folder)[1]
    assert main(["verify", str(path)]) == 0
    copy(folder)
    assert main(["verify", str(path)]) == 1
    assert "holds other cases than its name says" in capsys.readouterr().err


@pytest.mark.parametrize("tables", [PLAIN, UNITS], ids=["plain", "units"])
def test_every_two_parts_that_are_swapped_are_noticed(tmp_path, tables):
    large = written(tmp_path, tables)
    large.run(workers=1)
    paths = [tmp_path / "big" / name for name in files(tmp_path)]
    for i, path in enumerate(paths):
        for other in paths[:i]:
            kept = path.read_bytes()
            shutil.copy(other, path)
            assert large.status()["state"] == "partial" and large.verify().path == path
            path.write_bytes(kept)
    assert large.status()["state"] == "done"


def pipe(path) -> None:
    os.mkfifo(path)


def directory(path) -> None:
    path.mkdir()


@pytest.mark.parametrize("make", [pipe, directory], ids=lambda make: make.__name__)
@pytest.mark.parametrize("besides", [False, True], ids=["in its place", "besides"])
def test_what_is_no_file_among_the_parts_is_said_and_left(folder, make, besides, capsys):
    path = folder / (names(folder)[1] if not besides else "more.nc")
    path.unlink(missing_ok=True)
    make(path)
    commands = ["run", "mine.toml"], ["run", "--force", "mine.toml"], ["verify", "mine.toml"], ["table", "mine.toml"]
    for command in (*commands, ["plot", "mine.toml", "--x", "P", "--y", "a"]):
        assert main(command) in (1, 2), command
        assert path.name in capsys.readouterr().err
    assert main(["status", "mine.toml"]) == 0 and path.name in capsys.readouterr().out
    with pytest.raises(study.StudyError, match=path.name):
        study.open_results(folder)
    assert path.exists() and not path.is_file()


def test_a_file_of_another_program_besides_is_named_and_never_removed(folder, capsys):
    path = folder / "000000000001-notes.nc"
    xr.Dataset({"mine": 1.0}).to_netcdf(path)
    before = path.read_bytes()
    for command in (["run"], ["run", "--force"], ["verify"], ["table"], ["plot", "--x", "P", "--y", "a"]):
        assert main([*command, "mine.toml"]) in (1, 2)
        assert path.name in capsys.readouterr().err
    with pytest.raises(study.StudyError, match="notes.nc: is a netCDF file of another program|notes.nc: is not a part"):
        study.open_results(folder)
    assert path.read_bytes() == before
    path.unlink()
    assert main(["run", "mine.toml"]) == 0 and "nothing to do" in capsys.readouterr().out


def test_nothing_is_written_where_nothing_is_to_do(folder, monkeypatch):
    monkeypatch.setattr("study.work.run.check_writable", lambda path: 1 / 0)
    monkeypatch.setattr("study.work.run.lock_file", lambda *_, **__: 1 / 0)
    assert study.load("mine.toml").run().counts == {}


def test_a_copied_part_is_no_results_file(folder):
    """It has the digest of the whole study."""
    shutil.copy(folder / names(folder)[0], folder.parent / "mine.nc")
    assert study.load("mine.toml").status()["state"] == "done", "in parts as before"
    assert study.load("mine.toml").open().status.size == 60


def test_the_digest_of_a_folder_changes_with_its_parts(folder):
    before = numbers_digest(folder)
    swap(folder)
    assert numbers_digest(folder) != before


@pytest.fixture
def line(tmp_path, monkeypatch):
    """A study whose results are one file."""
    monkeypatch.setattr(windows, "CASES", 1000)
    monkeypatch.chdir(tmp_path)
    for name, modulus in (("mine", "2 GPa"), ("other", "3 GPa")):
        text = TOML.replace("2 GPa", modulus, 1) + "[numerics]\nblock = 20\n"
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
        study.load(f"{name}.toml").run(workers=1)
    return study.load("mine.toml")


def test_results_of_another_study_are_not_verified(line, capsys):
    shutil.copy("results/other.nc", "results/mine.nc")
    assert line.verify().kind == "outdated" and line.status()["state"] == "outdated"
    assert main(["verify", "mine.toml"]) == 1
    assert "nothing is damaged, but it holds results of another definition" in capsys.readouterr().err
    assert main(["verify", "results/mine.nc"]) == 0
    assert "it holds results of the study other" in capsys.readouterr().out
    with pytest.raises(study.StudyError, match="another definition"):
        line.open()


@pytest.mark.parametrize("dim", ["h", "P"])
def test_cases_in_another_order_are_not_those_of_the_study(line, dim):
    data = xr.load_dataset("results/mine.nc")
    del data.attrs[ATTRIBUTE]
    data.attrs.pop(FORMER, None)
    data.isel({dim: slice(None, None, -1)}).to_netcdf("results/mine.nc")
    assert line.verify().kind == line.status()["state"] == "foreign"
    for act in (line.open, line.run):
        with pytest.raises(study.StudyError, match=f"its values of {dim} are not those of these cases"):
            act()


def test_blocks_under_other_names_count_by_their_keys(line):
    right, store = line.open(), Store(line.definition, line.results)
    first, second, third = sorted(store.folder.glob("*.block"))
    os.rename(first, store.folder / "aside")
    os.rename(second, first)
    os.rename(store.folder / "aside", second)
    shutil.copy(first, third)
    os.unlink("results/mine.nc")
    assert line.run(workers=1).computed == len(read_block(first).keys)
    xr.testing.assert_equal(line.open(), right)


def test_a_block_that_becomes_another_meanwhile_is_not_read(line):
    store = Store(line.definition, line.results)
    stock = inventory(store)
    path = stock.sources[0].path
    block = read_block(path)
    for changed in ({"facts": block.facts | {"x": [0.0]}}, {"keys": block.keys[::-1]}, {"arrays": {}}):
        stock.sources[0].__dict__.update(facts=block.facts, keys=block.keys, columns=[*block.arrays])
        write_block(path, replace(block, **changed))
        with pytest.raises(OSError, match="now holds other cases"):
            gather(store, stock, 0, 60)


def test_a_copied_record_protects_no_other_cases(line):
    mine, other = Store(line.definition, line.results), study.load("other.toml")
    assert lost_cases(mine, line.definition.digest) == (0, 60)
    theirs = mine.record(other.definition.digest)
    shutil.copy(mine.record(line.definition.digest), theirs)
    assert lost_cases(mine, other.definition.digest) is None


def test_a_figure_is_not_drawn_of_the_results_of_another_study(line):
    shutil.copy("results/other.nc", "results/mine.nc")
    with pytest.raises(study.StudyError, match="holds results of the study other"):
        open_studies("a figure", ("mine",), "results")
    np.testing.assert_equal(open_studies("a figure", ("other",), "results")[0].sizes["h"], 4)
