"""From a study file, or the parameters of a call, to a checked, frozen Definition.

Numbers have units, `R = "5 mm"`, `h = ["2 um", "20 um"]`, `P = { start = "1 mN", ... }`, or none. Inputs may have
spreads ("200 ± 10 GPa", materials by name). Then results have derivatives by the inputs of the solver, and from these
follows `NAME_spread`.
"""

import errno
import math
import re
import tomllib
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

from solver.numerics.userfile import NoFile, opened

from ..terminal import on_one_line, shown
from .definition import LARGE, MOST_VALUES, Definition, StudyError, refusal, settings, usual_block
from .draft import Draft
from .identity import digest_of, law_versions
from .punch import asperities, sticking
from .punch.laws import results_of
from .punch.scan_words import with_bodies
from .punch.stresses import none_in
from .request import MOST_MESSAGES, Request
from .scene.stacks import axes_in, in_layers
from .vocabulary import NUMERICS, absent, names, suggest

TOO_MANY_DIGITS = "a whole number has more than 4300 digits"
KEYS = {
    "numerics": (*NUMERICS, "block"),
    "output": ("x", "profiles", "dtype", "spreads", "stresses"),
    "model": None,
    "axes": None,
}
"""Section of a study file -> the keys that it may have; None: its keys are names of parameters."""
SECTIONS = ("title", "kind", "model", "axes", "cases", "layers", "sample", "correlations", "numerics", "output")
LARGEST_FILE = 32_000_000  # bytes: a million values of an axis are 20 MB
MOST_TABLES = 100_000  # tables such as [[cases]]: tomllib and the checks take some 50 µs for each
MOST_PARTS = 50  # of a dotted key; tomllib needs memory by the square of their number, 2.4 GB for 20,000
_PART = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
LONG_KEY = re.compile(rf"(?<![A-Za-z0-9_-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{MOST_PARTS}}}")
TABLE = re.compile(r"^[ \t]*+\[\[|\{", re.MULTILINE)

#: A value that begins with a word or ±, or with a number and then a word or ±. The e of "1e-6" is no word.
_NO_QUOTES = re.compile(r"=[\s\[{]*+(?:[-+.\d][-+.\deE_]*+\s*+)?(?:[^\W\d_]|±)")


def read(path) -> Definition:
    """Definition of a study file. Raises StudyError with all that is wrong with it."""
    return from_tables(*parsed(path))


def from_tables(tables: dict, name: str, text: str, where: str) -> Definition:
    """Definition of the parsed TOML tables; `where` begins every message."""
    kind = tables.get("kind", "contact")
    if kind != "contact":
        gone = "; a micro law needs no study: call solver.fit_power_law" if kind == "micro_law" else ""
        raise StudyError([f'{where}: kind = {shown(kind)}: must be "contact", or left out{gone}'])
    unknown = islice((key for key in tables if key not in SECTIONS), MOST_MESSAGES)
    errors = [_no_section(key, tables[key]) for key in unknown]
    tables = tables | {section: _table(tables, section, keys, errors) for section, keys in KEYS.items()}
    return complete(Request.in_file(tables, errors), tables, name, text, where)


def from_call(
    parameters: dict,
    rows: list[dict],
    same_piece: bool,
    tables: dict,
    correlations: Any = None,
    where: str = "solve",
) -> Definition:
    """Definition of a call of `study.solve`; tables : title and output, as those of a study file; `where` begins every
    message."""
    correlations = {} if correlations is None else correlations
    return complete(Request.in_python(parameters, rows, same_piece, correlations), tables, "solve", "", where, LARGE)


