"""Results in SI units beside other arrays: they align, and texts with units select along their dimensions."""

import numpy as np
import pytest
import xarray as xr

import study


@pytest.fixture(scope="module")
def found():
    return study.solve(
        R="5 mm", E2="210 GPa", base="half_space", micro="smooth", P=["1 N", "2 N", "5 N"], profiles=False
    )


def test_results_align_with_measured_values(found):
    """xarray aligns only indexes whose classes are equal: measured values at one of the loads have a plain index."""
    measured = xr.DataArray([3e-5, 4e-5], {"P": [2.0, 7.0]}, "P")
    assert (found.a - measured).P.values.tolist() == [2.0] == (measured - found.a).P.values.tolist()
    assert xr.align(found.a, measured, join="outer")[0].P.values.tolist() == [1.0, 2.0, 5.0, 7.0]
    again = found.reindex(P=[1.0, 3.0])
    assert float(again.a[0]) == float(found.a[0]) and np.isnan(again.a[1])


def test_texts_in_arrays_select(found):
    for texts in (np.array(["5 N", "1 N"]), xr.DataArray(["5 N", "1 N"], dims="P")):
        assert found.sel(P=texts).P.values.tolist() == [5.0, 1.0]
    assert found.sel(P=np.array(["5 N", "1 N"])[0]).P.item() == 5.0, "a text of numpy: copy() got no data"
    pandas = pytest.importorskip("pandas")
    for form in (pandas.Index, pandas.Series):
        assert found.sel(P=form(["5 N", "1 N"])).P.values.tolist() == [5.0, 1.0]
    assert float(found.sel(P="1.2 N", method="nearest", tolerance="0.3 N").P) == 1.0
    with pytest.raises(KeyError):
        found.sel(P="1.2 N", method="nearest", tolerance="0.1 N")
    assert found.sel(P=found.P > 1.5).P.values.tolist() == [2.0, 5.0]
    with pytest.raises(ValueError, match="is a pressure"):
        found.sel(P=np.array(["5 N", "1 Pa"]))


def test_texts_are_no_new_coordinates(found):
    """They were, and all results NaN."""
    for texts in (["1 N"], ["1 N", "3 N"], np.array(["1 N"], dtype=object)):
        with pytest.raises(ValueError, match='P: give numbers in the SI unit here; texts such as "1 N" are for sel'):
            found.reindex(P=texts)


@pytest.mark.parametrize(
    ("ends", "loads"),
    [(("1.5 N", "6 N"), [2, 5]), (("2 N", None), [2, 5]), ((None, "2 N"), [1, 2]), ((1.5, "2 N"), [2])],
)
def test_slices_have_texts_at_either_end(found, ends, loads):
    assert found.sel(P=slice(*ends)).P.values.tolist() == loads
