"""From tables to a grid: the order of its dimensions, defaults, gaps, and values just outside of what is allowed."""

import tomllib
from decimal import Decimal

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import study
from solver.parameters import Parameter
from study import StudyError
from study.inputs.definition import Definition
from study.inputs.grid import as_array
from study.inputs.lexicon import PACKAGE
from study.inputs.reading import from_tables

SMOOTH = {"micro": "smooth", "base": "half_space"}


def defined(text: str = "", **tables) -> Definition:
    return from_tables(tomllib.loads(text) | tables, "s", text, "s")


def messages(text: str = "", **tables) -> list[str]:
    with pytest.raises(StudyError) as caught:
        defined(text, **tables)
    return [message.removeprefix("s: ") for message in caught.value.messages]


def test_dimensions_stand_in_the_order_of_the_file_but_cases_come_first():
    text = "[axes]\nnu2 = [0.1, 0.2]\nP = [1, 2]\nnu1 = [0, 0.1, 0.2]\n[model]\nbase = 'half_space'\nmicro = 'smooth'\n"
    assert list(defined(text).grid.sizes) == ["nu2", "P", "nu1"]
    assert list(defined(text + "[[cases]]\nk = 1\n[[cases]]\nk = 2\n").grid.sizes) == ["case", "nu2", "P", "nu1"]
    drawn = text + "[sample]\nsize = 2\nseed = 1\nk = { start = 1, stop = 2 }\n"
    assert list(defined(drawn).grid.sizes) == ["case", "nu2", "P", "nu1"]


def test_profiles_are_in_the_order_of_the_vocabulary():
    one, other = (
        defined(model=SMOOTH | {"P": 1}, output={"profiles": list(given)}) for given in (("lam", "p"), ("p", "lam"))
    )
    assert one.profiles == other.profiles == ("p", "lam") and one.digest == other.digest


@pytest.mark.parametrize("kind", [np.array, pd.Series, xr.DataArray])
def test_points_may_be_labelled(kind):
    assert study.solve(**SMOOTH, P=1e-5, x=kind([0, 0.5, 1])).x.values.tolist() == [0, 0.5, 1]


@pytest.mark.parametrize("x", [[0, 0.5, 0.5, 1], [0.1, 1], [0, 0.9], [0], [1, 0], [0, 1, 1], [-0.1, 0, 1]])
def test_points_increase_from_0_to_1(x):
    assert messages(model=SMOOTH | {"P": 1}, output={"x": x}) == [
        f"x = {x}: a list must increase from 0 to 1, both included"
    ]


def test_a_micro_law_in_the_wrong_place():
    assert messages(model=SMOOTH | {"P": 1, "micro": ["smooth", "disc_cell"]}) == [
        "[model] micro has several values: these belong in [axes]"
    ]


def test_numerics_reach_the_grid():
    given = {"scheme": "picard", "k": 2.0, "rtol": 1e-4, "accuracy": 0.1, "model_check": "first_order", "nodes": 16,
             "max_iterations": 7}  # fmt: skip
    rough = SMOOTH | {"micro": "disc_cell", "Nbar": 1e5, "Ra": 0.004}
    found = defined(model=rough | {"P": 1}, numerics=given | {"block": 3})
    assert {name: found.grid.values[name][1].item() for name in given} == given and found.block == 3


def test_rows_of_cases():
    """What a row leaves out is its default, or nothing; the number of a case is its place, from 0."""
    rows = [{"P": 1, "nu1": 0.1, "label": "b"}, {"P": 1, "h": 2.0, "label": "a"}, {"P": 2}]
    grid = defined(cases=rows, model=SMOOTH).grid
    assert grid.labels["case"][1].tolist() == [0, 1, 2] and grid.labels["case"][1].dtype == np.int32
    assert grid.labels["label"][1].tolist() == ["b", "a", ""]
    assert grid.values["nu1"][1].tolist() == [0.1, 0.3, 0.3]
    np.testing.assert_array_equal(grid.values["h"][1], [np.nan, 2.0, np.nan])
    assert messages(cases=[rows[0], rows[0] | {"label": "c"}], model=SMOOTH) == ["cases 0 and 1 are the same"]
    assert messages(cases=[rows[0], rows[1] | {"label": "b"}], model=SMOOTH) == [
        'label[0] and label[1] are both "b": values of an axis must differ'
    ]


