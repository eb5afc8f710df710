"""Numbers with units: what is read, what is refused and with which words, and readable multiples."""

import math
import re
from decimal import Decimal

import numpy as np
import pytest

from study.specimen import quantities
from study.specimen.quantities import READABLE, Quantity, has_unit, quantity, readable


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("3 um", "m", 3e-6),
        ("3um", "m", 3e-6),
        ("3 µm", "m", 3e-6),
        ("0.1 nm", "m", 1e-10),
        ("210 GPa", "Pa", 2.1e11),
        ("2.5e11 1/m^2", "1/m^2", 2.5e11),
        ("100 mm⁻²", "1/m^2", 1e8),
        ("2.1/um^2", "1/m^2", 2.1e12),
        ("0.1/um^2", "1/m^2", 1e11),
        ("11/um^2", "1/m^2", 1.1e13),
        ("1/um^2", "1/m^2", 1e12),
        ("-5 mm", "m", -5e-3),
        ("−5 mm", "m", -5e-3),
        ("1.5e−3 m", "m", 1.5e-3),
        ("100 mm^−2", "1/m^2", 1e8),
        ("100 1/mm²", "1/m^2", 1e8),
        ("1e2 1/mm2", "1/m^2", 1e8),
        ("1e2 mm-2", "1/m^2", 1e8),
        ("2e3 N/mm2", "Pa", 2e9),
        ("1 cmH2O", "Pa", 98.0665),
        ("10 mN", "N", 1e-2),
        ("1 kgf", "N", 9.80665),
        ("0.3", "1", 0.3),
        (0.3, "1", 0.3),
        (Decimal("0.3"), "1", 0.3),
        (np.float64(0.3), "1", 0.3),
    ],
)
def test_a_number_is_rounded_once(text, unit, value):
    """Equal to the literal in SI, not near it: `sel(h="3 um")` has to find 3e-6."""
    assert quantity("x", text, unit) == Quantity(value, 0.0)


@pytest.mark.parametrize("sign", ["±", "+/-", "+-"])
def test_spreads(sign):
    assert quantity("E1", f"200 {sign} 10 GPa", "Pa") == Quantity(2e11, 1e10)
    assert quantity("E1", f"200 GPa {sign} 10 GPa", "Pa") == Quantity(2e11, 1e10)
    assert quantity("E1", f"200 GPa {sign} 5 %", "Pa") == Quantity(2e11, 1e10)
    assert quantity("E1", f"200 {sign} 5 % GPa", "Pa") == Quantity(2e11, 1e10)
    assert quantity("E1", f"-200 GPa {sign} 5 %", "Pa") == Quantity(-2e11, 1e10)
    assert quantity("h", f"2 um {sign} 100 nm", "m") == Quantity(2e-6, 1e-7)
    assert quantity("nu1", f"0.3 {sign} 0.02", "1") == Quantity(0.3, 0.02)
    assert quantity("Nbar", f"2{sign}0.1/um^2", "1/m^2") == Quantity(2e12, 1e11)


