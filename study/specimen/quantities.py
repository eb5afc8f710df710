"""Numbers with units: "5 mm", "200 ± 10 GPa" or quantities of pint become SI numbers, and SI numbers readable text.

The units of READABLE are read here, all others by pint. The first of the others imports pint, which takes half a
second.
"""

import math
import numbers
import re
from dataclasses import dataclass
from decimal import ROUND_HALF_EVEN, Context, Decimal, DivisionByZero, InvalidOperation, Overflow, localcontext
from functools import cache, lru_cache
from typing import Any

from ..terminal import on_one_line, shown

#: SI unit -> what it measures, and the multiples in which it is read most easily (name, size), the largest first.
READABLE = {
    "m": ("a length", (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9))),
    "Pa": ("a pressure", (("GPa", 1e9), ("MPa", 1e6), ("kPa", 1e3), ("Pa", 1.0))),
    "N": ("a force", (("kN", 1e3), ("N", 1.0), ("mN", 1e-3), ("µN", 1e-6), ("nN", 1e-9))),
    "N/m": ("a stiffness", (("MN/m", 1e6), ("kN/m", 1e3), ("N/m", 1.0), ("mN/m", 1e-3))),
    "J/m^2": ("a work per area", (("J/m²", 1.0), ("mJ/m²", 1e-3), ("µJ/m²", 1e-6))),
    "1/m^2": ("a number per area", (("1/µm²", 1e12), ("1/mm²", 1e6), ("1/m²", 1.0))),
    "m^2": ("an area", (("mm²", 1e-6), ("µm²", 1e-12), ("nm²", 1e-18))),
    "degree": ("an angle", (("deg", 1.0),)),
    "1": ("a pure number", (("", 1.0),)),
}
LONGEST = 100  # characters of a text with a unit, because pint computes any expression that is written there
#: The decimal context in which texts are read, whatever context the caller has set. 28 digits, Python's default, are
#: far more than a float holds. Every field is set: a missing one would come from `decimal.DefaultContext`.
_EXACT = Context(28, ROUND_HALF_EVEN, -999999, 999999, 1, 0, [], [DivisionByZero, InvalidOperation, Overflow])
_SURE = 1e-5  # a smaller relative spread is not written
_SPREAD = re.compile(r"\s*(?:±|\+/-|\+-)\s*")
_UNIT_OR_SPREAD = re.compile(rf"(?![eE][-+]?\d)[^\W\d_]|[%°]|{_SPREAD.pattern}")  # the e of "1,2e-5" is no unit
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
#: A number with a unit that is a product of powers. It is read as the number times the size of its unit, without pint.
#: The 1 of "1/um^2" must not be a digit of the number: "2.1/um^2" would be "2." times 1/um^2.
_PLAIN = re.compile(rf"({_NUMBER.pattern})\s*((?:(?<![\d.])1/)?[A-Za-zµ]+(?:(?:\^|\*|/)-?[A-Za-z0-9µ]+)*)")
#: Patterns that make pint read another number without a word: characters that it does not know, and drops or takes for
#: a product ("5,0 mm" as 50 mm, "200–220 GPa" as 44 TPa), a second decimal point, a second number, by which it
#: multiplies the first ("5 500 um", "5 1/2 in", "200 GPa (10)"), and two tolerances ("200 GPa +10/-5 GPa").
_AMBIGUOUS = re.compile(
    r"[^\w\s.+\-*/^()·×%°±⁻]|[¼-¾⅐-⅞]|\.\d*\.|\d[eE][-+]?\d+\.|[\w)]\s*\(\s*[-+]?[\d.]|\)\s*[\d.]"
    r"|(?<!\+)/\s*-\s*[\d.]|(?<![-+±*/^(×·\s])\s+(?!1\s*/\s*[^\d\s.])[\d.]"
)
#: A German data sheet writes 210 GPa as "210.000 MPa", which pint reads as 210 MPa.
_THOUSANDS = re.compile(r"(\d{2,3})\.000[^A-Za-z\d]*(?:[\d.]+\s*)?(?:N/mm|MPa)")
#: The minus sign of printed texts where it cannot be the dash of a range: before the number, or in an exponent.
_MINUS = re.compile(r"^−|(?<=\d[eE])−|(?<=\^)−")
#: A power without ^, as in "mm2" and "mm-2". The letters must not follow a digit: the e of "1e2" is no unit.
_POWER = re.compile(r"(?<![\d.A-Za-z])([A-Za-zµ]+)(-?[23])(?![\w.])")
#: Words for the micrometre that pint does not have. It takes µ alone for another quantity.
_MICRONS = re.compile(r"(?<=[\d\s.])(?:mu|µ|μ|mum|microns?)$")


