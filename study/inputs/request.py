"""What a call of Python or a study file asks for, in one form for both, and its numbers and words without units."""

import math
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..specimen.foreign import plain
from ..specimen.quantities import Quantity, has_unit
from ..terminal import shown
from .grid import as_array, equal_values
from .lexicon import Lexicon, default, lexicon_for, lexicon_of
from .punch.scan_words import with_scans
from .punch.shapes import ANGLES, PREFIX, WORDS, as_written, in_degrees
from .sample import LIMITS, LONGEST_AXIS, range_values, sampled
from .scene.scene import INFINITE
from .scene.stacks import in_call, in_tables, is_of_layers
from .vocabulary import BODIES, NUMERICS, SCENE, Parameter, finite, no_parameter

MOST_MESSAGES = 30  # shown for a study at a time
#: Attributes `units` of pure numbers. pint writes "dimensionless".
PURE = ("1", "", "dimensionless")
#: Inputs that are names of objects.
OBJECTS = ("micro", "shape")
#: Bounds of load and depth under adhesion.
_PULLED = "[-1000, 1000]"
#: The end of a message about `same_piece`.
NEEDS_NAMES = (
    "no two of punch, layer and body are of one material by name, such as punch and body of PMMA; leave it out"
)


@dataclass(frozen=True)
class AnyValue:
    """The value of an input that a contact must have but on which nothing depends: the number if inputs have no units,
    otherwise the text."""

    number: float
    text: str


@dataclass
class Input:
    """A parameter as written in the call or file: numbers, texts, quantities of pint, or names of materials.

    section : of the study file, "" in Python
    dims : its dimensions, () of a single value
    values : list of its values, None for a case that lacks it. A range is a dict until it is read. None if there is a
        mistake in it
    array : the DataArray, if it is one; then `values` is None
    """

    name: str
    section: str = ""
    dims: tuple[str, ...] = ()
    values: Any = None
    array: Any = None

    @property
    def shape(self) -> tuple[int, ...]:
        return self.array.shape if self.array is not None else (len(self.values),) if self.dims else ()

    @property
    def unit(self) -> str:
        """The unit of a DataArray; "1" of pure numbers."""
        unit = "1" if self.array is None else self.array.attrs.get("units", "1")
        return "1" if unit in PURE else unit

    @property
    def is_wrong(self) -> bool:
        """Whether the input was refused and has no values."""
        return self.array is None and self.values is None

    @property
    def has_unit(self) -> bool:
        """Whether the input, or one of its values, has a unit or a spread."""
        if self.array is not None:
            return self.unit != "1"
        values = self.values.values() if isinstance(self.values, dict) else self.values
        values = list(values) if isinstance(self.values, (dict, list)) else []
        pure = {*map(type, values)} <= {float, int}  # quick: of most long lists
        return not pure and any(type(value) is Quantity or has_unit(value) for value in values)

    def at(self, place: list[int]) -> Any:
        """The value at a place, one index for each dimension; None for a number from a range or a material."""
        if self.array is not None:
            return f"{self.array.values[tuple(place)]:g}" + f" {self.unit}" * (self.unit != "1")
        value = self.values[place[0] if place else 0]
        return None if type(value) is Quantity else value