@pytest.mark.parametrize(
    ("given", "unit", "message"),
    [
        (3, "m", 'h = 3 has no unit: must be a length, such as "2 mm"'),
        ("3", "m", 'h = "3" has no unit: must be a length'),
        ("3 N", "m", 'h = "3 N" is a force: must be a length'),
        ("3 Pa", "N", 'h = "3 Pa" is a pressure: must be a force'),
        ("3 kg", "N", 'h = "3 kg" is in kilogram: must be a force'),
        ("3 mil", "m", 'h = "3 mil" is an angle or a ratio: must be a length'),  # 1/1000 inch is a thou
        ("3 flarp", "m", 'h = "3 flarp": no unit has this name; must be a length'),
        ("3 um", "1", 'h = "3 um" is a length: must be a number without a unit'),
        ("3 ± x um", "m", "± must be followed by a number"),
        ("(3 ± 0.2) um", "m", 'must be a length, such as "2 mm"; without brackets'),
        ("3 ± 4 ± 5 um", "m", "must be a length"),
        ("um", "m", "must be a length"),
        ("1e999 m", "m", "must be finite"),
        ("1e999999999 mm", "m", "must be finite"),
        ("1e999999 km", "m", "must be finite"),
        ("1e99999999999999999999 mm", "m", "must be finite"),
        ("5 mm ± 1e999999999 km", "m", "must be finite"),
        ("1e999999 km²", "m^2", "must be finite"),
        (True, "m", "must be a length"),
        (None, "m", "must be a length"),
        ([1], "m", "must be a length"),
        ("1 " + "m*" * 100 + "m", "m", "must be a length"),
        ("9**9**9**9 m", "m", "no unit has this name"),
        ("210.000 N/mm²", "Pa", 'h = "210.000 N/mm²": the point may separate thousands: write 210 or 210e3'),
        ("70.000 ± 5.000 MPa", "Pa", "may separate thousands: write 70 or 70e3"),
        ("5 mm ± 0.1", "m", 'the spread of h = "0.1" has no unit: must be a length'),
        ("5 mm ± 2 % mm", "m", "only the unit of the number may follow %"),
        ("5 ± 2 %% mm", "m", "only the unit of the number may follow %"),
        ("5 ± 2 %", "m", 'h = "5" has no unit: must be a length'),
        ("5 mm ± 1e999 %", "m", "must be finite"),
        ("9 um %", "m", 'h = "9 um %": % may only follow ±'),
        ("9 um ± 5 um %", "m", 'the spread of h = "5 um %": % may only follow ±'),
        ("30 % ± 2 %", "1", 'write the spread as a number, as in "0.3 ± 0.02"'),
    ],
)
def test_what_is_refused(given, unit, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        quantity("h", given, unit)


@pytest.mark.parametrize(
    "number",
    ["5,0", "5 500", "1'000", "5 1/2", "210(5)", "210 (5)", "1.5.2", "1e3.5", "5 .5", "5 mm 3", "3 ft 2", "4 ± 0,2"]
    + ["5 mm (3)", "5 mm(+3)", "5 (mm)3", "5 mm [3]", "5|3", "5;3", "5:3", "5 mm ~3", "5–7", "5 – 7", "5−7"]
    + ["2½", "5 mm +3/-2"],
)
@pytest.mark.parametrize("unit", ["um", ""])
def test_a_number_that_could_be_read_in_two_ways_is_refused(number, unit):
    """pint drops commas and multiplies numbers that stand side by side: it reads 50, 2500, 5/2, 1050, 0.3; it
    takes most signs that it does not know for a product: it reads the range 5–7 as 35."""
    message = f'h = "{number} {unit}'.rstrip() + '": write one number, with a decimal point and without gaps: must be'
    with pytest.raises(ValueError, match=re.escape(message)):
        quantity("h", f"{number} {unit}", "m" if unit else "1")


@pytest.mark.parametrize(
    "text",
    [
        "5×10³ µm",
        "5·10^3 um",
        "5 * 10**3 um",
        "10 mm / 2",
        "10/2 mm",
        "4 mm + 1e3 um",
        "5 (mm)",
        "5\u00a0mm",
        "5_000 um",
    ],
)
def test_what_is_computed(text):
    assert quantity("h", text, "m") == Quantity(5e-3)


def test_densities_are_no_two_numbers():
    for text in ("2 1/um^2", "2 1 / um^2", "2 /um^2", "2 um^ -2", "2 per um^2", "2e6 1/mm/mm", "2×10^6 1/mm²"):
        assert quantity("Nbar", text, "1/m^2") == Quantity(2e12)


def test_what_has_a_unit():
    assert has_unit("0.3 ± 0.02") and has_unit("30 %") and has_unit("5,0 mm")
    assert not any(map(has_unit, ("0,02", "1 000", "0.3, 0.4", "1_000", "1e-5,2e-5")))
    assert all(has_unit(text) for text in ("3 um", "3um", " -2.5e3 N", "200 ± 10 GPa"))
    assert not any(has_unit(given) for given in ("3", "disc_cell", "", 3, 0.5, None, [3], "layered", "1e5"))


def test_quantities_of_pint():
    pint = pytest.importorskip("pint")
    own = pint.UnitRegistry()
    assert has_unit(own.Quantity(3.0, "um"))
    assert quantity("h", own.Quantity(3.0, "um"), "m").value == pytest.approx(3e-6, rel=1e-15)  # a float product
    with pytest.raises(ValueError, match=r"h = 3.0 newton: must be a length"):
        quantity("h", own.Quantity(3.0, "N"), "m")


def test_readable_numbers():
    assert readable(2.5e-6, "m") == "2.5 µm"
    assert readable(2.5e-6, "m", 3e-8) == "2.500 ± 0.030 µm"
    assert readable(1.23e9, "Pa", 2e7) == "1.230 ± 0.020 GPa"
    assert readable(1.23e9, "Pa", 1e3) == "1.23 GPa"
    assert readable(0.0, "N") == "0 nN"
    assert readable(-4e-3, "m") == "-4 mm"
    assert readable(math.nan, "m") == "unknown"
    assert readable(0.16004, "1", 0.0021) == "0.1600 ± 0.0021"


@pytest.mark.parametrize("unit", [unit for unit in READABLE if unit != "1"])
def test_readable_numbers_are_read_again(unit):
    """From 1e-12 to 1e12, to the five digits that are written."""
    for value in 1.2345 * 10.0 ** np.arange(-12, 13):
        assert quantity("x", readable(value, unit), unit).value == pytest.approx(value, rel=1e-4)


@pytest.mark.parametrize("unit", ["m", "Pa", "N", "1/m^2"])
def test_numbers_with_a_plain_unit_are_what_pint_says(unit):
    """They are read without it, for it takes half a millisecond; and to the last digit."""
    words = {"m": "mm um µm nm inch", "Pa": "GPa kPa N/mm^2 psi", "N": "mN nN kgf lbf", "1/m^2": "1/um^2 1/mm² mm^-2"}
    random = np.random.default_rng(0)
    for word in words[unit].split():
        for number in (f"{random.uniform(0, 1e4)!r}", f"{random.uniform(0, 9):.3e}", "3", ".5", "7."):
            whole = quantities._registry().Quantity(f"{number} {word}".replace("²", "^2")).to(unit).magnitude
            assert quantity("h", f"{number} {word}", unit).value == float(whole)
    for text, value in (("5 GPa + 3 GPa", 8e9), ("6 kPa/2", 3e3)):
        assert quantity("E1", text, "Pa").value == value


def test_our_units_have_the_size_of_pint():
    """Units in which we write numbers are read without it, also with u and ^2."""
    written = [(name, unit) for unit, (_, multiples) in READABLE.items() for name, _ in multiples if unit != "1"]
    written += [(name.replace("µ", "u").replace("²", "^2"), unit) for name, unit in written]
    for name, unit in written:
        size = quantities._size(name.replace("²", "^2"), unit)
        assert size == Decimal(quantities._registry().Quantity(name).to(unit).magnitude), name


@pytest.mark.parametrize("text", ["2 mu", "2mu", "2 μ", "2 µ", "2 micron", "2.0 microns", "2 ± 0.1 mu"])
def test_micrometres_in_other_words(text):
    assert quantity("h", text, "m").value == 2e-6
