"""Several runs of one study at once: who waits, who computes, who writes the results; without processes or luck."""

import io
import shutil

import pytest
from line_study import leftovers, load, store_block

from study.files import lock
from study.files.lock import lock_file
from study.store import blocks
from study.store.block_file import read_block
from study.store.blocks import put
from study.store.windows import Store
from study.work import cases
from study.work import run as running

WHOLE = {"state": "done", "cases": 23, "counts": {0: 23}, "reason": ""}


@pytest.fixture
def opened(file):
    return load(file)


def folder_of(opened):
    return Store(opened.definition, opened.results).folder


def state(opened) -> dict:
    return {name: value for name, value in opened.status().items() if name != "path"}


def once(monkeypatch, name: str, before) -> None:
    """Call `before` with the arguments of the first call of a function of study.run, then the function."""
    real = getattr(running, name)

    def function(*arguments, **options):
        monkeypatch.setattr(running, name, real)
        before(*arguments, **options)
        return real(*arguments, **options)

    monkeypatch.setattr(running, name, function)


@pytest.mark.parametrize("other", ["ends the work", "is killed"])
def test_who_waited_goes_on_with_what_is_there(opened, monkeypatch, computed, other):
    first, raw, said = lock_file(Store(opened.definition, opened.results).lock), io.BytesIO(), []
    first.__enter__()

    def end(_):
        said.append(raw.getvalue())
        first.__exit__(None, None, None)
        store_block(opened, 0, 5)
        if other == "ends the work":
            opened.run()
        computed.clear()

    real = running.say_waiting
    monkeypatch.setattr(running, "say_waiting", lambda order: real(order) or end(order))
    report = opened.run(workers=1, stream=io.TextIOWrapper(raw, write_through=False))
    assert said == [b"line: waiting for another run of this study to end\n"], "at once"
    assert report.complete and state(opened) == WHOLE
    assert (report.computed, report.counts) == ((0, {}) if other == "ends the work" else (18, {0: 23}))
    assert 0 not in computed and leftovers(opened.results) == []


def test_who_waits_says_so_only_to_somebody(opened):
    running.say_waiting(running.Order(opened.definition, opened.results))


def test_parts_do_not_wait_for_each_other_and_leave_each_others_files_alone(opened, monkeypatch):
    monkeypatch.setattr(running, "say_waiting", lambda _: pytest.fail("waits"))
    with lock_file(Store(opened.definition, opened.results).lock, shared=True):
        written = folder_of(opened) / ".half.tmp"
        written.touch()
        report = opened.run(part=(1, 2))
        assert written.exists()
    assert not report.complete and report.computed == 13
    assert opened.run(part=(2, 2)).complete and leftovers(opened.results) == []


def test_a_part_that_ends_while_another_computes_leaves_the_results_to_it(opened):
    with lock_file(Store(opened.definition, opened.results).lock, shared=True):
        assert opened.run(part=(1, 2)).computed == 13
        report = opened.run(part=(2, 2))
        assert (report.computed, report.complete, report.path.exists()) == (10, True, False)
    assert opened.run().computed == 0
    assert state(opened) == WHOLE and leftovers(opened.results) == []


def test_the_last_part_finds_that_another_has_written_the_results(opened, monkeypatch):
    def last(_, report):
        assert not report.complete
        assert opened.run(part=(1, 2)).complete

    once(monkeypatch, "_export_if_last", last)
    report = opened.run(part=(2, 2))
    assert report.complete and report.computed == 10
    assert state(opened) == WHOLE and leftovers(opened.results) == []


def test_failures_of_a_part_are_in_the_report_of_the_last(opened, monkeypatch):
    real = cases.compute
    monkeypatch.setattr(cases, "compute", lambda wanted: real(wanted) if wanted.first != 5 else 1 / 0)
    report = opened.run(part=(2, 2))
    assert report.failures == {0: "cases 5 to 9: ZeroDivisionError: division by zero"}
    assert (report.computed, report.counts, report.complete) == (5, {0: 5, 127: 18}, False)


def test_without_locks_the_second_computes_the_same_again(opened, monkeypatch):
    monkeypatch.setattr(lock, "fcntl", None)
    once(monkeypatch, "add", lambda *_: opened.run())
    report = opened.run(workers=1)
    assert report.complete and report.computed == 23 and state(opened) == WHOLE
    assert leftovers(opened.results) == []


def test_blocks_removed_by_somebody_else_end_the_run(opened, monkeypatch):
    once(monkeypatch, "add", lambda *_: shutil.rmtree(folder_of(opened)))
    with pytest.raises(FileNotFoundError):
        opened.run(workers=1)
    assert opened.run().complete


def test_a_block_that_vanishes_while_it_is_looked_for_is_missing(opened, monkeypatch):
    store_block(opened, 0, 5)
    with monkeypatch.context() as patched:
        patched.setattr(blocks, "read_block", lambda path: path.with_name("gone").read_bytes())
        assert opened.status()["counts"] == {127: 23}
    assert opened.status()["counts"] == {0: 5, 127: 18}


def test_a_block_written_twice_is_one_file(opened):
    path = store_block(opened, 0, 5)
    assert put(Store(opened.definition, opened.results), read_block(path)) == path
    assert list(folder_of(opened).glob("*.block")) == [path]
