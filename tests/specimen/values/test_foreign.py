"""Values of other packages: of pint, pint-xarray, uncertainties, polars, dask and astropy, and what stands in for them.

The stand-ins have what the program looks at, and are always tried. The packages are tried where they are installed.
"""

import datetime
from decimal import Decimal
from fractions import Fraction

import dask.array
import numpy as np
import pandas as pd
import pytest
import xarray as xr

import study
from study.specimen.foreign import plain

pint = pytest.importorskip("pint")
UNITS = pint.UnitRegistry()
BALL = {"E2": "210 GPa", "base": "half_space", "micro": "smooth", "x": 2, "workers": 1}
LAYER = {"n": 0.5, "micro": "smooth", "P": 1e-5, "x": 2, "workers": 1}


class Unsure:
    """As a ufloat: a number with a standard deviation, that does arithmetic and is no float."""

    dtype = np.dtype(object)

    def __init__(self, nominal_value: float, std_dev: float):
        self.nominal_value, self.std_dev = nominal_value, std_dev

    def __mul__(self, factor: float) -> "Unsure":
        return Unsure(self.nominal_value * factor, self.std_dev * factor)

    def __float__(self):
        raise TypeError("can't convert an affine function to float; use x.nominal_value")

    def __repr__(self) -> str:
        return f"{self.nominal_value}+/-{self.std_dev}"


class Measured:
    """As a Measurement of pint: a quantity with an unsure magnitude, which hands on the attributes of that."""

    def __init__(self, magnitude: Unsure, units: str):
        self.magnitude, self.units = magnitude, units

    def __getattr__(self, name: str):
        return getattr(self.magnitude, name)

    def to(self, unit: str) -> "Measured":
        size = float(UNITS.Quantity(1.0, self.units).to(unit).magnitude)
        return Measured(self.magnitude * size, unit)


class Column:
    """As a series of polars, which has no `tolist`."""

    def __init__(self, *values):
        self.values, self.shape = values, (len(values),)

    def __array__(self, dtype=None, copy=None):
        return np.array(self.values, dtype=dtype)

    def __repr__(self):
        return f"Column{self.values}"  # names of tests must not depend on an address


class Tensor:
    """As a tensor of torch, whose `to` is to another device: it has no unit."""

    def __init__(self, *values):
        self.values = values

    def to(self, device: str) -> "Tensor":
        return self

    def tolist(self) -> list:
        return [*self.values]

    def __repr__(self) -> str:
        return f"Tensor{self.values}"


class Astropy(np.ndarray):
    """As a quantity of astropy: an array with a unit, which `tolist` leaves out."""

    def __new__(cls, values, unit: str):
        made = np.asarray(values, dtype=float).view(cls)
        made.unit = unit
        return made

    @property
    def value(self):
        return np.asarray(self)

    def to(self, unit: str):
        raise AssertionError(f"{unit} is read by roughcoat itself")


@pytest.mark.parametrize(
    ("given", "SI"),
    [
        (UNITS.Quantity(2, "mm"), 2e-3),
        (UNITS.Quantity([2, 3], "mm"), [2e-3, 3e-3]),
        (UNITS.Quantity(Decimal("2.5"), "mm"), 2.5e-3),
        (UNITS.Quantity(np.float32(2), "mm"), 2e-3),  # was 2.0000000949949026e-3
        (xr.DataArray(UNITS.Quantity([2, 3], "mm"), dims="R"), [2e-3, 3e-3]),
        (xr.DataArray([2, 3], dims="R", attrs={"units": "millimeters"}), [2e-3, 3e-3]),
        (xr.DataArray([2, 3], dims="R", attrs={"units": UNITS.millimeter}), [2e-3, 3e-3]),
        (xr.Variable("R", [2, 3], {"units": "mm"}), [2e-3, 3e-3]),
        (Column("2 mm", "3 mm"), [2e-3, 3e-3]),
        (pd.Series(["2 mm", "3 mm"], index=["x", "y"]), [2e-3, 3e-3]),
        (np.array(["2 mm", "3 mm"], dtype=object), [2e-3, 3e-3]),
        ([np.str_("2 mm"), np.array("3 mm")], [2e-3, 3e-3]),
        (Astropy(2, "mm"), 2e-3),
        (Astropy([2, 3], "mm"), [2e-3, 3e-3]),
        ([Astropy(2, "mm"), "3 mm"], [2e-3, 3e-3]),
    ],
    ids=str,
)
def test_a_length_is_taken_with_its_unit(given, SI):
    found = study.solve(**BALL, R=given, P="1 N")
    assert found.R.dims == (("R",) if isinstance(SI, list) else ())
    np.testing.assert_array_max_ulp(found.R.values, np.array(SI), 1)


