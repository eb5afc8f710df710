"""Parcels of cases, with everything that a worker on any machine needs to solve them.

This module imports neither xarray nor netCDF4: without them a worker process starts in half the time and takes 44 MB
less.
"""

import pickle
import traceback
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solver import NUMERICS_VERSION, Problem, Solution, sensitivities, solve
from solver.known import Known
from solver.laws import BUILT_IN, Law
from solver.laws.trial import going_on
from solver.layers import numbers_of

from ..inputs.definition import Definition
from ..inputs.grid import columns
from ..inputs.vocabulary import BY_INPUT, CONTROLS, INTEGERS, TRUTHS
from ..terminal import short_of_memory


@dataclass(frozen=True, eq=False)
class Parcel:
    """Cases to be solved.

    first, last : numbers of the first and the last case
    parameters : name -> (n,), or (1,) for all cases
    x : points of the profiles, (m,)
    results, profiles : names of the wanted results and profiles
    inputs : of the solver, for the wanted derivatives
    stresses : names of the wanted largest stresses and their places
    numerics : wanted version of the solver's numerics
    known : laws, shapes and tables of users for which words in the parameters stand
    """

    first: int
    last: int
    parameters: dict[str, np.ndarray]
    x: np.ndarray
    results: tuple[str, ...]
    profiles: tuple[str, ...]
    inputs: tuple[str, ...]
    stresses: tuple[str, ...]
    numerics: str
    known: Known


@dataclass(frozen=True)
class Failure:
    """The reason why a block has no results: the message of an exception, and its traceback."""

    message: str
    trace: str


def parcel(definition: Definition, index: Sequence) -> Parcel:
    """The parcel of the cases numbered `index` (n,), n > 0."""
    parameters = columns(definition.grid, np.asarray(index))
    parameters = {name: array if definition.grid.values[name][0] else array[:1] for name, array in parameters.items()}
    wanted = definition.x, definition.results, definition.profiles, definition.inputs, definition.stresses
    known = definition.grid.lexicon.known.only(parameters)
    return Parcel(int(index[0]), int(index[-1]), parameters, *wanted, NUMERICS_VERSION, known)


def laws_of_users(known: Known, micro: np.ndarray) -> list[Law]:
    """The laws for the words of `micro` that do not belong to this package."""
    return [law for word in set(micro.ravel().tolist()) if (law := known.laws[word]) not in BUILT_IN]


def can_travel(definition: Definition) -> bool:
    """Whether the micro laws of a study can be sent to another process.

    Their functions must have names, in a module that the process can import. The running program is not such a module.
    """
    for law in laws_of_users(definition.grid.lexicon.known, definition.grid.values["micro"][1]):
        if any(getattr(part, "__module__", "") == "__main__" for part in vars(law).values() if callable(part)):
            return False
        try:
            pickle.dumps(law)
        except (pickle.PicklingError, AttributeError, TypeError):
            return False
    return True


def compute(task: Parcel) -> dict[str, np.ndarray]:
    """Solve a parcel: name -> (n, ...). It uses no file and no shared state: any thread, on any machine, may run it."""
    with going_on():  # for the functions of a user's law
        problem = Problem.of(known=task.known, **task.parameters)
        solution = solve(problem, task.x)
        arrays = arrays_of(solution, task.results, task.profiles)
        arrays |= stresses_of(problem, solution, task.stresses) if task.stresses else {}
        return arrays | (derivatives_of(problem, solution, task) if task.inputs else {})


def arrays_of(solution: Solution, results: tuple[str, ...], profiles: tuple[str, ...]) -> dict[str, np.ndarray]:
    """The stored arrays of a solution: name in the vocabulary -> (B,), profiles (B, m)."""
    special = {"lam0": solution.lam[:, 0], "nodes_used": solution.nodes}
    names = (*CONTROLS, *results, *INTEGERS)
    arrays = {name: special[name] if name in special else getattr(solution, name) for name in names}
    arrays |= {name: getattr(solution, name) for name in profiles}
    return {name: np.asarray(array, dtype=(INTEGERS | TRUTHS).get(name, np.float64)) for name, array in arrays.items()}


def stresses_of(problem: Problem, solution: Solution, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    """The largest stresses and their places: those of the `names` NAME, NAME_r, NAME_z -> (B,), or (B, N) over the N
    layers or interfaces of stacks."""
    from solver.yields.below import central_spot
    from solver.yields.contact import of_contacts  # here, since most studies want no stresses
    from solver.yields.stacked.mixture import of_mixture

    of_bodies = of_mixture if numbers_of(problem.parameters) else of_contacts
    places, columns = {("", "_r", "_z"): of_bodies(problem, solution)}, {}
    if {*central_spot.SPOT_EXTREMES} & {*names}:
        places["", "_z"] = central_spot.of_contacts(problem, solution)
    for ends, stresses in places.items():
        for name, parts in stresses.items():
            columns |= {f"{name}{end}": part for end, part in zip(ends, parts, strict=True)}
    return columns


def derivatives_of(problem: Problem, solution: Solution, task: Parcel) -> dict[str, np.ndarray]:
    """NAME_by_input -> (B, k), and (B, k, m) of profiles, in the units of the solution."""
    solved = sensitivities(problem, solution, task.x if task.profiles else task.x[:1], task.inputs)
    derivatives = solved.slopes | {"lam0": solved.lam[..., 0]} | {name: getattr(solved, name) for name in task.profiles}
    return {f"{name}{BY_INPUT}": array for name, array in derivatives.items()}


def guarded(task: Parcel) -> dict[str, np.ndarray] | Failure:
    """`compute`; an exception is returned as a Failure."""
    try:
        if task.numerics != NUMERICS_VERSION:
            raise RuntimeError(f"the worker has version {NUMERICS_VERSION} of the numerics, not {task.numerics}")
        return compute(task)
    except Exception as error:
        what = f"{type(error).__name__}: {error}"
        if short_of_memory(error):
            what = f"MemoryError: {error}; a smaller `block` of [numerics] takes less"
        message = f"cases {task.first} to {task.last}: {what}"
        return Failure(message, traceback.format_exc())


def blocks_of(missing: Sequence, size: int, part: tuple[int, int] = (1, 1)) -> list[Sequence]:
    """The missing cases, cut into blocks of at most `size`: the numbers of the cases of each block.

    part : (i, n), only the i-th of n parts. Cases belong to parts by their numbers, whichever cases are missing, so
        that parts that start at different times share no case
    """
    mine = missing[missing // size % part[1] == part[0] - 1] if part[1] > 1 else missing
    return [mine[start : start + size] for start in range(0, len(mine), size)]
