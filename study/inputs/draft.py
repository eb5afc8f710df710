"""A draft of a grid: it reads the inputs without units and collects all mistakes."""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from .checks import (
    dimensions_that_differ,
    equal_cases,
    heights_that_yield,
    missing_everywhere,
    missing_in_cases,
    mixed_units,
    one_control,
    picard_for_nothing,
    slips_of_laws,
)
from .grid import Grid, as_array, equal_values
from .lexicon import Lexicon
from .punch import micro_laws, shapes, sticking
from .request import Input, Request
from .sample import sampled, values_of_axis
from .scene.scene import INFINITE

#: Inputs that are names of objects.
_WORDS = ("micro", "shape")
MOST_DIMENSIONS = 31  # a netCDF variable has at most 32, and profiles have x as one more


@dataclass
class Draft:
    """Collects the numbers of parameters; `finish` makes the Grid of them.

    request : the inputs; its `errors` are those of the draft
    sizes, values, labels : as those of the Grid
    """

    request: Request
    sizes: dict[str, int] = field(default_factory=dict)
    values: dict = field(default_factory=dict)
    labels: dict = field(default_factory=dict)
    errors: list[str] = field(init=False)

    def __post_init__(self):
        self.errors = self.request.errors

    @property
    def lexicon(self) -> Lexicon:
        """What the words of the request stand for."""
        return self.request.lexicon

    def expand(self) -> None:
        """Make ranges and [sample] lists of values."""
        request = self.request
        if request.sample is not None:
            names = [name for name, entry in request.inputs.items() if entry.section == "[sample]"]
            columns = sampled(request, names, self.checked)
            for name in names:
                request.inputs[name].values = columns.get(name)
        for name, entry in request.inputs.items():
            if entry.dims == (name,) and entry.array is None:
                entry.values = values_of_axis(entry, request)

    def read(self, entry: Input) -> None:
        """Read the numbers or words of an input without a unit. A gap in [[cases]] becomes the default, or NaN."""
        name, gaps = entry.name, entry.section == "[[cases]]"
        default = self.lexicon.parameter(name).default
        raw = entry.values if entry.array is None else entry.array.values.ravel().tolist()
        raw = [default if gaps and value is None else value for value in raw]
        array = self.checked(name, raw, gaps=gaps, distinct=entry.dims == (name,))
        self.values[name] = entry.dims, array.reshape(entry.shape)

    def checked(self, name: str, raw: list, gaps: bool = False, distinct: bool = False) -> np.ndarray:
        """The values as an array, with messages for those that are not allowed.

        gaps : None is allowed, and becomes NaN; distinct : values that are equal get a message
        """
        before = len(self.errors)
        if name in _WORDS:
            try:
                raw = self._named(name, raw)
            except ValueError as error:
                self.errors.append(f"{name}: {error}")
                return np.empty(len(raw))
        if name.endswith(".profile") and any(self._is_without_file(word) for word in raw):
            return np.empty(len(raw))
        raw = shapes.as_written(raw) if name in shapes.WORDS else raw
        endless = INFINITE.get(name, ())
        raw = [math.inf if isinstance(value, str) and value.lower() in endless else value for value in raw]
        array = as_array(sticking.row_of(name, self.request.sections, self.lexicon), raw, name, self.errors, gaps)
        if len(self.errors) > before and len(raw) == 1:
            self.errors[-1] += sticking.hint(name, raw[0], self.request.sections)
        if distinct and len(self.errors) == before:
            self.errors += equal_values(name, array.tolist())
        return array

    def _is_without_file(self, word: Any) -> bool:
        """Whether a word is a table of a profile that could not be read: the request has said why."""
        is_table = isinstance(word, str) and word.startswith(shapes.table.PREFIX)
        return is_table and word not in self.lexicon.known.profiles

    def _named(self, name: str, raw: list) -> list:
        """The values of `micro` or `shape` as names that the lexicon has. Raises ValueError for what cannot be used."""
        if name == "micro":
            self.request.learn(raw)
            return self.lexicon.names_of(raw)
        words = shapes.as_written(raw)
        try:
            self.request.learn_shapes(words)
        except ValueError as error:
            raise ValueError(str(error).removeprefix("shape ")) from None
        return words

    def check(self, labels: dict[str, np.ndarray]) -> None:
        """Messages for what is missing, and for dimensions on which two inputs disagree. Fills in the defaults.

        labels : axes that are not among the values, as they are in SI
        """
        request, values = self.request, self.values
        self.errors += one_control(request.sections)
        arrays = {name: array for name, (dims, array) in values.items() if dims}
        self.errors += dimensions_that_differ(request, labels | arrays)
        parameters = self.lexicon.parameters_of(request.sections)
        for name in [name for name in parameters if name not in request.sections]:
            parameter = self.lexicon.parameter(name)  # those of a law or a shape that no case has stay away
            selector, owners, *_ = parameter.needed_by
            if name.rpartition(".")[2] in ("cn", "ct", "profile") or name == "asperities_on":
                continue
            if shapes.left_out(name, request.sections, self.lexicon) or sticking.left_out(name, request.sections):
                continue
            words = values.get(selector, ((), ""))[1]  # "": micro has been refused
            if parameter.default is not None and (selector not in _WORDS or np.any([words == word for word in owners])):
                values[name] = (), np.array(parameter.default)
        names = {*request.sections, *["n"] * request.physical}  # n follows from moduli
        names |= {name for name in parameters if request.physical and name.endswith(".n")}
        words = {name: array for name, (_, array) in values.items()}
        self.errors += missing_everywhere(self.lexicon, names, lambda name: words.get(name, ()), self.errors)
        if not self.errors:
            rows = [repr(sorted(((k, v) for k, v in row.items() if k != "label"), key=str)) for row in request.rows]
            self.errors += equal_cases(rows)

    def put_dimensions(self) -> None:
        """Note the lengths of dimensions, and the coordinates of dimensions that are no inputs."""
        request = self.request
        for dims, array in self.values.values():
            for dim, size in zip(dims, array.shape, strict=True):
                self.sizes.setdefault(dim, size)
        for entry in request.inputs.values():
            for dim in entry.dims if entry.array is not None else ():
                stacked = hasattr(entry.array.indexes.get(dim), "levels")  # see `data.coordinates`
                if dim not in request.inputs and dim in entry.array.coords and not stacked:
                    self.labels.setdefault(dim, ((dim,), entry.array.coords[dim].values))
        if "case" in self.sizes and (request.rows or request.sample is not None or request.physical):
            self.labels.setdefault("case", (("case",), np.arange(self.sizes["case"], dtype=np.int32)))
        if request.labels and not request.physical:
            self.labels["label"] = ("case",), np.array(request.labels, dtype=str)
        if len(self.sizes) > MOST_DIMENSIONS:
            self.errors.append(f"{len(self.sizes)} dimensions: at most {MOST_DIMENSIONS} are allowed")

    def finish(self) -> Grid:
        """The grid, after the checks of several parameters together. Fits B and beta where they are left out."""
        grid = self._grid()
        if not self.errors and micro_laws.wants_a_fit(grid):
            laws, errors = micro_laws.fitted(grid)
            self.values |= laws
            self.errors += errors
            grid = replace(self._grid(), fitted=True)
        if not self.errors:
            self.errors += missing_in_cases(grid) + picard_for_nothing(grid) + heights_that_yield(grid)
            self.errors += micro_laws.mistakes_of_choice(grid, self.request.sections)
            self.errors += micro_laws.mistakes_of_tables(grid, self.request.physical)
            self.errors += [] if self.request.physical else mixed_units(grid)
            self.errors += shapes.mistakes(grid, self.request.sections, self.request.physical)
            self.errors += sticking.mistakes(grid, self.request.sections)
        self.errors += [] if self.errors else slips_of_laws(grid)
        return grid

    def _grid(self) -> Grid:
        values = {name: self.values[name] for name in self.lexicon.parameters_of(self.values) if name in self.values}
        return Grid(self.sizes, values, self.labels, lexicon=self.lexicon)
