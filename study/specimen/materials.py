"""Elastic constants of common materials by name, each with its spread and its source; and of the user's own file.

>>> steel = get("100Cr6")
>>> steel.name, steel.E, steel.nu
('steel 52100', 207000000000.0, 0.29)
>>> f"{steel.reduced_modulus:.3g} +- {steel.reduced_modulus_spread:.1g} Pa"
'2.26e+11 +- 4e+09 Pa'
"""

import difflib
import math
import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path

from ..terminal import shown
from .quantities import multiple

__all__ = ["Material", "get", "names", "read", "table"]
SOFTEST, STIFFEST = 1e3, 2e12
"""Bounds of E in Pa. Each E of the table, 8.6 kPa to 1143 GPa, is between them; one in GPa by mistake is below."""
LEAST_SPREAD = 1e-6
"""Least spread of E, over E: no E is known better. A spread given in GPa by mistake, 5 beside 207e9 Pa, is below."""

NUMBERS = {
    "E": f"a number of Pa from {SOFTEST:g} to {STIFFEST:g} (210 GPa is 210e9)",
    "nu": "a number above -1 and at most 0.5",
    "E_spread": f"0 or a number of Pa from {LEAST_SPREAD:g} E to E (5 GPa is 5e9), one standard deviation",
    "nu_spread": "a number from 0 to 0.5, one standard deviation",
}
"""The keys that a section must have, and what is allowed."""
OTHERS = {"condition": "a text", "source": "a text", "also": "a list of texts", "checked": "true or false"}
"""The keys that it may have, and what is allowed."""


@dataclass(frozen=True)
class Material:
    """An isotropic elastic material; what `get` and `read` return has passed their checks.

    Attributes
    ----------
    name : as in the table
    E, nu : Young's modulus, Pa, and Poisson's ratio
    E_spread, nu_spread : one standard deviation of each, Pa and 1, among the pieces that bear the name
    condition : what the values hold for, and what they depend on
    source : where they are from
    also : other names
    checked : whether both numbers were read in the source; if not, the source says which were not
    """

    name: str
    E: float
    nu: float
    E_spread: float
    nu_spread: float
    condition: str = ""
    source: str = ""
    also: tuple[str, ...] = ()
    checked: bool = False

    @property
    def reduced_modulus(self) -> float:
        """E* = E/(1 - nu²), Pa."""
        return self.E / (1 - self.nu**2)

    @property
    def reduced_modulus_spread(self) -> float:
        """One standard deviation of E*, Pa, to first order in the spreads of E and nu, which are taken as independent.

        (dE*)² = (dE/(1 - nu²))² + (2 nu E dnu/(1 - nu²)²)²
        """
        less = 1 - self.nu**2
        return math.hypot(self.E_spread / less, 2 * self.nu * self.E * self.nu_spread / less**2)


def get(name: str, among: Mapping[str, Material] | None = None) -> Material:
    """The material of this name, or of this other name; capitals, hyphens and spaces do not matter.

    Parameters
    ----------
    name : such as "steel 52100" or "100Cr6"
    among : where to look, as `read` returns it; without it the table of this package

    Returns
    -------
    Material

    Raises
    ------
    LookupError : there is none; names like it are suggested

    Examples
    --------
    >>> get("ptfe").nu
    0.46
    """
    known = _built_in() if among is None else among
    spelled = {_plain(word): entry for entry in known.values() for word in entry.also}
    spelled |= {_plain(entry.name): entry for entry in known.values()}  # names win over other names
    plain = _plain(name)
    if plain in spelled:
        return spelled[plain]
    near = [word for word in spelled if plain and plain in word] or difflib.get_close_matches(plain, spelled, n=3)
    meant = [f'"{name}"' for name in known if name in {spelled[word].name for word in near}]
    hint = f"did you mean {' or '.join(meant[:6])}?" if meant else f"known: {', '.join(known)}"
    raise LookupError(f"{_shown(name)} is no material; {hint}")


def names() -> tuple[str, ...]:
    """The names of the materials of this package, in the order of its table.

    Returns
    -------
    tuple of str
    """
    return tuple(_built_in())


def table() -> str:
    """Every material in aligned columns, for a terminal: name, E, nu, E* = E/(1 - nu²), each with its spread.

    Returns
    -------
    str
    """
    rows = [("material", "E", "nu", "E/(1 - nu²)"), *(_numbers(entry) for entry in _built_in().values())]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    )


def markdown() -> str:
    """The table of docs/materials.md: what `table` shows, other names, condition and source."""
    head = ("material", "E", "ν", "E/(1 − ν²)", "holds for", "source", "read")
    rows = [head, ("---",) * len(head)]
    for entry in _built_in().values():
        name, *numbers = _numbers(entry)
        named = f"**{name}** ({', '.join(entry.also)})" if entry.also else f"**{name}**"
        rows.append((named, *numbers, entry.condition, entry.source, "yes" if entry.checked else "in part"))
    return "\n".join(f"| {' | '.join(cell.replace('|', '/') for cell in row)} |" for row in rows)


