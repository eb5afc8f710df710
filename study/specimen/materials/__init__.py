"""Elastic constants and strengths of common materials by name, with spreads and sources; and the user's own materials.

>>> steel = get("100Cr6")
>>> steel.name, steel.E, steel.nu
('steel 52100', 207000000000.0, 0.29)
>>> f"{steel.reduced_modulus:.3g} +- {steel.reduced_modulus_spread:.1g} Pa"
'2.26e+11 +- 4e+09 Pa'
"""

import difflib
import math
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import NamedTuple

from solver.laws.elastic_plastic import TABOR

from ..quantities import multiple
from .entries import STRENGTHS, Material, of_sections, plainly, read, written
from .works import Pair, pairs, work_of_adhesion

__all__ = ["Material", "Pair", "get", "names", "pairs", "read", "table", "work_of_adhesion"]


#: Parts of names with at most this many letters match only the beginning of a name.
_SHORT = 3


def get(name: str, among: Mapping[str, Material] | None = None) -> Material:
    """The material that has this name or is also called so; capitals, hyphens and spaces do not matter.

    Parameters
    ----------
    name : such as "steel 52100" or "100Cr6"
    among : the materials to search, as `read` returns them; by default the table of this package

    Returns
    -------
    Material

    Raises
    ------
    LookupError : there is no such material; similar names are suggested

    Examples
    --------
    >>> get("ptfe").nu
    0.46
    """
    materials = _built_in() if among is None else among
    spelled = {plainly(word): entry for entry in materials.values() for word in entry.also}
    spelled |= {plainly(entry.name): entry for entry in materials.values()}  # names win over other names
    plain = plainly(name)
    if plain in spelled:
        return spelled[plain]
    within = [word for word in spelled if word.startswith(plain) or (len(plain) > _SHORT and plain in word)]
    near = (within if plain else []) or difflib.get_close_matches(plain, spelled, n=3)
    meant = [f'"{name}"' for name in materials if name in {spelled[word].name for word in near}]
    hint = f"did you mean {' or '.join(meant[:6])}?" if meant else f"known: {', '.join(materials)}"
    raise LookupError(f"{written(name)} is not a material; {hint}")


class Strength(NamedTuple):
    """A yield strength in Pa, its standard deviation, and whether it is the hardness over 2.84; NaN: not known."""

    value: float = math.nan
    spread: float = 0.0
    from_hardness: bool = False


def known_strength(material: Material | str) -> Strength:
    """The yield strength of a material, or its hardness over 2.84 where only that is known."""
    if isinstance(material, str):
        try:
            material = get(material)
        except LookupError:  # a material of the user's file
            return Strength()
    if material.yield_strength:
        return Strength(material.yield_strength, material.yield_strength_spread)
    if material.hardness:
        return Strength(material.hardness / TABOR, material.hardness_spread / TABOR, True)
    return Strength()


def strength_of(material: Material | str) -> float:
    """The value of `known_strength` alone, Pa; NaN where none is known."""
    return known_strength(material).value


def names() -> tuple[str, ...]:
    """The names of the materials of this package, in the order of its table.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> names()[:2]
    ('steel 52100', 'steel M50')
    """
    return tuple(_built_in())


def table() -> str:
    """Every material in aligned columns, for a terminal: name, E, nu, E* = E/(1 - nu²), each with its spread.

    Returns
    -------
    str

    Examples
    --------
    >>> print(table().splitlines()[1])
    steel 52100         207 ± 3 GPa      0.29 ± 0.01      226.0 ± 3.6 GPa
    """
    rows = [("material", "E", "nu", "E/(1 - nu²)"), *(_numbers(entry) for entry in _built_in().values())]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    )


def markdown() -> str:
    """The table of docs/materials_table.md: that of `table`, other names, strengths, condition and sources."""
    head = ("material", "E", "ν", "E/(1 − ν²)", "strengths", "holds for", "source", "read", "source of the strengths")
    rows = [head, ("---",) * len(head)]
    for entry in _built_in().values():
        name, *numbers = _numbers(entry)
        named = f"**{name}** ({', '.join(entry.also)})" if entry.also else f"**{name}**"
        read_in = "yes" if entry.checked else "in part"
        rows.append((named, *numbers, _strengths(entry), entry.condition, entry.source, read_in, entry.strength_source))
    return "\n".join(f"| {' | '.join(cell.replace('|', '/') for cell in row)} |" for row in rows)


def in_words(entry: Material) -> str:
    """All that is known of a material, a line each, for a terminal."""
    name, E, nu, reduced = _numbers(entry)
    lines = {"E": E, "nu": nu, "E/(1 - nu²)": reduced}
    lines |= {
        name.replace("_", " "): _in_multiples(value, getattr(entry, f"{name}_spread")) if value else "not known"
        for name, value in ((name, getattr(entry, name)) for name in STRENGTHS)
    }
    lines |= {"also called": ", ".join(entry.also), "holds for": entry.condition, "source": entry.source}
    lines |= {"read there": "yes" if entry.checked else "in part", "source of the strengths": entry.strength_source}
    width = max(map(len, lines))
    return "\n".join([entry.name, *(f"  {label:{width}}  {text}" for label, text in lines.items() if text)])


@cache
def _built_in() -> dict[str, Material]:
    text = resources.files(__package__).joinpath("materials.toml").read_text("utf-8")
    return of_sections(tomllib.loads(text), "materials.toml")


def _numbers(entry: Material) -> tuple[str, str, str, str]:
    return (
        entry.name,
        _in_multiples(entry.E, entry.E_spread),
        _with_spread(entry.nu, entry.nu_spread),
        _in_multiples(entry.reduced_modulus, entry.reduced_modulus_spread),
    )


def _strengths(entry: Material) -> str:
    """The strengths that are known: "hardness 8.0 ± 0.7 GPa"."""
    strengths = [(name, getattr(entry, name), getattr(entry, f"{name}_spread")) for name in STRENGTHS]
    words = [f"{name.replace('_', ' ')} {_in_multiples(value, spread)}" for name, value, spread in strengths if value]
    return "; ".join(words)


def _in_multiples(value: float, spread: float) -> str:
    """A modulus in kPa, MPa or GPa."""
    unit, size = multiple(value, "Pa")
    return f"{_with_spread(value / size, spread / size)} {unit}"


def _with_spread(value: float, spread: float) -> str:
    """A number and its spread, with the fewest decimals that round both by at most a twentieth of the spread."""
    if spread == 0:
        return f"{value:.4g}"
    enough = (n for n in range(9) if all(abs(round(x, n) - x) <= spread / 20 for x in (value, spread)))
    decimals = next(enough, 9)
    return f"{value:.{decimals}f} ± {spread:.{decimals}f}"
