"""The text of a study file. Files that would exhaust the memory while tomllib reads them are refused."""

import errno
import re
import tomllib
from pathlib import Path

LARGEST_FILE = 32_000_000  # bytes: a million values of an axis are 20 MB
MOST_TABLES = 100_000  # tables such as [[cases]]: tomllib and the checks take some 50 µs for each
MOST_PARTS = 50  # of a dotted key; tomllib needs memory by the square of their number, 2.4 GB for 20,000
_PART = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
LONG_KEY = re.compile(rf"(?<![A-Za-z0-9_-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{MOST_PARTS}}}")
TABLE = re.compile(r"^[ \t]*+\[\[|\{", re.MULTILINE)

#: A value that begins with a word, or with a number and a word or ±; the e of "1e-6" is none.
_NO_QUOTES = re.compile(r"=[\s\[{]*+(?:[-+.\d][-+.\deE_]*+\s*+)?(?:[^\W\d_]|±)")


def text_in(path: Path) -> str:
    """The text of a study file. Raises OSError, or ValueError for wrong UTF-8 and for keys of too many parts."""
    if path.exists() and not path.is_file() and not path.is_dir():  # opening a folder has a message of its own
        raise OSError(errno.EINVAL, "is no regular file")
    with open(path, "rb") as file:
        raw = file.read(LARGEST_FILE + 1)
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


def same_tables(one: str, other: str) -> bool:
    """Whether the texts of two study files say the same, but for the title, comments and the order of lines."""
    try:
        _check_keys(one)
        _check_keys(other)
        return one == other or tomllib.loads(one) | {"title": ""} == tomllib.loads(other) | {"title": ""}
    except (ValueError, RecursionError):
        return False


def hint(text: str, reason: str) -> str:
    """The end of a message about a line of TOML that has a usual mistake; "" for another."""
    if "overwrite" in reason:
        return "; a name is given twice in one section"
    place = re.search(r"at line (\d+)", reason)
    line = text.split("\n")[int(place[1]) - 1][:300] if place else ""
    if re.search("[“”„‘’«»]", line):
        return '; quotes are straight: "5 mm"'
    if re.search(r"=\s*[-+]?\d+,\d", line):
        return "; a number has a decimal point"
    plain = "'" not in line and '"' not in line and _NO_QUOTES.search(line)
    return '; texts stand in quotes, a number with its unit too: "5 mm"' if plain else ""
