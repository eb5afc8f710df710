"""Whatever happens to a run, what is on disk is kept, and the next run ends in the dataset of an undisturbed one."""

import io
import json
import os
import random
import signal
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from children import PATIENCE, child, computed_in, lines, wait_for
from interrupted_study import BLOCK, CASES, TEXT, assert_ends_well, cases_on_disk, written
from line_study import store_block
from same import assert_same

import study
from study.__main__ import main
from study.files import results_file
from study.files.seal import seal
from study.store import block_file, writer
from study.store.block_file import read_block
from study.work import progress

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals and limits")

LARGE = 50  # cases in a block, where few blocks are enough
IN_FLIGHT = 4 * 2 * BLOCK  # cases submitted and not stored, for two workers


@pytest.fixture
def opened(tmp_path) -> study.Study:
    return written(tmp_path)


@pytest.fixture
def coarse(tmp_path) -> study.Study:
    """The same study in six blocks, for what may happen to any of them."""
    found = written(tmp_path)
    return study.Study(replace(found.definition, block=LARGE), found.results)


def test_killed_at_ten_random_moments(opened, undisturbed, tmp_path):
    """From before the first block to when so many have been begun that some must have been stored."""
    file, before = tmp_path / "line.toml", set()
    for attempt, begun in enumerate(random.sample((0, 0, 1, 1, 2, 3, 4, 6, 9, 12), 10)):
        log = tmp_path / f"log{attempt}"
        process = child(file, log, workers=2)
        wait_for(lambda: len(computed_in(log)) >= begun * BLOCK or not process.is_alive())  # noqa: B023
        process.join(random.uniform(0, 0.02))
        process.kill()
        process.join()
        after, computed = cases_on_disk(opened), computed_in(log)
        assert before <= after, "nothing that was on disk is lost"
        assert not before & set(computed) and len(set(computed)) == len(computed), "nothing is computed twice"
        assert len(set(computed) - after) <= IN_FLIGHT, "a kill costs the blocks in flight"
        before = after
    assert before, "of twelve begun blocks at most eight are in flight"
    assert_ends_well(opened, undisturbed, CASES - len(before))


@pytest.mark.parametrize(
    "at", ["store.writer.finish", "store.writer.create", "store.writer.put", "store.writer.forget_other_exports"]
)
def test_killed_while_the_results_are_written(opened, undisturbed, tmp_path, at):
    process = child(tmp_path / "line.toml", tmp_path / "log", at=at, workers=2)
    process.join(PATIENCE)
    assert process.exitcode == -signal.SIGKILL
    assert_ends_well(opened, undisturbed, 0)


def spoil(path: Path, how: str) -> None:
    """Damage a file."""
    data = bytearray(path.read_bytes())
    if how == "bit flipped":
        place = random.randrange(len(data))
        data[place] ^= 1 << random.randrange(8)
    path.write_bytes({"truncated": data[:-100], "emptied": b"", "bit flipped": data}[how])


@pytest.mark.parametrize("how", ["truncated", "emptied", *["bit flipped"] * 5])
def test_a_damaged_block_is_computed_again(coarse, undisturbed, caplog, how):
    paths = [store_block(coarse, start, start + LARGE) for start in range(0, CASES - LARGE, LARGE)]
    spoil(paths[3], how)
    assert_ends_well(coarse, undisturbed, CASES - (len(paths) - 1) * LARGE)
    assert f"{paths[3]}: is not a complete block; the same command computes its cases again" in caplog.text


def test_a_block_damaged_after_the_inventory_stops_the_results(opened, undisturbed, monkeypatch):
    real = writer.gather

    def gather(store, known, start, stop):
        spoil(known.sources[7].path, "bit flipped")
        return real(store, known, start, stop)

    monkeypatch.setattr(writer, "gather", gather)
    with pytest.raises(block_file.Damaged, match="is not a complete block; the same command computes its cases again"):
        opened.run()
    monkeypatch.undo()
    assert_ends_well(opened, undisturbed, BLOCK)