def complete(request: Request, tables: dict, name: str, text: str, where: str, most: float = MOST_VALUES) -> Definition:
    """The definition that a request describes, with its digest. Raises StudyError with every message.

    tables : title, [output], the block of [numerics] and the order of [axes] are read from these
    most : how many numbers the results may hold
    """
    draft, errors, scene = Draft(request), request.errors, None
    draft.expand()
    spreads = tables.get("output", {}).get("spreads", True)
    if not isinstance(spreads, bool):
        errors.append(f"[output] spreads = {shown(spreads)}: must be true or false")
    if request.physical:
        # imported here, since they load xarray, which pure numbers do not need
        from .scene.changes import inputs_of
        from .scene.physical_inputs import read as read_scene

        scene = read_scene(request, draft, spreads is True, axes_in(tables))
    else:
        for entry in request.inputs.values():
            if not entry.is_wrong:
                draft.read(entry)
        draft.check({})
    draft.put_dimensions()
    grid = draft.finish()
    grid, scans = (grid, ()) if errors else with_bodies(grid, scene, errors)
    errors += [] if errors else sticking.rough_and_sticking(grid, scene and scene.unit)
    inputs = () if errors or scene is None or not scene.spreads else inputs_of(scene, grid)
    title, x, profiles, dtype, stresses = settings(tables, errors)
    if stresses and not errors and (reason := none_in(grid)):
        errors.append(f"[output] stresses = true: {reason}")
    block = tables.get("numerics", {}).get("block", 1 if errors else usual_block(grid))
    if type(block) is not int or not 1 <= block <= 1_000_000:
        errors.append(f"[numerics] block = {shown(block)}: must be a whole number in [1, 1000000]")
    some_feel = not errors and bool(asperities.felt(grid).any())
    micro = grid.values["micro"][1] if "micro" in grid.values else ()
    results = results_of(grid.lexicon.known.laws, micro, "w_adhesion" in grid.values, some_feel)
    stresses += names("spot_stress") if stresses and some_feel else ()
    definition = Definition(
        *(name, title, text, grid, x, profiles, dtype, block, ""),
        scene=scene,
        results=results,
        inputs=inputs,
        stresses=stresses,
        says_what_is_felt=not errors and asperities.is_said(grid),
        scans=scans,
    )
    if (numbers := definition.numbers) > most:
        limit = f"at most {most:.0e} (fewer points, or profiles = false)"
        errors.append(f"{grid.size} cases make {numbers:.1e} numbers: {limit}")
    if errors:
        raise refusal(where, in_layers(errors, request.sections))
    return replace(definition, digest=digest_of(definition), laws=tuple(law_versions(grid)))


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


def _no_section(key: str, value: Any) -> str:
    """A message about a key at the top of the file: a parameter, say, since the line [model] is missing."""
    lacking = absent(key)
    near = f"; {lacking}" if lacking else suggest(key, SECTIONS)
    below = near.startswith("; known") and not isinstance(value, (dict, list))
    return f"{shown(key)} is not a section{near}{'; parameters stand below [model] or [axes]' * below}"


def _table(tables: dict, section: str, keys: tuple[str, ...] | None, errors: list[str]) -> dict:
    """A section of the file, {} when absent; messages for keys other than `keys` (None: any)."""
    table = tables.get(section, {})
    if not isinstance(table, dict):
        errors.append(f"{section} = {shown(table)}: must be a table [{section}]")
        return {}
    unknown = [key for key in table if keys and key not in keys]
    errors += [f"[{section}] {shown(key)} is not known{suggest(key, keys)}" for key in unknown[:MOST_MESSAGES]]
    return table


def text_in(path: Path) -> str:
    """The text of a study file. Raises OSError, or ValueError for wrong UTF-8 and keys of too many parts."""
    try:
        with opened(path, math.inf) as file:
            raw = file.read(LARGEST_FILE + 1)
    except NoFile:
        raise OSError(errno.EINVAL, "is no regular file") from None
    if len(raw) > LARGEST_FILE:
        raise OSError(errno.EFBIG, f"is larger than {LARGEST_FILE // 1_000_000} MB; ranges and [sample] keep it small")
    text = raw.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    tables = sum(1 for _ in TABLE.finditer(text))
    if tables > MOST_TABLES:  # before tomllib reads them
        wrong = f"has {tables} tables, [[cases]] and those in braces: at most {MOST_TABLES}"
        raise OSError(errno.EFBIG, f"{wrong}; [axes] and [sample] say as many cases in a few lines")
    _check_keys(text)
    return text


def _check_keys(text: str) -> None:
    """Raise ValueError for a key of too many parts."""
    long = LONG_KEY.search(text)
    if long:
        raise ValueError(f"a key has more than {MOST_PARTS} parts (at line {text.count(chr(10), 0, long.start()) + 1})")


def same_tables(text: str, other: str) -> bool:
    """Whether the texts of two study files say the same, but for the title, comments and the order of lines."""
    try:
        _check_keys(text)
        _check_keys(other)
        return text == other or tomllib.loads(text) | {"title": ""} == tomllib.loads(other) | {"title": ""}
    except (ValueError, RecursionError):
        return False


def hint(text: str, reason: str) -> str:
    """The end of a message about wrong TOML, if the line has one of the usual mistakes; else ""."""
    if "overwrite" in reason:
        return "; a name is given twice in one section"
    place = re.search(r"at line (\d+)", reason)
    line = text.split("\n")[int(place[1]) - 1][:300] if place else ""
    if "Unclosed" in reason and len(re.findall(r"[\[{]", line or "[")) > len(re.findall(r"[\]}]", line)):
        return "; a list ends with ], a range with }"
    if re.search("[“”„‘’«»]", line):
        return '; quotes are straight: "5 mm"'
    if re.search(r"=\s*[-+]?\d+,\d", line):
        return "; a number has a decimal point"
    plain = "'" not in line and '"' not in line and _NO_QUOTES.search(line)
    return '; texts stand in quotes, a number with its unit too: "5 mm"' if plain else ""
