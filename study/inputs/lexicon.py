"""The meaning of the words in a call, a study or results: the vocabulary, with the additions of users' laws and
shapes."""

import json
from collections import ChainMap
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from solver import Problem
from solver.known import PACKAGE as OF_SOLVER
from solver.known import RESERVED, Known, names_of
from solver.known import default as known_by_default
from solver.laws import Law, name_in, own_table
from solver.numerics.caches import once
from solver.parameters import CONTROL, NamedRows, Parameter, among

from .vocabulary import BODIES, PARAMETERS, SCENE, VOCABULARY, Entry, Names, parameters_of_layers

#: The key of the encoding of the coordinate `micro`, where a dataset has its laws, shapes and tables. Encodings stay
#: with a dataset, and are not written to files.
KNOWN = "known"
#: The attribute of results that has the tables of the laws of scans, name -> text, in JSON.
TABLES = "scan_laws"


@dataclass(frozen=True, eq=False)
class Lexicon:
    """The words of a call, a study or results: the rows of this package, and the additions of users' laws and shapes.

    known : the laws, shapes and tables of profiles that the words stand for
    """

    known: Known

    def __reduce__(self):
        return lexicon_of, (self.known,)

    @once
    def of_users(self) -> dict[str, Entry]:
        """The rows of parameters that laws and shapes declare but this package lacks."""
        rows = {}
        for law in self.known.laws.values():
            for name, row in law.parameters.items():
                owners = " and ".join(other.name for other in self.known.laws.values() if name in other.parameters)
                words = row.long_name or f"parameter of the micro law {owners}"
                rows.setdefault(name, Entry(name, "roughness", words, row.symbol or name, row.powers))
        for kind in self.known.shapes.values():
            for name, row in kind.parameters.items():
                words = row.long_name or f"parameter of the shape {kind.name}"
                rows.setdefault(name, Entry(name, "shape", words, row.symbol or name, row.powers))
        return {name: row for name, row in rows.items() if name not in PARAMETERS}

    @once
    def rows(self) -> NamedRows:
        """Name -> row of each parameter, result and coordinate."""
        return NamedRows({**VOCABULARY, **self.of_users}, VOCABULARY.further)

    @once
    def all_rows(self) -> Mapping[str, Entry]:
        """The rows, and those of SCENE."""
        return ChainMap(self.rows, SCENE)

    @once
    def parameters(self) -> Names:
        """Names of parameters."""
        return Names((*PARAMETERS, *self.of_users))

    def parameter(self, name: str) -> Parameter:
        """The row of a parameter in the solver's table: bounds, choices, default, which cases need it."""
        row = CONTROL.get(name) or self.known.parameters.get(name) or Parameter()
        interval = (self.rows.get(name) or SCENE[name]).interval
        return row._replace(interval=interval) if interval else row

    def parameters_of(self, names: Iterable[str]) -> list[str]:
        """Names of all parameters of inputs, also for the layers that the `names` of inputs mention."""
        return [*self.parameters, *parameters_of_layers(names)]

    def problem(self, numbers: Mapping[str, Any], **changed: Any) -> Problem:
        """The problem of a table of numbers, such as those of a scene or of the cases of a grid.

        numbers : name -> one value, or (B,); names that are no parameters have no effect
        changed : parameters with other values; a control replaces the control among the numbers
        """
        left_out = {*changed, *(CONTROL if {*changed} & {*CONTROL} else ())}
        names = [name for name in self.parameters_of(numbers) if name in numbers and name not in left_out]
        return Problem.of(known=self.known, **{name: numbers[name] for name in names}, **changed)

    def cases_with(self, name: str, values) -> np.ndarray:
        """bool: the cases that have a parameter.

        values : a function: name of a parameter such as base -> its values
        """
        return among(self.parameter(name).needed_by, values)

    def matters(self, name: str, values) -> bool:
        """Whether the answer of some case may depend on a parameter; `values` as in `cases_with`."""
        parameter = self.parameter(name)
        return all(
            any(np.any(among(pair, values)) for pair in zip(condition[::2], condition[1::2], strict=True))
            for condition in (parameter.needed_by, parameter.used_by)
        )

    def names_of(self, micro: list) -> list:
        """The values of `micro` with names in place of laws."""
        return names_of(micro)

    def law_or_name(self, micro: str) -> Law | str:
        """The value of `micro` for another call: the law itself if it is a user's, otherwise its name."""
        return micro if micro in PACKAGE.known.laws else self.known.laws[micro]

    def smooth_laws(self) -> list[str]:
        """Names of the laws without asperities."""
        return [name for name, law in self.known.laws.items() if not law.rough]


