"""A draft of a grid: it takes parameters in every form in which they can be given, and collects all mistakes."""

from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from ..specimen.foreign import plain
from .checks import missing_parameters, mixed_units, not_given, picard_for_nothing, slips_of_laws
from .grid import LONGEST_AXIS, Grid, as_array, axis_values, equal_values, same_labels, twins
from .laws import fitted, is_parameter, law_names, update_vocabulary, wants_a_fit
from .sample import LIMITS, draw
from .vocabulary import CONTROLS, NUMERICS, PARAMETERS, VOCABULARY, no_parameter

MOST_MESSAGES = 30  # that are shown for a study at a time
MOST_DIMENSIONS = 31  # a netCDF variable has at most 32, and profiles have x as one more


def label_slips(labels: list) -> list[str]:
    """Messages for labels of [[cases]] that are no texts, or the same."""
    if not all(isinstance(label, str) for label in labels):
        return ["[[cases]] label: must be text"]
    return equal_values("label", [label or i for i, label in enumerate(labels)])


def one_control(names) -> list[str]:
    """A message if the names of the parameters have none of P, a and D, or several."""
    given = [name for name in CONTROLS if name in names]
    return [f"exactly one of P, a, D must be given, not {' and '.join(given) or 'none'}"] * (len(given) != 1)


