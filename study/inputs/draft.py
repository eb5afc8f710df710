"""A draft of a grid: it reads the numbers without units of what is given, and collects all mistakes."""

from dataclasses import dataclass, field, replace

import numpy as np

from .checks import (
    dimensions_that_differ,
    equal_cases,
    heights_that_yield,
    missing_parameters,
    mixed_units,
    not_given,
    one_control,
    picard_for_nothing,
    slips_of_laws,
)
from .given import Given, Input
from .grid import Grid, as_array, equal_values
from .laws import fitted, law_names, wants_a_fit
from .sample import sampled, values_of_axis
from .vocabulary import PARAMETERS, VOCABULARY

MOST_DIMENSIONS = 31  # a netCDF variable has at most 32, and profiles have x as one more


@dataclass
class Draft:
    """Collects the numbers of parameters; `finish` makes the Grid of them.

    given : what they are read from; its `errors` are those of the draft
    sizes, values, labels : as those of the Grid
    """

    given: Given
    sizes: dict[str, int] = field(default_factory=dict)
    values: dict = field(default_factory=dict)
    labels: dict = field(default_factory=dict)
    errors: list[str] = field(init=False)

    def __post_init__(self):
        self.errors = self.given.errors

    def expand(self) -> None:
        """Make ranges and [sample] lists of values."""
        given = self.given
        if given.sample is not None:
            names = [name for name, entry in given.inputs.items() if entry.section == "[sample]"]
            columns = sampled(given.sample, names, given.physical, self.checked, given.errors)
            for name in names:
                given.inputs[name].values = columns.get(name)
        for name, entry in given.inputs.items():
            if entry.dims == (name,) and entry.array is None:
                entry.values = values_of_axis(name, entry.values, given.physical, given.errors)

    def read(self, entry: Input) -> None:
        """The numbers or words of an input without a unit. What a case does not say has its default, or NaN."""
        name, gaps = entry.name, entry.section == "[[cases]]"
        default = VOCABULARY[name].own.default
        raw = entry.values if entry.array is None else entry.array.values.ravel().tolist()
        raw = [default if gaps and value is None else value for value in raw]
        array = self.checked(name, raw, gaps=gaps, distinct=entry.dims == (name,))
        self.values[name] = entry.dims, array.reshape(entry.shape)

    def checked(self, name: str, raw: list, gaps: bool = False, distinct: bool = False) -> np.ndarray:
        """The values as an array, with messages for those that are not allowed.

        gaps : None is allowed, and becomes NaN; distinct : values that are equal get a message
        """
        before = len(self.errors)
        if name == "micro":
            try:
                raw = law_names(raw)
            except ValueError as error:
                self.errors.append(f"{name}: {error}")
                return np.empty(len(raw))
        array = as_array(VOCABULARY[name].own, raw, name, self.errors, gaps)
        if distinct and len(self.errors) == before:
            self.errors += equal_values(name, array.tolist())
        return array

    def check(self, labels: dict[str, np.ndarray]) -> None:
        """Messages for what is missing, and for dimensions on which two inputs disagree. Fills in the defaults.

        labels : axes that are not among the values, as they are in SI
        """
        given, values = self.given, self.values
        self.errors += one_control(given.sections)
        self.errors += dimensions_that_differ(given, labels | {n: array for n, (dims, array) in values.items() if dims})
        _, laws = values.get("micro", ((), ""))  # "" if what was given has been refused
        for name in [name for name in PARAMETERS if name not in given.sections]:
            parameter = VOCABULARY[name].own  # of a law that no case has it stays away
            selector, owners, *_ = parameter.needed_by
            if parameter.default is not None and (selector != "micro" or np.isin(laws, owners).any()):
                values[name] = (), np.array(parameter.default)
        names = {*given.sections, *["n"] * given.physical}  # n follows from moduli
        self.errors += not_given(names, lambda name: values.get(name, ((), ()))[1], self.errors)
        if not self.errors:
            rows = [repr(sorted(((k, v) for k, v in row.items() if k != "label"), key=str)) for row in given.rows]
            self.errors += equal_cases(rows)

    def put(self, name: str, dims: tuple[str, ...], array: np.ndarray) -> None:
        """A number that follows from others, over its dimensions."""
        self.values[name] = dims, self.checked(name, array.ravel().tolist()).reshape(array.shape)

    def put_dimensions(self) -> None:
        """Note the lengths of dimensions, and coordinates of those that are no inputs."""
        given = self.given
        for dims, array in self.values.values():
            for dim, size in zip(dims, array.shape, strict=True):
                self.sizes.setdefault(dim, size)
        for entry in given.inputs.values():
            for dim in entry.dims if entry.array is not None else ():
                stacked = hasattr(entry.array.indexes.get(dim), "levels")  # see `carried`
                if dim not in given.inputs and dim in entry.array.coords and not stacked:
                    self.labels.setdefault(dim, ((dim,), entry.array.coords[dim].values))
        if "case" in self.sizes and (given.rows or given.sample is not None or given.physical):
            self.labels.setdefault("case", (("case",), np.arange(self.sizes["case"], dtype=np.int32)))
        if given.labels and not given.physical:
            self.labels["label"] = ("case",), np.array(given.labels, dtype=str)
        if len(self.sizes) > MOST_DIMENSIONS:
            self.errors.append(f"{len(self.sizes)} dimensions: at most {MOST_DIMENSIONS} are allowed")

    def finish(self) -> Grid:
        """The grid, with B and beta where they are to be fitted, after a check of what concerns several parameters."""
        grid = self._grid()
        if not self.errors and wants_a_fit(grid):
            laws, errors = fitted(grid)
            self.values |= laws
            self.errors += errors
            grid = replace(self._grid(), fitted=True)
        if not self.errors:
            self.errors += missing_parameters(grid) + picard_for_nothing(grid) + heights_that_yield(grid)
            self.errors += [] if self.given.physical else mixed_units(grid)
        self.errors += [] if self.errors else slips_of_laws(grid)
        return grid

    def _grid(self) -> Grid:
        return Grid(self.sizes, {name: self.values[name] for name in PARAMETERS if name in self.values}, self.labels)
