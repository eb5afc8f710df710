"""Running a study: blocks, resume, interruption, failures."""

import tempfile
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from children import wait_for
from hypothesis import given, settings
from hypothesis import strategies as st
from line_study import COUNT, ending, leftovers, load, store_block
from same import assert_same_numbers

import study
from study.data.dataset import DatasetParts
from study.inputs.reading import from_tables
from study.store.windows import Store
from study.work import cases
from study.work import run as running


def as_solved(dataset):
    """The dataset with its numerical settings as attributes, as `study.solve` has them."""
    variables, coords = (
        {name: dataset.variables[name] for name in part} for part in (dataset.data_vars, dataset.coords)
    )
    return DatasetParts(variables, coords, dataset.attrs).settings_as_attributes().dataset()


@pytest.mark.parametrize("workers", [1, 2, 5])
@pytest.mark.parametrize("block", [1, 4, 23, 1000])
def test_blocks_and_workers_do_not_change_the_answer(file, block, workers):
    opened = load(file, **{"block = 5": f"block = {block}"})
    report = opened.run(workers=workers)
    assert (report.cases, report.computed, report.failures, report.counts) == (23, 23, {}, {0: 23})
    whole = study.solve(P=np.linspace(1e-6, 1e-4, 23), micro="smooth", base="half_space", x=3)
    xr.testing.assert_allclose(as_solved(opened.open()), whole, rtol=1e-12, atol=0)  # closed forms
    assert leftovers(opened.results) == []


def test_rerun_computes_nothing(file, computed):
    opened = load(file)
    opened.run()
    before = (opened.results / "line.nc").read_bytes()
    assert len(computed) == COUNT
    assert load(file).run().computed == 0
    assert len(computed) == COUNT
    assert (opened.results / "line.nc").read_bytes() == before


