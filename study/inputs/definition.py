"""Study files: TOML text -> a checked, frozen Definition with the digest of what determines its numbers."""

import re
import tomllib
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ..specimen.foreign import plain
from ..terminal import counted, on_one_line, shown
from .given import MOST_MESSAGES, Draft
from .grid import MOVED, Grid, usual_block
from .identity import digest_of, law_versions
from .toml_text import hint, text_in
from .vocabulary import NUMERICS, absent, finite, names, suggest

POINTS = 33  # of a profile, when a study does not say it
LARGE = 500_000_000  # numbers in one results file, 4 GB: a larger grid may be a mistake, so `run` wants --yes
MOST_VALUES = 5_000_000_000  # 40 GB: no larger grid is allowed, it can be cut into several studies
TOO_MANY_DIGITS = "a whole number has more than 4300 digits"
DTYPES = ("float64", "float32")
KEYS = {"numerics": (*NUMERICS, "block"), "output": ("x", "profiles", "dtype", "spreads"), "model": None, "axes": None}
"""Section of a study file -> the keys that it may have; None: its keys are names of parameters."""
PER_CASE = 16  # about how many numbers a case has besides the profiles
SECTIONS = ("title", "kind", "model", "axes", "cases", "sample", "numerics", "output")


class StudyError(ValueError):
    """Input that cannot be used; `messages` has every reason, one line each.

    code : exit code of a command; 1 where the input is right, and what it leads to is wrong
    """

    def __init__(self, messages, code: int = 2):
        self.messages, self.code = tuple(messages), code
        super().__init__("\n".join(self.messages))


@dataclass(frozen=True, eq=False)
class Definition:
    """What a study computes.

    text : the study file as it was read; goes into the dataset
    x : (m,) points r/a of the profiles
    profiles : names of the profiles that are stored
    dtype : "float64" or "float32", of the stored numbers
    block : number of cases computed and stored at a time
    digest : sha256 of all that determines the numbers
    laws : "NAME VERSION" of each micro law that is not of this package, as it was when the digest was made
    scene : of a study with units, a `study.inputs.scene.scene.Scene`; its grid is dimensionless, its results are in SI
    """

    name: str
    title: str
    text: str
    grid: Grid
    x: np.ndarray
    profiles: tuple[str, ...]
    dtype: str
    block: int
    digest: str
    laws: tuple[str, ...] = ()
    scene: Any = None

    def __repr__(self) -> str:
        return f'Definition("{self.name}", {self.cases})'

    @property
    def cases(self) -> str:
        """Number of cases and axes in words: "12 cases (h 2 x P 6)", "60 cases (h 2 x P 6, each 5 times for ±)"."""
        dims = " x ".join(f"{name} {size}" for name, size in self.in_results(self.grid.sizes).items()) or "one case"
        moved = f", each {self.times} times for ±" if self.times > 1 else ""
        return f"{counted(self.grid.size, 'case')} ({dims}{moved})"

    @property
    def times(self) -> int:
        """How often a case of the results is solved: once, and twice more for each of its inputs with a spread."""
        return self.grid.sizes.get(MOVED, 1)

    @property
    def numbers(self) -> int:
        """How many numbers the results hold, roughly."""
        return self.grid.size * (PER_CASE + len(self.x) * len(self.profiles))

    def in_results(self, of_dims: dict) -> dict:
        """A dictionary of the dimensions of the grid, with the names that the results give these, and without MOVED."""
        names = self.scene.dims if self.scene else {}
        return {names.get(dim, dim): value for dim, value in of_dims.items() if dim != MOVED}


def parsed(path) -> tuple[dict, str, str, str]:
    """The tables of a study file, its name, its text, and the path that begins every message.

    Raises StudyError when the file cannot be read or is not TOML.
    """
    path = Path(path)
    where = path.as_posix()
    if path.suffix != ".toml" or not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,199}", path.stem):
        name = "NAME of letters without accents, digits, _, - and ., 200 at most"
        raise StudyError([f"{where}: a study file is called NAME.toml, {name}"])
    try:
        text = text_in(path)
        tables = tomllib.loads(text)
    except OSError as error:
        raise StudyError([f"{where}: cannot be read: {error.strerror}"]) from None
    except RecursionError:
        raise StudyError([f"{where}: is not valid TOML: brackets are nested too deep"]) from None
    except UnicodeDecodeError as error:
        wrong = f"is not UTF-8 (byte {error.start}): save it with the encoding UTF-8, which TOML has"
        raise StudyError([f"{where}: {wrong}"]) from None
    except ValueError as error:  # wrong TOML
        reason = TOO_MANY_DIGITS if "integer string conversion" in str(error) else on_one_line(str(error), 200)
        more = hint(text, reason) if isinstance(error, tomllib.TOMLDecodeError) else ""
        raise StudyError([f"{where}: is not valid TOML: {reason}{more}"]) from None
    return tables, path.stem, text, where


def from_tables(tables: dict, name: str, text: str, where: str) -> Definition:
    """Definition of the TOML tables of a study without units; `where` begins every message."""
    draft, given = new_draft(tables, where)
    for key, value in given["model"].items():
        draft.scalar(key, value, "[model]")
    if "cases" in tables:  # before the axes, as `case` is the first dimension wherever [[cases]] stand in the file
        draft.cases(tables["cases"])
    if "sample" in tables:
        draft.sample(tables["sample"])
    for key, value in given["axes"].items():
        draft.axis(key, value, "[axes]")
    return complete(draft, given, name, text, where)


