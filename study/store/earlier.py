"""The results file of an earlier version of a study: which of its cases this one can use, and which would be lost."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from solver import NUMERICS_VERSION
from solver.laws import identity as law_identity
from solver.laws import name_in

from ..data.dataset import not_run
from ..data.units import PHYSICAL_SCALE
from ..files.access import Unusable
from ..files.checksums import ATTRIBUTE, digest_of_cases, parsed
from ..files.examine import BROKEN, Condition, coordinates_of, runs, stamp
from ..files.netcdf import File
from ..inputs.definition import Definition, StudyError
from ..inputs.grid import Grid, columns
from ..inputs.identity import case_keys, find
from ..inputs.reading import same_tables
from ..inputs.scene.scales import grid_of_results, parameters_from_si, result_from_si, scales_of
from ..inputs.vocabulary import NOT_RUN, PARAMETERS, SCENE
from ..terminal import on_one_line, program
from .block_file import Damaged
from .blocks import Store, facts, usable

MEND = "run the study as it was (its text is the attribute study), which mends it, or use --results DIR"


@dataclass(frozen=True, eq=False)
class ResultsSource:
    """The N cases of a results file.

    grid : their dimensionless parameters; names : of the columns; seen : `stamp` of the file when it was examined
    scales : of a file in SI units, R and the unit of moduli of each case, as a grid
    """

    path: Path
    grid: Grid
    keys: np.ndarray
    status: np.ndarray
    names: tuple[str, ...]
    seen: tuple | None
    scales: Grid | None = None

    def read(self, rows: np.ndarray) -> dict[str, np.ndarray]:
        """Columns of the cases at `rows`: name -> (n, ...).

        The file is read by the windows in which it was examined, so that no window with damage is touched.
        """
        given = columns(self.grid, rows)
        found = {name: given[name] for name in self.names if name in self.grid.values}
        over = [name for name in self.names if name not in found]
        with File(self.path) as file:
            for start, stop, window in runs(self.grid):
                here = np.flatnonzero((start <= rows) & (rows < stop))
                for name in over if len(here) else ():
                    piece = file.read(name, window)
                    piece = piece.reshape(stop - start, *piece.shape[len(self.grid.sizes) :])
                    if name not in found:
                        found[name] = np.empty((len(rows), *piece.shape[1:]), piece.dtype)
                    found[name][here] = piece[rows[here] - start]
        if stamp(self.path) != self.seen:
            raise Damaged(f"{self.path}: has been replaced while its cases were read; the same command goes on")
        if self.scales:
            scales = columns(self.scales, rows)
            found |= {name: result_from_si(name, found[name], scales) for name in over}
        return found


@dataclass(frozen=True, eq=False)
class Earlier:
    """A results file and its condition.

    cases : how many it holds; identified : whether it is known which cases these are; numerics : their version
    source : the cases that this study can use, or None
    text, command : of the study file and of the command that made it, "" where they are lost
    """

    condition: Condition
    cases: int = 0
    identified: bool = False
    numerics: str = ""
    source: ResultsSource | None = None
    text: str = ""
    command: str = ""


def earlier(definition: Definition, found: Condition) -> Earlier:
    """What a results file holds that has been examined."""
    if found.kind in ("missing", "foreign", "unreadable") or not found.digest and not found.damage:
        return Earlier(found)
    try:
        with File(found.path) as file:
            known = [name for name in file.attributes() if f"@{name}" not in found.damage]
            text, command = (str(file.attribute(name)) if name in known else "" for name in ("study", "command"))
            return replace(_described(definition, found, file), text=text, command=command)
    except Unusable:
        return Earlier(found)
    except BROKEN as error:
        return Earlier(replace(found, kind="foreign", reason=f"is laid out as no results of ours ({error!r})"))


def _described(definition: Definition, found: Condition, file: File) -> Earlier:
    if "status" not in file.variables:  # no contacts, such as those of the trade-off
        return Earlier(found, numerics=found.numerics)
    identified = _identified(definition, found, file)
    if identified is None:
        return Earlier(found, Grid(found.sizes, {}).size)
    grid, x, numerics, scales = identified
    names = tuple(not_run(definition, 0))
    columns = {name: np.empty(0, file.dtype(name)) for name in names if name in file.variables}
    columns |= {name: array[:0] for name, (_, array) in grid.values.items() if array.ndim}
    if not usable(definition, facts(x) | {"numerics_version": numerics}, columns):
        return Earlier(found, grid.size, True, numerics)
    status = file.read("status").ravel()
    status = status if found.intact is None else np.where(found.intact, status, np.int8(NOT_RUN))
    source = ResultsSource(found.path, grid, case_keys(grid), status, names, stamp(found.path), scales)
    return Earlier(found, grid.size, True, numerics, source)


def _identified(definition: Definition, found: Condition, file: File) -> tuple | None:
    """(grid, points x, numerics, scales) of the cases in a file.

    Where these are damaged in the file, they are those of the definition, if the line `=cases` of the checksums shows
    that the file holds the cases of the definition. None if it does not.
    """
    if not {*PARAMETERS, *SCENE, "x", "=structure", "@numerics_version"} & set(found.damage):
        grid, scales = _grid_in(file)
        return grid, file.read("x"), found.numerics, scales
    lines = parsed(str(file.attribute(ATTRIBUTE))) if ATTRIBUTE in file.attributes() else {}
    grid, x = definition.grid, definition.x
    same = list(grid_of_results(definition, grid).sizes.items()) == list(found.sizes.items())
    if same and lines.get("=cases") == digest_of_cases(NUMERICS_VERSION, x, case_keys(grid)):
        return grid_of_results(definition, grid), x, NUMERICS_VERSION, scales_of(definition)
    return None


def _grid_in(file: File) -> tuple[Grid, Grid | None]:
    """The dimensionless grid of a results file, from its coordinates, and the scales of a file in SI units."""
    dims, values = file.variables, {}
    for name in (*PARAMETERS, *SCENE):
        if name in dims and name in coordinates_of(file):
            array = file.read(name)  # a text has lost the dimension of its characters, so `dims` may be longer
            values[name] = dims[name][: array.ndim], array.astype(str) if array.dtype.kind in "OU" else array
    versions = str(file.attribute("micro_laws")).split("\n") if "micro_laws" in file.attributes() else []
    if "micro" in values:  # a law of another version than the registered one is another law
        own, words = values["micro"]
        old = {name_in(text): text for text in versions if law_identity(name_in(text)) != text}
        values["micro"] = own, np.array([old.get(word, word) for word in words.ravel().tolist()]).reshape(words.shape)
    sizes = {dim: file.sizes[dim] for dim in dims["status"]}
    if PHYSICAL_SCALE not in file.attributes():
        return Grid(sizes, values), None
    values, scales = parameters_from_si(values)
    return Grid(sizes, values), Grid(sizes, scales)


def of_what(found: Condition) -> str:
    """What the results in a sound file belong to, if not to the study as it is now: "another definition"."""
    return "another definition" if found.numerics == NUMERICS_VERSION else "another version of the numerics"


def statuses(path: Path) -> np.ndarray:
    """The statuses in a results file of a contact study, an array over its grid."""
    with File(path) as file:
        return file.read("status")


def check_replaceable(store: Store, found: Earlier, keys: np.ndarray, force: bool = False, renew: bool = False) -> None:
    """Raise StudyError when a results file holds cases that are not among those of `keys` (B, 2), which replace it.

    force : they may be lost; renew : if the same study file made them. A file that roughcoat has not written is never
        replaced
    """
    digest, file = store.definition.digest, found.condition
    damaged = file.kind == "damaged"
    if file.kind in ("foreign", "unreadable"):
        raise Unusable(file.path, file.kind, f"{file.reason}; move it away, or use --results DIR")
    # a file that is cut off: nothing in it can be read
    nothing = file.kind == "missing" or damaged and not (file.digest or found.cases)
    if force or nothing or file.digest == digest or (renew and same_tables(found.text, store.definition.text)):
        return
    way = f"{program()} run --force {store.definition.name}" if renew else "--force"
    made = f'; it was made by "{on_one_line(found.command, 80)}"' if found.command else ""
    if damaged and not found.identified:
        raise StudyError([f"{file.path}: {file.reason}; which cases it holds cannot be told: {MEND}"])
    if found.numerics != NUMERICS_VERSION:
        owner = f"version {found.numerics} of the numerics, this is {NUMERICS_VERSION}"
        choice = f"{way} computes them again, --results DIR elsewhere"
        raise StudyError([f"{file.path}: holds results of {owner}: {choice}{made}"])
    kept = np.count_nonzero(find(found.source.keys, keys, np.zeros(len(keys))) >= 0) if found.source else 0
    if not found.cases or kept < found.cases:
        lost = f"{found.cases - kept} of its {found.cases} cases are not in this one"
        if damaged:
            raise StudyError([f"{file.path}: {file.reason}; {lost}: {MEND}"])
        owner = f"another definition (digest {file.digest[:8]}, here {digest[:8]})"
        choice = f"{way} replaces them, --results DIR writes elsewhere"
        raise StudyError([f"{file.path}: holds results of {owner}, {lost}: {choice}{made}"])
