"""From a request, of a call or of a study file, to a checked, frozen Definition: the grid of cases, what is stored of
them, and the digest of what determines the numbers.

Numbers have units, `R = "5 mm"`, `h = ["2 um", "20 um"]`, `P = { start = "1 mN", ... }`, or none. Inputs may have
spreads ("200 ± 10 GPa", materials by name). Then results have derivatives by the inputs of the solver, and from these
follows `NAME_spread`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from solver.bases import may_be_layered
from solver.layers import numbers_of

from ..specimen.foreign import plain
from ..terminal import counted, shown
from .checks import (
    fill_in,
    heights_that_yield,
    missing_in_cases,
    mixed_units,
    picard_for_nothing,
    slips_of_laws,
)
from .grid import Grid, along
from .identity import digest_of, law_versions
from .punch import micro_laws, shapes, sticking
from .punch.scan_words import ScanWord, with_bodies
from .punch.stresses import LAYER_NUMBER, dimension, none_in, stored
from .request import MOST_MESSAGES, Request
from .scene.stacks import axes_in, in_layers
from .vocabulary import FIRST_MATERIAL, finite, names

POINTS = 33  # of a profile, unless the study sets them
LARGE = 500_000_000  # numbers in one results file, 4 GB: a larger grid may be a mistake, so `run` wants --yes
MOST_VALUES = 5_000_000_000  # 40 GB: no larger grid is allowed, it can be cut into several studies
MOST_DIMENSIONS = 31  # a netCDF variable has at most 32, and profiles have x as one more
DTYPES = ("float64", "float32")
PER_CASE = 16  # numbers of a case besides the profiles, roughly
#: Cases in a block: of ordinary cases, of those that take some milliseconds each, of those that may take ten seconds
#: each. A block is some seconds of work. A killed run loses the blocks that are being computed.
USUAL, SLOW, SLOWEST = 8000, 1000, 100
#: On the exact layer a case with a larger n, or a smaller rtol, may need a mesh that no other case can use.
_STIFF, _FINE = 1e3, 1e-9
_MANY_NODES = 96  # the solver never chooses more at first; with more a case takes some milliseconds


class StudyError(ValueError):
    """Input that cannot be used; `messages` has every reason, one line each.

    code : exit code of a command; 2 for a wrong input, 1 if something goes wrong with a valid input

    Examples
    --------
    >>> import study
    >>> try:
    ...     study.solve(P=1e-5, base="half_space", micro="smoth")
    ... except study.StudyError as error:
    ...     print(error.messages[0].partition(" one of ")[0])
    solve: micro = "smoth": must be
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
    """The cases and results of a study.

    text : the study file as it was read; goes into the dataset
    x : (m,) points r/a of the profiles
    profiles : names of the profiles that are stored
    dtype : "float64" or "float32", of the stored numbers
    block : number of cases computed and stored at a time
    digest : sha256 of all that determines the numbers
    laws : "NAME VERSION" of each micro law from outside this package; the version is in the digest
    results : names of the results, without profiles and flags
    scene : of a study with units, a `study.inputs.scene.scene.Scene`; its grid is dimensionless, its results are in SI
    inputs : names of the solver's inputs that change with some spread; results have derivatives by them
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
        """Rough number of the numbers in the blocks. The results hold as many, and as many spreads."""
        stresses = sum(int(np.prod(self.shape_of(name))) for name in self.stresses)
        per_case = PER_CASE + stresses + len(self.x) * len(self.profiles)
        return self.grid.size * per_case * (1 + len(self.inputs))

    @property
    def layers(self) -> int:
        """The number of layers over which stresses are stored; 0 of no stack, or of no stresses."""
        return numbers_of(self.grid.values) if self.stresses else 0

    def dims_of(self, name: str) -> tuple[str, ...]:
        """The dimensions that a result has behind those of the cases, while `layer` may still be an axis of materials:
        x of profiles, the number of a layer or of an interface of the largest stresses of stacks."""
        if name in self.profiles:
            return ("x",)
        dim = dimension(name) if self.layers and name in self.stresses else ""
        return (LAYER_NUMBER if dim == "layer" else dim,) if dim else ()

    def shape_of(self, name: str) -> tuple[int, ...]:
        """The lengths of these dimensions."""
        return tuple(len(self.x) if dim == "x" else self.layers for dim in self.dims_of(name))

    def in_results(self, table: dict) -> dict:
        """The table, whose keys are dimensions of the grid, with the names of these dimensions in the results."""
        names = (self.scene.dims if self.scene else {}) | ({"layer": FIRST_MATERIAL} if self.layers else {})
        return {names.get(dim, dim): value for dim, value in table.items()}


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
    return definition_of(
        Request.in_python(parameters, rows, same_piece, correlations), tables, "solve", "", where, LARGE
    )


def definition_of(
    request: Request, tables: dict, name: str, text: str, where: str, most: float = MOST_VALUES
) -> Definition:
    """The definition that a request describes, with its digest. Raises StudyError with every message.

    tables : title, [output], the block of [numerics] and the order of [axes] are read from these
    most : how many numbers the results may hold
    """
    errors, scene = request.errors, None
    request.expand()
    spreads = tables.get("output", {}).get("spreads", True)
    if not isinstance(spreads, bool):
        errors.append(f"[output] spreads = {shown(spreads)}: must be true or false")
    if request.physical:
        # imported here, since they load xarray, which pure numbers do not need
        from .scene.changes import inputs_of
        from .scene.physical_inputs import read as read_scene

        scene = read_scene(request, spreads is True, axes_in(tables))
    else:
        for entry in request.inputs.values():
            if not entry.is_wrong:
                request.read(entry)
        fill_in(request, {})
    grid = grid_of(request)
    grid, scans = (grid, ()) if errors else with_bodies(grid, scene, errors)
    if "w_adhesion" in grid.values and not errors:
        errors += sticking.rough_and_sticking(grid, scene and scene.unit)
    inputs = () if errors or scene is None or not scene.spreads else inputs_of(scene, grid)
    title, x, profiles, dtype, with_stresses = settings(tables, errors)
    if with_stresses and not errors and (reason := none_in(grid)):
        errors.append(f"[output] stresses = true: {reason}")
    block = tables.get("numerics", {}).get("block", 1 if errors else usual_block(grid, with_stresses))
    if type(block) is not int or not 1 <= block <= 1_000_000:
        errors.append(f"[numerics] block = {shown(block)}: must be a whole number in [1, 1000000]")
    some_feel = not errors and bool(micro_laws.felt(grid).any())
    micro = grid.values["micro"][1] if "micro" in grid.values else np.array([])
    results = micro_laws.results_of(grid.lexicon.known.laws, micro, "w_adhesion" in grid.values, some_feel)
    definition = Definition(
        *(name, title, text, grid, x, profiles, dtype, block, ""),
        scene=scene,
        results=results,
        inputs=inputs,
        stresses=stored(grid, some_feel) if with_stresses and not errors else (),
        says_what_is_felt=not errors and micro_laws.is_said(grid),
        scans=scans,
    )
    if (numbers := definition.numbers) > most:
        limit = f"at most {most:.0e} (fewer points, or profiles = false)"
        errors.append(f"{grid.size} cases make {numbers:.1e} numbers: {limit}")
    if errors:
        raise refusal(where, in_layers(errors, request.sections))
    return replace(definition, digest=digest_of(definition), laws=tuple(law_versions(grid)))


def grid_of(request: Request) -> Grid:
    """The grid of the values that have been read, after the checks of several parameters together.

    B and beta are fitted where they are left out.
    """
    labels, errors, physical = _labels_of(request), request.errors, request.physical
    if len(request.sizes) > MOST_DIMENSIONS:
        errors.append(f"{len(request.sizes)} dimensions: at most {MOST_DIMENSIONS} are allowed")
    grid = Grid(request.sizes, _in_order(request), labels, lexicon=request.lexicon)
    if not errors and micro_laws.wants_a_fit(grid):
        fits, wrong = micro_laws.fitted(grid)
        request.values |= fits
        errors += wrong
        grid = replace(grid, values=_in_order(request), fitted=True)
    if not errors:
        rows = grid.lexicon.rows
        roles = {rows[name].role for name in request.sections if name in rows}
        errors += missing_in_cases(grid) + picard_for_nothing(grid) + heights_that_yield(grid)
        errors += micro_laws.mistakes_of_choice(grid, request.sections)
        errors += micro_laws.mistakes_of_tables(grid, physical)
        errors += [] if physical else mixed_units(grid)
        errors += shapes.mistakes(grid, request.sections, physical) if "shape" in roles else []
        errors += sticking.mistakes(grid, request.sections) if "adhesion" in roles else []
    errors += [] if errors else slips_of_laws(grid)
    return grid


def _in_order(request: Request) -> dict:
    """The values in the order of the vocabulary."""
    values = request.values
    return {name: values[name] for name in request.lexicon.parameters_of(values) if name in values}


def _labels_of(request: Request) -> dict:
    """The coordinates of dimensions that are no inputs, as those of a Grid. Notes the lengths of dimensions."""
    sizes: dict[str, int] = request.sizes
    labels: dict[str, tuple] = {}
    for dims, array in request.values.values():
        for dim, size in zip(dims, array.shape, strict=True):
            sizes.setdefault(dim, size)
    for entry in request.inputs.values():
        for dim in entry.dims if entry.array is not None else ():
            stacked = hasattr(entry.array.indexes.get(dim), "levels")  # see `data.coordinates`
            if dim not in request.inputs and dim in entry.array.coords and not stacked:
                labels.setdefault(dim, ((dim,), entry.array.coords[dim].values))
    if "case" in sizes and (request.rows or request.sample is not None or request.physical):
        labels.setdefault("case", (("case",), np.arange(sizes["case"], dtype=np.int32)))
    if request.labels and not request.physical:
        labels["label"] = ("case",), np.array(request.labels, dtype=str)
    return labels


def settings(tables: dict, errors: list[str]) -> tuple:
    """The title, x, profiles and dtype of a Definition, from the title and the section [output], and whether it has
    stresses."""
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
    return title, x, profiles, dtype, output["stresses"] is True


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


def usual_block(grid: Grid, with_stresses: bool = False) -> int:
    """Number of cases in a block, unless the study says it. The slowest kind of case in the grid decides.

    The largest stresses of a contact take 5 to 50 ms, on stacks half a second.
    """
    n, rtol, nodes = (along(grid, name) for name in ("n", "rtol", "nodes"))
    layered = np.any(may_be_layered(along(grid, "base")))
    approximated = (along(grid, "scheme") == "picard").any()
    if layered and (approximated or (n > _STIFF).any() or (rtol < _FINE).any()):
        return SLOWEST
    if with_stresses:
        return SLOWEST if numbers_of(grid.values) else SLOW
    return SLOW if approximated or (nodes > _MANY_NODES).any() or micro_laws.many_bodies(grid) else USUAL
