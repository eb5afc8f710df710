"""The heading of a text file: the unit of its heights, a factor, and the number that stands for a missing point.

Three text formats state every length in their heading: SDF (ISO 25178-71), SMD (ISO 5436-2) and PRF.
"""

import re
from collections.abc import Sequence

import numpy as np

from .scan import UNITS, WORDS, metres, spelt
from .scan_texts import NumberTable

_UNIT = rf"(?:(?i:{'|'.join(WORDS)})s?|{'|'.join(sorted(UNITS, key=len, reverse=True))}|Å|A)(?![^\W_])"
_NUMBER = r"[-+]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][-+]?\d+)?(?![\w.,])"
#: Factors with a stated unit: height × factor is in that unit. SurfaceTopography and Gwyddion know them too.
_FACTORS = [
    re.compile(pattern, re.IGNORECASE)
    for pattern in (
        rf"factor\s*\(?\s*(?:->|→|to|in)\s*(?-i:(?P<unit>{_UNIT}))\s*\)?\s*[=:]?\s*(?P<factor>{_NUMBER})",
        rf"\bbit2(?P<unit>nm|um)\b\W*?(?P<factor>{_NUMBER})",
        rf"\b(?:z|height|value|data)[\s_-]*units?\s*[=:]\s*(?P<factor>{_NUMBER})\s*\*?\s*(?-i:(?P<unit>{_UNIT}))",
    )
]
#: A name and a number, perhaps with a unit and "per bit".
_PAIR = re.compile(
    rf'(?P<key>[\w\\@][\w ./()\[\]>|\\@"×*-]*?)"?\s*(?:[=:;,\s]|(?<=[(\[×*]))\s*"?\s*(?P<value>{_NUMBER})'
    rf"\s*(?P<unit>{_UNIT})?(?P<per>\s*(?:/|per)\s*(?:bit|digit|count|lsb|step)s?\b)?"
)
#: Names of a scale of heights, and names that contain such a word without being a scale.
_SCALE = re.compile(
    r"scale\b|scaling|scale[\s_-]*(?:data|z|height)|skalier|échelle|fa[ck]t(?:o|eu)r|multipl|\bmult\b|amplif|bit2|\blsb\b"
    r"|\b1\s*(?:bit|digit|count)\b|quanti[sz]|^units?$|units? of$|[a-z]\s*[*×]$"
    r"|(?:per|/)[\s_-]*(?:bit|digit|count|lsb)s?\b"
    r"|\b(?:z|heights?|values?|data)\s*[\[(]\s*[x×*]?$"
    r"|\b(?:z|height|vertical|value|data)[\s_.-]*(?:axis[\s_.-]*)?(?:calib|conver|sens|gain|quant|units?$)",
    re.IGNORECASE,
)
_NO_SCALE = re.compile(
    r"(?<![^\W_])(?<!\[)(?:x|y|xy|q)(?![^\W_])|\b[xy]{1,2}[\s_-]*(?:scal|fac|cal)|lateral|horizontal|width|pixel|time|colou?r"
    r"|gr[ae]y|full|\bbar\b|display|date|intensity|phase|auto|force|speed|feedback|form|quality|zoom|filter|sampl|fill"
    r"|overlap|crest|averag|noise",
    re.IGNORECASE,
)
_VALUE_UNIT = re.compile(
    r"^\W*(?:value units?|z[\s_-]*units?|units? (?:of )?(?:z|data|heights?|values?)|height units?|data units?|einheiten"
    r"|unités|unità valore|unidades de valor|jednotky hodnot)\W*?[\s:=,;]\W*([^\W\d_]+)",
    re.IGNORECASE,
)
_KEYENCE_UNIT = re.compile(r'^\W*unit"?[,;\t]\s*"?([^\W\d_]+)', re.IGNORECASE)
_NO_DATA = re.compile(
    rf"\b(?:no[\s_-]*data(?:[\s_-]*value)?|(?:missing|invalid|undefined|void|bad|masked)[\w\s-]*value)\W*?[\s:=]\W*?"
    rf"({_NUMBER})\s*$",
    re.IGNORECASE,
)
_SIZE = re.compile(
    r"^\W*(?:(?P<rows>nrows|y-pixels|ny|number of rows|vertical)|(?P<columns>ncols|x-pixels|nx|number of columns"
    r"|horizontal))\"?\s*[=:,;\s]\s*\"?(?P<number>\d+)\W*$",
    re.IGNORECASE,
)