@dataclass(frozen=True)
class Quantity:
    """A number in an SI unit, and its spread (one standard deviation) in the same unit; 0: no spread is known."""

    value: float
    spread: float = 0.0

    def __str__(self) -> str:
        return f"{self.value:g}"


def has_unit(entry: Any) -> bool:
    """Whether something is a quantity of pint, a `ufloat`, or a text with a number followed by a unit or a spread."""
    if isinstance(entry, str):
        number = _NUMBER.match(entry.strip())
        return bool(number) and bool(_UNIT_OR_SPREAD.search(entry.strip(), number.end()))
    return (hasattr(entry, "magnitude") and hasattr(entry, "to")) or _is_unsure(entry)


def _is_unsure(number: Any) -> bool:
    """Whether something is a number with a standard deviation: a `ufloat` of the package uncertainties."""
    return hasattr(number, "nominal_value") and hasattr(number, "std_dev") and not hasattr(number, "magnitude")


def unit_in(entry: Any) -> str:
    """The unit of a text or of a quantity of pint, as it is written; "" where it is not a plain product of units."""
    if not isinstance(entry, str):
        return str(getattr(entry, "units", ""))
    plain = [_PLAIN.fullmatch(part) for part in _SPREAD.split(entry.strip())]
    return next((match[2] for match in plain if match), "")


def quantity(name: str, entry: Any, unit: str) -> Quantity:
    """The SI value of a text ("5 mm", "200 ± 10 GPa"), a quantity of pint, or, for unit "1", of a number or a `ufloat`.

    name : of the number, for messages
    entry : text, number, `ufloat`, or quantity of pint; a measured one (a `ufloat` with a unit) has a spread
    unit : one of READABLE: the SI unit of the result

    Raises ValueError: there is no number or no unit, or the unit measures something else, which the message names.
    """
    with localcontext(_EXACT):
        try:
            return _quantity(name, entry, unit)
        except (Overflow, InvalidOperation) as error:  # "1e999999 km" is beyond _EXACT too
            raise ValueError(f"{name} = {shown(entry)}: must be finite") from error


def _quantity(name: str, entry: Any, unit: str) -> Quantity:
    what, multiples = READABLE.get(unit, (f"a number of {unit}", ((unit, 1.0),)))
    example = f"2 {multiples[min(1, len(multiples) - 1)][0]}"
    wanted = f'must be {what}, such as "{example}"' if unit != "1" else "must be a number without a unit"
    if isinstance(entry, str):
        return _from_text(name, _MINUS.sub("-", entry.strip()), unit, wanted)
    is_number = isinstance(entry, (numbers.Real, Decimal)) and not isinstance(entry, bool)
    if unit != "1" and (is_number or _is_unsure(entry)):
        raise ValueError(f"{name} = {shown(entry)} has no unit: {wanted}")
    if not is_number and not has_unit(entry):
        raise ValueError(f"{name} = {shown(entry)}: {wanted}")
    try:
        magnitude = entry if is_number or _is_unsure(entry) else _of_pint(entry, unit)
        value, spread = (magnitude.nominal_value, magnitude.std_dev) if _is_unsure(magnitude) else (magnitude, 0.0)
        value, spread = float(value), float(spread)
    except OverflowError as error:
        raise ValueError(f"{name} = {shown(entry)}: must be finite") from error
    except MemoryError:
        raise
    except Exception as error:  # its class depends on the registry of the quantity
        raise ValueError(f"{name} = {shown(entry)}: {wanted}") from error
    if not 0 <= spread < math.inf:
        raise ValueError(f"the spread of {name} = {shown(entry)}: must be finite and not below 0")
    return Quantity(value, spread)


