"""The word "scan:FILE" of `micro`: a scan whose own law is computed before the contacts (study/scan_laws).

"scan:sample" is the scan that comes with roughcoat; a file of this name is "scan:./sample".

Here the file is read and refused, and it is told on which bodies its contacts are, and up to which pressure. Where they
are on several bodies each has a law of its own, and a word of its own, "scan:FILE (h = 2 um)".
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from solver import solve
from solver.bases import is_bare, on_springs
from solver.kernels.two_layers import layer_modulus
from solver.known import Known, names_of
from solver.laws import Law
from solver.laws.own_table import LAW_UNIT, OF_SCAN, awaiting_rows
from solver.numerics.userfile import place
from solver.parameters import CONTROL
from solver.scaling import dimensionless
from solver.shapes import PARABOLOID

from ... import samples
from ...specimen.foreign import plain
from ...terminal import shown
from ..grid import Grid, along, columns
from ..lexicon import lexicon_of
from .pressed_body import told_by

if TYPE_CHECKING:
    from ...specimen.scan import Scan

#: The name of the scan that comes with roughcoat.
_SAMPLE = "sample"
#: In the versions of the laws: raised when the rows of a scan, or the curves near them, change.
_OF_ROWS = "1"
#: Most bodies of a study that have a law each: a law takes some ten seconds.
_MOST_BODIES = 30
#: Cases of a body that are solved without asperities, to see how hard they are pressed.
_LOOKED_AT = 1000
#: Bodies are one where their numbers agree in so many digits: moduli and their ratios come by different ways.
_DIGITS = 10


@dataclass(frozen=True)
class ScanWord:
    """A law that is still to be computed.

    Attributes
    ----------
    name : of the law, a word of `micro`
    file : the scan, as the word names it
    path : of the scan, from the root
    content : digest of its heights and steps
    version : of the law, made of the content, the body and `top`
    top : pressure over the modulus that is felt, up to which contacts can be pressed; inf: not known
    body : parameter -> number or word, lengths in m, of the body; None: a half-space
    case : parameter of the solver -> its value, in a case on the body
    metre : 1 m in the lengths of the case
    """

    name: str
    file: str
    path: Path
    content: str
    version: str
    top: float
    body: Mapping[str, Any] | None
    case: Mapping[str, Any]
    metre: float


def scan_in(word: str, path: Path | None = None) -> Scan:
    """The scan of a word "scan:FILE". Raises ValueError for a file that has no map of heights, with its lengths.

    path : where it is, if that is known
    """
    from ...specimen.scan_files import read  # few contacts have a scan

    file = word.removeprefix(OF_SCAN)
    table = f'compute the law with its arguments, roughcoat scan {file} ... --law law.csv: micro = "table:law.csv"'
    if not file:
        raise ValueError('names no file: "scan:wafer.sdf"')
    try:
        scan = read(path or _place(file))
    except OSError as error:
        raise ValueError(f"{file}: cannot be read: {error.strerror or error}") from None
    except (ValueError, ImportError) as error:
        named = str(error) if str(error).startswith(Path(file).name) else f"{file}: {error}"
        raise ValueError(f"{named.removesuffix('.')}; or {table}") from None
    if scan.z.ndim != 2:
        raise ValueError(f"{file}: is a profile: the law of a scan needs a map of heights")
    return scan


def _place(file: str) -> Path:
    """The path of the scan that a word names. Raises ValueError for ~name/ of a user who does not exist."""
    return samples.scan() if file == _SAMPLE else place(file)


def content_of(scan: Scan) -> str:
    """A digest of heights and steps."""
    arrays = np.asarray(scan.steps, "<f8"), np.asarray(scan.z.shape, "<f8"), np.ascontiguousarray(scan.z, "<f8")
    return hashlib.sha256(b"".join(array.tobytes() for array in arrays)).hexdigest()


def with_scans(known: Known, micro: Any) -> Known:
    """With the words "scan:FILE" among the values of `micro`, whose laws have no rows yet. Raises ValueError for a file
    that cannot be used."""
    words = np.ravel(np.array(names_of(plain(micro)), dtype=object)).tolist()
    for word in dict.fromkeys(word for word in words if isinstance(word, str) and word.startswith(OF_SCAN)):
        if word not in known.laws:
            known = known.with_law(awaiting_rows(word, content_of(scan_in(word))))
    return known


def with_bodies(grid: Grid, scene: Any, errors: list[str]) -> tuple[Grid, tuple[ScanWord, ...]]:
    """The grid with a law for each body on which a scan is pressed, and what has to be computed of each. The scene gets
    the same words. Messages for bodies on which there is no such law."""
    laws = grid.lexicon.known.laws
    names = [name for name, law in laws.items() if name.startswith(OF_SCAN) and _is_awaiting(law)]
    names = [name for name in names if "micro" in grid.values and (grid.values["micro"][1] == name).any()]
    if scene is None or not names:
        return grid, ()
    known, words, scans = grid.lexicon.known, np.array(np.broadcast_to(along(grid, "micro"), grid.shape), object), []
    for name in names:
        flat = np.flatnonzero(words.ravel() == name)
        bodies, reason = _bodies(grid, flat)
        if reason:
            errors.append(f"micro = {shown(name)}: {reason}")
            continue
        if "micro" in grid.sizes and len(bodies) > 1:
            way_out = "give one body, or each scan with its bodies in a call of its own"
            errors.append(f"micro = {shown(name)}: several bodies need a law each, and micro is an axis: {way_out}")
            continue
        for rest, cases in _named_apart(bodies, grid):
            scan = _scan_word(grid, name, name + rest, flat[cases])
            known = known.with_law(awaiting_rows(scan.name, scan.version, scan.body))
            words.ravel()[flat[cases]] = scan.name
            scans.append(scan)
    lexicon, micro = lexicon_of(known), _short(grid, words)
    scene.lexicon, scene.parameters["micro"] = lexicon, _as_parameter(*micro)
    return replace(grid, values=grid.values | {"micro": micro}, lexicon=lexicon), tuple(scans)


def _is_awaiting(law: Law) -> bool:
    return law.scales is awaiting_rows("", "").scales


def _bodies(grid: Grid, index: np.ndarray) -> tuple[list[tuple[dict, np.ndarray]], str]:
    """What tells each body from others, with its cases as places in `index` (k,); and why there is none."""
    table = columns(grid, index)
    bare, springs = is_bare(table["base"]), on_springs(table["base"])
    if springs.any():
        word = shown(str(table["base"][springs][0]))
        way_out = 'take "layered", "auto" or "stack"'
        return [], f"base = {word}: a layer of springs has no kernel, which the law of a scan needs: {way_out}"
    told = told_by(table, table[LAW_UNIT], grid.lexicon)
    texts = [np.where(bare, "", _texts(values)) for values in told.values()]
    rows = np.array(["\0".join(row) for row in zip(*texts, strict=True)] if texts else [""] * len(index))
    _, first, which = np.unique(rows, return_index=True, return_inverse=True)
    if len(first) > _MOST_BODIES:
        way_out = "take fewer thicknesses or materials, or laws from tables (roughcoat scan ... --law)"
        return [], f"there are {len(first)} bodies, of which each needs a law, at most {_MOST_BODIES}: {way_out}"
    bodies = []
    for number in np.argsort(first):
        at = first[number]
        told_here = {} if bare[at] else {name: values[at].item() for name, values in told.items()}
        bodies.append((told_here, np.flatnonzero(which == number)))
    return bodies, ""


def _texts(values: np.ndarray) -> np.ndarray:
    if values.dtype.kind not in "fiu":
        return values.astype(str)
    return np.array([f"{value:.{_DIGITS}g}" for value in values.tolist()])


def _named_apart(bodies: list[tuple[dict, np.ndarray]], grid: Grid) -> list[tuple[str, np.ndarray]]:
    """The end of the word of each body, "" of a lone one, and its cases."""

    def text_of(body: dict, name: str) -> str:
        is_length = grid.lexicon.rows[name].powers == (0, 1)
        return f"{name} = {_text(1e6 * body[name])} um" if is_length else f"{name} = {_text(body[name])}"

    names = list(dict.fromkeys(name for body, _ in bodies for name in body))
    differing = [name for name in names if len({_text(body.get(name)) for body, _ in bodies}) > 1]
    ends = [", ".join(text_of(body, name) for name in differing if name in body) for body, _ in bodies]
    several = len(bodies) > 1
    return [(f" ({end or 'half-space'})" * several, cases) for end, (_, cases) in zip(ends, bodies, strict=True)]


def _text(value: Any) -> str:
    return f"{value:.{_DIGITS}g}" if isinstance(value, float) else str(value)


def _scan_word(grid: Grid, word: str, name: str, index: np.ndarray) -> ScanWord:
    """What has to be computed for the cases numbered `index` (k,), which are on one body."""
    case = {key: values.item() for key, values in columns(grid, index[:1]).items()}
    table = {key: np.array([value]) for key, value in case.items()}
    metre, bare = case[LAW_UNIT], bool(is_bare(case["base"]))
    told = {} if bare else {key: values.item() for key, values in told_by(table, np.array(metre), grid.lexicon).items()}
    top, content = _hardest(grid, index), grid.lexicon.known.laws[word].version
    version = hashlib.sha256(json.dumps([_OF_ROWS, content, told, repr(top)], sort_keys=True).encode()).hexdigest()
    file = word.removeprefix(OF_SCAN)
    return ScanWord(name, file, _place(file).absolute(), content, version[:24], top, told or None, case, metre)


def _hardest(grid: Grid, index: np.ndarray) -> float:
    """A power of 2 that the nominal pressure of no contact exceeds, over the modulus that is felt: without asperities
    it is larger. inf where the shape makes it infinite, or no such contact is solved."""
    if "shape" in grid.values and (grid.values["shape"][1] != PARABOLOID).any():
        return np.inf
    control = next(name for name in CONTROL if name in grid.values)
    hardest = index[np.argmax(np.broadcast_to(along(grid, control), grid.shape).ravel()[index])]
    some = np.append(index[:: -(-len(index) // _LOOKED_AT)], hardest)
    problem = dimensionless(grid.lexicon.problem(columns(grid, some), micro="smooth", scheme="newton"))
    pressures = solve(problem, np.array([0.0, 1.0])).p0 * (1 + problem.m) / layer_modulus(problem.n)
    return float(2.0 ** np.ceil(np.log2(np.nanmax(pressures)))) if np.isfinite(pressures).any() else np.inf


def _short(grid: Grid, words: np.ndarray) -> tuple[tuple[str, ...], np.ndarray]:
    """Words over all dimensions of the grid, over those alone along which they change."""
    dims = list(grid.sizes)
    for axis in reversed(range(len(dims))):
        first = words.take([0], axis)
        if (words == first).all() and dims[axis] not in grid.values["micro"][0]:
            words = first.take(0, axis)
            del dims[axis]
    return tuple(dims), np.array(words, dtype=str)


def _as_parameter(dims: tuple[str, ...], words: np.ndarray) -> Any:
    from ...arrays import xarray_later as xr

    return xr.DataArray(words, dims=dims) if dims else words.item()
