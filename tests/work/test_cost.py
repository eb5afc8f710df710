"""What a run would cost: asked before, and near the truth."""

import sys

import numpy as np
import pytest
from children import PROCESSES
from line_study import load, store_block

import study
from solver.body import tables as operator_tables
from solver.compiled.library import core
from study.__main__ import main
from study.inputs.reading import from_tables
from study.store import blocks, writer
from study.work import cost as estimates
from study.work import plan


def test_a_large_study_asks_first(file, monkeypatch, computed):
    monkeypatch.setattr(plan, "LARGE", 400)
    opened = load(file)
    with pytest.raises(
        study.StudyError, match=r"^line: 23 cases: about \d+ s, .* of disk; the results are .* GB; --yes computes them$"
    ):
        opened.run()
    assert not opened.results.joinpath("line.nc").exists() and computed == [], "nothing but a sample is computed"
    assert opened.run(yes=True).computed == 23


def test_what_is_large_is_more_than_so_many_numbers(file, monkeypatch):
    opened = load(file)
    monkeypatch.setattr(plan, "LARGE", opened.definition.numbers - 1)
    with pytest.raises(study.StudyError, match="--yes computes them"):
        opened.run()
    monkeypatch.setattr(plan, "LARGE", opened.definition.numbers)
    assert opened.run().complete


def test_a_large_study_is_told_the_cost_with_its_workers(file, monkeypatch):
    asked, real = [], plan.estimate
    monkeypatch.setattr(plan, "LARGE", 1)
    monkeypatch.setattr(plan, "estimate", lambda *given: asked.append(given[1]) or real(*given))
    with pytest.raises(study.StudyError):
        load(file).run(workers=7)
    assert asked == [7]


def test_cost_in_words():
    cost = estimates.Estimate(cases=9, present=1, seconds=125.4, memory=5.1e8, size=6.66e8, disk=1.4e9)
    said = "about 2 min 5 s, at most 0.51 GB of memory and 1.4 GB of disk; the results are 0.67 GB"
    assert estimates.describe(cost) == said


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
    assert two - alone > 2 * estimates.WORKER


