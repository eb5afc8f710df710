"""A file that comes to the place of the results while they are computed stays; the blocks keep what is computed."""

import os
from pathlib import Path

import pytest
from line_study import load, present

import study
from study.figures import registry
from study.figures.figure_results import results
from study.files.seal import seal
from study.studies.evidence import tradeoff
from study.work import cases

STAYS = "appeared or changed while its results were computed, and is left as it is: move it away, and the same "
STAYS += "command writes"


def during(monkeypatch, action) -> None:
    """Do something while the last block of the line is computed."""
    real = cases.compute

    def compute(wanted):
        if wanted.last > 20:
            action()
        return real(wanted)

    monkeypatch.setattr(cases, "compute", compute)


def at_the_end(monkeypatch, action) -> None:
    """Do something when the file is complete, just before it gets its place."""
    monkeypatch.setattr("study.store.writer.seal", lambda path: (seal(path), action()))


def refused(opened: study.Study, **options) -> None:
    """A run says that another file has its place."""
    with pytest.raises(study.StudyError) as caught:
        opened.run(**options)
    (message,) = caught.value.messages
    assert caught.value.code == 1 and message == f"{opened.results / 'line.nc'}: {STAYS} them"
    assert present(opened) == 23 and not list(opened.results.rglob("*.tmp"))


def another(path: Path) -> None:
    """Results of another study of the same name."""
    other = path.parents[1] / "elsewhere"
    other.mkdir(exist_ok=True)
    (other / "line.toml").write_text("[model]\nmicro = 'smooth'\nbase = 'half_space'\nP = 3e-6\n")
    study.load(other / "line.toml", other).run()
    os.rename(other / "line.nc", path)


APPEAR = {
    "text": lambda path: path.write_text("precious"),
    "results": another,
    "folder": lambda path: (path.mkdir(), (path / "precious").touch()),
    "pipe": os.mkfifo,
    "link to nothing": lambda path: path.symlink_to("nowhere.nc"),
    "link to a file": lambda path: (path.with_name("far").write_text("precious"), path.symlink_to("far")),
}


def shape(path: Path) -> tuple:
    """What is at a path, without opening it."""
    found = path.lstat()
    return found.st_ino, found.st_mode, found.st_size, found.st_mtime_ns


@pytest.mark.parametrize("what", APPEAR)
def test_what_appears_during_a_run_stays(file, monkeypatch, what):
    opened = load(file)
    path, before = opened.results / "line.nc", []
    with monkeypatch.context() as patched:
        # a link to nothing that comes before the writing begins is followed, as one that was there
        when = at_the_end if what == "link to nothing" else during
        when(patched, lambda: (APPEAR[what](path), before.append(shape(path))))
        refused(opened)
    assert shape(path) == before[0], "it is as it was"
    os.rename(path, path.with_name("aside"))
    report = opened.run()
    assert report.complete and report.computed == 0, "the blocks have stayed"
    assert (opened.open().status == 0).all()


def test_a_file_that_changes_during_a_run_stays(file, monkeypatch):
    """One that the run would replace, since its cases are in the study."""
    load(file, **{"num = 23": "num = 2"}).run()
    opened = load(file)
    path = opened.results / "line.nc"
    with monkeypatch.context() as patched:
        at_the_end(patched, lambda: os.utime(path))
        refused(opened)
    assert study.open_results(path).sizes["P"] == 2
    with monkeypatch.context() as patched:
        at_the_end(patched, lambda: os.chmod(path, 0o600))
        assert opened.run().complete, "what is in it is the same"
    assert opened.open().sizes["P"] == 23


def test_results_that_are_removed_during_a_run_are_written(file, monkeypatch):
    load(file, **{"num = 23": "num = 3"}).run()
    opened = load(file)
    with monkeypatch.context() as patched:
        at_the_end(patched, (opened.results / "line.nc").unlink)
        assert opened.run().complete and opened.status()["state"] == "done"


def test_the_same_results_by_another_run_are_no_harm(file, monkeypatch):
    """Of a file system without locks."""
    opened = load(file)

    def elsewhere():
        monkeypatch.undo()
        other = study.Study(opened.definition, opened.results.with_name("other"))
        other.run()
        os.rename(other.results / "line.nc", opened.results / "line.nc")

    during(monkeypatch, elsewhere)
    assert opened.run().complete and opened.status()["state"] == "done"


def test_the_last_part_looks_again_too(file, monkeypatch):
    opened = load(file)
    path = opened.results / "line.nc"
    opened.run(part=(1, 2))
    at_the_end(monkeypatch, lambda: path.write_text("precious"))
    refused(opened, part=(2, 2))
    assert path.read_text(encoding="utf-8") == "precious"


def test_measurements_of_the_trade_off_do_not_replace_what_appears(tmp_path, monkeypatch):
    path = tmp_path / "tradeoff.nc"
    few = tradeoff.measure(2, ways={"auto": tradeoff.WAYS["auto"]})
    made = registry.entry("measured", "tradeoff")._replace(measure=lambda: path.write_text("precious") and few)
    monkeypatch.setitem(registry.REGISTERS[""]["measured"], "tradeoff", made)
    with pytest.raises(study.StudyError, match=r"tradeoff.nc: appeared or changed .* and is left as it is"):
        results("tradeoff", tmp_path)
    assert path.read_text(encoding="utf-8") == "precious"
