"""The power is cut at every moment at which a run waits for the disk. What had reached the disk is kept, and the next
run ends in the results of an undisturbed one, to the last bit."""

import os
import stat
from pathlib import Path

import pytest

import study
from study.files.results_file import numbers_digest
from study.inputs.reading import from_tables
from study.store import windows
from study.work import run as running

TABLES = {
    "model": {"n": 0.5, "Ra": 0.004, "base": "thin_layer", "Nbar": 250000},
    "axes": {"P": [1e-5, 3e-5, 2e-5], "h": [0.01, 0.02, 0.03, 0.05, 0.07], "bonding": ["frictionless", "bonded"]},
    "numerics": {"block": 4},
    "output": {"x": 4},
}
CASES = 30
#: Cases from which a study has many windows, of ten and five cases here; and seconds for which blocks are in memory.
KINDS = {"one window": (1000, 0.0), "windows": (20, float("inf")), "windows with blocks": (20, 0.0)}


class Disk:
    """What is on the disk under a folder when the power is cut.

    cuts : for each moment two sets of files, path -> bytes

    A disk may write names late or early. In the first set are the names that were flushed with their folders; in the
    second those that programs see, renamed or removed a moment ago. Files have their bytes if these were flushed, else
    none.
    """

    def __init__(self, folder: Path):
        self.folder, self.flushed, self.names, self.cuts = folder, {}, {folder: {}}, []

    def fsync(self, file: int) -> None:
        """`os.fsync` on this disk; the power may be cut before it."""
        self.cut()
        what = os.fstat(file)
        if stat.S_ISDIR(what.st_mode):
            folder = next(path for path in (self.folder, *self.folder.rglob("*")) if path.stat().st_ino == what.st_ino)
            self.names[folder] = {path: None if path.is_dir() else self._bytes(path) for path in folder.iterdir()}
        else:
            self.flushed[what.st_ino] = os.pread(file, what.st_size, 0)

    def cut(self) -> None:
        """Note what is on the disk if the power is cut now."""
        self.cuts += [self._late(self.folder), self._early()]

    def _bytes(self, path: Path) -> bytes:
        content = path.read_bytes()  # another file may have had this number of the file system
        return content if self.flushed.get(path.stat().st_ino) == content else b""

    def _late(self, folder: Path) -> dict[Path, bytes]:
        files = {}
        for path, content in self.names.get(folder, {}).items():
            files |= self._late(path) if content is None else {path: content}
        return files

    def _early(self) -> dict[Path, bytes]:
        return {path: self._bytes(path) for path in self.folder.rglob("*") if path.is_file()}

    def put_back(self, files: dict[Path, bytes], folder: Path) -> None:
        """Make a folder in which these files are."""
        for path, content in files.items():
            place = folder / path.relative_to(self.folder)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(content)


def written(folder: Path) -> study.Study:
    folder.mkdir(exist_ok=True)
    return study.Study(from_tables(TABLES, "cut", "text", "cut.toml"), folder)


def present(opened: study.Study) -> int:
    """How many cases are on the disk."""
    return CASES - opened.status()["counts"].get(127, 0)


@pytest.mark.parametrize("kind", KINDS)
def test_the_power_is_cut(tmp_path, monkeypatch, kind):
    many, brief = KINDS[kind]
    monkeypatch.setattr(windows, "CASES", many)
    monkeypatch.setattr(windows, "usual_block", lambda grid: 10)
    monkeypatch.setattr(windows, "BLOCKS", 1)
    monkeypatch.setattr(running, "BRIEF", brief)
    disk = Disk(tmp_path / "disk")
    with monkeypatch.context() as patched:
        patched.setattr(os, "fsync", disk.fsync)
        undisturbed = written(disk.folder).run(workers=1)
    disk.cut()
    digest, before = numbers_digest(undisturbed.path), [0, 0]
    for moment, files in enumerate(disk.cuts):
        again = written(tmp_path / str(moment))
        disk.put_back(files, again.results)
        there = present(again)
        assert there >= before[moment % 2], "nothing that was on the disk is lost"
        before[moment % 2] = there
        report = again.run(workers=1)
        assert report.complete and report.computed == CASES - there
        assert numbers_digest(report.path) == digest and again.verify().kind == "sound"
        assert there == CASES or not [*again.results.rglob("*.tmp")], "a run that has nothing to do removes nothing"
    assert before == [CASES, CASES]
    print(f"{kind}: the power was cut {len(disk.cuts)} times")
