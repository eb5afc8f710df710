"""`study.solve(chunks=...)`: dask arrays, a chunk of which is solved when it is asked for, by any scheduler."""

from dataclasses import replace

import dask
import numpy as np
import pytest
import xarray as xr

import study
from solver import laws
from study import lazy

ROUGH = {"Nbar": 250000.0, "Ra": 0.004, "n": 0.5}
LOADS = np.geomspace(1e-6, 1e-4, 25).tolist()
BALL = {"R": "5 mm", "E2": "210 ± 10 GPa", "nu1": 0.25, "micro": "smooth", "P": ["1 N", "2 N", "3 N"]}
LAYERS = {"E1": ["200 GPa", "100 GPa"], "h": ["1 um", "2 um"]}
SMOOTH = {"micro": "smooth", "base": "half_space", "P": [1e-5, 2e-5, 3e-5]}


@pytest.mark.parametrize(
    ("parameters", "chunks", "of_a"),
    [
        ({**ROUGH, "h": [0.1, 0.2], "P": LOADS}, {"P": 10}, {"h": (2,), "P": (10, 10, 5)}),
        ({**BALL, **LAYERS}, {"P": (1, 2), "E1": 1}, {"E1": (1, 1), "h": (2,), "P": (1, 2)}),
        ({**SMOOTH, "P": 1e-5}, {}, {}),
    ],
)
def test_the_results_are_those_of_a_call_without_chunks(parameters, chunks, of_a):
    """To 1e-9: cases in another company may differ in the last digits. Estimates of errors are made of differences, and
    `residual` has none but last digits."""
    whole, lazily = study.solve(**parameters), study.solve(**parameters, chunks=chunks)
    assert dict(lazily.a.chunksizes) == of_a and {*lazily.variables} == {*whole.variables}
    xr.testing.assert_identical(lazily.a.coords.to_dataset(), whole.a.coords.to_dataset())
    found = lazily.compute()
    for name, array in whole.variables.items():
        assert found[name].dtype == array.dtype and found[name].dims == array.dims
        xr.testing.assert_identical(xr.Variable((), 0, found[name].attrs), xr.Variable((), 0, array.attrs))
        if array.dtype.kind == "f" and name != "residual":
            rtol = 1e-4 if "error" in name else 1e-9
            np.testing.assert_allclose(found[name], array, rtol=rtol, atol=1e-14, err_msg=name)
    assert {**found.attrs, "history": "", "created": ""} == {**whole.attrs, "history": "", "created": ""}


def test_a_chunk_is_solved_once_when_it_is_asked_for(monkeypatch):
    solved = []
    compute = lazy.compute
    monkeypatch.setattr(
        lazy, "compute", lambda wanted: solved.append(wanted.parameters["P"].tolist()) or compute(wanted)
    )
    found = study.solve(**SMOOTH, chunks={"P": 2})
    assert solved == []
    with dask.config.set(scheduler="synchronous"):
        found.a.isel(P=2).compute()
        assert solved == [[3e-5]]
        dask.compute(found.a, found.p)
    assert sorted(solved[1:]) == [[1e-5, 2e-5], [3e-5]]


def test_threads_solve_them():
    with dask.config.set(scheduler="threads", num_workers=2):
        found = study.solve(**SMOOTH, chunks={"P": 1}).a.values
    np.testing.assert_array_equal(found, study.solve(**SMOOTH).a.values)


def test_processes_solve_them_and_a_law_of_ones_own_goes_with_its_chunk():
    """A worker process knows the laws of this package only."""
    laws.register(replace(laws.LAWS["power_law"], name="mine", version="1"))
    law, known = {"B": 1.0, "beta": 0.9} | ROUGH, {"P": [1e-5, 2e-5], "base": "half_space"}
    with dask.config.set(scheduler="processes", num_workers=2):
        found = study.solve(**known, micro="mine", **law, chunks={"P": 1}).a.values
    np.testing.assert_allclose(found, study.solve(**known, micro="power_law", **law).a, rtol=1e-9)


@pytest.mark.parametrize(
    ("chunks", "message"),
    [
        (3, 'chunks = 3: must be a dictionary such as {"P": 10}'),
        ({"x": 3}, 'chunks: "x" is no dimension of the grid (P)'),
        ({"P": 0}, "chunks: P = 0: must be a whole number, 1 or more, -1 for all, or a tuple"),
        ({"P": "auto"}, 'chunks: P = "auto": must be a whole number'),
        (
            {"P": (1, 1)},
            "chunks: P = (1, 1): must be a whole number, 1 or more, -1 for all, or a tuple of lengths that",
        ),
    ],
)
def test_chunks_that_do_not_fit_are_refused(chunks, message):
    with pytest.raises(study.StudyError) as refused:
        study.solve(**SMOOTH, chunks=chunks)
    assert len(refused.value.messages) == 1 and str(refused.value).startswith(message)


@pytest.mark.parametrize("more", [{"workers": 2}, {"progress": True}])
def test_what_dask_does_itself_is_not_asked_of_the_call(more):
    with pytest.raises(study.StudyError, match="chunks: dask divides the work"):
        study.solve(**SMOOTH, chunks={"P": 1}, **more)


@pytest.mark.filterwarnings("ignore")  # zarr says what it thinks of texts of a fixed length
def test_to_zarr(tmp_path):
    pytest.importorskip("zarr")
    lazily = study.solve(**ROUGH, h=[0.1, 0.2], P=LOADS, chunks={"P": 10})
    lazily.to_zarr(tmp_path / "contacts.zarr")
    stored = xr.open_zarr(tmp_path / "contacts.zarr")
    assert stored.a.chunks == lazily.a.chunks
    xr.testing.assert_equal(stored.compute(), lazily.compute())
