"""Blocks stay, whatever becomes of the study file; `clean` removes those that hold no case of it."""

import pytest
import xarray as xr
from line_study import load, store_block
from same import assert_same_numbers

import study
from study.__main__ import main
from study.files.lock import lock_file
from study.store import windows
from study.store.block_file import Damaged, read_block
from study.store.blocks import forget_other_exports, gather, inventory, lost_cases, note_export
from study.store.windows import Store
from study.work import plan

FEWER = {"P = {start = 1e-6, stop = 1e-4, num = 23}": "P = [1e-6, 1e-4]"}
OTHERS = {"num = 23": "num = 31"}


def blocks(opened) -> list:
    return sorted(opened.results.glob(".line.blocks/*.block"))


def test_an_edit_there_and_back_computes_nothing_again(file, computed):
    opened = load(file)
    for start in (0, 5, 10):
        store_block(opened, start, start + 5)
    before = blocks(opened)
    assert load(file, **FEWER).run().computed == 1, "of the two ends one is in a block"
    assert {*before} < {*blocks(opened)} and load(file, **FEWER).run().counts == {}
    computed.clear()
    again = load(file)
    assert again.run().computed == 7 and again.run().counts == {}


def test_clean_removes_what_does_not_serve_and_says_it(file, capsys):
    opened = load(file)
    store_block(opened, 0, 5)
    store_block(load(file, **OTHERS), 5, 12)
    folder = opened.results / ".line.blocks"
    (folder / "0.block").write_bytes(b"x")
    (folder / "1.block").write_bytes(b"x")
    (folder / "mine.txt").touch()
    (folder / ".0.block.01234567.tmp").touch()
    opened, command = load(file), ["clean", str(file), "--results", str(opened.results)]
    assert main(command) == main(command) == 0
    assert capsys.readouterr().out.splitlines() == [
        f"{folder}: removed 1 block of 7 cases, 2 damaged blocks; the study needs the other 1 block",
        f"{folder}: nothing to remove; the study needs the other 1 block",
    ]
    assert (folder / "mine.txt").exists() and not list(folder.glob("*.tmp"))
    assert opened.run().computed == 18
    data, there = (opened.results / "line.nc").read_bytes(), blocks(opened)
    store_block(load(file, **OTHERS), 5, 12)
    load(file)
    assert main(command) == 0 and blocks(opened) == there
    assert (opened.results / "line.nc").read_bytes() == data
    assert capsys.readouterr().out == f"{folder}: removed 1 block of 7 cases; the study needs the other 5 blocks\n"


def test_clean_of_nothing(file):
    opened = load(file)
    assert opened.clean() == [f"{opened.results}/.line.blocks: is not there, nothing to remove"]


def test_clean_waits_for_no_run_and_disturbs_none(file):
    path = store_block(load(file, **OTHERS), 5, 12)
    opened = load(file)
    with lock_file(Store(opened.definition, opened.results).lock), pytest.raises(ValueError, match="study is going on"):
        opened.clean()
    assert path.exists()


def test_a_run_that_is_refused_leaves_nothing(file, monkeypatch):
    """Neither the folder of the blocks nor that of the results."""
    opened = load(file)
    with monkeypatch.context() as patched:
        patched.setattr(plan, "LARGE", 10)
        with pytest.raises(study.StudyError, match="--yes computes them"):
            opened.run()
    assert not opened.results.exists()
    opened.results.mkdir()
    xr.Dataset({"a": 1.0}).to_netcdf(opened.results / "line.nc")
    for part in ((1, 1), (1, 2)):
        with pytest.raises(study.StudyError, match="of another program"):
            opened.run(part=part)
        assert [path.name for path in opened.results.iterdir()] == ["line.nc"]


def test_a_block_under_the_name_of_another_changes_no_number(file, tmp_path):
    """Its cases are those of its keys, and the block whose name it has is written beside it."""
    opened = load(file)
    opened.run()
    expected = opened.open()
    (opened.results / "line.nc").unlink()
    first, second = store_block(opened, 0, 5), store_block(opened, 5, 10)
    second.replace(first)
    report = opened.run(workers=1)
    assert report.computed == 5
    assert_same_numbers(opened.open(), expected)


def test_a_block_that_becomes_another_is_noticed_when_it_is_read(file):
    opened = load(file)
    store = Store(opened.definition, opened.results)
    first, second = store_block(opened, 0, 5), store_block(opened, 5, 10)
    known = inventory(store)
    second.replace(first)
    assert len(read_block(first).keys) == 5
    with pytest.raises(Damaged, match="now holds other cases"):
        gather(store, known, 0, 5)


def test_the_record_of_an_export_says_which_of_its_cases_would_be_lost(file):
    """It is written before the results file is replaced, so after a kill there may be two."""
    two = load(file, **{"P = {start = 1e-6, stop = 1e-4, num = 23}": "P = [1e-6, 1e-4, 3e-4]"})
    some, two = (Store(opened.definition, opened.results) for opened in (load(file), two))
    some.folder.mkdir(parents=True)
    (first, second), known = (store.definition.digest for store in (some, two)), inventory(some)
    assert lost_cases(some, first) is None
    note_export(some, known)
    note_export(two, inventory(two))
    assert lost_cases(some, first) == (0, 23) and lost_cases(some, second) == (1, 3)
    assert lost_cases(two, first) == (21, 23)
    forget_other_exports(two)
    assert lost_cases(some, first) is None and lost_cases(two, second) == (0, 3)
    two.record(second).write_bytes(b"damaged")
    assert lost_cases(two, second) is None


def test_of_a_large_study_blocks_that_no_part_needs_are_removed(file, monkeypatch):
    """They are of parts that are there, since a run was killed before it removed them, and of another study."""
    monkeypatch.setattr(windows, "CASES", 10)
    monkeypatch.setattr(windows, "usual_block", lambda grid: 12)
    monkeypatch.setattr(windows, "BLOCKS", 1)
    opened = load(file)
    first, second = windows.windows_of(Store(opened.definition, opened.results))
    opened.run(part=(2, 2))
    folder = opened.results / ".line.blocks"
    names = [f"{window.prefix}0123.block" for window in (first, second)]
    names += ["000000000000-0123456789abcdef-0123.block", "0123.block"]
    for name in names:
        (folder / name).touch()
    kept = f"{opened.results / 'line'}: the study is kept in parts, which stay; "
    kept += f"it is so large that no block is looked for in {folder}"
    assert opened.clean() == [kept, f"{folder}: removed 2 blocks that no part needs"] and opened.clean() == [kept]
    assert [path.name for path in blocks(opened)] == [names[0], names[3]]
    with lock_file(Store(opened.definition, opened.results).lock), pytest.raises(ValueError, match="study is going on"):
        opened.clean()