#: The size of the whole map, or the distance between its points, as headings state them.
_EXTENT = re.compile(
    rf"^\W*(?:(?P<all>width|height)|(?P<each>(?:xy?[\s_-]*)?pixel[\s_-]*(?:size|width)))\W*?[:=]\s*(?P<value>{_NUMBER})"
    rf"\s*(?P<unit>{_UNIT})\W*$",
    re.IGNORECASE,
)
#: A distance may differ by this share from the rounded one in the heading. A count that is off by one of N points, a
#: share of 1/N, would differ by more.
_ROUNDED = 1e-3


def extent_notes(table: NumberTable, steps: Sequence[float], unit: str, name: str) -> tuple[str, ...]:
    """Notes where the heading of a map states distances between points other than the steps (dy, dx) in `unit`.

    The width in Gwyddion is that of N steps, not of the N - 1 from the first point to the last.
    """
    notes: tuple[str, ...] = ()
    for number, line in table.heading:
        if not (match := _EXTENT.match(line)) or not (size := length(match["unit"])):
            continue
        axis = 0 if (match["all"] or "").lower() == "height" else 1
        points = table.numbers.shape[axis] if match["all"] else 1
        of_heading = float(match["value"].replace(",", ".")) * size / metres(unit, name) / points
        if abs(of_heading - steps[axis]) > _ROUNDED * abs(of_heading):
            notes += (
                f'line {number} has "{line[:80]}", {of_heading:.5g} {unit} a point, but {("dy", "dx")[axis]} is '
                f"{steps[axis]:.5g} {unit}, which is taken",
            )
    return notes


def length(word: str) -> float | None:
    """Metres in a unit of length as a heading writes it; None for any other word."""
    return spelt(word) or {"A": 1e-10}.get(word)


def check_units(table: NumberTable, arguments: dict, places: list, name: str) -> tuple[str, ...]:
    """Notes where `unit` or `height_unit` of the call differs from a unit in the heading ("x [mm] z [nm]").

    What the call gives holds. Without height_unit heights are in `unit`, unless the heading has another unit for them.
    Where the heading has a unit for each column, those at `places` count: first of the positions, last of the heights.
    A place is None where a distance stands for the positions; a single unit is then the unit of the heights.

    Raises ValueError: heights in another unit where the call has no height_unit; a unit that is no length, such as V.
    """
    unit, width = arguments["unit"], table.numbers.shape[1]
    height_unit = arguments.get("height_unit", unit)
    columns, line = _column_units(table, width)
    of_heights, height_line = _value_unit(table)
    has_factor = any(pattern.search(line) for _, line in table.heading for pattern in _FACTORS)
    converted = has_factor and length(stated_height_unit(table) or "") == metres(height_unit, name)
    if has_factor and (converted or length(of_heights) is None):
        of_heights = ""  # "data unit=rad" before the factor that converts it to metres
    notes: list[str] = []
    for i, place in enumerate(places):
        heights, each = i == len(places) - 1, len(columns) == width
        argument, used = ("height_unit", height_unit) if heights else ("unit", unit)
        if place is None and len(columns) in (1, width):
            continue
        stated = [([of_heights], height_line)] if heights and of_heights else []
        if not stated or (each and width > 1):
            stated.append(([columns[place]] if each and columns else columns, line))
        for words, quoted in stated:
            if not words or metres(used, name) in [length(word) for word in words]:
                continue
            if argument not in arguments or not any(map(length, words)):
                raise ValueError(f"{name}: {_contradiction(argument, used, words, quoted)}")
            subject = "heights are" if heights else "positions are"
            notes.append(f"{subject} in {used}, as {argument} says; the heading has {' and '.join(words)}")
    return tuple(dict.fromkeys(notes))