def new_draft(tables: dict, where: str) -> tuple[Draft, dict]:
    """A draft of the section [numerics], which has the messages about unknown sections and keys, and the tables with
    all sections."""
    kind = tables.get("kind", "contact")
    if kind != "contact":
        gone = "; a micro law needs no study: call solver.fit_power_law" if kind == "micro_law" else ""
        raise StudyError([f'{where}: kind = {shown(kind)}: must be "contact", or left out{gone}'])
    draft = Draft()
    draft.errors += [
        _no_section(key, tables[key]) for key in islice((key for key in tables if key not in SECTIONS), MOST_MESSAGES)
    ]
    given = tables | {section: _table(tables, section, keys, draft.errors) for section, keys in KEYS.items()}
    for key in [key for key in NUMERICS if key in given["numerics"]]:
        draft.scalar(key, given["numerics"][key], "[numerics]")
    return draft, given


def _no_section(key: str, value: Any) -> str:
    """A message about a key at the top of the file: a parameter, say, since the line [model] is missing."""
    lacking = absent(key)
    near = f"; {lacking}" if lacking else suggest(key, SECTIONS)
    below = near.startswith("; known") and not isinstance(value, (dict, list))
    return f"{shown(key)} is not a section{near}{'; parameters stand below [model] or [axes]' * below}"


def complete(draft: Draft, tables: dict, name: str, text: str, where: str, most: float = MOST_VALUES) -> Definition:
    """The definition of a draft that has all its parameters, with its digest. Raises StudyError with every message.

    tables : title and the sections [numerics] and [output] are read here
    most : how many numbers the results may hold
    """
    errors, grid = draft.errors, draft.finish()
    title, x, profiles, dtype = settings(tables, errors)
    block = tables.get("numerics", {}).get("block", 1 if errors else usual_block(grid))
    if type(block) is not int or not 1 <= block <= 1_000_000:
        errors.append(f"[numerics] block = {shown(block)}: must be a whole number in [1, 1000000]")
    made = Definition(name, title, text, grid, x, profiles, dtype, block, "")
    if made.numbers > most:
        errors.append(
            f"{grid.size} cases make {made.numbers:.1e} numbers: at most {most:.0e} (fewer points, or profiles = false)"
        )
    if errors:
        raise refusal(where, errors)
    return replace(made, digest=digest_of(made), laws=tuple(law_versions(grid)))


def settings(tables: dict, errors: list[str]) -> tuple:
    """Title, points and names of the profiles, and type of the numbers: of the title and the section [output]."""
    title = tables.get("title", "")
    output = {"x": POINTS, "profiles": True, "dtype": DTYPES[0]} | tables.get("output", {})
    x = profile_points(output["x"], errors)
    if not isinstance(title, str):
        errors.append(f"title = {shown(title)}: must be text")
    profiles, dtype = profile_names(output["profiles"], errors), output["dtype"]
    if dtype not in DTYPES:
        errors.append(f"[output] dtype = {shown(dtype)}: must be one of " + ", ".join(f'"{d}"' for d in DTYPES))
    return title, x, profiles, dtype


def refusal(where: str, errors: list[str]) -> StudyError:
    """The error to raise for these messages. Each begins with `where`; after MOST_MESSAGES the rest is counted."""
    more = len(errors) - MOST_MESSAGES
    shortened = errors[:MOST_MESSAGES] + ([f"and {more} more mistakes"] if more > 0 else [])
    return StudyError(f"{where}: {message}" for message in shortened)


def profile_names(profiles, errors: list[str]) -> tuple[str, ...]:
    """Names of the profiles to store, from true, false or their list; in the order of the vocabulary."""
    known, profiles = names("profile"), plain(profiles)
    if isinstance(profiles, bool):
        return known if profiles else ()
    if not isinstance(profiles, (list, tuple)) or not set(map(str, profiles)) <= set(known):
        listed = ", ".join(f'"{name}"' for name in known)
        errors.append(f"profiles = {shown(profiles)}: must be true or false, or a list of {listed}")
        return ()
    return tuple(name for name in known if name in profiles)


def profile_points(x, errors: list[str]) -> np.ndarray:
    """Points r/a from their number or their list: increasing from 0 to 1."""
    points = plain(x)
    points = points.values.tolist() if hasattr(points, "dims") else points
    if type(points) is int and 2 <= points <= 10_000:
        return np.linspace(0.0, 1.0, points)
    if not isinstance(points, (list, tuple, range)) or not all(map(finite, points)):
        errors.append(f"x = {shown(x)}: must be a whole number in [2, 10000] or a list of numbers from 0 to 1")
        return np.array([])
    found = np.array(points, dtype=float)
    if len(found) < 2 or found[0] != 0 or found[-1] != 1 or (np.diff(found) <= 0).any():
        errors.append(f"x = {shown(points)}: a list must increase from 0 to 1, both included")
    return found


def _table(tables: dict, section: str, known: tuple[str, ...] | None, errors: list[str]) -> dict:
    """A section of the file, {} when absent; messages for keys that are not `known` (None: the caller checks them)."""
    found = tables.get(section, {})
    if not isinstance(found, dict):
        errors.append(f"{section} = {shown(found)}: must be a table [{section}]")
        return {}
    unknown = [key for key in found if known and key not in known]
    errors += [f"[{section}] {shown(key)} is not known{suggest(key, known)}" for key in unknown[:MOST_MESSAGES]]
    return found