@pytest.mark.parametrize(
    "given", [Measured(Unsure(2.0, 0.1), "mm"), [Measured(Unsure(2.0, 0.1), "mm"), "3 ± 0.2 mm"]], ids=["one", "list"]
)
def test_a_measurement_has_a_spread(given):
    found = study.solve(**BALL, R=given, P="1 N")
    same = study.solve(**BALL, R="2 ± 0.1 mm", P="1 N")
    np.testing.assert_array_max_ulp(found.R_spread.values.ravel()[0], 1e-4, 2)
    np.testing.assert_allclose(found.a_spread.values.ravel()[0], same.a_spread, rtol=1e-12, atol=0)  # of one ulp in R


def test_a_pure_number_may_be_unsure():
    found = study.solve(**BALL, R="2 mm", P="1 N", nu2=Unsure(0.3, 0.02))
    assert (found.nu2, found.nu2_spread) == (0.3, 0.02)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"R": Unsure(2.0, 0.1)}, r"^solve: R = 2.0\+/-0.1 has no unit: must be a length"),
        ({"R": [Unsure(2.0, 0.1)]}, r"^solve: R\[0\] = 2.0\+/-0.1 has no unit: must be a length"),
        ({"R": "2 mm", "nu2": Unsure(0.3, np.nan)}, "^solve: the spread of nu2 = .*: must be finite and not below 0"),
        ({"R": "2 mm", "nu2": Unsure(0.3, -0.01)}, "^solve: the spread of nu2 = .*: must be finite and not below 0"),
        ({"R": Astropy(2, "kg")}, '^solve: R = "2.0 kg" is in kilogram: must be a length'),
        ({"R": xr.DataArray(UNITS.Quantity([2, 3], "kg"), dims="R")}, 'R = "1 kilogram" is in kilogram'),
        ({"R": Decimal("12.345")}, "^solve: R = 12.345 has no unit"),
        ({"R": Fraction(1, 3)}, "^solve: R = 1/3 has no unit"),
        ({"R": Column(2.0, 3.0)}, r"^solve: R\[0\] = 2.0 has no unit"),
        ({"R": dask.array.from_array(np.array([2.0, 3.0]))}, r"^solve: R\[0\] = 2.0 has no unit"),
        ({"R": pd.NA}, "^solve: R = <NA>: must be a length"),
        ({"R": np.timedelta64(5, "ns")}, '^solve: R = "5 nanoseconds" is in nanosecond: must be a length'),
        ({"R": datetime.datetime(2026, 1, 2)}, "^solve: R = 2026-01-02 00:00:00: must be a length"),
    ],
    ids=str,
)
def test_what_is_refused(given, message):
    with pytest.raises(study.StudyError, match=message):
        study.solve(**BALL, P="1 N", **given)


@pytest.mark.parametrize(
    ("given", "numbers"),
    [
        (Decimal("0.02"), 0.02),
        (Fraction(1, 50), 0.02),
        (np.array(0.02), 0.02),
        (Column(0.02, 0.03), [0.02, 0.03]),
        (Tensor(0.02, 0.03), [0.02, 0.03]),
        (pd.Series([0.02, 0.03], index=["x", "y"]), [0.02, 0.03]),
        (dask.array.from_array(np.array([0.02, 0.03])), [0.02, 0.03]),
        (xr.DataArray(UNITS.Quantity([0.02, 0.03], ""), dims="h"), [0.02, 0.03]),
        (Astropy([0.02, 0.03], ""), [0.02, 0.03]),
        (xr.Variable("h", [0.02, 0.03]), [0.02, 0.03]),
    ],
    ids=str,
)
def test_a_number_without_a_unit(given, numbers):
    assert study.solve(**LAYER, h=given).h.values.tolist() == numbers


@pytest.mark.parametrize(
    "given",
    [
        *(
            Astropy(0.02, "mm"),
            Unsure(0.02, 0.001),
            Column(0.02, None),
            pd.Series([0.02, pd.NA]),
            np.array([0.02, None]),
        ),
        # times: their numbers are nanoseconds
        *(np.timedelta64(5, "ns"), np.array([5, 6], "m8[ns]"), xr.DataArray(np.array([5, 6], "m8[ns]"), dims="h")),
        *(np.datetime64("2026-01-02"), pd.Timestamp("2026-01-02"), pd.DatetimeIndex(["2026-01-02"])),
    ],
    ids=str,
)
def test_what_is_no_number_without_a_unit(given):
    """A quantity of astropy was its number, whatever its unit; so was a time."""
    with pytest.raises(study.StudyError, match="h.* = .*(must be a finite number|makes this a study)"):
        study.solve(**LAYER, h=given)


