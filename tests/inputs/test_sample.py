"""The section [sample]: random cases that are the same on every machine, and what is refused."""

import tomllib

import numpy as np
import pytest

from study import StudyError
from study.inputs.reading import from_tables
from study.inputs.sample import uniform

GOOD = """
[sample]
size = 4000
seed = 7
P = { start = 1e-12, stop = 0.1, spacing = "log" }
Nbar = { start = 1e-6, stop = 1e6, spacing = "log", over = "Ra^2" }
Ra = { start = 1e-5, stop = 0.1, spacing = "log" }
nu1 = { start = 0, stop = 0.5 }
h = { start = 1, stop = 2, over = "Ra" }
n = [0.1, 0.5]
bonding = ["frictionless", "bonded"]
[axes]
micro = ["smooth", "disc_cell"]
"""


def grid_of(text: str = GOOD):
    return from_tables(tomllib.loads(text), "mine", text, "mine.toml").grid


def column(name: str, text: str = GOOD) -> np.ndarray:
    dims, array = grid_of(text).values[name]
    assert dims == ("case",)
    return array


def test_a_sample_is_the_dimension_case_and_goes_with_axes():
    grid = grid_of()
    assert grid.sizes == {"case": 4000, "micro": 2}
    np.testing.assert_array_equal(grid.labels["case"][1], np.arange(4000))
    assert grid.values["rtol"][0] == ()


def test_the_ranges_are_filled_evenly():
    """Each tenth of a range holds a tenth of the cases, to four standard deviations."""
    P, Ra = column("P"), column("Ra")
    shares = {
        "P": np.log10(P / 1e-12) / 11,
        "Ra": np.log10(Ra / 1e-5) / 4,
        "Nbar Ra^2": np.log10(column("Nbar") * Ra**2 / 1e-6) / 12,
        "nu1": column("nu1") / 0.5,
        "h Ra": column("h") * Ra - 1,
    }
    for name, share in shares.items():
        assert share.min() > -1e-5 and share.max() < 1 + 1e-5, name
        counts, _ = np.histogram(share, 10, (-1e-5, 1 + 1e-5))
        assert np.all(np.abs(counts - 400) < 4 * np.sqrt(400 * 0.9)), name
    for name, value in (("n", 0.1), ("bonding", "bonded")):
        assert abs((column(name) == value).sum() - 2000) < 4 * np.sqrt(4000) / 2
    together = np.corrcoef([*shares.values(), column("n"), column("bonding") == "bonded"])
    assert np.all(np.abs(together - np.eye(len(together))) < 4.5 / np.sqrt(4000)), "each has a stream of its own"


def test_the_draws_are_the_same_on_every_machine():
    """The upper bits of PCG64, by the published algorithm, on the seed sequence that numpy documents as stable."""
    state = np.random.PCG64([7, *b"P"]).state["state"]
    x, step = state["state"], state["inc"]
    expected = []
    for _ in range(3):
        x = (x * 0x2360ED051FC65DA44385DF649FCCF645 + step) % 2**128
        word, turn = (x >> 64) ^ (x % 2**64), x >> 122
        expected.append(((word >> turn | word << (64 - turn)) % 2**64 >> 11) / 2**53)
    assert uniform(3, 7, "P").tolist() == expected
    assert column("P")[:3].tolist() == [1.31297e-05, 3.61967e-06, 2.43105e-12]
    assert column("nu1")[:3].tolist() == [float(f"{u / 2:.5e}") for u in uniform(3, 7, "nu1")]
    assert column("n")[:3].tolist() == [0.1 if u < 0.5 else 0.5 for u in uniform(3, 7, "n")]
    assert column("Nbar")[:3].tolist() == [884046.0, 14526900000.0, 3607970.0]


def test_six_digits_within_the_range():
    for name in ("P", "Nbar", "Ra", "h", "nu1"):
        assert all(float(f"{value:.5e}") == value for value in column(name).tolist())
    n = column("Ra", GOOD.replace("start = 1e-5, stop = 0.1", "start = 0.09999998, stop = 0.09999999"))
    assert n.min() >= 0.09999998 and n.max() <= 0.09999999


def test_a_sample_can_be_continued():
    longer, other = GOOD.replace("size = 4000", "size = 5000"), GOOD.replace("seed = 7", "seed = 8")
    wider = GOOD.replace("nu1 =", "nu2 = { start = 0, stop = 0.5 }\nnu1 =")
    for name in ("P", "Nbar", "n"):
        np.testing.assert_array_equal(column(name, longer)[:4000], column(name))
        np.testing.assert_array_equal(column(name, wider), column(name))
        assert (column(name, other) != column(name)).mean() > 0.3
    assert (column("nu1", wider) != column("nu2", wider)).all()


