"""The condition of a results file: sound, damaged, of an earlier version, of another program.

A results file is an export of the blocks of a study. Its attribute `contents_digest` is one digest over names,
dimensions, types, numbers, coordinates and attributes. So the file is right as a whole or not at all.
"""

import hashlib
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import inf
from pathlib import Path

import numpy as np

from ..data.provenance import OF_THE_RUN
from ..inputs.grid import Grid, windows
from ..terminal import memory_message, short_of_memory
from .access import Unusable, are_whole
from .netcdf import File, check_regular
from .seal import is_whole

ATTRIBUTE = "contents_digest"
FORMER = "checksums"  # the attribute that an earlier version wrote in place of the digest
CHUNK = 8192  # cases in a chunk of the file: 2 MB of a profile
BROKEN = (KeyError, IndexError, ValueError, TypeError, AttributeError, OverflowError)
"""Exceptions while reading a file that is not laid out like our results."""
OURS = ("study_digest", "numerics_version")
"""Attributes that every results file has, and by which it is recognised."""
PACKED = 10_000  # largest plausible ratio of a dataset's bytes in memory to those of its file; ours reaches a hundred
CHANGED = "is damaged, or another program has changed it: its numbers are not those that were written"


@dataclass(frozen=True, eq=False)
class Identity:
    """The properties by which a file proves to be that of certain cases of a study.

    digest : of the study
    coordinates : dimension of the cases -> its values
    attributes : further attributes; the file may lack one, and must not have another value of it
    """

    digest: str
    coordinates: dict[str, np.ndarray]
    attributes: dict[str, object] = field(default_factory=dict)

    def differs(self, condition: "Condition", file: File) -> str:
        """Why an undamaged file is not that of these cases; "" if it is."""
        if condition.digest != self.digest:
            return "its results are of another definition or version of the numerics"
        if list(condition.sizes) != list(self.coordinates):
            return f"its dimensions are {list(condition.sizes)}, not {list(self.coordinates)}"
        for dim, values in self.coordinates.items():
            if dim not in file.variables or not _same(file.read(dim), values):
                return f"its values of {dim} are not those of these cases"
        of_file = {name: file.attributes.get(name) for name in self.attributes}
        wrong = [name for name, value in of_file.items() if value is not None and value != self.attributes[name]]
        return f"its {wrong[0]} is {of_file[wrong[0]]}, not {self.attributes[wrong[0]]}" if wrong else ""


def _same(array: np.ndarray, values: np.ndarray) -> bool:
    texts = {array.dtype.kind, values.dtype.kind} & {*"OUS"}
    return np.array_equal(array.astype(str), values.astype(str)) if texts else np.array_equal(array, values)


@dataclass(frozen=True, eq=False)
class Condition:
    """The condition of a results file.

    kind : "sound"; "unverified": it seems right, but has no digest, since an earlier version or another program wrote
        it; "damaged"; "foreign": not written by roughcoat; "misplaced": it has other cases than the wanted ones;
        "unreadable"; "missing"
    reason : the fault; it follows the path in a message
    digest, numerics : of the study, and version of the solver's numerics, as the file says; "" where it does not
    title, text, command, name : title of the study, text of its file, command that ran it, and its name
    sizes : of the dimensions of the cases, in order; {} for a file without cases
    seen : `stamp` of the file before it was examined, None where there was no file
    unpacked : bytes of the variables in memory
    """

    path: Path
    kind: str
    reason: str = ""
    digest: str = ""
    numerics: str = ""
    title: str = ""
    text: str = ""
    command: str = ""
    name: str = ""
    sizes: dict[str, int] = field(default_factory=dict)
    seen: tuple | None = None
    unpacked: int = 0

    @property
    def good(self) -> bool:
        return self.kind in ("sound", "unverified")

    def raise_if_bad(self) -> None:
        """Raise FileNotFoundError or Unusable unless the file can be used."""
        if self.kind == "missing":
            raise FileNotFoundError(2, "No such file", os.fspath(self.path))
        if not self.good:
            raise Unusable(self.path, self.kind, self.reason)


