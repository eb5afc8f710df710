"""Checksums of a results file, which it carries in its attribute `checksums`.

The attribute is a text. Each line has a name and the 32 hexadecimal digits of a checksum:

    @NAME      a global attribute as roughcoat wrote it (all but the history, to which other programs add)
    =structure dimensions, types and attributes of all variables named here
    NAME       the numbers of a variable that is read whole, such as a coordinate
    #NAME      the numbers of a variable over the cases
    =cases     which case each row is: the keys of the cases, the points x and the version of the numerics
    =runs      for each run of consecutive cases its own 32 digits, over all the variables over the cases
    =checksums the lines above

So a message can name what is damaged, and the undamaged cases can still be used.
"""

import hashlib
import json

import numpy as np

from .access import Unusable
from .netcdf import File

ATTRIBUTE = "checksums"
NOT_SUMMED = (ATTRIBUTE, "history")
RUN = 8192  # fewest cases of a run; all cases of a damaged run are computed again
MOST_RUNS = 1024  # so that the text has at most 32 kB
DIGITS = 32


def digest(*parts) -> str:
    """The first 128 bits of sha256 over texts and arrays, as hexadecimal digits."""
    found = hashlib.sha256()
    for part in parts:
        found.update(part.encode("utf-8", "surrogatepass") if isinstance(part, str) else as_bytes(part))
    return found.hexdigest()[:DIGITS]


def as_bytes(array: np.ndarray):
    """The bytes of an array: numbers in little-endian order, texts separated by null characters."""
    if array.dtype.kind in "OU":
        return "\0".join(map(str, array.ravel().tolist())).encode("utf-8", "surrogatepass")
    return np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<")).reshape(-1).view(np.uint8)


class CaseDigests:
    """Digests of variables over `size` cases. A variable is added piece by piece, from the first case to the last.

    digests : name -> a digest for each run of `run` cases
    """

    def __init__(self, size: int):
        self.size = size
        self.run = max(RUN, -(-size // MOST_RUNS))
        self.digests: dict[str, list[str]] = {}
        self._open: dict[str, tuple[int, hashlib._Hash]] = {}

    def add(self, name: str, piece: np.ndarray) -> None:
        """Add the next cases of a variable, (n, ...)."""
        done = self.digests.setdefault(name, [])
        place, found = self._open.pop(name, (0, hashlib.sha256()))
        while len(piece):
            now, piece = np.split(piece, [self.run - place % self.run])
            found.update(as_bytes(now))
            place += len(now)
            if place % self.run == 0 or place == self.size:
                done.append(found.hexdigest()[:DIGITS])
                found = hashlib.sha256()
        self._open[name] = place, found

    def lines(self, runs: bool = True) -> dict[str, str]:
        """The lines #NAME and, if `runs`, =runs, for which all variables must have been added."""
        found = {f"#{name}": digest(*own) for name, own in self.digests.items()}
        if runs and found:
            found["=runs"] = "".join(digest(*all_of) for all_of in zip(*self.digests.values(), strict=True))
        return found


def digest_of_cases(numerics: str, x: np.ndarray, keys: np.ndarray) -> str:
    """The line `=cases`."""
    return digest(numerics, np.asarray(x, dtype=np.float64), keys)


def lines_of_head(file: File, whole: list[str], over: list[str], attributes: list[str]) -> dict[str, str]:
    """All lines but those of the cases; "lost" for what cannot be read.

    whole : variables that are read whole; over : those over the cases; attributes : of the file
    """

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
        attributes = {key: type_and_values(file.attribute(key, name)) for key in file.attributes(name)}
        found[name] = [kind, dims[name], [sizes[dim] for dim in dims[name]], attributes]
    return json.dumps(found, sort_keys=True)


def type_and_values(value) -> list:
    """The type and the values of an attribute for JSON, which has no NaN: floats are texts."""
    array = np.atleast_1d(value)
    return [array.dtype.kind, [repr(one) if array.dtype.kind == "f" else one for one in array.tolist()]]


def as_text(lines: dict[str, str]) -> str:
    """The attribute, with the line =checksums at its end."""
    found = "".join(f"{name} {digits}\n" for name, digits in lines.items())
    return found + f"=checksums {digest(found)}\n"


def parsed(given: str) -> dict[str, str]:
    """The lines of the attribute. The value of `=checksums` is "right", or "wrong" if the attribute is damaged."""
    found = dict(line.rpartition(" ")[::2] for line in given.split("\n") if " " in line)
    right = given[: given.rfind("=checksums ")]
    return found | {"=checksums": "right" if found.get("=checksums") == digest(right) else "wrong"}