def _of_pint(entry: Any, unit: str) -> Any:
    """The magnitude, a number or a `ufloat`, of a quantity of pint in `unit`."""
    number = entry.magnitude
    if hasattr(number, "dtype") and not _is_unsure(number):  # of numpy: 210 GPa of float16 would be infinite in Pa
        entry = type(entry)(float(number), entry.units)
    return entry.to(unit).magnitude


def _from_text(name: str, text: str, unit: str, wanted: str) -> Quantity:
    """The quantity in a text. In "200 ± 10 GPa" the unit holds for the value as well."""
    head, *spread = _SPREAD.split(text)
    entry = f'{name} = "{on_one_line(text, LONGEST)}"'
    if len(text) > LONGEST or len(spread) > 1 or not _NUMBER.match(head):
        bare = '; without brackets, as in "3 ± 0.2 mm"' * (bool(spread) and text.startswith("("))
        raise ValueError(f"{entry}: {wanted}{bare}")
    if spread and (problem := _spread_error(spread[0])):
        raise ValueError(f"{entry}: {problem}")
    if _AMBIGUOUS.search(text):
        raise ValueError(f"{entry}: write one number, with a decimal point and without gaps: {wanted}")
    if thousands := _THOUSANDS.match(text):
        digits = thousands[1]
        raise ValueError(f"{entry}: the point may separate thousands: write {digits} or {digits}e3: {wanted}")
    if not spread:
        return Quantity(_si(name, text, unit, wanted))
    number = _NUMBER.match(spread[0])
    common = spread[0][number.end() :]
    if common.lstrip().startswith("%"):  # "200 GPa ± 5 %", or "200 ± 5 % GPa", in which pint would read GPa/100
        common = common.replace("%", "", 1).rstrip()
        if common and (has_unit(head) or "%" in common):
            raise ValueError(f"{entry}: only the unit of the number may follow %")
        if "%" in head:  # "30 % ± 2 %" could be ± 0.02 and ± 0.006
            raise ValueError(f'{entry}: write the spread as a number, as in "0.3 ± 0.02"')
        value = _si(name, head + common, unit, wanted)
        spread = abs(value * float(number[0])) / 100
        if not math.isfinite(spread):
            raise ValueError(f"the spread of {name} = {number[0]} %: must be finite")
        return Quantity(value, spread)
    head = head if has_unit(head) else head + common
    return Quantity(_si(name, head, unit, wanted), _si(f"the spread of {name}", spread[0], unit, wanted))


def _spread_error(text: str) -> str:
    """The error in the text after ±; "" if it begins with a number that may be a standard deviation."""
    if text.startswith(("-", "−")):
        return "± must be followed by a number not below 0: leave out its minus sign"
    return "" if _NUMBER.match(text) else "± must be followed by a number, finite and not below 0"