def test_what_is_missing_is_said_with_the_first_case_that_needs_it():
    """Thin layers need h and n, whatever the others are."""
    rows = [{"P": 1, "base": "half_space"}, {"P": 2, "base": "thin_layer", "n": 0.5}, {"P": 3, "h": 1.0, "n": 0.5}]
    assert messages(cases=rows, model={"micro": "smooth"}) == [
        'h is missing in case 1: base = "thin_layer" or "layered" needs it'
    ]
    assert messages(cases=[rows[0], {"base": "half_space"}], model={"micro": "smooth"}) == ["P is missing in case 1"]
    several = [rows[2] | {"P": 4}, *({"P": P, "n": 0.5} for P in (5, 6, 7))]
    assert messages(cases=several, model={"micro": "smooth"}) == ['h is missing in case 1: base = "layered" needs it']
    grid = defined(cases=[rows[0], {"P": 2}], model={"micro": "smooth", "h": 1.0, "n": 0.5}).grid
    assert grid.values["base"][1].tolist() == ["half_space", "layered"]


def test_what_is_missing_is_said_beside_other_mistakes():
    said = messages(model={"micro": "smooth", "P": -1, "bonding": "glued"}, axes={"n": []})
    assert [text.split(":")[0] for text in said] == ["n is empty", "P = -1", 'bonding = "glued"', "h is missing"]
    said = messages(model={"micro": "smooth", "P": 1, "n": 0.5, "hh": 0.1})  # it may be the thickness
    assert said == ['[model] "hh" is not a parameter; did you mean "h"?']
    assert len(messages(model={"base": "soft", "P": 1, "n": 0.5, "micro": "smooth"})) == 1


def test_an_axis_that_only_some_points_need_is_asked_of_all():
    """Along another dimension than the base: a layered row needs h of every case."""
    rows, axes = [{"P": 1, "h": 0.1}, {"P": 2}], {"base": ["half_space", "layered"]}
    expected = 'h is missing in case 1: base = "layered" needs it'
    assert messages(cases=rows, axes=axes, model={"micro": "smooth", "n": 0.5}) == [expected]
    assert defined(cases=rows, axes={"base": ["half_space"]}, model={"micro": "smooth"}).grid.size == 2


def test_a_value_between_a_single_one_and_the_interval_is_refused():
    """Also where floats are checked by their extremes."""
    own = Parameter(interval="[4, 256]", also=(0,))
    errors = []
    as_array(own, [0.0, 2.0, 8.0], "q", errors)
    assert errors == ["q[1] = 2.0: must be 0 or in [4, 256]"]
    assert as_array(own, [0.0, 8.0], "q", errors).tolist() == [0, 8] and len(errors) == 1


def test_decimal_numbers():
    """As databases give them."""
    errors, own = [], PACKAGE.parameter("P")
    assert as_array(own, [Decimal("1e-5"), 2e-5], "P", errors).tolist() == [1e-5, 2e-5] and not errors
    as_array(own, [Decimal("sNaN")], "P", errors)
    assert errors == ["P = sNaN: must be a finite number, in [1e-24, 1e3]"]


def test_nothing_is_a_value_only_where_gaps_are_allowed():
    errors = []
    assert np.isnan(as_array(PACKAGE.parameter("h"), [None, 1.0], "h", errors, gaps=True)).tolist() == [True, False]
    as_array(PACKAGE.parameter("h"), [None, 1.0], "h", errors)
    assert errors == ["h[0] = None: must be a finite number, in [1e-12, 1e6]"]


def test_long_values_are_cut_in_messages():
    (message,) = messages(model=SMOOTH | {"P": "9" * 61})
    assert message == 'P = "' + "9" * 56 + "...: must be a finite number, in [1e-24, 1e3]"
    (message,) = messages(model=SMOOTH | {"P": "9" * 58})
    assert message == 'P = "' + "9" * 58 + '": must be a finite number, in [1e-24, 1e3]'