@dataclass
class Request:
    """All inputs of a call or of a study file, in one form, and what has been read of them.

    errors : messages, without the name of the file
    inputs : name -> input; cases come before axes, as `case` is the first dimension
    sections : name -> the section of the file where it stands, "" in Python
    rows : of [[cases]]; sample : the section of this name
    labels : of the cases
    same_piece : whether bodies of one material are one piece of it
    correlations : pair of inputs -> correlation of their spreads
    sign : the input, in words, that makes this a study with units; "" if none does. It has a unit, or exists only in
        such studies
    lexicon : what its words stand for
    values, sizes : of the parameters and dimensions that have been read, as those of a Grid
    """

    errors: list[str] = field(default_factory=list)
    inputs: dict[str, Input] = field(default_factory=dict)
    sections: dict[str, str] = field(default_factory=dict)
    rows: list[dict] = field(default_factory=list)
    sample: Any = None
    labels: list[str] = field(default_factory=list)
    same_piece: bool = False
    correlations: Any = field(default_factory=dict)
    sign: str = ""
    lexicon: Lexicon = field(default_factory=default)
    values: dict[str, tuple[tuple[str, ...], np.ndarray]] = field(default_factory=dict)
    sizes: dict[str, int] = field(default_factory=dict)

    @property
    def physical(self) -> bool:
        """Whether the request has units."""
        return bool(self.sign)

    @classmethod
    def in_python(cls, parameters: dict, rows: list[dict], same_piece: Any, correlations: Any) -> "Request":
        """Parameters of a call: DataArrays, 1-D sequences or single values, and rows of cases."""
        request = cls(correlations=correlations, lexicon=lexicon_for((parameters, *rows)))  # laws have parameters
        request._same_piece(same_piece, "")
        if any(is_of_layers(name) for table in (parameters, *rows) for name in table):
            parameters, rows = in_call(parameters, rows, request.errors)
        if rows:
            request._cases(rows)
        for name, value in parameters.items():
            value = plain(value)
            if hasattr(value, "dims") and hasattr(value, "shape"):  # a Dataset has no shape
                request._add(Input(name, "", tuple(map(str, value.dims)), array=value))
            elif isinstance(value, (list, range)) or (isinstance(value, tuple) and name != "layer"):
                request._add(Input(name, "", (name,), list(value[: LONGEST_AXIS + 1])))  # a range may be endless
            else:
                request._add(Input(name, "", (), [value]))
        return request._decided()

    @classmethod
    def in_file(cls, tables: dict, errors: list[str]) -> "Request":
        """The sections of a study file; [model], [axes] and [numerics] are tables."""
        request = cls(errors)
        tables, stack = in_tables(tables, errors)
        pairs = tables.get("correlations", {})
        if isinstance(pairs, dict) and all(isinstance(row, dict) for row in pairs.values()):
            pairs = {(first, second): value for first, row in pairs.items() for second, value in row.items()}
        request.correlations = pairs
        for name, value in tables["numerics"].items():
            if name in NUMERICS:
                request._add(Input(name, "[numerics]", (), [value]))
        for name, value in tables["model"].items():
            if name == "same_piece":
                request._same_piece(value, "[model] ")
            else:
                request._add(Input(name, "[model]", (), [value]))
        for name, value in stack.items():
            request._add(Input(name, "[[layers]]", (), [value]))
        if "cases" in tables:
            request._cases(tables["cases"])
        if "sample" in tables:
            request.sample = table = tables["sample"]
            for name in (name for name in table if name not in LIMITS) if isinstance(table, dict) else ():
                request._add(Input(name, "[sample]", ("case",), table[name]))
            if request.rows:
                errors.append("[sample] and [[cases]] both make the dimension case: only one of them is allowed")
        for name, value in tables["axes"].items():
            request._add(Input(name, "[axes]", (name,), value))
        return request._decided()

    def _same_piece(self, value: Any, place: str) -> None:
        value = plain(value)
        if not isinstance(value, bool):
            self.errors.append(f"{place}same_piece = {shown(value)}: must be true or false")
        self.same_piece = value is True

    def _cases(self, rows: Any) -> None:
        """Rows of parameters: values over the dimension `case`."""
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
            self.errors.append("cases must be [[cases]] tables (a list of dictionaries)")
            return
        if not rows:
            self.errors.append("cases is empty: must have at least one case")
            return
        self.rows = rows = [{name: plain(value) for name, value in row.items()} for row in rows]
        for name in dict.fromkeys(name for row in rows for name in row):
            if name != "label":
                self._add(Input(name, "[[cases]]", ("case",), [row.get(name) for row in rows]))
                continue
            self.labels = [row.get(name, "") for row in rows]
            if not all(isinstance(label, str) for label in self.labels):
                self.labels = []
                self.errors.append("[[cases]] label: must be text")
            self.errors += equal_values(name, [label or i for i, label in enumerate(self.labels)])

    def _add(self, entry: Input) -> None:
        """Add an input, unless it has been added already or is in a wrong section."""
        name, section = entry.name, entry.section
        if name == "same_piece":
            self.errors.append("same_piece is for all cases alike: true or false, no axis and not in cases")
        elif section == "[model]" and name in NUMERICS:
            self.errors.append(f"{section} {name} belongs in [numerics]")
        elif name in self.sections:
            other = f"in {section}" if section else "elsewhere"
            self.errors.append(f"{name} is given twice: in {self.sections[name]} and {other}")
        elif not (name in SCENE or name in BODIES or self._is_parameter(name)):
            place = f"{section} " if section else ""
            names = [*self.lexicon.parameters, *SCENE, *BODIES, *["label"] * (section == "[[cases]]")]
            later = len(self.errors) >= MOST_MESSAGES  # and not shown
            self.errors.append(f"{name} is not a parameter" if later else no_parameter(name, names, place))
        else:
            if section in ("[model]", "[numerics]", "[[layers]]") and isinstance(entry.values[0], (list, dict)):
                self.errors.append(f"{section} {name} has several values: these belong in [axes]")
                entry.values = None
            self._turn(entry)
            self._learn_profiles(entry)
            self.sections[name], self.inputs[name] = section, entry

    def learn(self, micro: list) -> None:
        """Add the laws that the values of `micro` stand for to the lexicon: objects, tables, scans, laws of installed
        packages. Raises ValueError for a law that cannot be used."""
        self.lexicon = lexicon_of(with_scans(self.lexicon.known, micro).with_laws_of(micro))

    def _learn_profiles(self, entry: Input) -> None:
        if entry.name.endswith(".profile") and not entry.is_wrong:
            values = entry.values if entry.array is None else entry.array.values
            try:
                self.lexicon = lexicon_of(self.lexicon.known.with_profiles({entry.name: values}))
            except ValueError as error:
                self.errors.append(f"layers: {error}")

    def learn_shapes(self, words: list) -> None:
        """Add the tables among the words of `shape` to the lexicon. Raises ValueError for one that cannot be used."""
        self.lexicon = lexicon_of(self.lexicon.known.with_tips(words))

    def _is_parameter(self, name: str) -> bool:
        """Whether this is the name of a parameter. Before it says no it looks at the laws of installed packages."""
        if name not in self.lexicon.parameters:
            with suppress(ValueError):  # a law that cannot be loaded is an error when `micro` names it
                self.lexicon = lexicon_of(self.lexicon.known.with_laws_of((), [name]))
        return name in self.lexicon.parameters

    def _turn(self, entry: Input) -> None:
        """Convert the numbers of an angle to degrees."""
        if entry.name not in ANGLES or entry.is_wrong:
            return
        try:
            if entry.array is not None:
                entry.array = in_degrees(entry.name, entry.array)
            else:
                entry.values = in_degrees(entry.name, entry.values)
        except ValueError as error:
            self.errors.append(str(error))
            entry.array = entry.values = None

    def _decided(self) -> "Request":
        """The request itself, with its `sign`, numbers or texts in place of each `AnyValue`, and cases before axes."""
        signs = [entry for name, entry in self.inputs.items() if name in SCENE or name in BODIES or entry.has_unit]
        for entry in sorted(signs, key=lambda entry: bool(entry.dims))[:1]:  # a single value rather than several
            values = [value for value in entry.values if value is not None] if isinstance(entry.values, list) else []
            value = next(filter(has_unit, values), values[0] if values else entry.values)
            self.sign = f"the unit of {entry.name}" if entry.array is not None else f"{entry.name} = {shown(value)}"
        for entry in self.inputs.values():
            if not entry.dims and entry.values and type(any_value := entry.values[0]) is AnyValue:
                entry.values = [any_value.text if self.physical else any_value.number]
        if self.same_piece and not self.physical:
            self.errors.append(f"same_piece: {NEEDS_NAMES}")
        if self.correlations and not self.physical:
            self.errors.append("correlations: no input has a spread here, since none has a unit")
        order = {"[[cases]]": 0, "[sample]": 0, "[model]": 2, "[[layers]]": 2}
        self.inputs = dict(sorted(self.inputs.items(), key=lambda pair: order.get(pair[1].section, 1)))
        return self

    def expand(self) -> None:
        """Make ranges and [sample] lists of values."""
        if self.sample is not None:
            names = [name for name, entry in self.inputs.items() if entry.section == "[sample]"]
            columns = sampled(self, names, self.checked)
            for name in names:
                self.inputs[name].values = columns.get(name)
        for name, entry in self.inputs.items():
            if entry.dims == (name,) and entry.array is None:
                is_range = isinstance(entry.values, dict)
                entry.values = range_values(name, entry.values, self) if is_range else self._listed(name, entry.values)
                entry.values = entry.values or None

    def _listed(self, key: str, raw: Any) -> list:
        """The values of an axis. Wrong input: messages, []."""
        if not isinstance(raw, list):
            form = "must be a list or {start, stop, num, spacing}; a single value belongs in [model]"
            self.errors.append(f"{key} = {shown(raw)}: {form}")
        elif not raw:
            self.errors.append(f"{key} is empty: must have at least one value")
        elif len(raw) > LONGEST_AXIS:
            self.errors.append(f"{key} is too long: at most {LONGEST_AXIS} values are allowed")
        else:
            return raw
        return []

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
        if name in OBJECTS:
            try:
                raw = self._named(name, raw)
            except ValueError as error:
                self.errors.append(f"{name}: {error}")
                return np.empty(len(raw))
        if name.endswith(".profile") and any(self._is_without_file(word) for word in raw):
            return np.empty(len(raw))
        raw = as_written(raw) if name in WORDS else raw
        endless = INFINITE.get(name, ())
        raw = [math.inf if isinstance(value, str) and value.lower() in endless else value for value in raw]
        array = as_array(row_of(name, self.sections, self.lexicon), raw, name, self.errors, gaps)
        if len(self.errors) > before and len(raw) == 1:
            self.errors[-1] += pull_hint(name, raw[0], self.sections)
        if distinct and len(self.errors) == before:
            self.errors += equal_values(name, array.tolist())
        return array

    def _is_without_file(self, word: Any) -> bool:
        """Whether a word is a table of a profile that could not be read: the request has said why."""
        is_table = isinstance(word, str) and word.startswith(PREFIX)
        return is_table and word not in self.lexicon.known.profiles

    def _named(self, name: str, raw: list) -> list:
        """The values of `micro` or `shape` as names that the lexicon has. Raises ValueError for what cannot be used."""
        if name == "micro":
            self.learn(raw)
            return self.lexicon.names_of(raw)
        words = as_written(raw)
        try:
            self.learn_shapes(words)
        except ValueError as error:
            raise ValueError(str(error).removeprefix("shape ")) from None
        return words


def row_of(name: str, sections: Any, lexicon: Lexicon) -> Parameter:
    """The row of a parameter in a call that gives `sections`: under adhesion load and depth may be 0 and negative."""
    row = lexicon.parameter(name)
    return row._replace(interval=_PULLED) if name in ("P", "D") and "w_adhesion" in sections else row


def pull_hint(name: str, value: Any, sections: Any) -> str:
    """The end of a message about a load or depth that only a punch that sticks has; "" for others."""
    pulls = name in ("P", "D") and "w_adhesion" not in sections and finite(value) and value <= 0
    return "; a pull needs w_adhesion, the work of adhesion" * pulls
