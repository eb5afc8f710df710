"""The grid of cases, and what `study.solve` makes of parameters in their several forms."""

from functools import cache

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import study
from study.inputs.grid import Grid, columns, unflatten

SMOOTH = {"micro": "smooth", "base": "half_space"}


@settings(deadline=None)
@given(shape=st.lists(st.integers(1, 5), max_size=4), data=st.data())
def test_columns_and_unflatten_are_inverse(shape, data):
    sizes = {f"d{i}": size for i, size in enumerate(shape)}
    values = {}
    for name in ("u", "v", "w"):
        dims = tuple(data.draw(st.permutations(list(sizes)))[: data.draw(st.integers(0, len(sizes)))])
        values[name] = dims, np.random.default_rng(len(dims)).random([sizes[dim] for dim in dims])
    grid = Grid(sizes, values)
    start = data.draw(st.integers(0, grid.size))
    stop = data.draw(st.integers(start, grid.size))
    whole, part = columns(grid, np.arange(grid.size)), columns(grid, np.arange(start, stop))
    for name, (dims, array) in values.items():
        expected = xr.DataArray(array, dims=dims).broadcast_like(xr.DataArray(np.empty(shape), dims=list(sizes)))
        np.testing.assert_array_equal(unflatten(grid, whole[name]), expected.transpose(*sizes))
        np.testing.assert_array_equal(part[name], whole[name][start:stop])


def test_scalars_sequences_and_results():
    found = study.solve(P=(1e-5, 2e-5, 4e-5), nu2=[0.3, 0.4], x=5, **SMOOTH)
    assert found.a.dims == ("P", "nu2")
    assert found.p.dims == ("P", "nu2", "x")
    assert found.x.values.tolist() == [0, 0.25, 0.5, 0.75, 1]
    np.testing.assert_allclose(found.a.sel(nu2=0.4), (0.75 * found.P) ** (1 / 3), rtol=1e-12, atol=0)  # Hertz
    assert found.base.item() == "half_space"
    assert "h" not in found
    assert (found.status == 0).all()


def test_one_case_has_no_dimension_but_x():
    found = study.solve(a=0.04, **SMOOTH)
    assert dict(found.sizes) == {"x": 33}
    assert found.a.ndim == 0
    np.testing.assert_allclose(found.D, 0.04**2, rtol=1e-12, atol=0)  # closed form


def test_profiles_can_be_left_out():
    found = study.solve(a=0.04, profiles=False, **SMOOTH)
    assert "p" not in found
    assert "lam" not in found
    assert found.p0.notnull()


def test_numpy_pandas_and_ranges_are_sequences():
    pandas = pytest.importorskip("pandas")
    for given_P in (np.array([1, 2]), pandas.Series([1, 2]), range(1, 3), (1, np.float32(2))):
        assert study.solve(P=given_P, **SMOOTH).P.values.tolist() == [1, 2]
    assert study.solve(P=np.float64(1), **SMOOTH).P.item() == 1
    assert study.solve(P=np.array(1.0), **SMOOTH).P.item() == 1


def test_text_axis_can_be_selected_by_name():
    found = study.solve(P=1e-5, h=0.02, n=0.5, micro="smooth", bonding=["frictionless", "bonded"])
    assert found.sel(bonding="bonded").bonding.item() == "bonded"


def test_whole_numbers_stay_whole():
    found = study.solve(P=1e-5, nodes=[8, 16], **SMOOTH)
    assert found.nodes.dtype.kind == "i"
    assert type(found.attrs["max_iterations"]) is int


def test_dataarray_over_its_own_dimension():
    P = xr.DataArray([1e-5, 2e-5], dims="sample", coords={"sample": ["u", "v"]})
    found = study.solve(P=P, nu2=0.2 + P * 1e4, **SMOOTH)
    assert found.a.dims == ("sample",)
    assert found.sel(sample="v").P.item() == 2e-5
    np.testing.assert_allclose(found.nu2, [0.3, 0.4], rtol=1e-14, atol=0)  # a rounding


def test_values_over_their_own_dimension_are_its_coordinate():
    """Twice the loads of a result, say, which carry those as their coordinate."""
    found = study.solve(P=2 * study.solve(P=[1e-5, 2e-5], **SMOOTH).P, **SMOOTH)
    assert found.indexes["P"].tolist() == [2e-5, 4e-5]


