"""What the words of a problem mean: its micro laws, shapes and profiles by their names, and its table of parameters.

A :class:`Known` is a value that travels with the problem, to other threads and processes too. `register` adds to what
calls know by themselves, :func:`default`; nothing else does.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import laws, shapes
from ..laws import own_table, trial
from ..laws.law import Law
from ..numerics import profiles
from ..numerics.kept import once, shared_lock
from ..parameters import COMMON, CONTROL, COUPLED, LAYER, LAYERED, NamedRows, Parameter, full_name, uses
from ..parameters import row as row_of_layer
from ..shapes import table
from ..shapes.shape import Kind
from . import installed

__all__ = ["PACKAGE", "PARAMETERS", "RESERVED", "Known", "default", "register"]

#: Names that no parameter of a law can have: the attributes of a Problem, and E and nu, which `scales` gets. The
#: package `study` adds results and its other inputs.
_OF_PROBLEM = (
    *("control", "value", "parameters", "known", "of", "take", "but", "rough", "invalid", "may_pull", "without_scheme"),
    *("can_feel", "feels_layer"),
)
RESERVED = {*CONTROL, *_OF_PROBLEM, "E", "nu"}


@dataclass(frozen=True, eq=False)
class Known:
    """Micro laws, shapes and profiles by name; a value, of which the methods `with_...` make others.

    Attributes
    ----------
    laws : name -> :class:`~solver.laws.Law`
    shapes : name -> :class:`~solver.shapes.Kind`
    profiles : word "table:FILE" of a graded layer -> its :class:`~solver.numerics.profiles.Profile`
    schemes : names of the schemes
    """

    laws: Mapping[str, Law]
    shapes: Mapping[str, Kind]
    profiles: Mapping[str, profiles.Profile]
    schemes: tuple[str, ...]

    def __repr__(self):
        names = [
            name for name in (*self.laws, *self.shapes, *self.profiles) if name not in {*laws.LAWS, *shapes.SHAPES}
        ]
        return f"Known({', '.join(['what this package has', *names])})"

    def __reduce__(self):
        """What this package has stays at home, and so do schemes, which other processes must have themselves."""
        of_users = {name: law for name, law in self.laws.items() if law not in laws.BUILT_IN}
        kinds = {name: kind for name, kind in self.shapes.items() if shapes.SHAPES.get(name) is not kind}
        return _arrived, (of_users, kinds, dict(self.profiles))

    def __copy__(self):
        return self

    def __deepcopy__(self, memo):
        return self

    @once
    def parameters(self) -> NamedRows:
        """Name -> :class:`~solver.parameters.Parameter`: the common ones, those of the laws and of the shapes, and by
        their names those of layers. ValueError where a law or a shape gives a parameter a name of something else."""
        rows = {**COMMON, **_declared_by_laws(self), **_declared_by_shapes(self)}
        rows["scheme"] = rows["scheme"]._replace(choices=self.schemes)
        rows["micro"] = rows["micro"]._replace(choices=tuple(self.laws))
        rows["shape"] = rows["shape"]._replace(choices=tuple(self.shapes))
        of_laws = "micro", tuple(law.name for law in self.laws.values() if law.on_body)
        rows["asperities_on"] = rows["asperities_on"]._replace(used_by=of_laws)
        of_laws = "micro", tuple(law.name for law in self.laws.values() if law.poisson)
        rows["nu1"] = rows["nu1"]._replace(used_by=(*COUPLED, *of_laws))
        rows["nu2"] = rows["nu2"]._replace(needed_by=(*LAYERED, *of_laws), used_by=(*COUPLED, *of_laws))
        return NamedRows(rows, lambda name: row_of_layer(name, self.profiles))

    @property
    def is_package(self) -> bool:
        """Whether all of it is of this package."""
        return not self.profiles and len(self.laws) == len(laws.LAWS) and len(self.shapes) == len(shapes.SHAPES)

    def table(self, count: int) -> Mapping[str, Parameter]:
        """The parameters with those of stacks of `count` layers among them; 0 : without these."""
        if not count:
            return self.parameters
        names = [full_name(number, field) for number in range(1, count + 1) for field in LAYER]
        return self.parameters | {name: self.parameters[name] for name in (*names, "sublayers")}

    def uses(self, name: str, values: Callable[[str], ArrayLike]) -> np.ndarray:
        """(...) bool: the cases whose answer depends on a parameter.

        Parameters
        ----------
        name : of the parameter
        values : a function: name of a parameter such as base -> its values, an array of any shape
        """
        return uses(self.parameters.get(name) or CONTROL[name], values)

    def with_law(self, law: Law) -> "Known":
        """With a law, in place of one of its name. Raises ValueError for a law that is declared wrongly."""
        if self.laws.get(law.name) is law:
            return self
        taken = self.laws.get(law.name, law) in laws.BUILT_IN
        if taken or not re.fullmatch(rf"[A-Za-z]\w*|({'|'.join(own_table.OF_FILES)}).+", law.name):
            raise ValueError(f'micro law "{law.name}": must have a name of its own, of letters, digits and _')
        if not (law.version and isinstance(law.version, str)):
            raise ValueError(f"micro law {law.name}: version must be a text, which changes whenever its numbers may")
        if wrong := trial.declaration(law):
            raise ValueError(f"micro law {law.name}: {wrong}")
        return _checked(replace(self, laws=MappingProxyType({**self.laws, law.name: law})))

    def with_shape(self, kind: Kind) -> "Known":
        """With a shape, in place of one of its name. Raises ValueError for the name of one of this package."""
        if self.shapes.get(kind.name) is kind:
            return self
        if kind.name in shapes.SHAPES:
            raise ValueError(f"shape {kind.name}: is one of this package: take another name")
        return _checked(replace(self, shapes=MappingProxyType({**self.shapes, kind.name: kind})))

    def with_laws_of(self, micro: Any, names: Iterable[str] = ()) -> "Known":
        """With what the values of `micro` are: laws as objects, and tables "table:FILE" that are not known yet. Where a
        word, or one of the `names` of parameters, is not known, with the laws of installed packages too.

        Parameters
        ----------
        micro : a name or a law, or several; or what has a law as its attribute `law`
        names : of parameters

        Raises
        ------
        ValueError : a table cannot be used; or something is not known, and a law of an entry point cannot be had
        """
        known, words = self, [law_in(word) for word in _flat(micro)]
        for word in words:
            if isinstance(word, str) and word.startswith(own_table.PREFIX) and word not in self.laws:
                known = known.with_law(own_table.read(word))
            elif isinstance(word, Law):
                known = known.with_law(word)
        words = {word for word in words if isinstance(word, str)}
        if known._has(names, words):
            return known
        known, wrong = known._with_installed()
        if wrong and not known._has(names, words):
            raise ValueError("\n".join(wrong))
        return known

    def with_tips(self, words: Any) -> "Known":
        """With the tables "table:FILE" among the words of `shape` that are not known yet; ValueError."""
        known = self
        for word in _tables_among(words, table.PREFIX, self.shapes):
            known = known.with_shape(table.read(word))
        return known

    def with_profiles(self, parameters: Mapping[str, Any]) -> "Known":
        """With the tables of profiles that stand among the parameters and are not known yet; ValueError."""
        words = [word for name, value in parameters.items() if name.endswith(".profile")
                 for word in _tables_among(value, profiles.PREFIX, self.profiles)]  # fmt: skip
        tables = {word: profiles.read(word) for word in words}
        return replace(self, profiles=MappingProxyType({**self.profiles, **tables})) if tables else self

    def only(self, parameters: Mapping[str, ArrayLike]) -> "Known":
        """With those laws, shapes and profiles alone, beside the ones of this package, that the parameters name."""
        profile = [name for name in parameters if name.endswith(".profile")] if self.profiles else []
        named = {name: _words(parameters.get(name, ())) for name in ("micro", "shape", *profile)}
        named_laws = {name: law for name, law in self.laws.items() if law in laws.BUILT_IN or name in named["micro"]}
        kinds = {name: kind for name, kind in self.shapes.items() if name in shapes.SHAPES or name in named["shape"]}
        tables = {word: rows for word, rows in self.profiles.items() if any(word in named[name] for name in profile)}
        if (len(named_laws), len(kinds), len(tables)) == (len(self.laws), len(self.shapes), len(self.profiles)):
            return self
        return Known(*map(MappingProxyType, (named_laws, kinds, tables)), self.schemes)

    def _has(self, names, words):
        return all(name in self.parameters for name in names) and words <= {*self.laws}

    def _with_installed(self):
        """With the laws of installed packages of which it has none of the name; and texts of what is wrong."""
        known, (pairs, wrong) = self, installed.laws()
        for law, where in pairs:
            if law.name not in self.laws:
                try:
                    known = known.with_law(law)
                except ValueError as error:
                    wrong = [*wrong, f"{where}: {error}"]
        return known, wrong


def names_of(micro: Any) -> Any:
    """The values of `micro`, or of a list of them, with names in place of laws."""
    if isinstance(micro, (list, tuple)):
        return [names_of(each) for each in micro]
    micro = law_in(micro)
    return micro.name if isinstance(micro, Law) else micro


def law_in(micro: Any) -> Any:
    """The law of what has one, such as the law of a scan; everything else as it is."""
    law = getattr(micro, "law", None)
    return law if isinstance(law, Law) else micro


def default() -> Known:
    """What a call knows that names nothing of its own: this package, and what the program has registered."""
    return _default.known


def register(kind: Law | Kind) -> Law | Kind:
    """Make a law, or a shape, known by its name to all later calls, in place of one registered before, and its
    parameters like any other.

    To travel to worker processes with the cases, its functions must have a name in a module that can be imported there.

    Parameters
    ----------
    kind : a `solver.Law`, or a `solver.shapes.Kind`

    Returns
    -------
    Law or Kind : the same

    Raises
    ------
    ValueError : the name is not allowed, or is that of a law or shape of this package; a law has no version; a
        parameter is declared wrongly, or has the name of something else, or of one of another law with other bounds

    Examples
    --------
    docs/own_law.md has a law in one file.
    """
    _default.change(lambda known: known.with_law(kind) if isinstance(kind, Law) else known.with_shape(kind))
    return kind


def register_scheme(name: str) -> None:
    """Make the name of a scheme (:mod:`solver.schemes`) known to all later calls."""
    _default.change(lambda known: known if name in known.schemes else replace(known, schemes=(*known.schemes, name)))


class _Default:
    """What calls know by themselves. A change is a step of its own: of two that come at once both count."""

    def __init__(self, known):
        self.known, self._lock = known, shared_lock()

    def change(self, step):
        with self._lock:
            self.known = step(self.known)


def _checked(known):
    """The same, whose table of parameters has been made: ValueError where it cannot."""
    _ = known.parameters
    return known


def _declared_by_laws(known):
    """Name -> row of the parameters of laws. ValueError where one cannot have its name."""
    declared: dict[str, tuple] = {}
    of_shapes = {name for kind in known.shapes.values() for name in kind.parameters}
    for law in known.laws.values():
        for name, parameter in law.parameters.items():
            first, names = declared.get(name, (parameter, ()))
            if name in RESERVED or name in COMMON or name in of_shapes:
                raise ValueError(f"micro law {law.name}: the name of the parameter {name} is that of something else")
            if parameter != first:
                reason = f"another interval, default, unit or words than that of {names[0]}: give it another name"
                raise ValueError(f"micro law {law.name}: the parameter {name} has {reason}")
            declared[name] = first, (*names, law.name)
    return {name: row._replace(needed_by=("micro", names)) for name, (row, names) in declared.items()}


def _declared_by_shapes(known):
    """Name -> row of the parameters of shapes. ValueError where one cannot have its name."""
    declared: dict[str, tuple] = {}
    of_laws = {name for law in known.laws.values() for name in law.parameters}
    for kind in known.shapes.values():
        for name, parameter in kind.parameters.items():
            first, words = declared.get(name, (parameter, ()))
            if parameter != first or name in COMMON or name in of_laws:
                raise ValueError(f"shape {kind.name}: the parameter {name} is that of something else")
            declared[name] = first, (*words, kind.name)
    return {name: row._replace(needed_by=("shape", words)) for name, (row, words) in declared.items()}


def _flat(values):
    """The words, laws and so on of one value, an array, or a list of such."""
    if isinstance(values, (list, tuple)):
        return [word for value in values for word in _flat(value)]
    return np.ravel(values).tolist() if hasattr(values, "__array__") else [values]


def _words(values):
    return set(np.unique(values).tolist())


def _tables_among(words, prefix, known):
    """The words "table:FILE" among others that are not known yet, each once, in order."""
    tables = (word for word in _flat(words) if isinstance(word, str) and word.startswith(prefix))
    return dict.fromkeys(word for word in tables if word not in known)


def _arrived(of_users, kinds, tables):
    """A :class:`Known` in the process to which it was sent."""
    if not (of_users or kinds or tables) and default().schemes == PACKAGE.schemes:
        return PACKAGE
    return Known(
        MappingProxyType({**PACKAGE.laws, **of_users}),
        MappingProxyType({**PACKAGE.shapes, **kinds}),
        MappingProxyType(tables),
        default().schemes,
    )


#: What this package has.
PACKAGE = Known(laws.LAWS, shapes.SHAPES, MappingProxyType({}), COMMON["scheme"].choices)
#: The table of its parameters.
PARAMETERS = PACKAGE.parameters
_default = _Default(PACKAGE)
#: The name that scripts of version 0.1 have for it.
shapes.register = register
