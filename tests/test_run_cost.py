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