def test_ranges_without_overflow():
    P = column("P", GOOD.replace("start = 1e-12, stop = 0.1", "start = 1e-24, stop = 1e3"))
    assert np.isfinite(P).all() and P.min() < 1e-23 and P.max() > 1e2


# what is replaced in GOOD, by what, and the message that must appear
BAD = [
    ("size = 4000", "", "[sample] size is missing: must be a whole number in [1, 1000000]"),
    ("size = 4000", "size = 0", "[sample] size = 0: must be a whole number in [1, 1000000]"),
    ("size = 4000", "size = true", "[sample] size = True: must be a whole number in [1, 1000000]"),
    ("seed = 7", "", "[sample] seed is missing: must be a whole number in [0, 4294967295]"),
    ("seed = 7", "seed = -1", "[sample] seed = -1: must be a whole number in [0, 4294967295]"),
    ("nu1 =", "nu3 =", '[sample] "nu3" is not a parameter; did you mean "nu'),
    ("n = [0.1, 0.5]", "micro = ['smooth']\nn = [0.1]", "micro is given twice: in [sample] and in [axes]"),
    ("nu1 = {", "base = {", "[sample] base = {'start': 0, 'stop': 0.5}: must be a list to choose from"),
    ("nu1 = {", "nodes = {", "[sample] nodes = {'start': 0, 'stop': 0.5}: must be a list to choose from"),
    ("nu1 = { start = 0, stop = 0.5 }", "nu1 = 0.3", "[sample] nu1 = 0.3: must be {start, stop, spacing, over} or a"),
    ("n = [0.1, 0.5]", "n = []", "[sample] n = []: must be {start, stop, spacing, over} or a list to choose from"),
    ("n = [0.1, 0.5]", "n = [-1]", "n = -1: must be 0 or in [1e-9, 1e9]"),
    ("n = [0.1, 0.5]", "n = [[1, 2], 0.5]", "n[0] = [1, 2]: must be a finite number, 0 or in [1e-9, 1e9]"),
    ("stop = 0.5", "stop = 0.5, num = 3", '[sample] nu1: "num" is not allowed; a range is {start, stop, spacing'),
    ("stop = 0.5", "stop = 0.0", "[sample] nu1: stop = 0.0: must be > start"),
    ("stop = 0.5", "stop = 0.9", "[sample] nu1: stop = 0.9: must be in (-1, 0.5]"),
    ("start = 0,", "start = -1.5,", "[sample] nu1: start = -1.5: must be in (-1, 0.5]"),
    ("start = 0,", "", "[sample] nu1: start is missing: must be a finite number"),
    ("start = 1e-12", "start = 0", "[sample] P: start = 0: must be a finite number, > 0 for spacing log"),
    ('stop = 0.1, spacing = "log" }\nN', 'stop = 0.1, spacing = "cubic" }\nN', '[sample] P: spacing = "cubic": must'),
    ('"Ra^2"', '"Rx^2"', '[sample] Nbar: over = "Rx^2": must be a power of a range of [sample]: P or Ra or nu1'),
    ('"Ra^2"', '"Ra^0"', '[sample] Nbar: over = "Ra^0": must be a power of a range of [sample]: P or Ra or nu1'),
    ('"Ra^2"', '"h"', '[sample] Nbar: over = "h": must be a power of a range of [sample]: P or Ra or nu1'),
    ('"Ra^2"', "2", "[sample] Nbar: over = 2: must be a power of a range of [sample]: P or Ra or nu1"),
    ("[axes]", "[[cases]]\nnu2 = 0.3\n[axes]", "[sample] and [[cases]] both make the dimension case: only one of them"),
    (GOOD, "sample = 3\nmodel.P = 1e-5\nmodel.micro = 'smooth'\nmodel.base = 'half_space'", "sample = 3: must be a"),
    (GOOD, "model={P=1,micro='smooth',base='half_space'}\nsample={size=1,seed=1}", "[sample] has no parameter: must"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "expected"), BAD, ids=lambda text: text[:30])
def test_bad_samples(old, new, expected):
    assert old in GOOD
    with pytest.raises(StudyError) as caught:
        grid_of(GOOD.replace(old, new, 1))
    messages = caught.value.messages
    assert all(message.startswith("mine.toml: ") for message in messages)
    assert any(expected in message for message in messages), messages
    assert len(messages) == 1, messages


def test_a_value_that_is_not_drawn_is_checked_too():
    text = GOOD.replace("size = 4000", "size = 1").replace("[0.1, 0.5]", "[0.1, 0.5, -1]")
    with pytest.raises(StudyError, match=r"n\[2\] = -1: must be 0 or in"):
        grid_of(text)
    assert grid_of(text.replace(", -1]", "]")).sizes["case"] == 1
