"""Results in readable multiples: the same numbers, in units that are named."""

import numpy as np
import pytest
import xarray as xr
from test_physical import COATED, quiet

import study

pytest.importorskip("pint")


def test_multiples():
    found = quiet(**COATED | {"h": ["50 nm ± 5 nm", "2 um"], "E2": "rigid"}, P="10 mN", x=3)
    shown = study.readable(found)
    units = {name: shown[name].attrs["units"] for name in ("h", "h_spread", "P", "a", "p", "E1", "E2", "R", "dP_dD")}
    assert units == {
        "h": "µm", "h_spread": "µm", "P": "mN", "a": "µm", "p": "GPa", "E1": "GPa", "E2": "GPa", "R": "mm",
        "dP_dD": units["dP_dD"],
    }  # fmt: skip
    assert shown.P == 10.0 and shown.sel(h=2.0).a.item() == pytest.approx(found.sel(h="2 um").a.item() * 1e6)
    np.testing.assert_allclose(shown.a_spread * 1e-6, found.a_spread, rtol=1e-15)
    assert np.isinf(shown.E2) and "units" not in shown.nu1.attrs and shown.status.dtype == found.status.dtype
    assert shown.a.dims == found.a.dims and "readable" in shown.attrs["physical_scale"]


def test_numbers_without_units_have_no_multiples():
    with pytest.raises(ValueError, match="a dataset of study.fit stays in SI"):
        study.readable(xr.Dataset({"fit_status": 0}))
    with pytest.raises(ValueError, match="the dataset is dimensionless"):
        study.readable(study.solve(P=1e-5, base="half_space", micro="smooth", x=2))
    with pytest.raises(ValueError, match=r"takes the dataset, not an array of it: study.readable\(contact\).a"):
        study.readable(quiet(**COATED, P="10 mN", x=3).a)


def test_a_reduced_modulus_of_a_text():
    assert study.reduced_modulus("91 GPa", 0.3) == study.reduced_modulus(91e9, 0.3) == pytest.approx(1e11, rel=1e-15)
    with pytest.raises(ValueError, match='E = "91 N" is a force: must be a pressure'):
        study.reduced_modulus("91 N", 0.3)
    with pytest.raises(ValueError, match=r"^nu must be in \(-1, 0.5\], and comes after E$"):
        study.reduced_modulus(0.3, 91e9)
