"""Signals: the first ends a run in good order, the second at once, and those that the parent ignores are ignored."""

import os
from signal import SIGINT, SIGTERM

import pytest
from children import PATIENCE, command, stored, wait_for
from line_study import load, present

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
RUN = ("run", "line.toml", "--workers", "1")


@pytest.fixture
def opened(file):
    return load(file, **{"num = 23": "num = 60"})


@pytest.mark.parametrize("number", [SIGINT, SIGTERM])
def test_the_first_ends_in_good_order_without_waiting_for_the_block_in_work(opened, tmp_path, number):
    process = command(tmp_path, 15, *RUN)
    wait_for(lambda: stored(tmp_path) == 3)
    os.kill(process.pid, number)
    process.join(PATIENCE)
    assert process.exitcode == 130
    said = (tmp_path / "errors").read_text()
    assert said.endswith("\ninterrupted; finished blocks are kept, the same command goes on from there\n")
    assert "Traceback" not in said
    assert not list(tmp_path.rglob("*.tmp")) and present(opened) == 15
    assert opened.run().computed == 45


@pytest.mark.parametrize(("first", "second"), [(SIGINT, SIGINT), (SIGTERM, SIGINT), (SIGINT, SIGTERM)])
def test_the_second_ends_at_once(opened, tmp_path, first, second):
    process = command(tmp_path, 15, *RUN, stuck=True)
    wait_for(lambda: stored(tmp_path) == 3)
    os.kill(process.pid, first)
    wait_for((tmp_path / "ending").exists)
    os.kill(process.pid, second)
    process.join(PATIENCE)
    assert process.exitcode == 130
    assert "interrupted" not in (tmp_path / "errors").read_text()
    assert opened.run().computed == 45, "what was stored is kept"


@pytest.mark.parametrize("number", [SIGINT, SIGTERM])
def test_a_signal_that_the_parent_ignores_is_ignored(opened, tmp_path, number):
    """As that of a closed terminal's Ctrl-C, when a shell starts a run in the background."""
    process = command(tmp_path, 15, *RUN, ignoring=(number,))
    wait_for(lambda: stored(tmp_path) == 3)
    os.kill(process.pid, number)
    (tmp_path / "go").touch()
    process.join(PATIENCE)
    assert process.exitcode == 0
    assert opened.status()["state"] == "done"
