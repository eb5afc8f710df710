"""Which tests `make test` leaves to `make verify`: the list tests/verify.txt."""

import zlib
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path

LIST = Path(__file__).resolve().parents[1] / "verify.txt"


@cache
def patterns() -> list[tuple[int, str]]:
    """N and the pattern of each line of the list: of the tests that match one in N stays, of 0 none."""
    lines = [line.split(maxsplit=1) for line in LIST.read_text(encoding="utf-8").splitlines()]
    return [(int(words[0]), words[1]) for words in lines if words and words[0] != "#"]


def left_out(node: str) -> bool:
    """Whether a test, by the name that pytest gives it, is left to `make verify`."""
    name = node.removeprefix("tests/")
    chance = zlib.crc32(name.encode())
    return any(fnmatchcase(name, pattern) and (n == 0 or chance % n) for n, pattern in patterns())