def _contradiction(argument: str, used: str, words: list[str], line: str) -> str:
    """A sentence on a unit of the call that is not the one in a line of the heading, and what to do."""
    lengths = [word for word in words if length(word)]
    way_out = (
        f"Give {argument}={lengths[-1]!r}, or {argument}={used!r} if the heading is wrong."
        if lengths
        else "This is no unit of length: choose another column or channel, or take the unit out of the heading."
    )
    return f'{argument} is {used}, but the heading has {" and ".join(words)}: "{line[:80]}". {way_out}'


def _column_units(table: NumberTable, width: int) -> tuple[list[str], str]:
    """The units in the line that names the columns, or in the next one, and that line; [] if there are none."""
    for i, (_, line) in enumerate(reversed(table.heading[-4:])):
        brackets = re.findall(r"[\[(]\s*([^\W\d_]+)\s*[\])]", line)
        text = line.strip("#% ")
        fields = [field.strip(' "') for field in text.split(table.separator) if field.strip(' "')]
        ends = [re.search(rf"(?:\bin\s|[/_\s(\[])\s*({_UNIT})\s*[)\]]?$", field) for field in fields]
        if len(brackets) == width or (len(fields) == width and all(length(field) for field in fields)):
            return (brackets if len(brackets) == width else fields), line
        if table.separator and len(fields) == width and all(ends):
            return [end[1] for end in ends], line
        if i == 0 and (units := [word for word in brackets if length(word)]):
            return units, line
    return [], ""


def _value_unit(table: NumberTable) -> tuple[str, str]:
    """The unit of the heights that the heading names, and its line; ("", "") if it names none."""
    keyence = any("xy calibration" in line.lower() for _, line in table.heading)
    if table.heading and table.heading[0][1].startswith("Zygo XYZ"):
        return "um", table.heading[0][1]
    if _wyko_in_nm(table):
        return "nm", table.heading[0][1]
    for _, line in table.heading:
        match = _VALUE_UNIT.match(line) or (keyence and _KEYENCE_UNIT.match(line))
        if match:
            return match[1], line
    return "", ""


def height_metres(table: NumberTable, arguments: dict, name: str) -> tuple[float, tuple[str, ...]]:
    """The height in metres that the number 1 stands for, and notes on the factors of the heading.

    A factor that the heading states with its unit ("height conversion factor (-> m)=6.3e-008", "Bit2nm = 0.012") is
    applied where the unit of heights is this unit. If height_unit of the call is another one, this holds, and the
    factor is not applied.

    Raises ValueError: any other line that looks like a scale; another unit where the call has no height_unit, or where
    the numbers without the factor are no lengths; two factors.
    """
    height_unit = arguments.get("height_unit", arguments["unit"])
    size, notes, value_unit, applied = metres(height_unit, name), (), _value_unit(table)[0], False
    no_lengths = bool(value_unit) and length(value_unit) is None
    has_column_unit = any(re.search(rf"\(\s*{_UNIT}\s*\)", line) for _, line in table.heading)
    for number, line in table.heading:
        if has_column_unit and line.lstrip('#%" ').startswith("\\"):  # of a Nanoscope, whose table has "Height(nm)"
            continue
        at, conversion = f'{name}, line {number}: "{line[:80]}"', _factor(table, line, value_unit)
        if not conversion:
            if not _is_wyko(table):
                _no_scale(line[:300], size, at)
            continue
        factor, unit = conversion
        if np.isclose(factor * length(unit), metres(height_unit, name), rtol=1e-9, atol=0):
            continue
        if length(unit) == metres(height_unit, name):
            if applied or factor == 0:
                raise ValueError(f"{at}: the heading has two factors of the heights, or 0: take out what does not hold")
            size, applied = factor * length(unit), True
            notes += (f"heights are multiplied by {factor:g} {unit}, as line {number} says",)
        elif "height_unit" in arguments and not no_lengths:
            notes += (
                f"heights are in {height_unit}, as height_unit says; the factor in line {number} of the heading, "
                f"{factor:g} {unit}, is not applied",
            )
        else:
            multiplied = "take the line out" if no_lengths else f"height_unit={height_unit!r}"
            raise ValueError(
                f"{at} makes {unit} of the heights, but height_unit is {height_unit}: give height_unit={unit!r}, and "
                f"it is applied; or {multiplied} if the heights have been multiplied"
            )
    return size, notes