@dataclass
class Draft:
    """Collects parameters; `finish` makes the Grid of them.

    errors : messages, without the name of the file
    sizes, values, labels : as those of the Grid
    sections : parameter -> the section of the file where it is given, "" in Python
    claims : (parameter, dimension, its size, its coordinate or None), of each dimension of each DataArray
    physical : whether the results will be in SI units
    """

    errors: list[str] = field(default_factory=list)
    sizes: dict[str, int] = field(default_factory=dict)
    values: dict = field(default_factory=dict)
    labels: dict = field(default_factory=dict)
    sections: dict[str, str] = field(default_factory=dict)
    claims: list = field(default_factory=list)
    physical: bool = False

    def __post_init__(self):
        update_vocabulary()

    def laws(self, given: list) -> None:
        """Register micro laws that are given as objects, so that their parameters are known when these come.

        What is wrong with a law is told later, when `micro` itself is checked.
        """
        with suppress(ValueError):
            law_names([law for one in given for law in (one if isinstance(one, list) else [one])])

    def scalar(self, name: str, raw, section: str) -> None:
        """One value for all cases."""
        if self._accept(name, section):
            if section and isinstance(raw, (list, dict)):
                self.errors.append(f"{section} {name} has several values: these belong in [axes]")
            else:
                self.values[name] = (), self.checked(name, [raw]).reshape(())

    def axis(self, name: str, raw, section: str) -> None:
        """A dimension called like its parameter."""
        if self._accept(name, section):
            array = self.checked(name, axis_values(raw, name, self.errors), distinct=True)
            self.sizes[name], self.values[name] = len(array), ((name,), array)

    def of_any_form(self, name: str, given) -> None:
        """A parameter given in Python: a DataArray, a 1-D sequence or a scalar."""
        given = plain(given)
        if hasattr(given, "dims") and hasattr(given, "shape"):  # a Dataset has no shape
            self.array(name, given)
        elif isinstance(given, (list, tuple, range)):
            self.axis(name, list(given[: LONGEST_AXIS + 1]), "")  # a range may be endless
        else:
            self.scalar(name, given, "")

    def cases(self, rows) -> None:
        """Rows of parameters: the dimension `case`. What a row leaves out has its default, or NaN if it has none."""
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
            self.errors.append("cases must be [[cases]] tables (a list of dictionaries)")
            return
        if not rows:
            self.errors.append("cases is empty: must have at least one case")
            return
        before = len(self.errors)
        self.number_cases(len(rows))
        for name in dict.fromkeys(name for row in rows for name in row):
            if name == "label":
                labels = [row.get("label", "") for row in rows]
                slips = label_slips(labels)
                self.errors += slips
                self.labels["label"] = ("case",), np.array([] if slips else labels, dtype=str)
            elif self._accept(name, "[[cases]]"):
                default = VOCABULARY[name].own.default
                raw = [default if row.get(name) is None else row[name] for row in rows]
                self.values[name] = ("case",), self.checked(name, raw, gaps=True)
        if len(self.errors) == before:  # otherwise the values need not be comparable
            points = [repr(sorted(((k, v) for k, v in row.items() if k != "label"), key=str)) for row in rows]
            self.errors += [f"cases {i} and {j} are the same" for i, j in twins(points)]

    def sample(self, table) -> None:
        """Random cases, drawn as the table [sample] says: the dimension `case`."""
        given = table if isinstance(table, dict) else {}
        known = {name: drawn for name, drawn in given.items() if name in LIMITS or self._accept(name, "[sample]")}
        if "case" in self.sizes:
            self.errors.append("[sample] and [[cases]] both make the dimension case: only one of them is allowed")
            return
        own = {name: VOCABULARY[name].own for name in known if name not in LIMITS}
        before = len(self.errors)
        for name in own:
            if isinstance(known[name], list):  # all of it, since some of its values may not be drawn
                self.checked(name, known[name])
        drawn = draw(known if given else table, own, self.errors)
        for name, values in drawn.items() if len(self.errors) == before else ():
            self.number_cases(len(values))
            self.values[name] = ("case",), self.checked(name, values)

    def array(self, name: str, given) -> None:
        """A DataArray: values over its own dimensions, which may be shared with other parameters."""
        if not self._accept(name, ""):
            return
        for dim, size in zip(map(str, given.dims), given.shape, strict=True):
            self.sizes.setdefault(dim, size)
            coordinate = given.coords[dim].values if dim in given.coords and dim != name else None
            if dim not in PARAMETERS and coordinate is not None:
                self.labels.setdefault(dim, ((dim,), coordinate))
            self.claims.append((name, dim, size, coordinate))
        flat = self.checked(name, given.values.ravel().tolist(), distinct=given.dims == (name,))
        self.values[name] = tuple(map(str, given.dims)), flat.reshape(given.shape)

    def finish(self) -> Grid:
        """Fill in the defaults and check what concerns several parameters."""
        self.errors += one_control(self.sections)
        self._check_dimensions()
        _, laws = self.values.get("micro", ((), ""))  # "" if what was given has been refused
        for name in [name for name in PARAMETERS if name not in self.sections]:
            own = VOCABULARY[name].own  # a parameter of a law that no case has stays away
            selector, owners = own.needed_by
            if own.default is not None and (selector != "micro" or np.isin(laws, owners).any()):
                self.values[name] = (), np.array(own.default)
        self.errors += not_given(self.sections, lambda name: self.values.get(name, ((), ()))[1], self.errors)
        grid = self._grid()
        if not self.errors and wants_a_fit(grid):
            laws, errors = fitted(grid)
            self.values |= laws
            self.errors += errors
            grid = replace(self._grid(), fitted=True)
        if not self.errors:
            self.errors += missing_parameters(grid) + picard_for_nothing(grid)
            self.errors += [] if self.physical else mixed_units(grid)
        self.errors += [] if self.errors else slips_of_laws(grid)
        return grid

    def _grid(self) -> Grid:
        return Grid(self.sizes, {name: self.values[name] for name in PARAMETERS if name in self.values}, self.labels)

    def _accept(self, name: str, section: str) -> bool:
        """Whether the name is known and new; otherwise a message."""
        place = f"{section} " if section else ""
        if not is_parameter(name):
            known = [*PARAMETERS, *["label"] * (section == "[[cases]]")]
            later = len(self.errors) >= MOST_MESSAGES  # and not shown
            self.errors.append(f"{name} is not a parameter" if later else no_parameter(name, known, place))
        elif section == "[model]" and name in NUMERICS:
            self.errors.append(f"{place}{name} belongs in [numerics]")
        elif name in self.sections:
            other = f"in {section}" if section else "elsewhere"
            self.errors.append(f"{name} is given twice: in {self.sections[name]} and {other}")
        else:
            self.sections[name] = section
            return True
        return False

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

    def number_cases(self, count: int) -> None:
        """Make the dimension `case`."""
        self.sizes["case"] = count
        self.labels["case"] = ("case",), np.arange(count, dtype=np.int32)

    def _check_dimensions(self) -> None:
        """Messages for dimensions: names that are taken, sizes or coordinates on which two parameters disagree."""
        if len(self.sizes) > MOST_DIMENSIONS:
            self.errors.append(f"{len(self.sizes)} dimensions: at most {MOST_DIMENSIONS} are allowed")
        for dim in self.sizes:
            if dim in PARAMETERS and self.values.get(dim, ((dim,),))[0] != (dim,):
                self.errors.append(f"{dim} is a dimension and a parameter over other dimensions")
            elif dim in PARAMETERS and dim not in self.sections:
                self.errors.append(f"the dimension {dim} is called like a parameter that is not given: rename it")
            elif dim in VOCABULARY and dim not in PARAMETERS and dim != "case":
                self.errors.append(f'a dimension cannot be called "{dim}", which is the name of a result')
        for name, dim, size, coordinate in self.claims:
            owner = (self.values if dim in PARAMETERS else self.labels).get(dim)
            if size == 0:
                self.errors.append(f"{name} is empty: must have at least one value")
            elif size != self.sizes[dim]:
                self.errors.append(f"{name} has {size} values along {dim}, another parameter has {self.sizes[dim]}")
            elif coordinate is not None and owner is not None and not same_labels(owner[1], coordinate):
                self.errors.append(f"{name} has other values of {dim} than another parameter")
