"""When two datasets of the same study are the same."""

import xarray as xr

# Differences of nearly equal numbers: rounding is what is in their last digits.
OF_ROUNDING = ("error", "profile_error", "residual")
OF_THE_RUN = ("history", "created", "command", "git_commit")


def assert_same_numbers(found: xr.Dataset, expected: xr.Dataset) -> None:
    """The same numbers at the same coordinates, to 1e-12: in other company a case has its sums in another order."""
    xr.testing.assert_allclose(found.drop_vars(OF_ROUNDING), expected.drop_vars(OF_ROUNDING), rtol=1e-12, atol=0)
    xr.testing.assert_allclose(found[[*OF_ROUNDING]], expected[[*OF_ROUNDING]], rtol=1e-12, atol=1e-12)


def assert_same(found: xr.Dataset, expected: xr.Dataset) -> None:
    """The same numbers, types, labels and attributes."""
    assert_same_numbers(found, expected)
    assert found.sizes == expected.sizes and dict(found.dtypes) == dict(expected.dtypes)
    for name in expected.variables:
        assert repr(found[name].attrs) == repr(expected[name].attrs), name
        assert repr(found[name].encoding.get("_FillValue")) == repr(expected[name].encoding.get("_FillValue")), name
    assert of_the_study(found) == of_the_study(expected)


def of_the_study(dataset: xr.Dataset) -> dict:
    return {name: value for name, value in dataset.attrs.items() if name not in OF_THE_RUN}
