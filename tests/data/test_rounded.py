"""Numbers in sentences: a hundred is written as 100, not as a power of ten."""

import pytest

import study
from study.terminal import rounded


@pytest.mark.parametrize(
    ("number", "text"),
    [(99.4, "99"), (99.7, "100"), (150.0, "150"), (1234.0, "1200"), (0.5, "0.5"), (1e-3, "0.001"), (1.5e6, "1.5e+06")],
)
def test_a_number_is_plain_up_to_a_million(number, text):
    assert rounded(number) == text


def test_the_strength_of_a_contact_far_beyond_yielding():
    """A steel ball at some hundred times its load of first yield: the sentence said 1e+02 and 1.5e+02 times."""
    ball = {"R": "5 mm", "punch": "steel 52100", "body": "steel 316L", "base": "half_space", "micro": "smooth"}
    with pytest.warns(UserWarning):
        contact = study.solve(**ball, a=["2.5 mm"])
    assert "e+0" not in study.summary(contact.isel(a=0))
