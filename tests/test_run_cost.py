"""What a run would cost: asked before, and near the truth."""

import time

import numpy as np
import pytest
from line_study import load, store_block

import study
from study import blocks, order
from study.blocks import parcel
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


def test_estimated_time_is_of_the_order_of_the_run(file):
    opened = load(file, **{"num = 23": "num = 20000", "block = 5": "block = 2000"})
    cost = opened.dry_run(workers=1)
    begun = time.perf_counter()
    blocks.compute(parcel(opened.definition, np.arange(20000)))
    assert 0.02 < cost.seconds / (time.perf_counter() - begun) < 50
