"""The results file written by windows is the one that would be written whole."""

import math
import sys

import numpy as np
import pytest
import xarray as xr
from children import PATIENCE, PROCESSES
from hypothesis import example, given, settings
from hypothesis import strategies as st
from same import assert_same

import study
from study.data.dataset import parts
from study.files import results_file
from study.files.examine import examine
from study.files.results_file import write
from study.inputs.grid import Grid, box, cut_out, windows
from study.inputs.reading import from_tables
from study.store import writer
from study.work.cases import compute, parcel

shapes = st.lists(st.integers(1, 7), max_size=4).map(tuple)


@settings(deadline=None)
@given(shape=shapes, most=st.integers(1, 60), chunk=st.integers(1, 30))
@example(shape=(7,), most=5, chunk=3)
def test_windows_follow_each_other_in_flat_order(shape, most, chunk):
    grid = Grid({f"d{i}": size for i, size in enumerate(shape)}, {})
    numbers = np.arange(math.prod(shape)).reshape(shape)
    found = [numbers[tuple(window.values())].ravel() for window in windows(grid, most, chunk)]
    np.testing.assert_array_equal(np.concatenate(found), np.arange(numbers.size))
    assert max(map(len, found)) <= max(most, chunk)
    chunks = box(shape, chunk)
    for window in windows(grid, most, chunk):
        assert all(part.start % length == 0 for part, length in zip(window.values(), chunks, strict=True))


@settings(deadline=None)
@given(shape=shapes, most=st.integers(1, 60))
def test_a_box_is_not_needlessly_small(shape, most):
    lengths = box(shape, most)
    assert math.prod(lengths) <= most
    assert math.prod(lengths) == math.prod(shape) or 4 * math.prod(lengths) >= most


@pytest.mark.parametrize(
    ("shape", "most", "lengths"),
    [((7,), 7, [7]), ((7,), 5, [4]), ((7,), 3, [3]), ((3, 7), 5, [1, 4]), ((4, 5), 10, [2, 5]), ((5, 3), 9, [3, 3])],
)
def test_boxes_are_few_and_alike(shape, most, lengths):
    """Two boxes of 4 and 3 rather than 5 and 2, or three."""
    assert box(shape, most) == lengths


def tables(**output) -> dict:
    return {
        "model": {"n": 0.5, "Ra": 0.004, "base": "thin_layer"},
        "cases": [{"label": "soft", "Nbar": 250000, "nu1": 0.4}, {"label": "", "micro": "smooth"}],
        "axes": {"P": [1e-5, 2e-5, 3e-5], "h": [0.01, 0.02], "bonding": ["bonded", "frictionless"]},
        "numerics": {"block": 5},
        "output": {"x": 4} | output,
    }


@pytest.mark.parametrize(("size", "output"), [(1, {}), (3, {"profiles": False}), (8, {}), (1000, {})])
def test_written_by_windows_as_written_whole(tmp_path, monkeypatch, size, output):
    monkeypatch.setattr(writer, "CHUNK", size)
    monkeypatch.setattr(writer, "AT_ONCE", 1)
    definition = from_tables(tables(**output), "windows", "text", "windows.toml")
    opened = study.Study(definition, tmp_path)
    opened.run()
    whole = parts(definition, compute(parcel(definition, np.arange(24))), "command").dataset()
    write(whole, tmp_path / "whole.nc", examine(tmp_path / "whole.nc"))
    expected, found = study.open_results(tmp_path / "whole.nc"), opened.open()
    assert_same(found, expected)


@settings(max_examples=20, deadline=None)
@given(low=st.integers(0, 5), length=st.integers(1, 3))
def test_a_grid_cut_out_is_the_cases_there(low, length):
    grid = from_tables(tables(), "w", "", "w").grid
    window = {dim: slice(low % size, min(low % size + length, size)) for dim, size in grid.sizes.items()}
    from study.inputs.grid import columns

    part, whole = cut_out(grid, window), columns(grid, np.arange(grid.size))
    for name, column in columns(part, np.arange(part.size)).items():
        expected = whole[name].reshape(grid.shape)[tuple(window.values())].ravel()
        np.testing.assert_array_equal(column, expected)


def test_a_large_file_is_opened_lazily(tmp_path, monkeypatch):
    monkeypatch.setattr(writer, "CHUNK", 6)
    opened = study.Study(from_tables(tables(), "lazy", "", "lazy"), tmp_path)
    opened.run()
    eager = study.open_results(tmp_path / "lazy.nc")
    monkeypatch.setattr(results_file, "LAZY", 1000)
    found = opened.open()
    assert all(found[name].chunks for name in found.data_vars)
    assert found.p.data.chunks[:2] == ((1, 1), (1, 1, 1))
    assert float(found.p.max().compute(num_workers=4)) == float(eager.p.max())
    xr.testing.assert_identical(study.open_results(tmp_path / "lazy.nc").load(), eager)


def peak_of_a_run(folder, points: int, answers) -> None:
    """Peak memory and size of the results, in bytes, of a run whose solver gives every block the same numbers."""
    import resource

    from study.work import cases

    axes = {"P": {"start": 1e-6, "stop": 1e-4, "num": points}, "h": {"start": 0.001, "stop": 0.01, "num": 300}}
    model = {"micro": "smooth", "base": "half_space"}
    tables = {"model": model, "axes": axes, "numerics": {"block": 2000}}
    opened = study.Study(from_tables(tables, "large", "", "large"), folder)
    solved = compute(parcel(opened.definition, np.arange(2000)))
    cases.compute = lambda wanted: {name: array[: wanted.last - wanted.first + 1] for name, array in solved.items()}
    writer.AT_ONCE = 4_000_000
    opened.run(workers=2)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    answers.put((peak, 8 * opened.definition.numbers))


@pytest.mark.skipif(sys.platform == "win32", reason="getrusage")
def test_memory_does_not_grow_with_the_study(tmp_path):
    answers, found = PROCESSES.Queue(), []
    for points in (200, 600):  # of fewer the arrays of a window decide
        process = PROCESSES.Process(target=peak_of_a_run, args=(tmp_path / str(points), points, answers))
        process.start()
        found.append(answers.get(timeout=PATIENCE))
        process.join()
    (small, of_small), (large, of_large) = found
    assert of_large - of_small > 78e6
    assert large - small < 0.3 * (of_large - of_small)
