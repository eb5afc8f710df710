"""Files that are either whole or not there."""

import os
import stat

import pytest

from study.files.atomic import make_folder, remove_temporary, replacing


def test_the_file_is_flushed_and_then_renamed(tmp_path, monkeypatch):
    """A power cut after a rename that reached the disk before the data would leave an empty file."""
    path, steps = tmp_path / "file", []
    path.write_text("old", encoding="utf-8")
    fsync, rename = os.fsync, os.replace

    def flushed(file):
        folder = stat.S_ISDIR(os.fstat(file).st_mode)
        assert folder or path.read_text(encoding="utf-8") == "old" and os.fstat(file).st_size == 3
        steps.append(os.fstat(file).st_ino)
        fsync(file)

    def renamed(source, target):
        steps.append(os.stat(source).st_ino)
        rename(source, target)

    monkeypatch.setattr(os, "fsync", flushed)
    monkeypatch.setattr(os, "replace", renamed)
    with replacing(path) as temporary:
        temporary.write_text("new", encoding="utf-8")
        assert temporary.parent == tmp_path and temporary.name.startswith(".file.")
    assert steps == [path.stat().st_ino] * 2 + [tmp_path.stat().st_ino], "the file, its new name, the folder of names"
    assert path.read_text(encoding="utf-8") == "new" and os.listdir(tmp_path) == ["file"]


@pytest.mark.parametrize("failure", [ValueError, KeyboardInterrupt, GeneratorExit])
def test_a_failure_leaves_what_was_there(tmp_path, failure):
    path = tmp_path / "file"
    for before in ([], ["file"]):
        with pytest.raises(failure), replacing(path) as temporary:
            temporary.write_text("half", encoding="utf-8")
            raise failure
        assert os.listdir(tmp_path) == before
        path.write_text("old", encoding="utf-8")
    with pytest.raises(failure), replacing(path):
        raise failure  # before anything is written
    assert path.read_text(encoding="utf-8") == "old"


def test_nothing_is_renamed_from_where_a_link_leads(tmp_path):
    """A folder of blocks that leads to a faster disk: results could not be renamed to their place at the end."""
    (tmp_path / "disk").mkdir()
    (tmp_path / "link").symlink_to("disk")
    with replacing(tmp_path / "file", tmp_path / "link") as temporary:
        assert temporary.parent == tmp_path
        temporary.touch()


def test_two_writers_have_temporary_files_of_their_own(tmp_path):
    """In the folder that was asked for."""
    folder = tmp_path / "folder"
    folder.mkdir()
    with replacing(tmp_path / "file", folder) as first, replacing(tmp_path / "file", folder) as second:
        assert first != second and first.parent == second.parent == folder
        first.write_text("first", encoding="utf-8")
        second.write_text("second", encoding="utf-8")
    assert (tmp_path / "file").read_text(encoding="utf-8") == "first", "the last to end"
    assert os.listdir(folder) == []


def test_the_names_of_new_folders_are_flushed(tmp_path, monkeypatch):
    flushed, real = [], os.fsync
    monkeypatch.setattr(os, "fsync", lambda file: flushed.append(os.fstat(file).st_ino) or real(file))
    make_folder(tmp_path / "results" / "blocks")
    assert set(flushed) == {tmp_path.stat().st_ino, (tmp_path / "results").stat().st_ino}
    make_folder(tmp_path / "results" / "blocks")
    assert len(flushed) == 2, "nothing is new"


def test_what_killed_writers_left_is_found_beside_what_a_link_leads_to(tmp_path):
    """And nothing else is removed."""
    disk = tmp_path / "disk"
    disk.mkdir()
    (tmp_path / "f[1].nc").symlink_to(disk / "large.nc")
    with pytest.raises(SystemExit), replacing(tmp_path / "f[1].nc") as temporary:
        assert temporary.parent == disk
        temporary.touch()
        os.link(temporary, disk / ".large.nc.01234567.tmp")
        raise SystemExit
    for name in (".other.nc.01234567.tmp", ".large.nc.mine.tmp", "large.nc"):
        (disk / name).touch()
    remove_temporary(tmp_path / "f[1].nc")
    assert sorted(os.listdir(disk)) == [".large.nc.mine.tmp", ".other.nc.01234567.tmp", "large.nc"]
