"""The largest values of models in boxes by the compiled core, against numpy (solver/yields/search/climb.py)."""

import numpy as np
import pytest
from both_paths import of_the_sources  # noqa: F401
from numpy.testing import assert_allclose

from solver.compiled.highest import FUNCTIONS, highest_in_c
from solver.compiled.library import VARIABLE, available
from solver.yields.extremes import VALUES
from solver.yields.search.climb import _highest

pytestmark = pytest.mark.skipif(not available(), reason="no compiled core was built here")
TASKS = 350


def boxes(flat: bool) -> tuple[np.ndarray, ...]:
    """Models, centres and bounds: random ones, most of them with their largest value inside of the box."""
    random = np.random.default_rng(int(flat))
    models = random.standard_normal((6, 4, TASKS))
    models[0] *= 3
    models[3:6:2] = -np.abs(models[3:6:2]) * 20
    low = random.uniform(-0.2, -0.02, (TASKS, 2))
    high = random.uniform(0.02, 0.2, (TASKS, 2))
    centre = random.uniform(low, high)
    if flat:
        low[:, 1] = high[:, 1] = centre[:, 1]
    return models, centre, low, high


def by_numpy(numbers: np.ndarray, *arrays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    def value(index, stresses):
        values = np.empty(stresses.shape[1:])
        for number, name in enumerate(FUNCTIONS):
            some = numbers[index] == number
            values[some] = VALUES[name](*stresses[:, some])
        return values

    return _highest(np.arange(len(numbers)), value, *arrays)


def test_the_functions_are_those_of_numpy():
    assert tuple(VALUES) == FUNCTIONS


@pytest.mark.parametrize("variant", available())
@pytest.mark.parametrize("flat", [False, True])
def test_they_are_those_of_numpy(flat, variant, monkeypatch):
    monkeypatch.setenv(VARIABLE, variant)
    numbers, arrays = np.arange(TASKS) % len(FUNCTIONS), boxes(flat)
    places, values = highest_in_c(numbers, *arrays)
    expected_places, expected = by_numpy(numbers, *arrays)
    assert_allclose(values, expected, rtol=2e-13, atol=2e-13)
    # at a smooth top values agree to rounding over the root of that in places
    assert_allclose(places, expected_places, rtol=0, atol=1e-6)
    low, high = arrays[2:]
    assert ((low < places) & (places < high))[:, 0].mean() > 0.3
    assert (places > low - 1e-15).all() and (places < high + 1e-15).all()  # middle and width of a box are rounded


@pytest.mark.parametrize("variant", available())
def test_a_task_has_the_same_bits_in_any_company(variant, monkeypatch):
    monkeypatch.setenv(VARIABLE, variant)
    numbers, arrays = np.arange(TASKS) % len(FUNCTIONS), boxes(False)
    places, values = highest_in_c(numbers, *arrays)
    some = np.array([3, 200, 77])
    part = highest_in_c(numbers[some], arrays[0][..., some], *(array[some] for array in arrays[1:]))
    assert (part[0] == places[some]).all() and (part[1] == values[some]).all()


@pytest.mark.parametrize("variant", available())
def test_stresses_that_are_no_numbers(variant, monkeypatch):
    """The largest value is then none either, and the search ends."""
    monkeypatch.setenv(VARIABLE, variant)
    models, *rest = boxes(False)
    models[0, :, 5] = np.nan
    numbers = np.zeros(TASKS, dtype=int)
    values = highest_in_c(numbers, models, *rest)[1]
    assert np.isnan(values[5]) and np.isnan(by_numpy(numbers, models, *rest)[1][5]) and np.isfinite(values[6])


def test_without_the_core_numpy_computes(monkeypatch):
    monkeypatch.setenv(VARIABLE, "numpy")
    assert highest_in_c(np.zeros(TASKS, dtype=int), *boxes(False)) is None
