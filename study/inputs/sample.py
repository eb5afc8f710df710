"""Values that follow from a rule in the study file: ranges, and random cases, the same on every machine."""

import math
import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..specimen.quantities import Quantity, quantity
from ..terminal import shown
from .lexicon import Lexicon
from .scene.bodies import of_names
from .scene.scene import si
from .vocabulary import BODIES, Parameter, check, finite, si_unit

LONGEST_AXIS = 1_000_000
KEYS = ("start", "stop", "spacing", "over")  # of a range
LIMITS = {"size": (1, LONGEST_AXIS), "seed": (0, 2**32 - 1)}
ANY_NUMBER = Parameter(interval="(-inf, inf)")
"""Bounds of a range of SI numbers in [sample]. The numbers that are drawn are checked later, as all with units are."""


def range_values(name: str, raw: dict, request: Any) -> list:
    """The values of a range, an input of the request; with units they are in SI. [] if it has a mistake."""
    errors, lexicon, before = request.errors, request.lexicon, len(request.errors)
    in_si = request.physical and _is_number(name, lexicon) and lexicon.all_rows[name].unit != "1"
    raw = _in_si(raw, name, lexicon.all_rows[name].unit, errors) if in_si else raw
    values = _range_values(raw, name, errors) if len(errors) == before else []
    return list(map(Quantity, values)) if in_si else values


def _range_values(raw: dict, key: str, errors: list[str]) -> list:
    """The values of {start, stop, num, spacing = "linear" | "log"}. Wrong input: messages, []."""
    before = len(errors)
    check_range(raw, key, errors, ("start", "stop", "num", "spacing"))
    num = raw.get("num")
    if type(num) is not int or not 2 <= num <= LONGEST_AXIS:
        errors.append(f"{key}: {quoted('num', raw)}: must be a whole number in [2, {LONGEST_AXIS}]")
    if len(errors) > before:
        return []
    make = np.geomspace if raw.get("spacing", "linear") == "log" else np.linspace
    return make(raw["start"], raw["stop"], num).tolist()


def check_range(raw: dict, key: str, errors: list[str], names: tuple[str, ...]) -> None:
    """Messages for the spacing and the ends of a range, and for keys that are not among `names`."""
    for name in raw:
        if name not in names:
            errors.append(f'{key}: "{name}" is not allowed; a range is {{{", ".join(names)}}}')
    spacing = raw.get("spacing", "linear")
    if spacing not in ("linear", "log"):
        errors.append(f'{key}: spacing = {shown(spacing)}: must be one of "linear", "log"')
    for end in ("start", "stop"):
        value = raw.get(end)
        if not finite(value) or (spacing == "log" and value <= 0):
            also = ", > 0 for spacing log" * (spacing == "log")
            errors.append(f"{key}: {quoted(end, raw)}: must be a finite number{also}")
    start, stop = raw.get("start"), raw.get("stop")
    if finite(start) and finite(stop) and not math.isfinite(float(stop) - float(start)):
        errors.append(f"{key}: from start = {shown(start)} to stop = {shown(stop)}: must be less than 1.8e308 apart")


def quoted(name: str, table: dict) -> str:
    """An entry of a table as messages quote it: "num = 3", or "num is missing"."""
    return f"{name} = {shown(table[name])}" if name in table else f"{name} is missing"


def sampled(request: Any, names: list[str], check_values: Callable) -> dict[str, list]:
    """The random values of the parameters `names` in [sample]: entries of lists, numbers in ranges; {} for a mistake.

    request : with the table [sample]; if the study has units, the numbers of ranges are in SI
    check_values : a function of a name and its values that appends messages
    """
    table, physical, errors, lexicon = request.sample, request.physical, request.errors, request.lexicon
    before, parameters, read, rows = len(errors), {}, dict(table) if isinstance(table, dict) else {}, lexicon.all_rows
    for name in names:
        raw = table[name]
        parameters[name] = Parameter(choices=("a material",)) if name in BODIES else lexicon.parameter(name)
        if physical and _is_number(name, lexicon):
            parameters[name] = parameters[name] if rows[name].unit == "1" and name in lexicon.rows else ANY_NUMBER
            if isinstance(raw, dict):
                read[name] = _in_si(raw, f"[sample] {name}", _unit_of_range(name, raw, rows), errors)
        if isinstance(raw, list):  # all of it, since some of its values may not be drawn
            _check_list(name, raw, request, check_values)
    refused = {*read} - {*names, *LIMITS}
    if len(errors) > before or (refused and not names):
        return {}
    read = {name: raw for name, raw in read.items() if name not in refused} if isinstance(table, dict) else table
    in_si = [name for name in names if physical and isinstance(read[name], dict)]
    return {n: [*map(Quantity, v)] if n in in_si else v for n, v in draw(read, parameters, errors).items()}


def _is_number(name: str, lexicon: Lexicon) -> bool:
    return name not in BODIES and not lexicon.parameter(name).choices


def _check_list(name: str, raw: list, request: Any, check_values: Callable) -> None:
    """Messages for the values of a list of [sample]."""
    if not (request.physical and _is_number(name, request.lexicon)) and name not in BODIES:
        check_values(name, raw)
        return
    for i, value in enumerate(raw):
        try:
            of_names(name, [value]) if name in BODIES else si(name, value, f"{name}[{i}]", request.lexicon)
        except (ValueError, LookupError) as error:
            request.errors.append(str(error.args[0]))


