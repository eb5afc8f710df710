"""The vocabulary of a problem: its micro laws, shapes and profiles by their names, and its table of parameters.

A :class:`Known` is a value that travels with the problem, to other threads and processes too. Only `register` adds to
the vocabulary that every call has, :func:`default`.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import laws, shapes
from ..laws import own_table, trial
from ..laws.law import Law
from ..numerics import profiles
from ..numerics.caches import once, shared_lock
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
    """Micro laws, shapes and profiles by name. It is a value: the methods `with_...` return others.

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
        """Only the user's laws, shapes and profiles are pickled. Another process has those of this package itself, and
        must have the schemes itself."""
        of_users = {name: law for name, law in self.laws.items() if law not in laws.BUILT_IN}
        kinds = {name: kind for name, kind in self.shapes.items() if shapes.SHAPES.get(name) is not kind}
        return _arrived, (of_users, kinds, dict(self.profiles))

    def __copy__(self):
        return self

    def __deepcopy__(self, memo):
        return self

    @once
    def parameters(self) -> NamedRows:
        """Name -> :class:`~solver.parameters.Parameter`: the common ones, those of laws and shapes, and, by their full
        names, those of layers. Raises ValueError if a parameter of a law or a shape has the name of something else."""
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
        """Whether it contains only laws and shapes of this package."""
        return not self.profiles and len(self.laws) == len(laws.LAWS) and len(self.shapes) == len(shapes.SHAPES)

    def table(self, count: int) -> Mapping[str, Parameter]:
        """The parameters, including those of stacks of `count` layers; 0: without those of stacks."""
        if not count:
            return self.parameters
        names = [full_name(number, field) for number in range(1, count + 1) for field in LAYER]
        return self.parameters | {name: self.parameters[name] for name in (*names, "sublayers")}

    def uses(self, name: str, values: Callable[[str], ArrayLike]) -> np.ndarray:
        """(...) bool: the cases whose answer depends on a parameter.

        Parameters
        ----------
        name : name of the parameter
        values : function from the name of a parameter, such as base, to its values, an array of any shape
        """
        return uses(self.parameters.get(name) or CONTROL[name], values)

    def with_law(self, law: Law) -> "Known":
        """A vocabulary with this law, in place of any of the same name. Raises ValueError for a law that is declared
        wrongly."""
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
        """A vocabulary with this shape, in place of any of the same name. Raises ValueError if the name is that of a
        shape of this package."""
        if self.shapes.get(kind.name) is kind:
            return self
        if kind.name in shapes.SHAPES:
            raise ValueError(f"shape {kind.name}: is one of this package: take another name")
        return _checked(replace(self, shapes=MappingProxyType({**self.shapes, kind.name: kind})))

    def with_laws_of(self, micro: Any, names: Iterable[str] = ()) -> "Known":
        """A vocabulary with the laws that are values of `micro`: laws as objects, and new tables "table:FILE". If a
        word, or one of the `names` of parameters, is still unknown, it also has the laws of installed packages.

        Parameters
        ----------
        micro : a name or a law, or several; or an object with a law as its attribute `law`
        names : names of parameters

        Raises
        ------
        ValueError : a table cannot be used; two laws have one name; or something is unknown, and the law of an
            entry point cannot be loaded
        """
        known, words = self, [law_in(word) for word in _flat(micro)]
        _refuse_one_name_of_two(word for word in words if isinstance(word, Law))
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
        """A vocabulary with the new tables "table:FILE" among the words of `shape`. Raises ValueError for a table that
        cannot be used."""
        known = self
        for word in _tables_among(words, table.PREFIX, self.shapes):
            known = known.with_shape(table.read(word))
        return known

    def with_profiles(self, parameters: Mapping[str, Any]) -> "Known":
        """A vocabulary with the new tables of profiles among the parameters. Raises ValueError for a table that cannot
        be used."""
        words = [word for name, value in parameters.items() if name.endswith(".profile")
                 for word in _tables_among(value, profiles.PREFIX, self.profiles)]  # fmt: skip
        tables = {word: profiles.read(word) for word in words}
        return replace(self, profiles=MappingProxyType({**self.profiles, **tables})) if tables else self

    def only(self, parameters: Mapping[str, ArrayLike]) -> "Known":
        """A vocabulary with only those laws, shapes and profiles that the parameters name, and those of this
        package."""
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
        """A vocabulary with the laws of installed packages whose names are not taken; and a list of error messages."""
        known, (pairs, wrong) = self, installed.laws()
        for law, where in pairs:
            if law.name not in self.laws:
                try:
                    known = known.with_law(law)
                except ValueError as error:
                    wrong = [*wrong, f"{where}: {error}"]
        return known, wrong


def names_of(micro: Any) -> Any:
    """`micro`, a value or a list of values, with the names of laws in place of the laws."""
    if isinstance(micro, (list, tuple)):
        return [names_of(each) for each in micro]
    micro = law_in(micro)
    return micro.name if isinstance(micro, Law) else micro


