"""Whether the model describes the contacts at first yield."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from solver.shapes import ROUND
from solver.solve import solve
from solver.yields.crossing import Crossing

from ..arrays.labelled import Labelled
from ..data.contacts import Contacts
from ..data.dataset import validity_of_rows
from ..inputs.identity import is_strength
from ..inputs.punch.micro_laws import results_of
from ..rules.rule import RULES, broken, of_cases, validity_attributes
from ..work.cases import arrays_of


def validity_at(contacts: Contacts, crossing: Crossing) -> np.ndarray:
    """`validity` of the contact at the first yield of each case, (B,) int32; 0 without a yield, or a load."""
    flags, rows = np.zeros(len(contacts.problem), np.int32), np.flatnonzero(crossing.numbers["P"] > 0)
    if not len(rows):
        return flags
    problem = contacts.problem.take(rows)
    # at its radius a contact takes the tables of one octave of h/a alone; not every shape has one at each load
    name = "a" if np.isin(problem.shape, ROUND).all() else "P"
    problem = replace(problem, control=name, value=crossing.numbers[name][rows])
    solution = solve(problem)
    # without strengths: their masks say that a body yields, which is known at these loads
    numbers = {name: value for name, value in problem.parameters.items() if not is_strength(name)}
    radii = contacts.scene.radii() if contacts.scene else {}
    results = results_of(problem.known.laws, problem.micro, felt=bool(problem.feels_layer().any()))
    numbers |= {name: contacts.column(value.to_xarray())[rows] for name, value in radii.items()}
    flags[rows] = validity_of_rows(numbers | arrays_of(solution, results, ()), problem.known).values
    return flags


def sentences_on(flags: np.ndarray) -> str:
    """A sentence for each assumption that contacts of this `validity` violate; "" if all hold."""
    violated = broken(Labelled("case", flags, validity_attributes()))
    return " ".join(of_cases(where) + RULES[name].sentence for name, where in violated.items() if where.any())