@pytest.mark.parametrize("first", ["P", "Ra"])
def test_dataarray_over_the_axis_of_another_parameter(first):
    both = {"P": [1e-5, 2e-5], "Ra": xr.DataArray([0.1, 0.2], dims="P", coords={"P": [1e-5, 2e-5]})}
    found = study.solve(**{first: both[first]}, **{k: v for k, v in both.items() if k != first}, **SMOOTH)
    assert found.sel(P=2e-5).Ra.item() == 0.2
    assert found.a.dims == ("P",)


def test_dataarray_of_two_dimensions_in_any_order():
    P = xr.DataArray(np.arange(1.0, 7).reshape(2, 3), dims=("u", "v"))
    nu2 = xr.DataArray(np.linspace(0, 0.4, 3), dims="v")
    found = study.solve(nu2=nu2, P=P, **SMOOTH)
    assert found.a.dims == ("v", "u")
    np.testing.assert_allclose(found.a.transpose("u", "v"), (0.75 * P) ** (1 / 3), rtol=1e-12, atol=0)  # Hertz


def array(values, *dims, **coords):
    return xr.DataArray(values, dims=dims, coords=coords)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"P": [1, 2], "Ra": array([1, 2, 3], "P")}, "Ra has 3 values along P, P has 2"),
        ({"Ra": array([1, 2, 3], "P"), "P": [1, 2]}, "Ra has 3 values along P, P has 2"),
        ({"P": [1, 2], "Ra": array([1, 2], "P", P=[1, 3])}, "Ra has other values of P, or in another order, than P"),
        (
            {"P": array([1, 2], "s", s=[1, 2]), "Ra": array([1, 2], "s", s=[1, 3])},
            "Ra has other values of s, or in another order, than P",
        ),
        ({"P": 1, "Ra": array([1, 2], "P")}, "P is a dimension and a parameter over other dimensions"),
        (
            {"P": 1, "Ra": array([1, 2], "h")},
            "the dimension h has the name of a parameter that is not given: rename it",
        ),
        ({"P": 1, "Ra": array([1, 2], "lam")}, 'a dimension cannot be called "lam", which is the name of a result'),
        ({"P": 1, "Ra": array([1, 2], "x")}, 'a dimension cannot be called "x", which is the name of a result'),
        ({"P": array([], "s")}, "P is empty: must have at least one value"),
        ({"P": array([1, 1], "P")}, "P[0] and P[1] are both 1.0: values of an axis must differ"),
        ({"P": array([1, -1], "s")}, "P[1] = -1: must be in [1e-24, 1e3]"),
        ({"P": []}, "P is empty: must have at least one value"),
        ({"P": [1, 1.0]}, "P[0] and P[1] are both 1.0: values of an axis must differ"),
        ({"P": np.ones((1, 2))}, "P = [1.0, 1.0]: must be a finite number, in [1e-24, 1e3]"),
        ({"P": range(10**12)}, "P is too long: at most 1000000 values are allowed"),
        ({"P": {"start": 1}}, "P = {'start': 1}: must be a finite number, in [1e-24, 1e3]"),
        ({"P": None}, "P = None: must be a finite number, in [1e-24, 1e3]"),
        ({"P": xr.Dataset()}, "P = <xarray.Dataset> Size: 0B\\nDimensions:  ()\\nData variables:...: must be a finite"),
        ({"cases": [{"P": 1e-5, "lable": "x"}]}, '[[cases]] "lable" is not a parameter; did you mean "label"?'),
        ({"P": 1 + 2j}, "P = (1+2j): must be a finite number, in [1e-24, 1e3]"),
        ({"P": np.bool_(True)}, "P = True: must be a finite number, in [1e-24, 1e3]"),
        ({"P": 1, "a": 2}, "exactly one of P, a, D must be given, not P and a"),
        ({}, "exactly one of P, a, D must be given, not none"),
        ({"P": 1, "Nabr": 2}, '"Nabr" is not a parameter; did you mean "Nbar"?'),
        ({"P": 1, "nodes": 16.5}, "nodes = 16.5: must be a whole number"),
        ({"cases": [{"P": 1}], "P": 1}, "P is given twice: in [[cases]] and elsewhere"),
        ({"cases": [{"P": 1, 2: 3}]}, '[[cases]] "2" is not a parameter'),
        ({"P": 1, "x": 1}, "x = 1: must be a whole number in [2, 10000]"),
    ],
    ids=str,
)
def test_bad_parameters(parameters, message):
    with pytest.raises(study.StudyError) as caught:
        study.solve(**parameters, **SMOOTH)
    assert len(caught.value.messages) == 1, caught.value.messages
    assert f"solve: {message}" in str(caught.value)


