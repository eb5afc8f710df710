"""Which way solves which cases, and what each base is: the two tables that say it."""

import re

import numpy as np
import pytest
import xarray as xr
from conftest import ROOT

from solver import Problem, bases, solve
from solver.ways import WAYS, by_equation, unfit, way_of

LAYER = {"h": 0.02, "n": 0.5}
ROUGH, SMOOTH = {"Nbar": 250000.0, "Ra": 0.004}, {"micro": "smooth"}
CONE, FLAT = {"shape": "cone", "half_angle": 70.0}, {"shape": "flat", "flat_radius": 0.1}
STICKS = {"w_adhesion": 1e-6}
#: Cases, the name of their way, and the equation by which a solved one can be found again.
CASES = [
    (ROUGH | {"base": "half_space"}, "by_scheme", "nodes"),
    (ROUGH | {"base": "thin_layer"}, "by_scheme", "nodes"),
    (ROUGH | {"scheme": "picard"}, "by_scheme", "nodes"),
    (ROUGH | CONE, "by_scheme", "nodes"),
    (ROUGH | FLAT, "flat", "flat"),
    (SMOOTH | {"base": "half_space"}, "hertz", "nodes"),
    (SMOOTH | {"base": "thin_layer"}, "springs", "nodes"),
    (SMOOTH, "by_scheme", "nodes"),
    (SMOOTH | CONE, "shaped", "basis"),
    (SMOOTH | FLAT | {"base": "half_space"}, "shaped", "basis"),
    (SMOOTH | STICKS, "sticking", "basis"),
    (SMOOTH | STICKS | CONE | {"base": "half_space"}, "sticking", "basis"),
]
#: What each base is: without a layer, on springs, one layer on springs, a stack, exact, to be chosen; the exact base.
WORDS = {
    "half_space": (True, False, False, False, False, False, "half_space"),
    "thin_layer": (False, True, True, False, False, False, "layered"),
    "layered": (False, False, False, False, True, False, "layered"),
    "auto": (False, False, False, False, False, True, "layered"),
    "stack": (False, False, False, True, True, False, "stack"),
    "thin_stack": (False, True, False, True, False, False, "stack"),
}
ASKED = (bases.is_bare, bases.on_springs, bases.is_thin_layer, bases.is_stack, bases.is_exact, bases.is_chosen)


@pytest.mark.parametrize(("case", "name", "equation"), CASES)
def test_each_case_has_its_way(case, name, equation):
    problem = Problem.of(P=1e-5, **LAYER | case)
    assert WAYS[way_of(problem)[0]].name == name
    assert [by_equation(problem, word)[0] for word in ("nodes", "flat", "basis")] == [
        word == equation for word in ("nodes", "flat", "basis")
    ]
    assert not unfit(problem).any()


def test_ways_do_not_depend_on_the_company():
    """Of all cases with one parameter set in one batch, each has the way that it has alone, and the same bits."""
    names = sorted({name for case, _, _ in CASES for name in case})
    usual = {"micro": "disc_cell", "base": "layered", "scheme": "newton", "shape": "paraboloid", "w_adhesion": 0.0}
    usual |= {"Nbar": 1e6, "Ra": 0.01, "half_angle": 45.0, "flat_radius": 1.0}
    columns = {name: [case.get(name, usual[name]) for case, _, _ in CASES] for name in names}
    together = Problem.of(P=1e-5, **LAYER, **columns)
    assert [WAYS[place].name for place in way_of(together)] == [name for _, name, _ in CASES]
    smooth = np.flatnonzero(~together.rough())
    for i in smooth:
        alone = solve(together.take([i]))
        np.testing.assert_array_equal(solve(together.take(smooth)).take([smooth.tolist().index(i)]).a, alone.a)


def test_what_each_base_is():
    array = np.array(list(WORDS))
    assert tuple(WORDS) == bases.BASES
    for column, asked in enumerate(ASKED):
        expected = [row[column] for row in WORDS.values()]
        assert [asked(word) for word in WORDS] == expected, asked.__name__
        assert asked(array).tolist() == expected
        labelled = asked(xr.DataArray(array, dims="base"))
        assert isinstance(labelled, xr.DataArray) and labelled.values.tolist() == expected
    assert bases.exact_of(array).tolist() == [row[-1] for row in WORDS.values()]
    assert bases.named(array).tolist() == [word.replace("auto", "layered") for word in WORDS]
    assert bases.is_exact_stack(array).tolist() == [word == "stack" for word in WORDS]
    assert bases.may_be_layered(array).tolist() == [word in ("layered", "auto") for word in WORDS]


def test_no_other_file_compares_the_words_of_bases():
    word = re.compile(rf'base\b[^=\n]{{0,12}}[!=]= *[("\']*({"|".join(WORDS)})')
    files = [path for room in ("solver", "study") for path in (ROOT / room).rglob("*.py")]
    assert [path.name for path in files if word.search(path.read_text(encoding="utf-8"))] == []
