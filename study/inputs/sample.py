"""Random cases: the section [sample] of a study file becomes columns of values, the same on every machine."""

import re

import numpy as np

from ..terminal import shown
from .grid import LONGEST_AXIS, check_range, quoted
from .vocabulary import Parameter, check

KEYS = ("start", "stop", "spacing", "over")  # of a range
LIMITS = {"size": (1, LONGEST_AXIS), "seed": (0, 2**32 - 1)}


def draw(table, known: dict[str, Parameter], errors: list[str]) -> dict[str, list]:
    """Columns of a random sample: parameter -> list of `size` values, in the order of the table.

    table : {size, seed, NAME = ..., ...}, known names; docs/studies.md says what a parameter may be
    known : parameter -> what values it may have
    errors : messages are appended here; {} is returned then

    Each parameter has random numbers of its own, so that a further parameter changes no other and a larger `size`
    continues the sample. Values are rounded to six digits: powers differ in the last bit between machines, rounded ones
    do not, and any case can be written down.
    """
    if not isinstance(table, dict):
        errors.append(f"sample = {shown(table)}: must be a table [sample]")
        return {}
    before = len(errors)
    for key, (low, high) in LIMITS.items():
        if type(table.get(key)) is not int or not low <= table[key] <= high:
            errors.append(f"[sample] {quoted(key, table)}: must be a whole number in [{low}, {high}]")
    drawn = {name: given for name, given in table.items() if name not in LIMITS}
    if not drawn:
        errors.append("[sample] has no parameter: must draw at least one")
    for name in drawn:
        _check(name, drawn, known[name], errors)
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


def _column(given, u: np.ndarray, columns: dict[str, list]) -> list:
    if isinstance(given, list):
        return [given[int(i)] for i in u * len(given)]
    start, stop = float(given["start"]), float(given["stop"])
    log = given.get("spacing", "linear") == "log"
    values = _rounded(start ** (1 - u) * stop**u if log else start * (1 - u) + stop * u)
    values = np.clip(values, start, stop)
    if "over" in given:
        other, power = divisor(given)
        with np.errstate(all="ignore"):  # a quotient that is not finite is refused later, as any such value
            values = _rounded(values / np.array(columns[other]) ** power)
    return values.tolist()


def _rounded(values: np.ndarray) -> np.ndarray:
    return np.array([float(f"{value:.5e}") for value in values])


def divisor(given: dict) -> tuple[str, int]:
    """Parameter and power by which a range is divided: ("Ra", 2) for over = "Ra^2"; ("", 0) without a valid `over`."""
    over = given.get("over")
    found = re.fullmatch(r"(\w+?)(?:\^([1-9]))?", over) if isinstance(over, str) else None
    return (found[1], int(found[2] or 1)) if found else ("", 0)


def _check(name: str, drawn: dict, own: Parameter, errors: list[str]) -> None:
    """Append messages for the list or range of one parameter."""
    key, given = f"[sample] {name}", drawn[name]
    if isinstance(given, list) and given:
        return  # its values are checked later, as those of any parameter
    if not isinstance(given, dict) or own.choices or own.whole:
        form = "" if own.choices or own.whole else f"{{{', '.join(KEYS)}}} or "
        errors.append(f"{key} = {shown(given)}: must be {form}a list to choose from")
        return
    before = len(errors)
    check_range(given, key, errors, KEYS)
    if len(errors) == before and not given["start"] < given["stop"]:
        errors.append(f"{key}: stop = {shown(given['stop'])}: must be > start")
    if "over" in given:
        plain = [n for n, other in drawn.items() if isinstance(other, dict) and "over" not in other]
        if divisor(given)[0] not in plain:
            allowed = " or ".join(plain) or "none here"
            errors.append(f"{key}: over = {shown(given['over'])}: must be a power of a range of [sample]: {allowed}")
    elif len(errors) == before:
        bad = [(end, check(own, given[end])) for end in ("start", "stop")]
        errors += [f"{key}: {end} = {shown(given[end])}: {text}" for end, text in bad if text]
