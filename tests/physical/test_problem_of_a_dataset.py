"""From a dataset to the problem of its inputs, and from inputs to a dataset that is not solved."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import study
from solver import solve
from study.data.contacts import Contacts
from study.inputs.request import AnyValue
from study.inputs.vocabulary import NOT_RUN
from study.solving import unsolved

BALL = {"R": "5 mm", "punch": "steel 52100", "body": "copper", "micro": "smooth"}
STACK = [
    {"h": "2 um", "material": "TiN", "bonding": "bonded"},
    {"h": "1 um", "E1": "80 GPa", "bonding": {"cn": "1 um/GPa"}},
]
CALLS = {
    "pure": {"P": [1e-5, 2e-5], "base": "half_space", "micro": "smooth"},
    "units": {"P": ["1 N", "2 N"], "h": ["1 um", "2 um", "3 um"], "layer": "TiN", **BALL},
    "a stack": {"D": "1 um", "layers": STACK, "layers.2.h": ["1 um", "2 um"], **BALL},
    "a graded layer": {"a": 0.05, "layers": [{"h": 0.1, "n": [1, 2], "profile": "linear"}], "micro": "smooth"},
    "cases": {"cases": [{"P": 1e-5, "base": "half_space"}, {"P": 2e-5, "h": 0.1, "n": 2.0}], "micro": "smooth"},
    "a cone": {"P": "1 mN", "shape": "cone", "half_angle": "70 deg", "E2": "1 GPa", "base": "half_space", "R": None},
}


@pytest.mark.parametrize("kind", CALLS)
def test_the_problem_is_that_of_the_call(kind):
    """It has the numbers of the results, and those of the inputs before they are solved."""
    call = {"micro": "smooth"} | {name: value for name, value in CALLS[kind].items() if value is not None}
    dataset = study.solve(**call, x=2)
    contacts = Contacts.of(dataset, "test")
    solution, (stress, size) = solve(contacts.problem), contacts.units
    for name, unit in {"P": stress * size**2, "a": size, "D": size, "p0": stress}.items():
        assert_allclose(getattr(solution, name) * unit, contacts.column(dataset[name].variable), rtol=1e-14, atol=0)
    if "cases" in call:  # first yield takes none
        return
    before = unsolved("test", call)
    assert (before.status == NOT_RUN).all() and before.status.dims == dataset.status.dims
    assert {*before.coords} == {*dataset.coords} and [*before.data_vars] == ["status"]
    problem = Contacts.of(before, "test").problem
    assert {*problem.parameters} == {*contacts.problem.parameters}
    for name, values in problem.parameters.items():
        assert_array_equal(values, contacts.problem.parameters[name])


def test_coordinates_over_all_cases():
    dataset = study.solve(P=["1 N", "2 N"], h=["1 um", "2 um"], layer=["TiN", "CrN"], **BALL)
    contacts = Contacts.of(dataset, "test")
    h, layer = (dataset[name].broadcast_like(dataset.status).transpose(*dataset.status.dims) for name in ("h", "layer"))
    assert_array_equal(contacts.coordinate("h", 0.0), h.values.ravel())
    assert_array_equal(contacts.column(dataset["layer"].variable), layer.values.ravel())
    assert np.isnan(contacts.coordinate("Y1", np.nan)).all() and contacts.units[1].tolist() == [5e-3] * 8


def test_any_value_has_the_unit_that_the_others_have():
    for call, P in ((BALL | {"E1": "1 GPa", "h": "1 um"}, 1e-9), ({"h": 0.1, "n": 2.0, "micro": "smooth"}, 1e-3)):
        assert pytest.approx(P, rel=1e-12) == unsolved("test", call | {"P": AnyValue(1e-3, "1 nN")}).P
