"""What the words of a call, a study or results stand for: the vocabulary, with what laws and shapes of users add."""

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
from solver.numerics.kept import once
from solver.parameters import CONTROL, NamedRows, Parameter, among

from .vocabulary import BODIES, PARAMETERS, SCENE, VOCABULARY, Entry, Names, parameters_of_layers

#: The key of the encoding of the coordinate `micro`, where a dataset has its laws, shapes and tables. Encodings stay
#: with a dataset, and are not written to files.
KNOWN = "known"
#: The attribute of results that has the tables of the laws of scans, name -> text, in JSON.
TABLES = "scan_laws"


@dataclass(frozen=True, eq=False)
class Lexicon:
    """The words of a call, a study or results: the rows of this package, and what their own laws and shapes add.

    known : the laws, shapes and tables of profiles that the words stand for
    """

    known: Known

    def __reduce__(self):
        return lexicon_of, (self.known,)

    @once
    def of_users(self) -> dict[str, Entry]:
        """The rows of parameters that laws and shapes declare and this package has not."""
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
        """Names of all parameters that inputs may have, those of the layers too which are among the `names` of some."""
        return [*self.parameters, *parameters_of_layers(names)]

    def problem(self, numbers: Mapping[str, Any], **changed: Any) -> Problem:
        """The problem of numbers by name, such as those of a scene or of cases of a grid: one value, or (B,), each.

        numbers : what is no parameter among them counts for nothing
        changed : parameters with other values; a control takes the place of that of the numbers
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
        """What says to another call which law is meant: the law itself of a user's, else its name."""
        return micro if micro in PACKAGE.known.laws else self.known.laws[micro]

    def smooth_laws(self) -> list[str]:
        """Names of the laws without asperities."""
        return [name for name, law in self.known.laws.items() if not law.rough]


@lru_cache(maxsize=64)
def lexicon_of(known: Known) -> Lexicon:
    """The lexicon of what is known."""
    return Lexicon(known)


def default() -> Lexicon:
    """The lexicon of this package, and of what the program has registered."""
    return lexicon_of(known_by_default())


PACKAGE = lexicon_of(OF_SOLVER)
"""The lexicon of this package alone."""

# A law must not call a parameter like a result, or like another argument of `study.solve`.
RESERVED.update({*VOCABULARY, "cases", "profiles", "title", "workers"} - set(OF_SOLVER.parameters))
RESERVED.update(f"{name}_spread" for name in VOCABULARY)
RESERVED.update(SCENE, BODIES)


def lexicon_for(tables: Iterable[Mapping[str, Any]], names: Iterable[str] = ()) -> Lexicon:
    """The lexicon of a call, as far as it can be had: what is wrong with a law is told where `micro` is read.

    tables : parameters, cases; names : of parameters, for which laws of installed packages are looked at
    """
    known = known_by_default()
    for micro, wanted in (([table.get("micro") for table in tables], ()), ((), names)):
        with suppress(ValueError):
            known = known.with_laws_of(micro, wanted)
    return lexicon_of(known)


def encoding_of(lexicon: Lexicon, values: Mapping[str, Any]) -> dict:
    """The encoding of the coordinate `micro` of results: empty where all is of this package.

    values : parameter -> its values
    """
    own = lexicon.known.only(values)
    return {} if own.is_package else {KNOWN: own}


def with_known(dataset: Any, lexicon: Lexicon, values: Mapping[str, Any]) -> Any:
    """The dataset itself, of results that were solved with the lexicon; `values` as of :func:`encoding_of`."""
    if "micro" in dataset.variables:
        lexicon = lexicon_of(_with_tables(lexicon.known, dataset.attrs))
        dataset.variables["micro"].encoding |= encoding_of(lexicon, values)
    return dataset


def lexicon_in(contact: Any) -> Lexicon:
    """The lexicon of a dataset, of one contact, or of variables by name: what it was solved with.

    Of results of a file it is that of the program, with the laws of installed packages that the results name, and with
    the laws of scans, whose tables the results have. A table of the user's is not read: whoever sends a results file
    must not choose which files are opened.
    """
    if "micro" in contact and KNOWN in contact["micro"].encoding:
        return lexicon_of(contact["micro"].encoding[KNOWN])
    there, stated = known_by_default(), getattr(contact, "attrs", {}).get("micro_laws", "")
    for line in stated.splitlines() if isinstance(stated, str) else ():
        if (name := name_in(line)) not in there.laws and not name.startswith(own_table.OF_FILES):
            with suppress(ValueError):  # then it stays unknown
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