def stated_height_unit(table: NumberTable) -> str | None:
    """The unit of the heights by the heading, after its factor if it has one; None where it states no unit."""
    value_unit = _value_unit(table)[0]
    units = (conversion[1] for _, line in table.heading if (conversion := _factor(table, line, value_unit)))
    return next(units, value_unit if value_unit and length(value_unit) else None)


def _factor(table: NumberTable, line: str, value_unit: str) -> tuple[float, str] | None:
    """The factor that a line states, and the unit that it leads to."""
    if _is_wyko(table):
        return _wyko(table) if re.match(r"wavelength\s", line, re.IGNORECASE) else None
    match = next((match for pattern in _FACTORS if (match := pattern.search(line))), None)
    if not match or (match["unit"] == "nm" and "2nm" in line.lower() and value_unit):
        return None  # SPIP leaves open whether the heights of a file with a z-unit have been multiplied
    return float(match["factor"].replace(",", ".")), match["unit"]


def _is_wyko(table: NumberTable) -> bool:
    return bool(table.heading) and table.heading[0][1].startswith("Wyko ASCII")


def _wyko(table: NumberTable) -> tuple[float, str] | None:
    """Heights of Wyko are in wavelengths (in nm) times Mult. None: in nm, by the second number of line 1."""
    text = "\n".join(line for _, line in table.heading)
    values = [re.search(rf"^{key}\s+\d+\s+\d+\s+({_NUMBER})", text, re.MULTILINE) for key in ("Wavelength", "Mult")]
    if _wyko_in_nm(table):
        return None
    if not all(values):
        return float("nan"), "nm"
    return float(values[0][1]) / float(values[1][1]), "nm"


def _wyko_in_nm(table: NumberTable) -> bool:
    return _is_wyko(table) and bool(re.match(r"\D*\d+\s+1\b", table.heading[0][1]))


def _no_scale(line: str, size: float, at: str) -> None:
    """Raise ValueError for a line that looks like a scale of the heights, unless the scale is 1."""
    for pair in _PAIR.finditer(line):
        key, value = pair["key"], float(pair["value"].replace(",", "."))
        if not (pair["per"] or _SCALE.search(key)) or _NO_SCALE.search(key):
            continue
        unit = length(pair["unit"]) if pair["unit"] else None
        grouped = re.fullmatch(r"\d{1,3},\d{3}", pair["value"])
        if grouped or not np.isclose(value * unit / size if unit else value, 1.0, rtol=1e-9, atol=0):
            raise ValueError(
                f"{at} looks like a scale of the heights and is not applied. Multiply the heights by it, unless that "
                "has been done, and take the line out of the file"
            )


def without_no_data(table: NumberTable, columns: np.ndarray, name: str) -> tuple[np.ndarray, tuple[str, ...]]:
    """The heights with NaN for the number by which the heading marks missing data ("NODATA_value -9999"), and a note.

    Raises ValueError: a map has another number of rows or columns than the heading says.
    """
    notes, marks = (), set()
    for number, line in table.heading:
        size = _SIZE.match(line)
        shape = dict(zip(("rows", "columns"), table.numbers.shape, strict=True))
        for axis, count in shape.items():
            if min(shape.values()) > 3 and size and size[axis] and int(size["number"]) != count:
                raise ValueError(
                    f'{name}, line {number}: "{line[:80]}", but {count} {axis} follow: the file may be cut off. If it '
                    "is right, take the line out"
                )
        if match := _NO_DATA.search(line):
            value = float(match[1].replace(",", "."))
            if value in marks:
                continue
            marks.add(value)
            bad = np.isclose(columns, value, rtol=1e-6, atol=0)
            columns = np.where(bad, np.nan, columns)
            notes += (f"{bad.sum()} heights of {value:g} are missing points, as line {number} says",) * bool(bad.any())
    return columns, notes


