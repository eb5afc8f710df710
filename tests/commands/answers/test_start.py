"""What commands and calls import: nothing heavy that they do not need. `make start` says what it gains."""

import json
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

import study
from study.arrays.labelled import Labelled
from study.data.dataset import as_dataset
from study.solving import solve_one

HEAVY = ("xarray", "pandas", "dask", "dask.array", "scipy.special", "scipy.linalg", "scipy.ndimage", "pint")
HEAVY = (*HEAVY, "matplotlib", "netCDF4", "SurfaceTopography", "multiprocessing.pool")
IN_UNITS = "R='5 mm', E2='210 GPa', P='10 N', micro='smooth', base='half_space'"
POINT = "from study.__main__ import main; main(['point', {}])"


def imported(code: str) -> set[str]:
    """The heavy modules that a Python of its own has imported after `code`."""
    code += f"\nimport json, sys\nprint(json.dumps([name for name in {HEAVY!r} if name in sys.modules]))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return {*json.loads(done.stdout.splitlines()[-1])}


def test_point_imports_nothing_heavy():
    """Neither xarray nor pandas for a contact that it prints."""
    assert imported(POINT.format("'P=1e-5', 'micro=smooth', 'base=half_space'")) == set()


def test_point_imports_scipy_special_for_strengths():
    """And for tables of layers."""
    inputs = "'R=5mm', 'h=2um', 'E1=200GPa', 'E2=210GPa', 'bonding=bonded', 'P=10N', 'micro=smooth'"
    assert imported(POINT.format(inputs)) - {"scipy.linalg"} == {"scipy.special"}


@pytest.mark.parametrize("inputs", ["P=1e-5, micro='smooth', base='half_space'", IN_UNITS])
def test_one_contact_imports_xarray_alone(inputs):
    """Its results are a dataset; xarray itself would import dask and pint while it makes one."""
    assert imported(f"import study; study.solve({inputs})") == {"xarray", "pandas"}


@pytest.mark.parametrize(
    "inputs",
    [
        {"P": 1e-5, "micro": "smooth", "base": "half_space"},
        {"R": "5 mm", "E2": "210 GPa", "P": "10 N", "micro": "smooth", "base": "half_space"},
        {"R": "5 mm", "h": "2 um", "E1": "200 ± 20 GPa", "body": "steel 52100", "P": "10 N", "micro": "smooth"},
        {"R": "5 mm", "h": "20 um", "E1": "2 GPa", "E2": "210 GPa", "P": "3 N", "Nbar": "1e4 1/mm^2", "Ra": "20 um"},
        {"R": "5 mm", "h": "5 um", "E1": "900 GPa", "E2": "2 GPa", "P": "60 N", "micro": "smooth"},  # most in a ring
    ],
)
def test_one_case_is_the_dataset(inputs):
    """The contact that `point` prints has the same words and numbers as that of `study.solve`."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("warnings.warn", lambda *_, **__: None)
        contact, dataset = solve_one(**inputs), study.solve(**inputs)
    assert str(study.summary(contact)) == str(study.summary(dataset))
    made = as_dataset(contact)
    times = ("history", "created")
    xr.testing.assert_identical(*(one.drop_attrs(deep=False) for one in (made, dataset)))
    assert {name: made.attrs[name] for name in made.attrs if name not in times} == {
        name: dataset.attrs[name] for name in dataset.attrs if name not in times
    }
    for name, variable in dataset.variables.items():
        np.testing.assert_array_equal(contact[name].values, variable.values)
        assert contact[name].dims == variable.dims and contact[name].attrs.keys() == variable.attrs.keys()


def test_labelled_arrays_broadcast_by_their_names():
    """As Variables of xarray do."""
    random = np.random.default_rng(0)
    first, second = Labelled(("a", "b"), random.random((2, 3))), Labelled(("c", "a"), random.random((4, 2)))
    for operation in (lambda a, b: a * b - 1 / b, lambda a, b: np.sqrt(a) > b, lambda a, b: abs(-a) + b[1]):
        ours, theirs = operation(first, second), operation(first.to_xarray(), second.to_xarray())
        assert ours.dims == theirs.dims
        np.testing.assert_array_equal(ours.values, theirs.values)
    np.testing.assert_array_equal(first.max("b").values, first.to_xarray().max("b").values)
    assert first.transpose("b", "a").to_xarray().identical(first.to_xarray().transpose("b", "a"))
    assert (first > -1).all() and not (first > 2).any()
    both = second.to_xarray() * first, first * second.to_xarray()
    assert [one.dims for one in both] == [("c", "a", "b"), ("a", "b", "c")], "beside Variables they are some"
    assert first.where(first > 0.5).count() == (first.values > 0.5).sum() and first.max() == first.values.max()