def _in_si(raw: dict, key: str, unit: str, errors: list[str]) -> dict:
    """A range with its ends as numbers in the SI `unit`; messages and {} for ends that it cannot have."""
    try:
        read = {end: quantity(f"{key}: {end}", raw[end], unit) for end in ("start", "stop") if end in raw}
    except ValueError as error:
        errors.append(str(error))
        return {}
    unsure = [end for end, number in read.items() if number.spread]
    errors += [f"{key}: {end} = {shown(raw[end])}: a range has no spread, a list of values may" for end in unsure]
    ends = {end: number.value for end, number in read.items()}
    wrong = [end for end, value in ends.items() if raw.get("spacing") == "log" and value <= 0]
    errors += [f"{key}: {end} = {shown(raw[end])}: must be > 0 for spacing log" for end in wrong]
    return {} if wrong or unsure else raw | ends


def _unit_of_range(name: str, raw: dict, rows: Mapping) -> str:
    """The SI unit of the ends of a range of [sample]. With over = "Ra^2" it is the unit of the product with Ra²."""
    i, j = rows[name].powers
    other, power = divisor(raw)
    if other in rows:
        i, j = i + power * rows[other].powers[0], j + power * rows[other].powers[1]
    return si_unit((i, j))


def draw(table, parameters: dict[str, Parameter], errors: list[str]) -> dict[str, list]:
    """Columns of a random sample: parameter -> list of `size` values, in the order of the table.

    table : {size, seed, NAME = ..., ...}; docs/studies.md says what a parameter may be
    parameters : NAME -> what values it may have
    errors : messages are appended here; {} is returned then

    Each parameter has its own random numbers: a further parameter changes no other, and a larger `size` continues the
    sample. Values are rounded to six digits. Powers differ in the last bit between machines, but rounded values do not,
    and any case can be written down.
    """
    if not isinstance(table, dict):
        errors.append(f"sample = {shown(table)}: must be a table [sample]")
        return {}
    before = len(errors)
    for key, (low, high) in LIMITS.items():
        if type(table.get(key)) is not int or not low <= table[key] <= high:
            errors.append(f"[sample] {quoted(key, table)}: must be a whole number in [{low}, {high}]")
    drawn = {name: raw for name, raw in table.items() if name not in LIMITS}
    if not drawn:
        errors.append("[sample] has no parameter: must draw at least one")
    for name in drawn:
        _check(name, drawn, parameters[name], errors)
    if len(errors) > before:
        return {}
    columns = {}
    for name in sorted(drawn, key=lambda name: "over" in drawn[name]):  # divisors come first
        columns[name] = _column(drawn[name], uniform(table["size"], table["seed"], name), columns)
    return {name: columns[name] for name in drawn}


def uniform(size: int, seed: int, name: str) -> np.ndarray:
    """(size,) numbers uniform on [0, 1): the upper 53 bits of PCG64 seeded by `seed` and `name`.

    numpy promises these bits for ever, which it does not for the numbers of its Generator.
    """
    return (np.random.PCG64([seed, *name.encode()]).random_raw(size) >> np.uint64(11)) * 2.0**-53


def _column(raw, u: np.ndarray, columns: dict[str, list]) -> list:
    if isinstance(raw, list):
        return [raw[int(i)] for i in u * len(raw)]
    start, stop = float(raw["start"]), float(raw["stop"])
    log = raw.get("spacing", "linear") == "log"
    values = _rounded(start ** (1 - u) * stop**u if log else start * (1 - u) + stop * u)
    values = np.clip(values, start, stop)
    if "over" in raw:
        other, power = divisor(raw)
        with np.errstate(all="ignore"):  # a quotient that is not finite is refused later, as any such value
            values = _rounded(values / np.array(columns[other]) ** power)
    return values.tolist()


def _rounded(values: np.ndarray) -> np.ndarray:
    return np.array([float(f"{value:.5e}") for value in values])


def divisor(raw: dict) -> tuple[str, int]:
    """Parameter and power by which a range is divided: ("Ra", 2) for over = "Ra^2"; ("", 0) without a valid `over`."""
    over = raw.get("over")
    parts = re.fullmatch(r"(\w+?)(?:\^([1-9]))?", over) if isinstance(over, str) else None
    return (parts[1], int(parts[2] or 1)) if parts else ("", 0)


def _check(name: str, drawn: dict, parameter: Parameter, errors: list[str]) -> None:
    """Append messages for the list or range of one parameter."""
    key, raw = f"[sample] {name}", drawn[name]
    if isinstance(raw, list) and raw:
        return  # its values are checked later, as those of any parameter
    if not isinstance(raw, dict) or parameter.choices or parameter.whole:
        form = "" if parameter.choices or parameter.whole else f"{{{', '.join(KEYS)}}} or "
        errors.append(f"{key} = {shown(raw)}: must be {form}a list to choose from")
        return
    before = len(errors)
    check_range(raw, key, errors, KEYS)
    if len(errors) == before and not raw["start"] < raw["stop"]:
        errors.append(f"{key}: stop = {shown(raw['stop'])}: must be > start")
    if "over" in raw:
        plain = [n for n, other in drawn.items() if isinstance(other, dict) and "over" not in other]
        if divisor(raw)[0] not in plain:
            allowed = " or ".join(plain) or "none here"
            errors.append(f"{key}: over = {shown(raw['over'])}: must be a power of a range of [sample]: {allowed}")
    elif len(errors) == before:
        wrong = [(end, check(parameter, raw[end])) for end in ("start", "stop")]
        errors += [f"{key}: {end} = {shown(raw[end])}: {text}" for end, text in wrong if text]
