"""What a run would cost: asked before, and near the truth."""

import numpy as np
import pytest
from line_study import load, store_block

import study
from study import blocks, estimate, order
from study.cluster import available_workers
from study.estimate import WORKER


def test_a_large_study_asks_first(file, monkeypatch, computed):
    monkeypatch.setattr(order, "LARGE", 400)
    opened = load(file)
    with pytest.raises(
        study.StudyError, match=r"^line: 23 cases: about \d+ s, at most .* on disk; --yes computes them$"
    ):
        opened.run()
    assert not opened.results.joinpath("line.nc").exists() and computed == [], "nothing but a sample is computed"
    assert opened.run(yes=True).computed == 23


def test_what_is_large_is_more_than_so_many_numbers(file, monkeypatch):
    opened = load(file)
    monkeypatch.setattr(order, "LARGE", opened.definition.numbers - 1)
    with pytest.raises(study.StudyError, match="--yes computes them"):
        opened.run()
    monkeypatch.setattr(order, "LARGE", opened.definition.numbers)
    assert opened.run().complete


def test_a_large_study_is_told_the_cost_with_its_workers(file, monkeypatch):
    asked, real = [], order.estimate
    monkeypatch.setattr(order, "LARGE", 1)
    monkeypatch.setattr(order, "estimate", lambda *given: asked.append(given[1]) or real(*given))
    with pytest.raises(study.StudyError):
        load(file).run(workers=7)
    assert asked == [7]


def test_cost_in_words():
    cost = estimate.Estimate(cases=9, present=1, seconds=125.4, memory=5.1e8, size=6.66e8)
    assert estimate.describe(cost) == "about 2 min 5 s, at most 0.51 GB of memory, 0.67 GB on disk"


def test_dry_run_says_what_is_there_and_writes_nothing(file):
    opened = load(file)
    cost = opened.dry_run()
    assert (cost.cases, cost.present) == (23, 0) and cost.seconds > 0
    assert cost.size == 8 * 23 * (16 + 2 * 3) and cost.memory > cost.size
    assert not opened.results.exists()
    store_block(opened, 0, 5)
    assert opened.dry_run().present == 5
    opened.run()
    before = sorted(opened.results.rglob("*"))
    cost = opened.dry_run()
    assert (cost.present, cost.seconds) == (23, 0.0)
    assert load(file, **{"num = 23": "num = 45"}).dry_run().present == 23
    assert sorted(opened.results.rglob("*")) == before


def test_estimated_memory_counts_worker_processes(file):
    opened = load(file, **{"num = 23": "num = 40"})  # eight blocks
    alone, two = (opened.dry_run(workers=count).memory for count in (1, 2))
    assert two - alone > 2 * WORKER


def test_estimated_memory_grows_with_the_blocks_under_way(file):
    """Of each worker 4 wait and one is solved, which takes 5 times as much: 9 blocks of 5 cases of 22 numbers."""
    one, two, longer, longest, half = (
        load(file, **changes).dry_run(workers=workers).memory
        for workers, changes in (
            (1, {}),
            (2, {}),
            (1, {"block = 5": "block = 23"}),
            (1, {"block = 5": "block = 1000"}),
            (1, {"x = 3": 'x = 3\ndtype = "float32"'}),
        )
    )
    of_five = 9 * 8 * 22 * 5
    assert two - one == pytest.approx(of_five) and longer - one == pytest.approx(of_five / 5 * 18)
    assert longest == longer, "there are 23 cases"
    assert one - half == pytest.approx((of_five + 3 * 8 * 22 * 23) / 2), "the results, three times, and the blocks"


def test_estimated_memory_does_not_grow_with_the_results_beyond_a_window(file):
    studies = (load(file, **{"num = 23": f"num = {num}"}) for num in (600_000, 700_000))
    few, many = (estimate.estimate(opened.definition, 1) for opened in studies)
    assert many.size - few.size == 8 * 22 * 100_000
    assert many.memory - few.memory == pytest.approx(100 * 100_000), "bytes for the key of a case, and to find it"


@pytest.fixture
def clock(monkeypatch) -> list[float]:
    """A clock on which a case takes 2 ms, and whatever is done for the first time 50 s more."""
    now, real = [0.0], blocks.compute

    def compute(wanted):
        now[0] += 0.002 * (wanted.last - wanted.first + 1) if now[0] else 50
        return real(wanted)

    monkeypatch.setattr(estimate, "compute", compute)
    monkeypatch.setattr(estimate.time, "perf_counter", lambda: now[0])
    return now


@pytest.mark.parametrize(("workers", "seconds"), [(1, 0.036), (3, 0.012)])
def test_estimated_time_is_that_of_the_missing_cases_on_all_workers(file, clock, workers, seconds):
    opened = load(file)
    store_block(opened, 0, 5)
    assert opened.dry_run(workers=workers).seconds == pytest.approx(seconds, rel=1e-12)
    assert opened.dry_run().seconds == pytest.approx(0.036 / available_workers(), rel=1e-12)


def test_the_sample_is_spread_over_the_study(file, monkeypatch):
    taken, real = [], blocks.compute
    monkeypatch.setattr(estimate, "compute", lambda wanted: taken.append(wanted) or real(wanted))
    load(file, **{"num = 23": "num = 20000", "block = 5": "block = 2000"}).dry_run()
    for wanted in taken:
        assert (wanted.first, wanted.last, len(wanted.parameters["P"])) == (0, 19999, 256)
        assert np.median(wanted.parameters["P"]) == pytest.approx(5.05e-5, rel=0.01)  # of the range 1e-6 to 1e-4
