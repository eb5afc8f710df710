"""DataArrays with units: their coordinates decide which numbers belong together, and none is reordered unseen."""

import re

import numpy as np
import pytest
import xarray as xr

import study

pytest.importorskip("pint")
BALL = {"E2": "210 GPa", "base": "half_space", "micro": "smooth", "x": 2, "workers": 1}


def of(values, units: str, dim: str = "ball", labels=None) -> xr.DataArray:
    return xr.DataArray(values, {dim: labels} if labels else None, dim, attrs={"units": units})


@pytest.mark.parametrize(
    ("given", "message"),
    [
        # the loads were taken in the order of R, and shown in their own: a was that of other balls
        ({"R": of([1, 2], "mm", labels=[0, 1]), "P": of([3, 4], "N", labels=[1, 0])}, "P has other values of ball, or"),
        ({"R": of([1, 2], "mm", labels=[0, 1]), "P": of([3, 4], "N", labels=[1, 2])}, "P has other values of ball, or"),
        ({"R": of([1, 2], "mm"), "P": of([3, 4, 5], "N")}, "P has 3 values along ball, R has 2"),
        ({"R": "1 mm", "nu2": [0.1, 0.2], "P": of([3, 4, 5], "N", "nu2")}, "P has 3 values along nu2, nu2 has 2"),
        ({"R": "1 mm", "nu2": [0.1, 0.2], "P": of([3, 4], "N", "nu2", [0.2, 0.1])}, "P has other values of nu2"),
        ({"cases": [{"R": "1 mm"}] * 2, "P": of([3, 4, 5], "N", "case")}, "P has 3 values along case, R has 2"),
        # the load of copper was that of PTFE
        (
            {"R": "1 mm", "punch": ["PTFE", "copper"], "P": of([3, 4], "N", "punch", ["copper", "PTFE"])},
            "P has other values of punch, or in another order, than punch",
        ),
        ({"R": ["1 mm", "2 mm"], "P": of([3, 4], "N", "R")}, 'P: a dimension cannot be called "R" here, unless that'),
        ({"R": "1 mm", "Ra": ["1 um"], "P": of([3], "N", "Ra")}, 'P: a dimension cannot be called "Ra" here, unless'),
        ({"R": "1 mm", "P": of([3, 3], "N", "P")}, "P[0] and P[1] are both 3 N: values of an axis must differ"),
        ({"R": "1 mm", "P": of(["3", "4"], "N")}, "P: a DataArray must hold numbers"),
        ({"R": "1 mm", "P": of([True, True], "N")}, "P: a DataArray must hold numbers"),
        ({"R": "1 mm", "P": "1 N", "nu2": xr.DataArray(["0.3"], dims="q")}, "nu2: a DataArray must hold numbers"),
        ({"R": "1 mm", "P": "1 N", "punch": []}, "punch is empty: must have at least one value"),
    ],
)
def test_what_is_refused(given, message):
    with pytest.raises(study.StudyError, match=f"^solve: {re.escape(message)}"):
        study.solve(**BALL | given)


def test_arrays_over_an_input_are_taken_together():
    """As those of earlier results are: their coordinate h is in m, and was compared with h/R."""
    h = of([5.0, 9.0], "um", "h", [5.0, 9.0])
    found = study.solve(
        **BALL | {"base": "layered", "R": "1 mm", "E1": "9 GPa", "h": h, "P": of([1, 2], "N", "h", [5, 9])}
    )
    assert found.a.dims == ("h",) and found.P.values.tolist() == [1, 2]


def test_cases_keep_their_own_numbers():
    """Some of the cases of earlier results were refused: "n has other values of case than another parameter"."""
    chosen = study.solve(**BALL, R="1 mm", cases=[{"P": "1 N"}, {"P": "2 N"}, {"P": "3 N"}]).isel(case=[1, 2])
    again = study.solve(**BALL, R="1 mm", P=chosen.P)
    assert again.case.values.tolist() == [1, 2]
    np.testing.assert_array_equal(again.a, chosen.a)


def test_an_array_over_itself_is_an_axis_whatever_the_modulus_depends_on():
    """`P=earlier.P` was refused wherever E2 has a spread, as that of every material has, or several values: the load in
    units of E2* R² lies along these too."""
    for moduli in ({"E2": "210 ± 10 GPa"}, {"E2": ["210 GPa", "70 GPa"]}):
        expected = study.solve(**BALL | moduli, R="1 mm", P=["1 N", "2 N"])
        again = study.solve(**BALL | moduli, R="1 mm", P=expected.P)
        assert again.drop_attrs().identical(expected.drop_attrs()) and again.sel(P="2 N").P == 2


def test_short_floats_do_not_overflow():
    """210 GPa of float16 became an infinite modulus in Pa, a rigid body."""
    found = study.solve(**BALL | {"R": "1 mm", "P": "1 N", "E2": of(np.array([210], np.float16), "GPa")})
    assert found.E2.values.tolist() == [210e9]


def test_a_case_need_not_have_a_label():
    """As without units; of one with a label and one without it was asked of every case."""
    rows = [{"P": "1 N", "label": "soft"}, {"P": "2 N"}]
    found = study.solve(**BALL, R="1 mm", cases=rows)
    assert found.label.values.tolist() == ["soft", ""]


def test_series_and_indexes_of_words_and_ratios_are_axes():
    """An Index of bases gave m a dimension of its own, with numbers of one base beside the other."""
    pandas = pytest.importorskip("pandas")
    words = ["half_space", "layered"]
    given = BALL | {"R": "5 mm", "P": "1 N", "E1": "2 GPa", "E_punch": "3 GPa", "h": "20 um"}
    expected = study.solve(**given | {"base": words})
    for form in (pandas.Index, pandas.Series, np.array, tuple):
        found = study.solve(**given | {"base": form(words)})
        assert found.a.dims == ("base",) and (found.a == expected.a).all(), form
    one = study.solve(**given | {"base": "layered", "E1": "1 GPa", "E_punch": "rigid"})
    del given["E1"], given["E_punch"]
    again = study.solve(**given | {"base": np.array("layered"), "n": np.array(1 / 210)})
    np.testing.assert_allclose(again.a, one.a, rtol=1e-12)


@pytest.mark.parametrize("unit", ["1", "", "dimensionless"])
def test_pure_numbers_make_no_study_with_units(unit):
    """With the unit of pint, or an empty one, all others were asked for theirs."""
    pure = {"base": "half_space", "micro": "smooth", "x": 2}
    found = study.solve(**pure, P=of([1e-6, 2e-6], unit))
    np.testing.assert_array_equal(found.a, study.solve(**pure, P=[1e-6, 2e-6]).a)
    with pytest.raises(study.StudyError, match=r"P = 1e-05 has no unit: .* \(the unit of h makes this a study"):
        study.solve(**pure, P=1e-5, h=of([1, 2], "um"))
    nu2 = of([0.2, 0.3], unit)
    np.testing.assert_array_equal(study.solve(**BALL, R="1 mm", P="1 N", nu2=nu2).nu2, nu2)
