"""Texts with units: the decimals of the caller, spreads that are none, long names of units, capitals."""

import decimal
from decimal import Decimal

import pytest

from study.specimen import quantities
from study.specimen.quantities import Quantity, quantity

#: What a program may have done to the numbers of `decimal` before it asks for a contact.
CONTEXTS = {
    "three digits": decimal.Context(prec=3),
    "rounded up": decimal.Context(prec=2, rounding=decimal.ROUND_UP),
    "nothing may be rounded": decimal.Context(traps=[decimal.Inexact, decimal.Rounded]),
    "no floats": decimal.Context(traps=[decimal.FloatOperation]),
    "small exponents": decimal.Context(Emin=-2, Emax=2, prec=3, traps=[decimal.Overflow, decimal.Subnormal]),
    "nothing is an error": decimal.Context(prec=4, traps=[]),
}


@pytest.mark.parametrize("context", CONTEXTS.values(), ids=CONTEXTS)
def test_texts_do_not_depend_on_the_decimals_of_the_caller(context):
    """With prec = 3, 12.345 mm was 12.3 mm, for ever after, since what is read is kept."""
    cases = [
        ("12.345 mm", "m", Quantity(0.012345)),
        ("1.23456 inch", "m", Quantity(1.23456 * 0.0254)),  # not a power of ten
        ("12.3456 ± 0.12345 N/mm^2", "Pa", Quantity(12.3456e6, 0.12345e6)),
        ("98.7654 kgf/cm**2", "Pa", Quantity(98.7654 * 98066.5)),  # read by pint alone
        ("12.345 GPa ± 1.2345 %", "Pa", Quantity(12.345e9, 12.345e9 * 0.012345)),
        (Decimal("0.123456"), "1", Quantity(0.123456)),
    ]
    for kept in (quantities._si, quantities._size, quantities._registry):
        kept.cache_clear()
    with decimal.localcontext(context):
        found = [quantity("x", given, unit) for given, unit, _ in cases]
    again = [quantity("x", given, unit) for given, unit, _ in cases]
    for one, later, (_, _, expected) in zip(found, again, cases, strict=True):
        assert one == later
        assert [one.value, one.spread] == pytest.approx([expected.value, expected.spread], rel=1e-15)


@pytest.mark.parametrize("sign", ["±", "+/-", "+-"])
@pytest.mark.parametrize(
    "spread", ["-10 GPa", "- 10 GPa", "−10 GPa", "-5 %", "-0 GPa", "nan GPa", "inf GPa", "-1e400 GPa"]
)
def test_a_spread_is_not_negative(sign, spread):
    """The minus sign was dropped without a word."""
    with pytest.raises(ValueError, match="^E1 = .*: ± must be followed by a number"):
        quantity("E1", f"200 GPa {sign} {spread}", "Pa")
    with pytest.raises(ValueError, match="± must be followed by a number"):
        quantity("E1", f"200 {sign} {spread}", "Pa")


@pytest.mark.parametrize("text", ["200 ± 0 GPa", "200 GPa ± 0 GPa", "200 GPa ± 0 %", "200 GPa ± 0.0 GPa"])
def test_a_spread_of_0_is_none(text):
    assert quantity("E1", text, "Pa") == Quantity(2e11)


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("12 meter", "m", 12.0),
        ("12 metres", "m", 12.0),
        ("12 micrometer", "m", 12e-6),
        ("12 microns", "m", 12e-6),
        ("12 nanometres", "m", 12e-9),
        ("12 newton", "N", 12.0),
        ("12 micronewtons", "N", 12e-6),
        ("12 pascal", "Pa", 12.0),
        ("12 gigapascals", "Pa", 12e9),
        ("12 newton / millimeter ** 2", "Pa", 12e6),
        ("12 1 / micrometer ** 2", "1/m^2", 12e12),
        ("12 per square micrometer", "1/m^2", 12e12),
    ],
)
def test_long_names_of_units(text, unit, value):
    """Also as pint writes them by itself."""
    assert quantity("x", text, unit).value == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "unit", "near"),
    [
        ("12 Meter", "m", "meter"),
        ("12 MM", "m", "mm"),
        ("12 Gpa", "Pa", "GPa"),
        ("12 mpa", "Pa", "MPa"),
        ("12 Gigapascal", "Pa", "gigapascal"),
        ("12 Newton", "N", "newton"),
    ],
)
def test_capitals_of_units(text, unit, near):
    with pytest.raises(ValueError, match=rf'\(did you mean "{near}"\?\).*must be a '):
        quantity("x", text, unit)
    with pytest.raises(ValueError, match="no unit has this name; must be"):
        quantity("x", "12 furrlong", unit)
