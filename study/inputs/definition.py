"""Study files: TOML text -> a checked, frozen Definition with the digest of what determines its numbers."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from solver.bases import may_be_layered

from ..specimen.foreign import plain
from ..terminal import counted, shown
from .grid import Grid, along
from .punch.asperities import many_bodies
from .punch.scan_words import ScanWord
from .request import MOST_MESSAGES
from .vocabulary import finite, names

POINTS = 33  # of a profile, unless the study says it
LARGE = 500_000_000  # numbers in one results file, 4 GB: a larger grid may be a mistake, so `run` wants --yes
MOST_VALUES = 5_000_000_000  # 40 GB: no larger grid is allowed, it can be cut into several studies
DTYPES = ("float64", "float32")
PER_CASE = 16  # numbers of a case besides the profiles, roughly
#: Cases in a block: ordinary ones, those that take some milliseconds each, those that may take ten seconds each.
#: A block is some seconds of work. A run that is killed loses the blocks in work.
USUAL, SLOW, SLOWEST = 8000, 1000, 100
#: On the exact layer a case with a larger n, or a smaller rtol, may need a mesh that no other case can use.
_STIFF, _FINE = 1e3, 1e-9
_MANY_NODES = 96  # the most that the solver begins with by itself; with more a case takes some milliseconds


class StudyError(ValueError):
    """Input that cannot be used; `messages` has every reason, one line each.

    code : exit code of a command; 2 for a wrong input, 1 for a right one that leads to something wrong
    """

    def __init__(self, messages, code: int = 2):
        self.messages, self.code = tuple(messages), code
        super().__init__("\n".join(self.messages))


def refuse_scans(definition: "Definition", who: str) -> "Definition":
    """The definition itself. Raises StudyError where a law of a scan would have to be computed, on many bodies perhaps.

    who : the name of the public function, for messages
    """
    if not definition.scans:
        return definition
    word, file = definition.scans[0].name, definition.scans[0].file
    way_out = f'compute the law first, roughcoat scan {file} --law law.csv: micro = "table:law.csv"'
    raise StudyError([f"{who}: micro = {shown(word)} is for contacts that are given: {way_out}"])


@dataclass(frozen=True, eq=False)
class Definition:
    """What a study computes.

    text : the study file as it was read; goes into the dataset
    x : (m,) points r/a of the profiles
    profiles : names of the profiles that are stored
    dtype : "float64" or "float32", of the stored numbers
    block : number of cases computed and stored at a time
    digest : sha256 of all that determines the numbers
    laws : "NAME VERSION" of each micro law that is not of this package; the version is in the digest
    results : names of the results, without profiles and flags
    scene : of a study with units, a `study.inputs.scene.scene.Scene`; its grid is dimensionless, its results are in SI
    inputs : names of those inputs of the solver that change with some spread; results have derivatives by them
    stresses : names of the largest stresses and their places, if the study wants them
    says_what_is_felt : whether the results have `asperities_used`
    scans : laws of scans that must be computed before the contacts: `scan_laws.words.with_rows`
    tables : name -> text of each law of a scan that has been
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
    results: tuple[str, ...] = names("result")
    inputs: tuple[str, ...] = ()
    stresses: tuple[str, ...] = ()
    says_what_is_felt: bool = False
    scans: tuple[ScanWord, ...] = ()
    tables: Mapping[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f'Definition("{self.name}", {self.cases})'

    @property
    def cases(self) -> str:
        """Number of cases and axes in words: "12 cases (h 2 x P 6)"."""
        dims = " x ".join(f"{name} {size}" for name, size in self.in_results(self.grid.sizes).items()) or "one case"
        return f"{counted(self.grid.size, 'case')} ({dims})"

    @property
    def numbers(self) -> int:
        """How many numbers the blocks hold, roughly. The results hold as many, and as many spreads."""
        per_case = PER_CASE + len(self.stresses) + len(self.x) * len(self.profiles)
        return self.grid.size * per_case * (1 + len(self.inputs))

    def in_results(self, table: dict) -> dict:
        """The table, whose keys are dimensions of the grid, with the names that the results give to these."""
        names = self.scene.dims if self.scene else {}
        return {names.get(dim, dim): value for dim, value in table.items()}


def settings(tables: dict, errors: list[str]) -> tuple:
    """What the title and the section [output] say: title, x, profiles, dtype and stresses of a Definition."""
    title = tables.get("title", "")
    output = {"x": POINTS, "profiles": True, "dtype": DTYPES[0], "stresses": False} | tables.get("output", {})
    x = profile_points(output["x"], errors)
    if not isinstance(title, str):
        errors.append(f"title = {shown(title)}: must be text")
    profiles, dtype = profile_names(output["profiles"], errors), output["dtype"]
    if dtype not in DTYPES:
        errors.append(f"[output] dtype = {shown(dtype)}: must be one of " + ", ".join(f'"{d}"' for d in DTYPES))
    if not isinstance(output["stresses"], bool):
        errors.append(f"[output] stresses = {shown(output['stresses'])}: must be true or false")
    return title, x, profiles, dtype, names("stress") if output["stresses"] is True else ()


def refusal(where: str, errors: list[str]) -> StudyError:
    """The error to raise for these messages. Each begins with `where`; after MOST_MESSAGES the rest is counted."""
    more = len(errors) - MOST_MESSAGES
    shortened = errors[:MOST_MESSAGES] + ([f"and {more} more mistakes"] if more > 0 else [])
    return StudyError(f"{where}: {message}" for message in shortened)


def profile_names(profiles, errors: list[str]) -> tuple[str, ...]:
    """Names of the profiles to store, from true, false or their list; in the order of the vocabulary."""
    choices, profiles = names("profile"), plain(profiles)
    if isinstance(profiles, bool):
        return choices if profiles else ()
    if not isinstance(profiles, (list, tuple)) or not set(map(str, profiles)) <= set(choices):
        listed = ", ".join(f'"{name}"' for name in choices)
        errors.append(f"profiles = {shown(profiles)}: must be true or false, or a list of {listed}")
        return ()
    return tuple(name for name in choices if name in profiles)


def profile_points(x, errors: list[str]) -> np.ndarray:
    """Points r/a from their number or their list: increasing from 0 to 1."""
    points = plain(x)
    points = points.values.tolist() if hasattr(points, "dims") else points
    if type(points) is int and 2 <= points <= 10_000:
        return np.linspace(0.0, 1.0, points)
    if not isinstance(points, (list, tuple, range)) or not all(map(finite, points)):
        errors.append(f"x = {shown(x)}: must be a whole number in [2, 10000] or a list of numbers from 0 to 1")
        return np.array([])
    radii = np.array(points, dtype=float)
    if len(radii) < 2 or radii[0] != 0 or radii[-1] != 1 or (np.diff(radii) <= 0).any():
        errors.append(f"x = {shown(points)}: a list must increase from 0 to 1, both included")
    return radii


def usual_block(grid: Grid) -> int:
    """Number of cases in a block, unless the study says it. The slowest kind of case in the grid decides."""
    n, rtol, nodes = (along(grid, name) for name in ("n", "rtol", "nodes"))
    layered = np.any(may_be_layered(along(grid, "base")))
    approximated = (along(grid, "scheme") == "picard").any()
    if layered and (approximated or (n > _STIFF).any() or (rtol < _FINE).any()):
        return SLOWEST
    return SLOW if approximated or (nodes > _MANY_NODES).any() or many_bodies(grid) else USUAL