@lru_cache(maxsize=64)
def lexicon_of(known: Known) -> Lexicon:
    """The lexicon of laws, shapes and tables."""
    return Lexicon(known)


def default() -> Lexicon:
    """The lexicon of this package, and of the laws and shapes that the program has registered."""
    return lexicon_of(known_by_default())


PACKAGE = lexicon_of(OF_SOLVER)
"""The lexicon of this package alone."""

# A parameter of a law must not have the name of a result, or of another argument of `study.solve`.
RESERVED.update({*VOCABULARY, "cases", "profiles", "title", "workers"} - set(OF_SOLVER.parameters))
RESERVED.update(f"{name}_spread" for name in VOCABULARY)
RESERVED.update(SCENE, BODIES)


def lexicon_for(tables: Iterable[Mapping[str, Any]], names: Iterable[str] = ()) -> Lexicon:
    """The lexicon of a call. It lacks laws that cannot be used: the reading of `micro` gives their messages.

    tables : parameters, cases; names : of parameters, for which laws of installed packages are looked at
    """
    known, words = known_by_default(), [table.get("micro") for table in tables]
    try:
        known = known.with_laws_of(words)
    except ValueError:  # the others are as they should be, and so are their parameters
        for word in words:
            with suppress(ValueError):
                known = known.with_laws_of(word)
    with suppress(ValueError):
        known = known.with_laws_of((), names)
    return lexicon_of(known)


def encoding_of(lexicon: Lexicon, values: Mapping[str, Any]) -> dict:
    """The encoding of the coordinate `micro` of results: empty if all laws and shapes are of this package.

    values : parameter -> its values
    """
    subset = lexicon.known.only(values)
    return {} if subset.is_package else {KNOWN: subset}


def with_known(dataset: Any, lexicon: Lexicon, values: Mapping[str, Any]) -> Any:
    """The dataset itself, which now knows the lexicon of its solution; `values` as for :func:`encoding_of`."""
    if "micro" in dataset.variables:
        lexicon = lexicon_of(_with_tables(lexicon.known, dataset.attrs))
        dataset.variables["micro"].encoding |= encoding_of(lexicon, values)
    return dataset


def lexicon_in(contact: Any) -> Lexicon:
    """The lexicon with which a dataset, one contact, or variables by name were solved.

    Results from a file have the lexicon of the program, with the laws of installed packages that the results name, and
    with the laws of scans, whose tables the results have. A table of the user's is not read: whoever sends a results
    file must not choose which files are opened.
    """
    if "micro" in contact and KNOWN in contact["micro"].encoding:
        return lexicon_of(contact["micro"].encoding[KNOWN])
    there, stated = known_by_default(), getattr(contact, "attrs", {}).get("micro_laws", "")
    for line in stated.splitlines() if isinstance(stated, str) else ():
        if (name := name_in(line)) not in there.laws and not name.startswith(own_table.OF_FILES):
            with suppress(ValueError):  # otherwise the law stays unknown
                there = there.with_laws_of(name)
    return lexicon_of(_with_tables(there, getattr(contact, "attrs", {})))


def _with_tables(known: Known, attributes: Mapping[str, Any]) -> Known:
    """With the laws of scans whose tables stand among the attributes of results. What is no such table counts for
    nothing."""
    with suppress(ValueError, TypeError, AttributeError):
        tables, lines = json.loads(attributes.get(TABLES, "{}")), attributes.get("micro_laws", "").splitlines()
        versions = {name_in(line): line.rpartition(" ")[2] for line in lines}
        for name, text in tables.items():
            if name in versions and name.startswith(own_table.OF_SCAN):
                known = known.with_law(own_table.of_scan(name, text, versions[name]))
    return known
