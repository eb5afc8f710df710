"""The numbers of some 80 cases of every kind as the present NUMERICS_VERSION has them: golden_numbers.csv.

That they are right is for other tests to say, test_golden_known.py among them. Here no change may move them unnoticed:
what was computed under one NUMERICS_VERSION is taken for the same, and reused.
"""

import csv

import make_golden_numbers as golden
import numpy as np
import pytest

from solver import NUMERICS_VERSION

LINES = golden.FILE.read_text(encoding="utf-8").splitlines()
ROWS = list(csv.DictReader(LINES[1:]))
REMAKE = "and run `python tools/references/make_golden_numbers.py`"
#: A thousandth of the usual rtol, and a hundred times the rounding of the exact layer's operator.
SAME = 1e-9
#: The paper's approximations amplify rounding, and end where they move by less than rtol/10.
SETTLED = 1e-5
#: An error estimate is the difference of two solutions, each with its rounding, which is 1e-11 at most.
#: That of the profiles looks at polynomials at the edge too, where rounding is ten times larger (on an ARM processor).
ESTIMATE, OF_PROFILES = {"rtol": 1e-2, "atol": 1e-11}, {"rtol": 1e-2, "atol": 1e-10}


def test_the_table_belongs_to_the_numerics_version():
    assert LINES[0] == f"# NUMERICS_VERSION {NUMERICS_VERSION}", f"NUMERICS_VERSION was changed: look why, {REMAKE}"
    given = [{name: str(value) for name, value in (golden.MAIN | change).items()} for change in golden.CASES]
    assert given == [{name: row[name] for name in golden.MAIN} for row in ROWS], f"the cases were changed: {REMAKE}"


@pytest.fixture(scope="module")
def found(each_path):
    """The answers (dict of arrays) to all rows, all of a control in one batch."""
    numbers = {name: np.full(len(ROWS), np.nan) for name in (*golden.EXACT, *golden.ERRORS, *golden.NUMBERS)}
    for control in ("P", "a", "D"):
        index = [i for i, row in enumerate(ROWS) if row["control"] == control]
        case = {name: [convert(name, ROWS[i][name]) for i in index] for name in golden.MAIN if name != "control"}
        part = golden.answers({control: case.pop("value")} | case)
        for name, values in part.items():
            numbers[name][index] = values
    return numbers


def convert(name, text):
    """A parameter from its text in the table."""
    return text if name in golden.TEXT else int(text) if name in golden.WHOLE else float(text)


def column(name):
    """A column of the table."""
    return np.array([float(row[name]) for row in ROWS])


def assert_same(name, values, rtol, atol=0.0):
    """Values (B,) agree with a column; else the message names the cases and what to do."""
    expected = column(name)
    moved = np.flatnonzero(~np.isclose(values, expected, rtol=rtol, atol=atol, equal_nan=True))
    text = [f"line {i + 3}: {expected[i]:.15g} is now {values[i]:.15g}" for i in moved]
    assert not text, f"{name} has moved: if it had to, bump NUMERICS_VERSION {REMAKE}. " + "; ".join(text)


@pytest.mark.parametrize("name", golden.EXACT)
def test_what_is_counted(found, name):
    chaotic = np.array([row["scheme"] == "picard" for row in ROWS]) & (name == "iterations")
    assert_same(name, np.where(chaotic, column(name), found[name]), rtol=0)


@pytest.mark.parametrize("name", golden.ERRORS)
def test_error_bars(found, name):
    assert_same(name, found[name], **OF_PROFILES if name == "profile_error" else ESTIMATE)


@pytest.mark.parametrize("name", golden.NUMBERS)
def test_numbers(found, name):
    assert_same(name, found[name], np.where([row["scheme"] == "picard" for row in ROWS], SETTLED, SAME))


def test_every_kind_is_there():
    """Status but those of the paper's scheme, models, bases, laws, tables, controls, bondings, punches, heights."""
    assert set(column("status")) >= {0, 1, 4, 5, 6, 8, 10} and set(column("model_used")) == set(range(1, 9))
    for name, choices in {"base": 4, "micro": 9, "control": 3, "bonding": 2, "scheme": 2, "model_check": 2}.items():
        assert len({row[name] for row in ROWS}) == choices
    assert {row["base"] for row, n in zip(ROWS, column("n"), strict=True) if n == 0} == {
        "thin_layer",
        "layered",
        "auto",
    }
    assert {row["base"] for row, m in zip(ROWS, column("m"), strict=True) if m > 0} == {row["base"] for row in ROWS}
    spread = {(float(row["sigma"]), float(row["cut"])) for row in ROWS if row["micro"] == "normal_heights"}
    assert min(spread)[0] == 0 and len({cut for _, cut in spread}) == 3 and len({sigma for sigma, _ in spread}) > 3