@pytest.mark.parametrize("one", [np.int64(1), np.int32(1), np.array(1), np.uint8(1)], ids=repr)
def test_whole_numbers_of_numpy(one):
    known = study.solve(**LAYER, h=0.02)
    assert study.solve(**LAYER | {"workers": one, "nodes": 16 * one, "x": 2 * one}, h=0.02).sizes == known.sizes
    for wrong in (one * 0, one * 1.5, np.bool_(True)):
        with pytest.raises(study.StudyError, match="^workers = .*: must be a whole number, 1 or more"):
            study.solve(**LAYER | {"workers": wrong}, h=0.02)


def test_options_of_numpy():
    found = study.solve(**LAYER | {"x": Column(0.0, 0.5, 1.0)}, h=0.02, profiles=np.array(["p"]), title=np.str_("mine"))
    assert found.x.values.tolist() == [0, 0.5, 1] and "p" in found and "lam" not in found
    assert "p" not in study.solve(**LAYER, h=0.02, profiles=np.bool_(False))


def test_physical_numbers_for_from_physical():
    scales = {"R": Astropy(2, "mm"), "E2_star": UNITS.Quantity(100, "GPa")}
    found = study.from_physical(
        **scales, h=Column("2 um", "4 um"), P=xr.DataArray(UNITS.Quantity([2.0], "N"), dims="P")
    )
    np.testing.assert_allclose(found["h"], [1e-3, 2e-3], rtol=1e-15, atol=0)
    np.testing.assert_allclose(found["P"], [5e-6], rtol=1e-15, atol=0)
    with pytest.raises(ValueError, match="must have no spread here"):
        study.from_physical(**scales, h=Measured(Unsure(2.0, 0.1), "um"))


@pytest.mark.parametrize("layers", [("TiN", "DLC a-C:H"), ("TiN",), ()], ids=str)
def test_a_tuple_is_no_stack_of_layers(layers):
    """It was an axis: two coatings, each without the other, where one on top of the other was meant."""
    bodies = {"R": "5 mm", "punch": "steel 52100", "body": "steel 52100", "micro": "smooth", "P": "1 N"}
    said = "is a tuple: a list is an axis, and `layers`, a list of layers, a stack"
    with pytest.raises(study.StudyError, match=said):
        study.solve(**bodies, h="2 um", layer=layers)
    with pytest.raises(study.StudyError, match=said):
        study.solve(**bodies, h="2 um", cases=[{"layer": layers}])
    found = study.solve(**bodies, h="2 um", layer=["TiN", "DLC a-C:H"])
    assert found.layer.values.tolist() == ["TiN", "DLC a-C:H"]


def test_the_packages_themselves():
    """ufloat, Measurement and unumpy of uncertainties; a series of polars; DataArrays of pint-xarray."""
    uncertainties = pytest.importorskip("uncertainties")
    polars = pytest.importorskip("polars")
    pytest.importorskip("pint_xarray")
    measured = UNITS.Quantity(2, "mm").plus_minus(0.1)
    several = UNITS.Quantity(np.array([uncertainties.ufloat(2, 0.1), uncertainties.ufloat(3, 0.1)]), "mm")
    for given in (measured, UNITS.Quantity(uncertainties.ufloat(2, 0.1), "mm"), several):
        found = study.solve(**BALL, R=given, P="1 N", nu2=uncertainties.ufloat(0.3, 0.02))
        np.testing.assert_array_max_ulp(found.R_spread.values.ravel()[0], 1e-4, 2)
        assert found.nu2_spread == 0.02
    assert study.solve(**BALL, R=polars.Series(["2 mm", "3 mm"]), P="1 N").R.values.tolist() == [2e-3, 3e-3]
    assert study.solve(**LAYER, h=polars.Series([0.02, 0.03])).h.values.tolist() == [0.02, 0.03]
    array = xr.DataArray([2.0, 3.0], coords={"R": [2.0, 3.0]}).pint.quantify("mm", R="mm")
    assert study.solve(**BALL, R=array, P="1 N").R.values.tolist() == [2e-3, 3e-3]
    assert plain(array).coords["R"].attrs["units"] == "millimeter"