def stated(text: str, name: str) -> tuple[np.ndarray, tuple[float, ...]] | None:
    """Heights and steps in m of a format whose heading states all lengths, SDF, SMD or PRF; None for other text."""
    if re.match(r"a[\w .-]+\n", text) and re.search(r"^\s*zscale\s*=", text, re.IGNORECASE | re.MULTILINE):
        return _sdf(text, name)
    if (
        "Z" in text  # quicker to find than the pair
        and "CZ" in text
        and re.search(r"^CZ\s+[A-Z]\s", text, re.MULTILINE)
        and re.search(r"^\s*(?:EOR|\x03)\s*$", text, re.MULTILINE)
    ):
        return _records(text, name)
    return None


def _sdf(text: str, name: str) -> tuple[np.ndarray, tuple[float, ...]]:
    """ISO 25178-71: a heading of "key = value", *, the heights in rows or one a line, *; height times Zscale is in
    m."""
    heading, _, rest = text.partition("\n*")
    pairs = (line.partition("=") for line in heading.splitlines())
    value = {key.strip().lower(): field.strip() for key, _, field in pairs}
    try:
        shape = int(value["numprofiles"]), int(value["numpoints"])
        dy, dx, scale = (float(value[key]) for key in ("yscale", "xscale", "zscale"))
    except (KeyError, ValueError) as error:
        raise ValueError(f"{name}: the SDF heading has no number for {error}") from error
    if value.get("compression", "0") != "0" or not scale > 0:
        raise ValueError(f"{name}: Zscale = {scale:g} must be positive, and Compression 0 in an SDF file")
    z = _heights(rest.partition("\n*")[0].split(), shape, name)
    marks = {"1": 2**16 - 1, "2": 2**32 - 1, "5": -(2**15), "6": -(2**31)}  # of whole numbers: no data
    z = np.where(z == marks.get(value.get("datatype")), np.nan, z) * scale
    return (z[0], (dx,)) if shape[0] == 1 else (z, (dy, dx))


def _records(text: str, name: str) -> tuple[np.ndarray, tuple[float, ...]]:
    """SMD and PRF: records of lines; the first has the axes, CX with its step and CZ with its unit and factor."""
    axis = r"^C{}\s+([A-Z])\s+({})\s+([a-zA-Zµ]+)\s+({})\s+[A-Z](?:\s+({}))?"
    x, z, y = (re.search(axis.format(letter, *[_NUMBER] * 3), text, re.MULTILINE) for letter in "XZY")
    spacing = re.search(rf"^SPACING\s+CX\s+({_NUMBER})", text, re.MULTILINE)
    step = (x and x[1] == "I" and x[5]) or (spacing and spacing[1])
    sizes = [UNITS.get(match[3].lower()) for match in (x, z) if match]
    if not step or y or None in sizes or len(sizes) != 2:
        raise ValueError(f"{name}: a profile of ISO 5436-2 needs lines CX with a step and CZ, in mm, um or nm; no CY")
    records = [record.split() for record in re.split(r"^\s*(?:EOR|\x03)\s*$", text, flags=re.MULTILINE)[1:]]
    numbers = (record for record in records if len(record) > 1 and re.fullmatch(rf"{_NUMBER}|(?i:bad)", record[0]))
    heights = _heights(next(numbers, []), (int(float(z[2])),), name)
    return heights * float(z[4]) * sizes[1], (float(step) * float(x[4]) * sizes[0],)


def _heights(fields: list[str], shape: tuple, name: str) -> np.ndarray:
    """The fields as numbers of that shape, NaN for Bad."""
    try:
        z = np.array([float("nan" if field.lower() == "bad" else field) for field in fields])
    except ValueError as error:
        raise ValueError(f"{name}: the heights have something other than numbers and Bad: {error}") from error
    if z.size != np.prod(shape):
        raise ValueError(f"{name}: {z.size} heights, but the heading says {' × '.join(map(str, shape))}")
    return z.reshape(shape)