@pytest.mark.parametrize("workers", [1, 2])
def test_interrupted_run_computes_only_the_missing_blocks(file, computed, monkeypatch, quiet, workers):
    opened = load(file)
    real, stored = running.add, []

    def interrupted(store, known, index, arrays):
        if len(stored) == 2:
            raise KeyboardInterrupt
        stored.append(index[0] // 5)
        real(store, known, index, arrays)

    monkeypatch.setattr(running, "add", interrupted)
    with pytest.raises(KeyboardInterrupt):
        opened.run(workers=workers)
    done = sum(len(range(i * 5, min(i * 5 + 5, 23))) for i in stored)
    expected = {"state": "partial", "cases": 23, "counts": {0: done, 127: 23 - done}, "path": None, "reason": ""}
    assert opened.status() | {"path": None} == expected
    wait_for(quiet)
    part = opened.open(partial=True)
    assert int((part.status == 127).sum()) == 23 - done
    assert (part.status.values == 127).tolist() == part.a.isnull().values.tolist()
    monkeypatch.setattr(running, "add", real)
    computed.clear()
    report = opened.run(workers=workers)
    assert sorted(computed) == [5 * i for i in range(COUNT) if i not in stored]
    assert report.computed == 23 - int((part.status != 127).sum())
    assert opened.status()["state"] == "done"
    assert (opened.open().status == 0).all()


def test_blocks_on_disk_serve_another_block_size(file, computed):
    opened = load(file)
    store_block(opened, 0, 5)
    computed.clear()
    other = load(file, **{"block = 5": "block = 9"})
    assert other.definition.digest == opened.definition.digest
    assert other.run().computed == 18
    assert computed == [5, 14]
    assert (other.open().status == 0).all()
    assert opened.status()["state"] == "done"


def test_failing_block_costs_that_block_only(file, monkeypatch, caplog):
    caplog.set_level("DEBUG", "study.work.run")
    real = cases.compute

    def compute(wanted):
        if wanted.first == 10:
            raise ZeroDivisionError("on purpose")
        return real(wanted)

    opened = load(file)
    monkeypatch.setattr(cases, "compute", compute)
    litter = Store(opened.definition, opened.results).folder / ".line.nc.killed.tmp"
    litter.parent.mkdir(parents=True)
    litter.touch()
    report = opened.run(workers=2)
    assert not litter.exists()
    assert report.failures == {2: "cases 10 to 14: ZeroDivisionError: on purpose"}
    assert "block 2: Traceback" in caplog.text and 'raise ZeroDivisionError("on purpose")' in caplog.text
    assert report.computed == 18
    assert report.counts == {0: 18, 127: 5}
    assert not report.path.exists()
    assert not report.complete
    assert np.flatnonzero(opened.open(partial=True).status == 127).tolist() == [10, 11, 12, 13, 14]
    with pytest.raises(study.StudyError, match="does not exist; run the study first"):
        opened.open()
    monkeypatch.setattr(cases, "compute", real)
    assert opened.run().computed == 5


AXES = {"P": [1e-6, 3e-6, 5e-6, 9e-6], "h": [0.001, 0.002, 0.003], "nu1": [0.2, 0.3], "bonding": ["bonded"]}
MODEL = {"micro": "smooth", "n": 0.5, "base": "thin_layer"}


@cache
def solved_whole() -> xr.Dataset:
    return study.solve(**AXES, **MODEL, x=3)


@settings(max_examples=15, deadline=None)
@given(data=st.data())
def test_random_blocks_orders_workers_and_parts_give_the_same_dataset(data):
    shuffled = {name: data.draw(st.permutations(AXES[name])) for name in data.draw(st.permutations(list(AXES)))}
    tables = {"model": MODEL, "axes": shuffled, "numerics": {"block": data.draw(st.integers(1, 30))}}
    tables |= {"output": {"x": 3}}
    parts, workers = data.draw(st.integers(1, 4)), data.draw(st.integers(1, 3))
    with tempfile.TemporaryDirectory() as folder:
        opened = study.Study(from_tables(tables, "random", "", "random"), Path(folder))
        for part in data.draw(st.permutations(range(parts))):
            report = opened.run(workers=workers, part=(part + 1, parts))
        assert report.complete and leftovers(Path(folder)) == ["random.nc"]
        found = as_solved(opened.open())
    whole = solved_whole()
    assert_same_numbers(found.sel({name: whole[name] for name in AXES}).transpose(*whole.dims), whole)


@pytest.mark.parametrize("ended", [True, False])
def test_retry_computes_the_cases_of_a_status_again(file, monkeypatch, ended):
    opened = load(file)
    with monkeypatch.context() as patched:
        ending(patched, {6: 3})
        opened.run(workers=1, fail_fast=not ended)
    assert opened.status()["state"] == ("done" if ended else "partial")
    assert opened.status()["counts"][3] == 1
    if ended:
        assert opened.run(retry=(1, 2)).counts == {}, "no case has this status"
    missing = opened.status()["counts"].get(127, 0)
    report = opened.run(retry=(3, 2))
    assert (report.computed, report.counts, report.complete) == (missing + 1, {0: 23}, True)
    whole = study.solve(P=np.linspace(1e-6, 1e-4, 23), micro="smooth", base="half_space", x=3)
    assert_same_numbers(as_solved(opened.open()), whole)
    assert opened.run(retry=(3,)).counts == {}, "nothing to do"


def test_a_block_size_of_one_part_does_not_change_which_cases_it_has(file):
    whole = np.arange(23)
    shares = [np.concatenate([*cases.blocks_of(whole, 5, (i, 3)), []]) for i in (1, 2, 3)]
    assert sorted(np.concatenate(shares).tolist()) == whole.tolist()
    later = np.concatenate(cases.blocks_of(whole[whole % 2 == 0], 5, (2, 3)))
    assert set(later) == {case for case in shares[1] if case % 2 == 0}
    assert [len(block) for block in cases.blocks_of(whole, 5)] == [5, 5, 5, 5, 3]


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ({"part": (0, 2)}, r"part = \(0, 2\): must be \(I, N\), whole numbers with 1 <= I <= N"),
        ({"part": (3, 2)}, r"part = \(3, 2\): must be"),
        ({"part": "1/2"}, 'part = "1/2": must be'),
        ({"retry": ("iteration_limit",)}, "must be a tuple of values of status"),
        ({"workers": 2.5}, "workers = 2.5: must be a whole number, 1 or more"),
        ({"workers": 0}, "workers = 0: must be"),
    ],
)
def test_options_that_mean_nothing_are_refused(file, option, message):
    """A part that is none computed nothing, without a word, and the names of statuses were tried by nobody."""
    with pytest.raises(study.StudyError, match=message):
        load(file).run(**option)


def test_a_progress_that_is_none_is_refused_where_nothing_is_left_to_compute(file):
    """Before anything is looked at: the same call means the same, whatever is on disk."""
    load(file).run()
    with pytest.raises(study.StudyError, match=r'progress = "yes": must be True, False or None'):
        load(file).run(progress="yes")
