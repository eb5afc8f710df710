"""Functions of the basis at waves, by recurrence and by scipy."""

import pytest
from numpy.testing import assert_allclose

from solver.body.wave_rule import FILM
from solver.smooth.products import _waves


@pytest.mark.parametrize(("octave", "size"), [(-2, 22), (FILM, 60)])
def test_recurrence_has_all_digits_but_the_last(octave, size):
    one, other = (_waves(octave, 0, size, by_recurrence) for by_recurrence in (False, True))
    assert_allclose(other.near, one.near, rtol=0, atol=2e-14)
    assert_allclose(other.far, one.far, rtol=0, atol=2e-14)