def test_a_block_of_another_study_is_not_taken_for_one_of_this(coarse, undisturbed, tmp_path):
    paths = [store_block(coarse, start, start + LARGE) for start in range(0, CASES - LARGE, LARGE)]
    (tmp_path / "other").mkdir()
    other = written(tmp_path / "other", TEXT.replace("n = 0.5", "n = 0.6"))
    paths[0].write_bytes(store_block(other, 0, LARGE).read_bytes())
    assert_ends_well(coarse, undisturbed, CASES - (len(paths) - 1) * LARGE)


def test_nothing_executable_is_read(coarse, undisturbed, tmp_path):
    """A block with a right checksum and columns of Python objects is refused like a damaged one."""
    path = store_block(coarse, 0, LARGE)
    block = read_block(path)
    head = np.array(json.dumps({"facts": block.facts, "columns": list(block.arrays)}))
    with open(path, "wb") as file:
        for array in (head, block.keys, *(array.astype(object) for array in block.arrays.values())):
            np.save(file, array)
    seal(path)
    with pytest.raises(block_file.Damaged):
        read_block(path)
    assert_ends_well(coarse, undisturbed, CASES)


@pytest.mark.parametrize("locks", [True, False])
def test_two_runs_at_once(opened, undisturbed, tmp_path, locks):
    logs = [tmp_path / "one", tmp_path / "two"]
    runs = [child(tmp_path / "line.toml", log, locks=locks, workers=2) for log in logs]
    for process in runs:
        process.join(PATIENCE)
    assert [process.exitcode for process in runs] == [0, 0]
    computed = [case for log in logs for case in computed_in(log)]
    assert set(computed) == set(range(CASES))
    if locks:
        assert len(computed) == CASES
        ends = sorted(lines(log)[-1] for log in logs)
        assert ends == ["ended", "nothing to do"], "the second waits and finds all done"
    assert_ends_well(opened, undisturbed, 0)


def test_parts_at_once(opened, undisturbed, tmp_path):
    logs = [tmp_path / f"part{i}" for i in range(3)]
    runs = [child(tmp_path / "line.toml", log, part=(i + 1, 3), workers=1) for i, log in enumerate(logs)]
    for process in runs:
        process.join(PATIENCE)
    assert [process.exitcode for process in runs] == [0, 0, 0]
    assert sorted(case for log in logs for case in computed_in(log)) == list(range(CASES))
    assert opened.status()["state"] == "done", "the last one has written the results"
    assert_ends_well(opened, undisturbed, 0)


def test_a_lazy_reader_keeps_its_file_while_it_is_replaced(coarse, undisturbed, monkeypatch, tmp_path):
    coarse.run()
    monkeypatch.setattr(results_file, "LAZY", 0)
    reader = coarse.open()
    assert reader.p.chunks
    written(tmp_path, TEXT.replace("num = 100", "num = 2")).run(force=True)
    assert_same(reader.load(), undisturbed)


def test_a_clock_that_jumps(opened, undisturbed, monkeypatch, tmp_path):
    path = store_block(opened, 0, BLOCK)
    os.utime(path, (2e9, 2e9))
    later = store_block(opened, BLOCK, 2 * BLOCK)
    os.utime(later, (1, 1))
    random_time = random.Random(1)
    monkeypatch.setattr(time, "time", lambda: random_time.uniform(0, 4e9))
    monkeypatch.setattr(progress, "EVERY", float("inf"))
    shown = io.StringIO()
    opened.run(workers=2, stream=shown)
    assert shown.getvalue().startswith(f"line: {CASES} of {CASES} cases, 0 failed, ") and "-" not in shown.getvalue()
    monkeypatch.undo()
    assert_ends_well(opened, undisturbed, 0)


@pytest.mark.parametrize("name", ["..", ".hidden", "a b", "-x", "ü", "n" * 250])
def test_names_that_would_be_trouble_in_the_results_folder_are_refused(tmp_path, name, capsys):
    (tmp_path / f"{name}.toml").write_text(TEXT, encoding="utf-8")
    assert main(["run", str(tmp_path / f"{name}.toml"), "--results", str(tmp_path / "results")]) == 2
    assert "a study file is called NAME.toml, NAME of letters without accents, digits" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == [f"{name}.toml"]
