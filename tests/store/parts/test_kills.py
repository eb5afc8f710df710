"""A study in many windows is killed forty times, at random moments. Nothing that was on the disk is lost, and it ends
in the results of an undisturbed run, to the last bit."""

import os
import random
import time
from pathlib import Path

import pytest
from children import PATIENCE, computed_in, note, started, wait_for

import study
from study.files.results_file import numbers_digest
from study.inputs.reading import from_tables
from study.store import windows
from study.work import cases, engine
from study.work import run as running

CASES, WINDOW, BLOCK, KILLS = 1200, 40, 10, 40
SLOW = 0.004  # seconds that a block takes at least
TABLES = {
    "model": {"n": 0.5, "Ra": 0.004, "base": "thin_layer", "Nbar": 250000},
    "axes": {"P": {"start": 1e-6, "stop": 1e-4, "num": 40}, "h": {"start": 0.01, "stop": 0.07, "num": 30}},
    "numerics": {"block": BLOCK},
    "output": {"profiles": False},
}

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")


def written(folder: Path) -> study.Study:
    return study.Study(from_tables(TABLES, "large", "text", "large.toml"), folder)


def shrink(brief: float) -> None:
    """Windows of WINDOW cases, whose blocks are in memory for `brief` seconds."""
    running.BRIEF, windows.CASES, windows.BLOCKS, windows.usual_block = brief, 100, 1, lambda grid: WINDOW


def run_to_be_killed(folder: Path, log: Path, brief: float) -> None:
    shrink(brief)
    real = cases.compute
    engine.START = engine.MANY = float("inf")  # worker processes would not know what follows

    def compute(wanted):
        time.sleep(SLOW)
        note(log, f"{wanted.first} {wanted.last}")
        return real(wanted)

    cases.compute = compute
    written(folder).run(workers=1)


@pytest.mark.parametrize("brief", [float("inf"), 0.0], ids=["in memory", "on the disk"])
def test_forty_kills(tmp_path, monkeypatch, brief):
    for module, name in ((running, "BRIEF"), (windows, "CASES"), (windows, "BLOCKS"), (windows, "usual_block")):
        monkeypatch.setattr(module, name, getattr(module, name))
    shrink(brief)
    large, before, lost = written(tmp_path / "killed"), 0, 0
    for attempt in range(KILLS):
        log, most = tmp_path / f"log{attempt}", random.uniform(0, 1.5 * CASES / KILLS)
        process = started(run_to_be_killed, large.results, log, brief)
        wait_for(lambda: len(computed_in(log)) >= most or not process.is_alive())  # noqa: B023
        process.join(random.uniform(0, SLOW))
        process.kill()
        process.join(PATIENCE)
        present = CASES - large.status()["counts"].get(127, 0)
        computed = computed_in(log)
        assert before <= present, "nothing that was on the disk is lost"
        assert len({*computed}) == len(computed) <= CASES - before, "nothing is computed twice"
        in_work = len(computed) - (present - before)
        assert in_work <= (WINDOW if brief else BLOCK) + BLOCK, "a kill costs the window, or the block, in work"
        before, lost = present, lost + in_work
    report = large.run(workers=1)
    assert report.complete and report.computed == CASES - before
    assert large.verify().kind == "sound" and not [*tmp_path.rglob("*.tmp")] and not [*tmp_path.rglob("*.block")]
    undisturbed = written(tmp_path / "undisturbed").run(workers=1)
    assert numbers_digest(report.path) == numbers_digest(undisturbed.path)
    print(f"killed {KILLS} times: {before} of {CASES} cases were there, {lost} were lost in work")