def read(path: str | os.PathLike) -> dict[str, Material]:
    """The materials of a TOML file of the user's own; `get(name, among)` finds them by their other names too.

    Each is a section `["my steel"]` with the numbers E (Pa), nu, E_spread (Pa), nu_spread, and if wanted the texts
    condition and source, the list `also` of other names, and checked = true.

    Parameters
    ----------
    path : of the file

    Returns
    -------
    dict : name -> Material

    Raises
    ------
    OSError : the file cannot be read
    ValueError : it is no TOML, or a value is missing or not allowed: a line for each, with file, section, key, value
    """
    path = Path(path)
    try:
        sections = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except UnicodeDecodeError as error:
        raise ValueError(f"{path.name} is not UTF-8 (byte {error.start}): save it with the encoding UTF-8") from None
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path.name} is no TOML file: {error}") from None
    return _materials(sections, path.name)


@cache
def _built_in() -> dict[str, Material]:
    text = resources.files(__package__).joinpath("materials.toml").read_text("utf-8")
    return _materials(tomllib.loads(text), "materials.toml")


def _materials(sections: dict, file: str) -> dict[str, Material]:
    """The materials of the sections of a file. Raises ValueError with every complaint, a line each."""
    errors = [f"{file}: [{_shown(name)}] {error}" for name, given in sections.items() for error in _errors(given)]
    if errors:
        raise ValueError("\n".join(errors))
    found: dict[str, Material] = {}
    owners: dict[str, str] = {}
    for name, given in sections.items():
        numbers = {key: float(given[key]) for key in NUMBERS}
        found[name] = Material(name, **(given | numbers | {"also": tuple(given.get("also", ()))}))
        for word in (name, *found[name].also):
            first = owners.setdefault(_plain(word), name)
            if first != name:
                errors.append(f"{file}: [{_shown(name)}] is called {_shown(word)}, and so is [{_shown(first)}]")
    if errors:
        raise ValueError("\n".join(errors))
    return found


def _errors(given) -> list[str]:
    """What is wrong with a section of the file."""
    if not isinstance(given, dict):
        return [f"= {_shown(given)}: must be a section with the keys {', '.join(NUMBERS)}"]
    allowed = NUMBERS | OTHERS
    errors = [f"{_shown(key)} is no key; known: {', '.join(allowed)}" for key in given if key not in allowed]
    errors += [f"{key} is missing: must be {words}" for key, words in NUMBERS.items() if key not in given]
    modulus = given.get("E")
    for key in allowed:
        if key in given and not _is_allowed(key, given[key], modulus):
            errors.append(f"{key} = {_shown(given[key])}: must be {allowed[key]}")
    return errors


def _is_allowed(key: str, value, modulus=None) -> bool:
    if key == "also":
        return isinstance(value, list) and all(isinstance(word, str) for word in value)
    if key in OTHERS:
        return isinstance(value, bool if key == "checked" else str)
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    if key == "E_spread":  # where E is wrong itself, its spread is not compared with it
        return value == 0 or value > 0 and (not _is_allowed("E", modulus) or LEAST_SPREAD * modulus <= value < modulus)
    return {"E": SOFTEST <= value <= STIFFEST, "nu": -1 < value <= 0.5, "nu_spread": 0 <= value <= 0.5}[key]


def _plain(name) -> str:
    """A name in small letters, with single blanks for hyphens and underscores."""
    return " ".join(str(name).casefold().replace("-", " ").replace("_", " ").split())


def _shown(value) -> str:
    return f"{value:g}" if isinstance(value, float) else shown(value)


def _numbers(entry: Material) -> tuple[str, str, str, str]:
    return (
        entry.name,
        _in_multiples(entry.E, entry.E_spread),
        _with_spread(entry.nu, entry.nu_spread),
        _in_multiples(entry.reduced_modulus, entry.reduced_modulus_spread),
    )


def _in_multiples(value: float, spread: float) -> str:
    """A modulus in kPa, MPa or GPa."""
    unit, size = multiple(value, "Pa")
    return f"{_with_spread(value / size, spread / size)} {unit}"


def _with_spread(value: float, spread: float) -> str:
    """A number and its spread, with the fewest decimals that change neither by more than a twentieth of the spread."""
    if spread == 0:
        return f"{value:.4g}"
    enough = (n for n in range(9) if all(abs(round(x, n) - x) <= spread / 20 for x in (value, spread)))
    decimals = next(enough, 9)
    return f"{value:.{decimals}f} ± {spread:.{decimals}f}"
