"""Checksums of a results file, which it carries in its attribute `checksums`: what they are of, how they compare.

The text has a line for each thing that is summed, its name and 32 hexadecimal digits:

    @NAME      a global attribute as roughcoat wrote it (all but the history, to which other programs add)
    =structure dimensions, types and attributes of all variables named here
    NAME       the numbers of a variable that is read whole, such as a coordinate
    #NAME      the numbers of a variable over the cases
    =cases     which case each row is: the keys of the cases, the points x and the version of the numerics
    =runs      for each run of consecutive cases its own 32 digits, over all the variables over the cases
    =checksums the lines above

So what is damaged can be named, and the cases that are not damaged can be told from those that are.
"""

import hashlib
import json

import numpy as np

from .access import Unusable
from .netcdf import File

ATTRIBUTE = "checksums"
NOT_SUMMED = (ATTRIBUTE, "history")
RUN = 8192  # cases of a run, at least: a damaged one is computed again as a whole
MOST_RUNS = 1024  # 32 kB of text
DIGITS = 32


def digest(*parts) -> str:
    """128 bits of sha256 over texts and arrays, as hexadecimal digits."""
    found = hashlib.sha256()
    for part in parts:
        found.update(part.encode("utf-8", "surrogatepass") if isinstance(part, str) else raw(part))
    return found.hexdigest()[:DIGITS]


def raw(array: np.ndarray):
    """The bytes of numbers in the order of a PC; texts (type object) one after another."""
    if array.dtype.kind in "OU":
        return "\0".join(map(str, array.ravel().tolist())).encode("utf-8", "surrogatepass")
    return np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<")).reshape(-1).view(np.uint8)


class Rows:
    """Digests of the variables over `size` cases, which come in pieces, from the first case to the last."""

    def __init__(self, size: int):
        self.size = size
        self.run = max(RUN, -(-size // MOST_RUNS))
        self.digests: dict[str, list[str]] = {}
        self._open: dict[str, tuple[int, hashlib._Hash]] = {}

    def add(self, name: str, piece: np.ndarray) -> None:
        """The next cases of a variable, (n, ...)."""
        done = self.digests.setdefault(name, [])
        place, found = self._open.pop(name, (0, hashlib.sha256()))
        while len(piece):
            now, piece = np.split(piece, [self.run - place % self.run])
            found.update(raw(now))
            place += len(now)
            if place % self.run == 0 or place == self.size:
                done.append(found.hexdigest()[:DIGITS])
                found = hashlib.sha256()
        self._open[name] = place, found

    def lines(self, runs: bool = True) -> dict[str, str]:
        """Those of the text: #NAME and, when all variables are there, =runs."""
        found = {f"#{name}": digest(*own) for name, own in self.digests.items()}
        if runs and found:
            found["=runs"] = "".join(digest(*all_of) for all_of in zip(*self.digests.values(), strict=True))
        return found


def split_runs(line: str) -> list[str]:
    """The digits of each run."""
    return [line[start : start + DIGITS] for start in range(0, len(line), DIGITS)]


def identity(numerics: str, x: np.ndarray, keys: np.ndarray) -> str:
    """The line `=cases`."""
    return digest(numerics, np.asarray(x, dtype=np.float64), keys)


def head(file: File, whole: list[str], over: list[str], attributes: list[str]) -> dict[str, str]:
    """The lines of the attributes, the structure and the variables read `whole`; "lost" for what cannot be read."""

    def line(make, *arguments) -> str:
        try:
            return digest(make(*arguments))
        except (Unusable, RuntimeError, AttributeError, IndexError, UnicodeDecodeError):
            return "lost"

    found = {f"@{name}": line(lambda name: str(file.attribute(name)), name) for name in attributes}
    found["=structure"] = line(structure, file, [*whole, *over])
    return found | {name: line(lambda name: file.read(name, characters=True), name) for name in whole}


def structure(file: File, names: list[str]) -> str:
    """Dimensions, types and attributes of the variables `names`, as JSON."""
    found, sizes, dims = {}, file.sizes, file.variables
    for name in names:
        kind = "str" if file.dtype(name) is str else file.dtype(name).str
        attributes = {key: plain(file.attribute(key, name)) for key in file.attributes(name)}
        found[name] = [kind, dims[name], [sizes[dim] for dim in dims[name]], attributes]
    return json.dumps(found, sort_keys=True)


def plain(value) -> list:
    """The type and the values of an attribute, as JSON has them; NaN as text."""
    array = np.atleast_1d(value)
    return [array.dtype.kind, [repr(one) if array.dtype.kind == "f" else one for one in array.tolist()]]


def text(lines: dict[str, str]) -> str:
    """The attribute."""
    found = "".join(f"{name} {digits}\n" for name, digits in lines.items())
    return found + f"=checksums {digest(found)}\n"


def parsed(given: str) -> dict[str, str]:
    """The lines of the attribute, however damaged; `=checksums` is "right" or "wrong"."""
    found = dict(line.rpartition(" ")[::2] for line in given.split("\n") if " " in line)
    right = given[: given.rfind("=checksums ")]
    return found | {"=checksums": "right" if found.get("=checksums") == digest(right) else "wrong"}