def test_no_more_workers_count_than_there_are_blocks(file, monkeypatch):
    """Memory and time of a small study are not those of all processors of the machine."""
    monkeypatch.setattr(estimates, "seconds_per_case", lambda _: 1.0)
    opened = load(file)
    blocks = -(-23 // opened.definition.block)
    few, many = (opened.dry_run(workers=count) for count in (blocks, 64))
    assert many == few and few.seconds == 23 / blocks


MODELS = {
    "half-space": ({"base": "half_space"}, False),
    "thin layer": ({"base": "thin_layer"}, False),
    "thin layer, judged": ({"base": "thin_layer", "model_check": "first_order"}, True),
    "exact layer": ({"base": "layered"}, True),
    "exact layer for some": ({"base": ["half_space", "layered"]}, True),
    "half-space, none to judge": ({"base": "half_space", "model_check": "first_order"}, False),
    "auto": ({"base": "auto"}, True),
}


def estimated(monkeypatch, given: dict, workers: int = 1, **numerics) -> float:
    """Estimated memory of eight blocks of ten contacts, in bytes."""
    monkeypatch.setattr(estimates, "seconds_per_case", lambda _: 0.0)
    numerics |= {name: given[name] for name in given if name == "model_check"}
    axes = {name: value for name, value in given.items() if isinstance(value, list)}
    model = {name: value for name, value in given.items() if name not in (*numerics, *axes)}
    tables = {
        "model": {"micro": "smooth", "h": 0.1, "n": 0.5} | model,
        "axes": {"P": {"start": 1e-6, "stop": 1e-4, "num": 80 // len(given["base"] if axes else [1])}} | axes,
        "numerics": {"block": 10} | numerics,
    }
    return estimates.estimate(from_tables(tables, "s", "", "s"), workers).memory


@pytest.mark.parametrize(("given", "tables"), MODELS.values(), ids=MODELS)
def test_estimated_memory_counts_the_tables_of_the_exact_layer(monkeypatch, given, tables):
    """Once for each process that computes; threads share them."""
    more = estimated(monkeypatch, given) - estimated(monkeypatch, {"base": "half_space"})
    assert more == pytest.approx(estimates.TABLES if tables else 0.0, abs=1e6)  # of matrices on another stack
    assert estimates.TABLES > operator_tables._MOST_BYTES
    alone, two = (estimated(monkeypatch, given, workers) for workers in (1, 2))
    threads = core() and given["base"] == "layered"
    assert (two - alone > 2 * estimates.WORKER + estimates.TABLES) == (tables and not threads)
    assert (two - alone < estimates.WORKER) == bool(core() and given["base"] in ("thin_layer", "layered")
                                                    and "model_check" not in given)  # fmt: skip


def test_estimated_memory_grows_with_the_largest_mesh(monkeypatch):
    """Ten cases on 96 nodes, the end of the ladder, or on 256: three matrices each, at least."""
    coarse, fine = (estimated(monkeypatch, {"base": "half_space"}, nodes=nodes) for nodes in (16, 256))
    assert estimated(monkeypatch, {"base": "half_space"}) == coarse
    assert fine - coarse == pytest.approx(3 * 8 * 10 * (256**2 - 96**2), rel=1e-9)


@pytest.mark.parametrize(
    ("points", "block", "dtype", "workers", "parts"),
    [
        # Python, keys, three windows of the results file, nine blocks of results, solver, three stacks of matrices
        ((8, 10), 10, "float64", 1, (250e6, 100 * 80, 3 * 52_480, 9 * 6_560, 80e6, 3 * 8 * 96 * 960)),
        ((8, 10), 10, "float32", 1, (250e6, 100 * 80, 3 * 26_240, 9 * 3_280, 80e6, 3 * 8 * 96 * 960)),
        ((8, 10), 4000, "float64", 1, (250e6, 100 * 80, 3 * 52_480, 9 * 52_480, 80e6, 3 * 8 * 96 * 7_680)),
        ((1000, 2000), 8000, "float64", 1, (250e6, 200e6, 3 * 64e6, 9 * 5_248_000, 80e6, 3 * 8 * 96 * 40_000)),
        # the calling thread and a process: blocks, solver and matrices of each
        ((8, 10), 40, "float64", 2, (250e6 + 110e6, 100 * 80, 3 * 52_480, 18 * 26_240, 160e6, 6 * 8 * 96 * 3_840)),
    ],
)
def test_estimated_memory_is_the_sum_of_its_parts(monkeypatch, points, block, dtype, workers, parts):
    monkeypatch.setattr(estimates, "seconds_per_case", lambda _: 0.0)
    axes = {name: {"start": 0.1, "stop": 0.4, "num": num} for name, num in zip(("P", "nu1"), points, strict=True)}
    model, output = {"base": "half_space", "micro": "smooth"}, {"dtype": dtype}
    tables = {"model": model, "axes": axes, "numerics": {"block": block}, "output": output}
    # a sum in another order
    definition = from_tables(tables, "s", "", "s")
    assert estimates.estimate(definition, workers).memory == pytest.approx(sum(parts), rel=1e-12)


def test_time_is_of_the_missing_cases_over_the_workers(monkeypatch):
    tables = {"model": {"base": "half_space", "micro": "smooth"}, "axes": {"P": [1e-6, 2e-6, 3e-6, 4e-6, 5e-6]}}
    monkeypatch.setattr(estimates, "seconds_per_case", lambda _: 60.0)
    definition = from_tables(tables | {"numerics": {"block": 1}}, "s", "", "s")
    assert [estimates.estimate(definition, 2, present).seconds for present in (0, 3, 5)] == [150.0, 60.0, 0.0]


def test_the_sample_is_spread_over_all_cases_and_timed_when_warm(monkeypatch):
    tables = {"model": {"base": "half_space", "micro": "smooth"}, "axes": {"P": {"start": 1, "stop": 2, "num": 1000}}}
    seen, clock = [], iter([10.0, 10.0 + 256 * 3])
    monkeypatch.setattr(estimates, "compute", lambda wanted: seen.append(wanted.parameters["P"]))
    monkeypatch.setattr(estimates.time, "perf_counter", lambda: seen.append("timed") or next(clock))
    assert estimates.seconds_per_case(from_tables(tables, "s", "", "s")) == 3.0
    first, begun, second, ended = seen
    assert begun == ended == "timed" and (first[:-1] < second[:-1]).all() and second[-1] == 1.0, "the next ones"
    assert (first[0], first[-1], len(first)) == (1.0, 2.0, 256)
    assert np.diff(first).max() < 2 * np.diff(first).min()


@pytest.mark.parametrize("dtype", ["float64", "float32"])
@pytest.mark.parametrize("before", [0, 1500], ids=["new", "extended"])
def test_disk_stays_just_below_the_estimate(tmp_path, monkeypatch, before, dtype):
    """Beside earlier blocks, which are there already. Looked at when the results file has just been written."""
    most, real = [], writer.forget_other_exports

    def size(pattern: str) -> int:
        return sum(path.stat().st_size for path in tmp_path.rglob(pattern) if path.is_file())

    def forget(store):
        real(store)
        most.append(size("*"))

    def opened(num):
        axes = {"P": {"start": 1e-6, "stop": 2e-6, "num": num}, "rtol": [1e-6, 1e-7]}
        model, output = {"base": "half_space", "micro": "smooth"}, {"dtype": dtype}
        tables = {"model": model, "axes": axes, "numerics": {"block": 800}, "output": output}
        return study.Study(from_tables(tables, "s", "", "s"), tmp_path)

    monkeypatch.setattr(writer, "forget_other_exports", forget)
    if before:
        opened(before).run(workers=1)
    there = size("*.block")
    estimated = opened(2999).dry_run().disk
    opened(2999).run(workers=1)
    # the estimate has room for the head of the file and for chunks that are not full, a tenth of so small a study
    assert (0.8 if dtype == "float64" else 0.7) * estimated < most[-1] - there < estimated


def test_the_cost_of_a_study_in_parts_is_said_without_its_keys(tmp_path, monkeypatch, capsys):
    """3e8 cases, whose keys would be 5 GB; the results are 600 files. What a smaller one has left is not looked at."""
    monkeypatch.setattr(blocks, "case_keys", lambda *_: 1 / 0)
    axes = "P = {start = 1, stop = 2, num = 30000}\nnu1 = {start = 0.1, stop = 0.4, num = 10000}\n"
    text = f'[model]\nmicro = "smooth"\nbase = "half_space"\n[axes]\n{axes}[output]\nprofiles = false\n'
    (tmp_path / "huge.toml").write_text(text)
    opened = study.load(tmp_path / "huge.toml", tmp_path / "results")
    monkeypatch.setattr(estimates, "seconds_per_case", lambda _: 0.0)
    (tmp_path / "results" / ".huge.blocks").mkdir(parents=True)
    (tmp_path / "results" / ".huge.blocks" / "a.block").touch()
    assert opened.status()["counts"] == {127: 300_000_000} and opened.status()["state"] == "new"
    cost = opened.dry_run()
    assert cost.present == 0 and cost.memory < 2e9 and 1.05 * cost.size < cost.disk < 1.06 * cost.size
    assert main(["status", str(tmp_path / "huge.toml"), "--results", str(tmp_path / "results")]) == 0
    assert "300000000 cases  new" in capsys.readouterr().out


VARIED = {
    "model": {"P": 1e-5, "n": 0.5, "micro": "smooth"},
    "axes": {"h": [0.001 * 2**i for i in range(8)], "nu2": [0.05 * i for i in range(8)]},
    "numerics": {"nodes": 112},
}


def peak_of_a_run(folder, answers) -> None:
    import resource

    study.Study(from_tables(VARIED, "varied", "", "varied"), folder).run(workers=1)
    answers.put(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024))


@pytest.mark.skipif(sys.platform == "win32", reason="getrusage")
def test_memory_stays_below_the_estimate(tmp_path, monkeypatch):
    """On layers of eight octaves of h/a, enough of each for tables, and a fine mesh: they take 130 MB."""
    monkeypatch.setattr(estimates, "seconds_per_case", lambda _: 0.0)
    answers = PROCESSES.Queue()
    process = PROCESSES.Process(target=peak_of_a_run, args=(tmp_path, answers))
    process.start()
    peak = answers.get(timeout=120)
    process.join()
    assert 0.25e9 < peak < estimates.estimate(from_tables(VARIED, "varied", "", "varied"), 1).memory