def law_in(micro: Any) -> Any:
    """The law of an object that has one, such as the law of a scan; any other value as it is."""
    law = getattr(micro, "law", None)
    return law if isinstance(law, Law) else micro


def default() -> Known:
    """The vocabulary that every call has: this package, and everything that the program has registered."""
    return _default.known


def register(kind: Law | Kind) -> Law | Kind:
    """Make a law or a shape, and its parameters, available by name to all later calls, in place of one registered
    before.

    To be sent to worker processes with the cases, its functions must have a name in a module that can be imported
    there.

    Parameters
    ----------
    kind : a `solver.Law`, or a `solver.shapes.Kind`

    Returns
    -------
    Law or Kind : `kind`

    Raises
    ------
    ValueError : the name is not allowed, or is that of a law or shape of this package; a law has no version; a
        parameter is declared wrongly, or has the name of something else, or that of another law's parameter with other
        bounds

    Examples
    --------
    docs/own_law.md shows a law in one file. A law of this package is known already, and stays as it is.

    >>> from dataclasses import replace
    >>> register(laws.LAWS["disc_cell"]).name
    'disc_cell'
    >>> register(replace(laws.LAWS["disc_cell"], name="my law"))
    Traceback (most recent call last):
    ValueError: micro law "my law": must have a name of its own, of letters, digits and _
    """
    _default.change(lambda known: known.with_law(kind) if isinstance(kind, Law) else known.with_shape(kind))
    return kind


def register_scheme(name: str) -> None:
    """Make the name of a scheme (:mod:`solver.schemes`) known to all later calls."""
    _default.change(lambda known: known if name in known.schemes else replace(known, schemes=(*known.schemes, name)))


class _Default:
    """The vocabulary that every call has. Changes are atomic: if two threads make one at the same time, both count."""

    def __init__(self, known):
        self.known, self._lock = known, shared_lock()

    def change(self, step):
        with self._lock:
            self.known = step(self.known)


def _checked(known):
    """`known`, after its table of parameters has been made. Raises ValueError if that is not possible."""
    _ = known.parameters
    return known


def _declared_by_laws(known):
    """Name -> row, for the parameters of laws. Raises ValueError if a parameter cannot have its name."""
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
    """Name -> row, for the parameters of shapes. Raises ValueError if a parameter cannot have its name."""
    declared: dict[str, tuple] = {}
    of_laws = {name for law in known.laws.values() for name in law.parameters}
    for kind in known.shapes.values():
        for name, parameter in kind.parameters.items():
            first, words = declared.get(name, (parameter, ()))
            if parameter != first or name in COMMON or name in of_laws:
                raise ValueError(f"shape {kind.name}: the parameter {name} is that of something else")
            declared[name] = first, (*words, kind.name)
    return {name: row._replace(needed_by=("shape", words)) for name, (row, words) in declared.items()}


def _refuse_one_name_of_two(of_call: Iterable[Law]) -> None:
    """Raise ValueError for two different laws of one name: every case with the name would have the last of them."""
    by_name: dict[str, Law] = {}
    for law in of_call:
        first = by_name.setdefault(law.name, law)
        if first is not law and not _are_one(first, law):
            raise ValueError(f'two micro laws of one call are called "{law.name}": give each a name of its own')


def _are_one(law, other):
    """Whether two objects are one law: tables of the same numbers, or copies, whose functions are the same."""
    if laws.identity(law) != laws.identity(other):
        return False
    same = (getattr(law, field.name) == getattr(other, field.name) for field in fields(law))
    return law.name.startswith(own_table.OF_FILES) or all(same)


def _flat(values):
    """All words, laws and so on in a value, an array, or a list of these."""
    if isinstance(values, (list, tuple)):
        return [word for value in values for word in _flat(value)]
    return np.ravel(values).tolist() if hasattr(values, "__array__") else [values]


def _words(values):
    return set(np.unique(values).tolist())


def _tables_among(words, prefix, known):
    """The words "table:FILE" among `words` that are not in `known`, each once, in order."""
    tables = (word for word in _flat(words) if isinstance(word, str) and word.startswith(prefix))
    return dict.fromkeys(word for word in tables if word not in known)


def _arrived(of_users, kinds, tables):
    """A :class:`Known`, put together again in the process to which it was sent."""
    if not (of_users or kinds or tables) and default().schemes == PACKAGE.schemes:
        return PACKAGE
    return Known(
        MappingProxyType({**PACKAGE.laws, **of_users}),
        MappingProxyType({**PACKAGE.shapes, **kinds}),
        MappingProxyType(tables),
        default().schemes,
    )


#: The vocabulary of this package.
PACKAGE = Known(laws.LAWS, shapes.SHAPES, MappingProxyType({}), COMMON["scheme"].choices)
#: The table of its parameters.
PARAMETERS = PACKAGE.parameters
_default = _Default(PACKAGE)
#: Scripts of version 0.1 use this name.
shapes.register = register
