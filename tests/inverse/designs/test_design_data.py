"""Designs as datasets of contacts, over lists and arrays; warnings, interrupts and progress."""

import itertools

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal
from test_design import LINING

import study
from study.inverse import design_cases, design_search

# Of steel and DLC, whose asperities would yield in some of these contacts.
pytestmark = pytest.mark.filterwarnings("ignore:a contact of the answer is beyond")


def test_lists_of_cases_and_arrays():
    rows = [{"P": 1e-5, "label": "light"}, {"P": 2e-5, "label": "heavy"}]
    given = {"n": 0.5, "bonding": "bonded", "micro": "smooth"}
    designed = study.design({"p0": 0.011}, by={"h": (1e-3, 0.1)}, cases=rows, **given)
    loads = xr.DataArray([1e-5, 2e-5], dims="run", coords={"who": ("run", ["a", "b"])})
    same = study.design({"p0": 0.011}, by={"h": (1e-3, 0.1)}, P=loads, **given)
    assert_array_equal(designed.h.values, same.h.values)
    assert designed.h.dims == ("case", "solution") and same.who.values.tolist() == ["a", "b"]


def test_a_design_is_a_dataset_of_contacts(tmp_path):
    """It can be written, and what takes contacts takes it."""
    designed = study.design({"p_max": "180 MPa"}, by={"h": ("1 um", "1 mm")}, P=["1 N", "5 N"], **LINING)
    designed.to_netcdf(tmp_path / "designed.nc")
    with xr.open_dataset(tmp_path / "designed.nc") as opened:
        assert opened.message.values.tolist() == designed.message.values.tolist()
        assert_array_equal(opened.h.values, designed.h.values)
    assert np.isfinite(study.sensitivities(designed).p_max_sensitivity).all()
    assert study.feasible(designed, p_max="< 181 MPa", h="< 100 um").values.ravel().tolist() == [True, False]
    assert designed.h.attrs["units"] == designed.h_spread.attrs["units"] == "m"


def test_solutions_outside_the_model_are_told():
    with pytest.warns(UserWarning, match="a contact of the answer is beyond what the model describes"):
        designed = study.design({"Ar_An": 0.1}, by={"Nbar": ("1e3 1/mm^2", "1e8 1/mm^2")}, P="1 N", h="100 um",
                                **{key: value for key, value in LINING.items() if key != "Nbar"})  # fmt: skip
    words = study.decode(designed.validity).item()
    assert words and f"outside the model there: {words.split()[0]}" in designed.message.item()


def test_an_interrupt_keeps_what_was_searched(monkeypatch):
    monkeypatch.setattr(design_search, "CHUNK", 2)
    results, calls = design_cases.Wanted.results, itertools.count()

    def interrupted(self, t, index):
        if index.max() >= 2 and next(calls) == 3:
            raise KeyboardInterrupt
        return results(self, t, index)

    monkeypatch.setattr(design_cases.Wanted, "results", interrupted)
    given = {"n": [0.1, 0.2, 0.3, 0.4, 0.5], "P": 1e-5, "bonding": "bonded", "micro": "smooth"}
    with pytest.warns(UserWarning, match="interrupted after 2 of 5, which are kept"):
        designed = study.design({"p0": 0.008}, by={"h": (1e-3, 0.1)}, **given)
    words = study.decode(designed.design_status).values.tolist()
    assert words == ["found", "found", "not_run", "not_run", "not_run"]
    assert_allclose(designed.p0.values[:2], 0.008, rtol=1e-6)
    assert designed.message.values[3] == "not searched, because the call was interrupted"


def test_an_interrupt_before_anything_is_found_ends_it(monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(design_cases.Wanted, "results", interrupted)
    with pytest.raises(KeyboardInterrupt):
        study.design({"p0": 0.008}, by={"h": (1e-3, 0.1)}, n=0.5, P=1e-5, bonding="bonded", micro="smooth")


@pytest.mark.usefixtures("impatient")
def test_a_long_design_says_how_far_it_is(stderr):
    given = {"n": [0.1, 0.2], "P": 1e-5, "Nbar": 250000, "Ra": 0.004, "bonding": "bonded"}
    study.design({"p0": 0.006}, by={"h": (1e-3, 0.1)}, **given)
    assert "searching 2 designs" in stderr.getvalue()
    before = stderr.getvalue()
    study.design({"p0": 0.006}, by={"h": (1e-3, 0.1)}, progress=False, **given)
    assert stderr.getvalue() == before