@pytest.mark.parametrize("cases", [{"P": 1}, [], [3], pd.DataFrame({"P": [1]})], ids=type)
def test_cases_are_a_list_of_dictionaries(cases):
    table = ' (of a table of pandas: cases=table.to_dict("records"))' * isinstance(cases, pd.DataFrame)
    with pytest.raises(study.StudyError) as caught:
        study.solve(cases=cases, **SMOOTH)
    assert caught.value.messages == (f"cases must be a list of dictionaries, at least one{table}",)


def test_solve_collects_all_messages():
    with pytest.raises(ValueError, match="h = 0") as caught:
        study.solve(P=-1, h=0, n=float("nan"), nu1=0.6, bonding="glued", Nabr=3)
    assert len(caught.value.messages) == 6


def test_what_a_case_does_not_need_stays_nan():
    """The solver does not look at it; no number is made up."""
    found = study.solve(cases=[{"base": "half_space"}, {"base": "layered", "h": 0.01}], P=1e-5, n=0.5, micro="smooth")
    assert np.array_equal(found.h, [np.nan, 0.01], equal_nan=True) and (found.status == 0).all()
    assert np.array_equal(
        columns(Grid({"case": 2}, {"h": (("case",), found.h.values)}), np.arange(2))["h"], found.h, True
    )


def test_cases_in_python_with_an_axis():
    cases = [
        {"P": 1e-5, "label": "u", **SMOOTH},
        {"P": 2e-5, "micro": "smooth", "h": 0.01, "n": 0.5, "bonding": None, "Ra": None},
    ]
    found = study.solve(cases=cases, nodes=[16, 24])
    assert found.a.dims == ("case", "nodes")
    assert found.label.values.tolist() == ["u", ""]
    assert found.base.values.tolist() == ["half_space", "layered"]
    assert found.bonding.values.tolist() == ["frictionless", "frictionless"]
    np.testing.assert_array_equal(found.h, [np.nan, 0.01])


@settings(max_examples=20, deadline=None)
@given(cuts=st.lists(st.integers(0, 18), max_size=4))
def test_the_answer_does_not_depend_on_the_blocks(cuts):
    parts = [chunk(*part[[0, -1]].tolist()) for part in np.split(np.arange(18), sorted({0, 18, *cuts})[1:-1])]
    for name, expected in chunk(0, 17).items():
        joined = np.concatenate([part[name] for part in parts])
        # error and residual are differences of nearly equal numbers: the last digits of those are in them
        np.testing.assert_allclose(joined, expected, rtol=1e-10, atol=1e-13, err_msg=name)


@cache
def chunk(first: int, last: int) -> dict[str, np.ndarray]:
    """What is computed of these cases at once."""
    from study.work.cases import compute, parcel

    return compute(parcel(chunked_definition(), np.arange(first, last + 1)))


@cache
def chunked_definition():
    from study.inputs.reading import from_tables

    tables = {
        "model": {"h": 0.02, "n": 0.5, "Nbar": 250000, "Ra": 0.004, "B": 0.1, "beta": 0.5},
        "axes": {
            "P": [1e-5, 4e-5],
            "micro": ["disc_cell", "power_law", "smooth"],
            "base": ["thin_layer", "half_space", "layered"],
        },
        "numerics": {"nodes": 16},
        "output": {"x": 3},
    }
    return from_tables(tables, "chunks", "", "chunks.toml")


@pytest.mark.parametrize(("start", "stop"), [(1e-6, 1e-5), ("1 N", "2 N")])
def test_a_range_of_a_study_file_is_answered_with_what_python_takes(start, stop):
    """It "must be a finite number", or "must be a force"."""
    with pytest.raises(study.StudyError, match="P: ranges are for study files; here give the values, as numpy"):
        study.solve(P={"start": start, "stop": stop, "num": 3}, h=0.02, n=0.5, micro="smooth")
