"""Blocks are removed when the results file holds all that is in them; the rest is said, kept, removed by `clean`."""

from types import SimpleNamespace

import pytest
import xarray as xr
from line_study import leftovers, load, store_block
from same import assert_same_numbers

import study
from study.__main__ import main
from study.files.lock import held
from study.store import tidy as tidying
from study.store.block_file import Damaged, read_block
from study.store.blocks import Store, gather, inventory
from study.work import plan

FEWER = {"P = {start = 1e-6, stop = 1e-4, num = 23}": "P = [1e-6, 1e-4]"}


def blocks(opened) -> list:
    return sorted(opened.results.glob(".line.blocks/*.block"))


def test_finishing_an_edited_study_keeps_what_it_does_not_contain(file, computed):
    opened = load(file)
    for start in (0, 5, 10):
        store_block(opened, start, start + 5)
    before = blocks(opened)
    fewer = load(file, **FEWER)
    report = fewer.run()
    assert report.computed == 1, "of the two ends one is in a block"
    assert (
        report.kept
        == f"{opened.results}/.line.blocks keeps what is not in it: 3 blocks of 15 cases; `clean` removes the blocks"
    )
    assert blocks(opened) == before and fewer.run().kept == report.kept
    computed.clear()
    again = load(file)
    assert again.run().computed == 7 and again.run().kept == ""
    assert not (opened.results / ".line.blocks").exists()


def test_digits_and_points_that_the_results_do_not_hold_are_kept(file):
    for changes in ({"x = 3": "x = 5"}, {"x = 3": "x = 3\ndtype = 'float32'"}, {"x = 3": "profiles = false"}):
        store_block(load(file), 0, 5)
        other = load(file, **changes)
        assert "1 block of 5 cases" in other.run().kept
        (other.results / "line.nc").unlink()
        assert load(file).status()["counts"] == {0: 5, 127: 18}


def test_clean_removes_what_does_not_serve_and_says_it(file, capsys):
    opened = load(file)
    store_block(opened, 0, 5)
    store_block(load(file, **{"num = 23": "num = 31"}), 5, 12)
    (opened.results / ".line.blocks" / "0.block").write_bytes(b"x")
    (opened.results / ".line.blocks" / "mine.txt").touch()
    load(file)
    command = ["clean", str(file), "--results", str(opened.results)]
    assert main(command) == 0
    assert capsys.readouterr().out.splitlines() == [
        f"{opened.results}/.line.blocks: removed 1 block of 7 cases, 1 damaged block",
        f"{opened.results}/.line.blocks: kept 1 block of 5 cases, 1 other file; `run` goes on from there",
    ]
    assert opened.run().computed == 18
    data = (opened.results / "line.nc").read_bytes()
    (opened.results / ".line.blocks" / "mine.txt").unlink()
    store_block(load(file, **{"num = 23": "num = 31"}), 5, 12)
    load(file)
    assert main(command) == 0 and not (opened.results / ".line.blocks").exists()
    assert (opened.results / "line.nc").read_bytes() == data
    assert capsys.readouterr().out == f"{opened.results}/.line.blocks: removed 1 block of 7 cases\n"
    assert main(command) == 0 and "nothing to remove" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("cases", "others", "rest"),
    [
        ([1], 0, "1 block of 1 case; `clean` removes the block"),
        ([5], 0, "1 block of 5 cases; `clean` removes the block"),
        ([1, 1], 0, "2 blocks of 2 cases; `clean` removes the blocks"),
        ([-1], 0, "1 damaged block; `clean` removes the block"),
        ([2, -1], 0, "1 block of 2 cases, 1 damaged block; `clean` removes the blocks"),
        ([-1, -1], 1, "2 damaged blocks, 1 other file; `clean` removes the blocks"),
        ([], 1, "1 other file"),
        ([], 2, "2 other files"),
    ],
)
def test_one_and_several_that_are_kept(file, monkeypatch, cases, others, rest):
    """And `clean` is named for blocks alone: other files it leaves where they are."""
    store = Store(load(file).definition, file.parent / "results")
    paths = [store.folder / f"{number}.block" for number in range(len(cases))]
    known = SimpleNamespace(blocks=dict(zip(paths, cases, strict=True)), covered=set())
    monkeypatch.setattr(tidying, "_rest", lambda _: [*paths, *(store.folder / f"{i}.txt" for i in range(others))])
    assert tidying.tidy(store, known) == f"{store.folder} keeps what is not in it: {rest}"


def test_clean_waits_for_no_run_and_disturbs_none(file):
    opened = load(file)
    path = store_block(load(file, **{"num = 23": "num = 31"}), 5, 12)
    opened = load(file)
    lock = Store(opened.definition, opened.results).lock
    with held(lock), pytest.raises(ValueError, match="a run of this study is going on"):
        opened.clean()
    assert path.exists()


@pytest.mark.usefixtures("read_in_a_fork")
def test_a_run_that_is_refused_leaves_nothing(file, monkeypatch):
    """Neither the folder of the blocks nor that of the results, and it takes nothing from another run."""
    opened = load(file)
    with monkeypatch.context() as patched:
        patched.setattr(plan, "LARGE", 10)
        with pytest.raises(study.StudyError, match="--yes computes them"):
            opened.run()
    with pytest.raises(study.StudyError, match="--scheduler nowhere"):
        opened.run(scheduler="nowhere")
    assert not opened.results.exists()
    opened.results.mkdir()
    xr.Dataset({"a": 1.0}).to_netcdf(opened.results / "line.nc")
    for part in ((1, 1), (1, 2)):
        with pytest.raises(study.StudyError, match="of another program"):
            opened.run(part=part)
        assert leftovers(opened.results) == []
    store = Store(opened.definition, opened.results)
    with held(store.lock, shared=True):
        tidying.withdraw(store, [store.folder])
        assert leftovers(opened.results) == [".line.blocks", "lock"]


def test_a_block_under_the_name_of_another_changes_no_number(file, tmp_path):
    """Its cases are those of its keys, and the block whose name it has is written beside it."""
    opened = load(file)
    opened.run()
    expected = opened.open()
    (opened.results / "line.nc").unlink()
    first, second = store_block(opened, 0, 5), store_block(opened, 5, 10)
    second.replace(first)
    report = opened.run(workers=1)
    assert report.computed == 18 and report.kept == ""
    assert_same_numbers(opened.open(), expected)


def test_a_block_that_becomes_another_is_noticed_when_it_is_read(file):
    opened = load(file)
    store = Store(opened.definition, opened.results)
    first, second = store_block(opened, 0, 5), store_block(opened, 5, 10)
    known = inventory(store)
    second.replace(first)
    assert len(read_block(first).keys) == 5
    with pytest.raises(Damaged, match="has become a block of other cases"):
        gather(store, known, 0, 5)
