"""`study.solve(chunks=...)`: dask arrays, a chunk of which is solved when it is asked for, by any scheduler."""

import os
import subprocess
import sys
from dataclasses import replace

import dask
import numpy as np
import pytest
import xarray as xr

import study
from solver import laws
from solver.known import register
from study import lazy

pytestmark = pytest.mark.usefixtures("forgetful")

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
    register(replace(laws.LAWS["power_law"], name="mine", version="1"))
    law, known = {"B": 1.0, "beta": 0.9} | ROUGH, {"P": [1e-5, 2e-5], "base": "half_space"}
    with dask.config.set(scheduler="processes", num_workers=2):
        found = study.solve(**known, micro="mine", **law, chunks={"P": 1}).a.values
    np.testing.assert_allclose(found, study.solve(**known, micro="power_law", **law).a, rtol=1e-9)


@pytest.mark.parametrize(
    ("chunks", "message"),
    [
        (0, 'chunks = 0: must be a dictionary such as {"P": 10}, one length for every dimension, or "auto"'),
        ("8 MB", 'chunks = "8 MB": must be a dictionary'),
        ((1, 2), "chunks = (1, 2): must be a dictionary"),
        (True, "chunks = True: must be a dictionary"),
        ({"x": 3}, 'chunks: "x" is not a dimension of the grid (P)'),
        ({"P": 0}, "chunks: P = 0: must be a whole number, 1 or more, -1 for all, or a tuple"),
        ({"P": "all"}, 'chunks: P = "all": must be a whole number'),
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


def test_lengths_for_every_dimension():
    """A whole number, and "auto": as many cases as a block of a study has."""
    two = {"P": [1e-5, 2e-5, 3e-5], "m": [0.0, 0.5], "micro": "smooth", "base": "half_space"}
    assert dict(study.solve(**two, chunks=2).a.chunksizes) == {"P": (2, 1), "m": (2,)}
    assert dict(study.solve(**two, chunks=-1).a.chunksizes) == {"P": (3,), "m": (2,)}
    many = two | {"P": np.linspace(1e-5, 1e-4, 20_000).tolist()}
    each = study.solve(**many, chunks="auto", profiles=False).a
    assert max(each.data.numblocks) > 2 and 1000 < np.prod(each.data.chunksize) <= 16_000
    one = study.solve(**many, chunks={"P": "auto", "m": 1}, profiles=False).a
    assert one.chunksizes["m"] == (1, 1) and len(one.chunksizes["P"]) > 1
    assert study.solve(**two | {"P": 1e-5, "m": 0.0}, chunks="auto").a.compute() > 0


PLANNED = """
try:
    import dask.array
    assert "expr" in dask.array.Array.__module__
except (ImportError, AssertionError):
    raise SystemExit("no query planning")
from roughcoat import solve
contact = solve(P=[1e-5, 2e-5, 3e-5], micro="smooth", base="half_space", chunks={"P": 2})
print(*contact.a.compute().values, contact.p.isel(P=2).compute().shape, contact.a.chunksizes["P"])
"""


def test_with_query_planning():
    """dask decides at import whether arrays are expressions, so that this takes a process of its own. Then a delayed
    argument of `map_blocks` was lost: "Missing dependency". Older dask, or an xarray without it, has none."""
    planned = os.environ | {"DASK_ARRAY__QUERY_PLANNING": "True"}
    ran = subprocess.run([sys.executable, "-c", PLANNED], env=planned, capture_output=True, text=True)
    if "no query planning" in ran.stderr:
        pytest.skip("this dask has no query planning of arrays")
    assert ran.returncode == 0, ran.stderr
    *a, rest = ran.stdout.strip().split(" ", 3)
    assert rest == "(33,) (2, 1)"
    np.testing.assert_allclose(np.array(a, float), study.solve(**SMOOTH).a, rtol=1e-9, atol=0)
