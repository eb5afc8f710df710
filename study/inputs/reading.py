"""Study files: from TOML text to a checked, frozen Definition."""

import errno
import math
import re
import tomllib
from itertools import islice
from pathlib import Path
from typing import Any

from solver.numerics.userfile import NoFile, in_folder_of, opened

from ..terminal import on_one_line, shown
from .definition import Definition, StudyError, definition_of
from .request import MOST_MESSAGES, Request
from .vocabulary import NUMERICS, absent, suggest

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
    """Definition of a study file, in whose folder the files that it names are looked for first. Raises StudyError with
    all its mistakes."""
    with in_folder_of(path):
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
    return definition_of(Request.in_file(tables, errors), tables, name, text, where)


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
        wrong = f"is not UTF-8 (byte {error.start}): save it with the encoding UTF-8, which TOML requires"
        raise StudyError([f"{where}: {wrong}"]) from None
    except ValueError as error:  # wrong TOML
        reason = TOO_MANY_DIGITS if "integer string conversion" in str(error) else on_one_line(str(error), 200)
        more = hint(text, reason) if isinstance(error, tomllib.TOMLDecodeError) else ""
        raise StudyError([f"{where}: is not valid TOML: {reason}{more}"]) from None
    return tables, path.stem, text, where


def _no_section(key: str, value: Any) -> str:
    """A message about a key at the top of the file, such as a parameter if the line [model] is missing."""
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
        raise OSError(errno.EINVAL, "is not a regular file") from None
    if len(raw) > LARGEST_FILE:
        raise OSError(errno.EFBIG, f"is larger than {LARGEST_FILE // 1_000_000} MB; ranges and [sample] keep it small")
    text = raw.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    tables = sum(1 for _ in TABLE.finditer(text))
    if tables > MOST_TABLES:  # before tomllib reads them
        wrong = f"has {tables} tables, [[cases]] and those in braces: at most {MOST_TABLES}"
        raise OSError(errno.EFBIG, f"{wrong}; [axes] and [sample] describe as many cases in a few lines")
    _check_keys(text)
    return text


def _check_keys(text: str) -> None:
    """Raise ValueError for a key of too many parts."""
    long = LONG_KEY.search(text)
    if long:
        raise ValueError(f"a key has more than {MOST_PARTS} parts (at line {text.count(chr(10), 0, long.start()) + 1})")


def same_tables(text: str, other: str) -> bool:
    """Whether the texts of two study files say the same, except for the title, comments and the order of lines."""
    try:
        _check_keys(text)
        _check_keys(other)
        return text == other or tomllib.loads(text) | {"title": ""} == tomllib.loads(other) | {"title": ""}
    except (ValueError, RecursionError):
        return False


def hint(text: str, reason: str) -> str:
    """The end of a message about wrong TOML, if the line has one of the usual mistakes; otherwise ""."""
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
