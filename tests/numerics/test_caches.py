"""What is kept of costly results: the latest used, within a number of bytes."""

import numpy as np
from numpy.testing import assert_array_equal

from solver.numerics.caches import Cache


def array(number, size=10):
    return np.full(size, float(number))


def test_the_oldest_go_and_those_in_use_stay():
    kept, made = Cache(250.0), []

    def get(number):
        return kept.get(number, lambda: made.append(number) or array(number))

    for number in range(5):  # of 80 bytes each
        assert_array_equal(get(number), array(number))
        assert_array_equal(get(0), array(0))
    assert made == [0, 1, 2, 3, 4] and kept.nbytes == 240
    assert [value[0] for value in kept.values()] == [3, 4, 0]
    get(1)
    assert made[-1] == 1 and [value[0] for value in kept.values()] == [4, 0, 1]


def test_several_are_made_at_once_if_they_are_not_kept():
    kept, made = Cache(1000.0), []

    def make(missing):
        made.append(missing)
        return [array(number) for number in missing]

    kept.several([1, 2], make)
    assert [value[0] for value in kept.several([2, 3, 1, 4], make)] == [2, 3, 1, 4]
    kept.several([4, 1], make)
    assert made == [[1, 2], [3, 4]] and kept.nbytes == 320
    assert [value[0] for value in kept.values()] == [2, 3, 4, 1]


def test_one_that_is_larger_than_all_is_kept_alone():
    kept = Cache(1.0)
    first = kept.get("first", lambda: array(1))
    assert kept.get("first", lambda: array(2)) is first
    kept.get("second", lambda: array(2))
    assert len(kept.values()) == 1 and kept.nbytes == 80


def test_what_several_share_counts_once_until_the_last_has_gone():
    kept, shared = Cache(1000.0), array(0)
    for number in range(3):
        kept.get(number, lambda number=number: (shared, [array(number)], None, "text"))
    assert kept.nbytes == 80 * 4
    kept.get("large", lambda: array(9, 116))  # 928 bytes: all of the others go
    assert kept.nbytes == 928
    kept.get("again", lambda: (shared, shared))
    assert len(kept.values()) == 1 and kept.nbytes == 80
    assert kept._uses == {id(shared): 2}, "of arrays that have gone nothing is left, however many there were"


def test_what_is_not_kept_is_not_found():
    kept = Cache(100.0)
    assert kept.find("first") is None
    first = kept.get("first", lambda: array(1))
    assert kept.find("first") is first