@lru_cache(maxsize=4096)  # reading a text takes half a millisecond
def _si(name: str, text: str, unit: str, wanted: str) -> float:
    """The SI value of a text without a spread. It is rounded once, so "3 um" is exactly the float 3e-6."""
    entry, text = on_one_line(text, LONGEST), _POWER.sub(r"\1^\2", text.replace("⁻²", "^-2").replace("²", "^2"))
    text = _MICRONS.sub("µm", text) if unit == "m" else text
    plain = _PLAIN.fullmatch(text)
    size = _size(plain[2], unit) if plain else None
    if size is not None and math.isfinite(value := float(Decimal(plain[1]) * size)):
        return value
    registry = _registry()  # outside `try`: an error in importing pint is not an error of the unit
    try:
        parsed = registry.Quantity(text)
    except MemoryError:
        raise
    except Exception as error:  # pint raises many kinds of errors
        raise ValueError(f'{name} = "{entry}": no unit has this name{_near(text, unit)}; {wanted}') from error
    if unit != "1" and parsed.unitless:
        raise ValueError(f'{name} = "{entry}" has no unit: {wanted}')
    if unit != "1" and "%" in text:  # pint reads "9 um %" as 0.09 um
        raise ValueError(f'{name} = "{entry}": % may only follow ±: {wanted}')
    if not parsed.is_compatible_with(unit):
        raise ValueError(f'{name} = "{entry}" is {_understood(parsed)}{_near(text, unit)}: {wanted}')
    value = float(parsed.to(unit).magnitude)
    if not math.isfinite(value):
        raise ValueError(f'{name} = "{entry}": must be finite')
    return value


def _near(text: str, unit: str) -> str:
    """A hint at a unit that differs only in capitals: "GPa" for "Gpa", "meter" for "Meter"; "" if there is none."""
    word = text[_NUMBER.match(text).end() :].strip()
    near = [name for name, _ in READABLE.get(unit, ("", ()))[1] if name.lower() == word.lower() != ""]
    near += [word.lower()] * (_size(word.lower(), unit) is not None)
    return f' (did you mean "{near[0]}"?)' if near else ""


@lru_cache(maxsize=256)
def _size(word: str, unit: str) -> Decimal | None:
    """The size of a unit such as "um" or "1/mm^2" in the SI `unit`; None if it is not known exactly."""
    written = {name.replace("²", "^2"): size for name, size in READABLE.get(unit, ("", ()))[1]}
    if unit != "1" and (size := written.get(word.replace("u", "µ"))):
        return Decimal(repr(size))
    registry = _registry()
    try:
        magnitude = registry.Quantity(word).to(unit).magnitude
    except MemoryError:
        raise
    except Exception:  # pint then reads the whole text, and the message says what is wrong
        return None
    # for the SI unit itself the magnitude is the integer 1
    return Decimal(magnitude) if isinstance(magnitude, (int, Decimal)) and unit != "1" else None


def _understood(parsed: Any) -> str:
    """A quantity of the wrong dimension in words: "a force"."""
    if parsed.dimensionless:
        return "an angle or a ratio"
    return next((what for unit, (what, _) in READABLE.items() if parsed.is_compatible_with(unit)), f"in {parsed.units}")


@cache
def _registry() -> Any:
    """The registry of pint. It computes with decimal numbers, so that "3 um" and "3e-6 m" are the same float."""
    import pint

    return pint.UnitRegistry(non_int_type=Decimal)


def multiple(largest: float, unit: str) -> tuple[str, float]:
    """Name and size of the multiple of an SI unit in which numbers up to `largest` are easiest to read.

    It is the largest multiple that does not exceed `largest`, or else the smallest.

    unit : one of READABLE
    """
    multiples = READABLE[unit][1]
    return next(((name, size) for name, size in multiples if largest >= size), multiples[-1])


def readable(value: float, unit: str, spread: float = 0.0) -> str:
    """A number in SI as text in a suitable multiple, with ± its spread: readable(2.5e-6, "m") is "2.5 µm".

    value, spread : in the SI `unit`, one of READABLE; a spread of less than 1e-5 of the value is left out
    """
    if not math.isfinite(value):
        return "infinite" if value > 0 else "unknown"
    name, size = multiple(abs(value), unit)
    number, spread = value / size, spread / size
    if spread > _SURE * abs(number):
        places = max(0, 1 - math.floor(math.log10(spread)))  # two digits of the spread
        text = f"{number:.{places}f} ± {spread:.{places}f}" if places < 7 else f"{number:.3e} ± {spread:.1e}"
    else:
        text = f"{number:.5g}"
    return f"{text} {name}".rstrip()
