"""A material, with its elastic constants, its strengths and their spreads, and files of materials."""

import math
import os
import tomllib
from dataclasses import dataclass
from pathlib import Path

from solver.numerics.userfile import NoFile, TooLarge, content

from ...terminal import shown

LARGEST = 10_000_000
"""Largest size of a file of materials, in bytes. It holds some 30,000 materials."""

SOFTEST, STIFFEST = 1e3, 2e12
"""Bounds of E in Pa. The table has 8.6 kPa to 1143 GPa. An E in GPa by mistake is below the bounds."""
LEAST_SPREAD = 1e-6
"""Least relative spread of E: no E is known better. A spread in GPa by mistake, 5 beside 207e9 Pa, is smaller."""

NUMBERS = {
    "E": f"a number of Pa from {SOFTEST:g} to {STIFFEST:g} (210 GPa is 210e9)",
    "nu": "a number above -1 and at most 0.5",
    "E_spread": f"0 or a number of Pa from {LEAST_SPREAD:g} E to E (5 GPa is 5e9), one standard deviation",
    "nu_spread": "a number from 0 to 0.5, one standard deviation",
}
"""Keys that a section must have -> the allowed values, in words."""
STRENGTHS = ("yield_strength", "hardness", "fracture_strength", "interface_strength")
"""Strengths that a section may have, each with its spread: NAME and NAME_spread, Pa."""
WEAKEST, STRONGEST = 1e3, 2e11
"""Bounds of a strength in Pa: gels break at some kPa, the hardness of diamond is some 0.1 TPa."""
_STRENGTH = dict.fromkeys(STRENGTHS, f"a number of Pa from {WEAKEST:g} to {STRONGEST:g} (1 GPa is 1e9)")
_STRENGTH |= {f"{name}_spread": "0 or less than the strength, one standard deviation in Pa" for name in STRENGTHS}
OTHERS = {"condition": "a text", "source": "a text", "also": "a list of texts", "checked": "true or false"}
OTHERS |= _STRENGTH | {"strength_source": "a text"}
"""Keys that a section may have -> the allowed values, in words."""


@dataclass(frozen=True)
class Material:
    """An isotropic elastic material. Materials that `get` and `read` return have passed their checks.

    Attributes
    ----------
    name : as in the table
    E, nu : Young's modulus, Pa, and Poisson's ratio
    E_spread, nu_spread : one standard deviation of each, Pa and 1, among the pieces that bear the name
    yield_strength, hardness : Pa; None: not known. The hardness is a mean pressure, on the projected area
    fracture_strength : of a coating, the tensile stress at which it cracks, Pa; None: not known
    interface_strength : of a coating, the stress at which it detaches from the substrate that the source names, Pa;
        None: not known
    yield_strength_spread, hardness_spread, fracture_strength_spread, interface_strength_spread : one standard deviation
        of each of these, Pa
    strength_source : of the strengths
    condition : for which material and state the values hold, and what they depend on
    source : of the values
    also : other names
    checked : whether both numbers were read in the source; if not, the source says which were not

    Examples
    --------
    >>> steel = Material("my steel", E=210e9, nu=0.3, E_spread=5e9, nu_spread=0.01)
    >>> print(f"{steel.reduced_modulus / 1e9:.1f} ± {steel.reduced_modulus_spread / 1e9:.1f} GPa")
    230.8 ± 5.7 GPa
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
    yield_strength: float | None = None
    yield_strength_spread: float = 0.0
    hardness: float | None = None
    hardness_spread: float = 0.0
    fracture_strength: float | None = None
    fracture_strength_spread: float = 0.0
    interface_strength: float | None = None
    interface_strength_spread: float = 0.0
    strength_source: str = ""

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

    Examples
    --------
    >>> import pathlib, tempfile
    >>> lines = ['["my steel"]', "E = 210e9", "nu = 0.3", "E_spread = 5e9", "nu_spread = 0.01"]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder, "mine.toml")
    ...     _ = file.write_text("\\n".join(lines))
    ...     materials = read(file)
    >>> materials["my steel"].nu
    0.3
    """
    path = Path(path)
    try:
        sections = tomllib.loads(content(path, LARGEST).decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n"))
    except UnicodeDecodeError as error:
        raise ValueError(f"{path.name} is not UTF-8 (byte {error.start}): save it with the encoding UTF-8") from None
    except (NoFile, TooLarge) as error:
        raise ValueError(f"{path.name} {error}") from None
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path.name} is not a TOML file: {error}") from None
    return of_sections(sections, path.name)


def of_sections(sections: dict, file: str) -> dict[str, Material]:
    """The materials of the sections of a file. Raises ValueError with every complaint, a line each."""
    errors = [f"{file}: [{written(name)}] {error}" for name, section in sections.items() for error in _errors(section)]
    if errors:
        raise ValueError("\n".join(errors))
    materials: dict[str, Material] = {}
    owners: dict[str, str] = {}
    for name, section in sections.items():
        numbers = {key: float(section[key]) for key in (*NUMBERS, *_STRENGTH) if key in section}
        materials[name] = Material(name, **(section | numbers | {"also": tuple(section.get("also", ()))}))
        for word in (name, *materials[name].also):
            first = owners.setdefault(plainly(word), name)
            if first != name:
                errors.append(f"{file}: [{written(name)}] is called {written(word)}, and so is [{written(first)}]")
    if errors:
        raise ValueError("\n".join(errors))
    return materials


def _errors(section) -> list[str]:
    """The errors of a section of the file."""
    if not isinstance(section, dict):
        return [f"= {written(section)}: must be a section with the keys {', '.join(NUMBERS)}"]
    allowed = NUMBERS | OTHERS
    errors = [f"{written(key)} is not a key; known: {', '.join(allowed)}" for key in section if key not in allowed]
    errors += [f"{key} is missing: must be {words}" for key, words in NUMBERS.items() if key not in section]
    modulus = section.get("E")
    for key in allowed:
        if key in section and not _is_allowed(key, section[key], modulus):
            errors.append(f"{key} = {written(section[key])}: must be {allowed[key]}")
    for name in STRENGTHS:
        strength, spread = section.get(name), section.get(f"{name}_spread")
        if (strength is None) != (spread is None):
            errors.append(f"{name} and {name}_spread go together: one of them is missing")
        elif strength is not None and _is_number(strength) and _is_number(spread) and spread >= strength:
            errors.append(f"{name}_spread = {written(spread)}: must be {allowed[f'{name}_spread']}")
    return errors


def _is_number(value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_allowed(key: str, value, modulus=None) -> bool:
    if key == "also":
        return isinstance(value, list) and all(isinstance(word, str) for word in value)
    if key in OTHERS and key not in _STRENGTH:
        return isinstance(value, bool if key == "checked" else str)
    if not _is_number(value):
        return False
    if key in STRENGTHS:
        return WEAKEST <= value <= STRONGEST
    if key in _STRENGTH:
        return value >= 0
    if key == "E_spread":  # it is not compared with an E that is wrong itself
        return value == 0 or value > 0 and (not _is_allowed("E", modulus) or LEAST_SPREAD * modulus <= value < modulus)
    return {"E": SOFTEST <= value <= STIFFEST, "nu": -1 < value <= 0.5, "nu_spread": 0 <= value <= 0.5}[key]


def plainly(name) -> str:
    """A name in lower case, with single spaces for hyphens and underscores."""
    return " ".join(str(name).casefold().replace("-", " ").replace("_", " ").split())


def written(value) -> str:
    return f"{value:g}" if isinstance(value, float) else shown(value)