def examine(path, identity: Identity | None = None, most: float = inf) -> Condition:
    """The condition of a results file. All of it is read, and compared with its digest.

    identity : of the cases that the file must hold; with other cases it is "misplaced"
    most : if the file has more bytes in memory, only its attributes are read
    """
    path = Path(path)
    seen = stamp(path)
    state = Condition(path, "damaged", "is damaged: its bytes are not those that were written")
    try:
        check_regular(path)
        if path.stat().st_size > most or is_whole(path) is not False:
            with File(path) as file:
                state = _described(file)
                if state.kind == "sound" and state.unpacked <= most and contents(file) != file.attributes[ATTRIBUTE]:
                    state = replace(state, kind="damaged", reason=CHANGED)
                if state.good and identity and (reason := identity.differs(state, file)):
                    state = replace(state, kind="misplaced", reason=reason)
    except FileNotFoundError:
        state = Condition(path, "missing")
    except Unusable as error:
        state = replace(state, kind=error.kind, reason=error.reason)
    except OSError as error:
        if short_of_memory(error):
            raise
        state = Condition(path, "unreadable", f"cannot be read: {error.strerror}")
    except MemoryError as error:
        if are_whole(path) and state.unpacked < PACKED * path.stat().st_size:
            raise
        # a file that is not ours, or a damaged one, may say that it has terabytes
        state = Condition(path, "unreadable", f"cannot be read: {memory_message(error)}")
    except BROKEN as error:
        state = replace(state, kind="damaged", reason=f"is damaged: results do not have this layout ({error})")
    return replace(state, seen=seen)


def stamp(path: Path) -> tuple | None:
    """Numbers that change when a file is replaced or written to; None when there is no file."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_size, status.st_mtime_ns


def statuses(path: Path) -> np.ndarray:
    """The statuses in a results file of a contact study, an array over its grid."""
    with File(path) as file:
        return file.read("status")


def _described(file: File) -> Condition:
    """The condition of a file by its attributes."""
    attributes, variables = file.attributes, file.variables
    unpacked = sum(variable.unpacked for variable in variables.values())
    if not {*OURS} & {*attributes}:
        return Condition(file.path, "foreign", "is a netCDF file of another program", unpacked=unpacked)
    about = [str(attributes.get(name, "")) for name in (*OURS, "title", "study", "command", "study_name")]
    status = variables.get("status")
    of_cases = dict(zip(status.dims, status.shape, strict=True)) if status else {}
    kind = "sound" if ATTRIBUTE in attributes else "unverified"
    return Condition(file.path, kind, "", *about, of_cases, unpacked=unpacked)


class Sums:
    """Running checksums of the variables of a file while they are written or read from beginning to end."""

    def __init__(self):
        self._sums: dict[str, hashlib._Hash] = {}

    def add(self, name: str, piece: np.ndarray) -> None:
        """Add the next numbers of a variable."""
        if name not in self._sums:
            self._sums[name] = hashlib.sha256()
        self._sums[name].update(_as_bytes(piece))

    def digest(self, file: File) -> str:
        """The digest of a file whose variables have all been added."""
        sums = {name: total.hexdigest() for name, total in sorted(self._sums.items())}
        return hashlib.sha256(json.dumps([_head(file), sums], sort_keys=True).encode()).hexdigest()


def contents(file: File) -> str:
    """The digest of the whole content of an open file, which is read part by part."""
    sums = Sums()
    for name, variable in file.variables.items():
        for window in _pieces(dict(zip(variable.dims, variable.shape, strict=True))):
            sums.add(name, file.read(name, window, characters=True))
    return sums.digest(file)


def _pieces(sizes: dict[str, int]) -> Iterator[dict[str, slice]]:
    """Consecutive windows that make up a variable of these dimensions; each consists of whole chunks."""
    of_cases = Grid({dim: size for dim, size in sizes.items() if dim != "x"}, {})
    return windows(of_cases, 8 * CHUNK, CHUNK) if 0 not in sizes.values() else iter([{}])


def _head(file: File) -> list:
    """Types, dimensions and attributes of all variables, and attributes of the file except those of the run."""
    described = {}
    for name, (kind, dims, shape, attributes) in file.variables.items():
        typed = {key: _typed(value) for key, value in attributes.items()}
        described[name] = ["str" if kind is str else kind.str, dims, shape, typed]
    left_out = (ATTRIBUTE, *OF_THE_RUN)
    return [described, {key: _typed(value) for key, value in file.attributes.items() if key not in left_out}]


def _typed(value) -> list:
    """The type and the values of an attribute for JSON, which has no NaN: floats are texts."""
    array = np.atleast_1d(value)
    return [array.dtype.kind, [repr(part) if array.dtype.kind == "f" else part for part in array.tolist()]]


def _as_bytes(array: np.ndarray):
    """The bytes of an array: numbers in little-endian order, texts separated by null characters."""
    if array.dtype.kind in "OU":
        return "\0".join(map(str, array.ravel().tolist())).encode("utf-8", "surrogatepass")
    return np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<")).reshape(-1).view(np.uint8)
