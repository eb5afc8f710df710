"""Batches: parts, their union, cases that are alike."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.testing import assert_array_equal

from solver.body.half_space import HalfSpace
from solver.laws import LAWS
from solver.numerics import batch


@batch.of_cases
class Inner(NamedTuple):
    """Numbers of cases, and one for all of them."""

    values: np.ndarray
    unit: float


@batch.of_cases
@dataclass(frozen=True, eq=False)
class Outer:
    """What a batch may have: arrays, tuples of arrays, batches, and what is the same for all cases."""

    name: str
    rows: np.ndarray
    several: tuple
    inner: Inner
    number: np.float64
    nothing: None = None


def outer():
    rows = np.arange(12.0).reshape(6, 2)
    inner = Inner(10 * np.arange(6), 3.0)
    return Outer("all", rows, (np.arange(6), -np.arange(6.0)), inner, np.float64(7.0))


def test_a_part_has_the_rows_of_its_cases_and_what_is_the_same_for_all():
    whole = outer()
    for index in (np.array([4, 0]), slice(1, 3), np.arange(6) % 2 == 0, [2]):
        part = whole.take(index)
        assert_array_equal(part.rows, whole.rows[index])
        assert_array_equal(part.several[1], whole.several[1][index])
        assert_array_equal(part.inner.values, whole.inner.values[index])
        assert (part.name, part.number, part.nothing, part.inner.unit) == ("all", 7.0, None, 3.0)


def test_parts_at_their_places_are_the_whole():
    whole, places = outer(), [np.array([1, 4]), np.array([0, 2, 5]), np.array([3])]
    parts = [whole.take(place) for place in places]
    again = batch.join(parts, places)
    assert_array_equal(again.rows, whole.rows)
    assert_array_equal(again.several, whole.several)
    assert_array_equal(again.inner.values, whole.inner.values)
    assert again.name == "all" and again.inner.unit == 3.0
    assert_array_equal(batch.join(parts).rows, whole.rows[np.concatenate(places)])
    given = batch.join(parts, places, inner=whole.inner)
    assert given.inner is whole.inner
    assert_array_equal(given.rows, whole.rows)


def test_numbers_of_numpy_are_no_batches():
    """They have a method `take` too."""
    assert not batch.is_batch(np.float64(1.0)) and batch.is_batch(HalfSpace(np.ones(2), np.zeros(2)))
    assert not batch.is_batch(LAWS["smooth"])
    assert replace(outer(), number=np.float64(2.0)).take([0]).number == 2.0


def test_cases_are_alike_if_no_column_differs():
    words, numbers = np.array(["a", "b", "a", "a", "b"]), np.array([1, 1, 2, 1, 1])
    groups = batch.alike(words, numbers)
    assert sorted(rows.tolist() for rows in groups) == [[0, 3], [1, 4], [2]]
    assert [rows.tolist() for rows in batch.alike(np.array([3, 3]))] == [[0, 1]]
    assert batch.alike(words[:0], numbers[:0]) == []


def test_a_march_goes_on_with_those_that_have_not_ended():
    """Halving numbers until they are below 1: each case makes its own steps, and what is carried is of its cases."""
    values, steps = np.array([0.5, 3.0, 20.0, np.nan]), np.zeros(4, dtype=int)

    def step(active, now):
        assert len(active) == len(now)
        steps[active] += 1
        return ~(now / 2 >= 1), now / 2

    assert batch.march(step, np.arange(4), values).tolist() == []
    assert steps.tolist() == [1, 2, 5, 1]
    assert batch.march(step, np.arange(4), values, most=1).tolist() == [1, 2]
    assert batch.march(lambda active: active > 0, np.arange(3), most=4).tolist() == [0]
    assert batch.march(step, np.arange(0), np.zeros(0)).tolist() == []
