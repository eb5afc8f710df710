"""Cases are packed into parcels, which hold all that a worker needs to solve them, on any machine.

This module imports neither xarray nor netCDF4: without them a worker process starts in half the time and takes 44 MB
less.
"""

import pickle
import traceback
from dataclasses import dataclass

import numpy as np

from solver import NUMERICS_VERSION, Problem, Solution, laws, sensitivities, solve
from solver.laws import Law
from solver.laws.trial import going_on

from ..inputs.definition import Definition
from ..inputs.grid import columns
from ..inputs.vocabulary import BY_INPUT, CONTROLS, INTEGERS


@dataclass(frozen=True, eq=False)
class Parcel:
    """Cases to be solved.

    first, last : numbers of the first and the last case
    parameters : name -> (n,), or (1,) for all cases
    x : (m,) points of the profiles; results, profiles : names of those that are wanted
    inputs : of the solver, by which derivatives are wanted
    stresses : names of the largest stresses and their places that are wanted
    numerics : version of the solver's numerics that is wanted
    laws : micro laws that the worker may not have registered
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
    laws: tuple[Law, ...] = ()


@dataclass(frozen=True)
class Failure:
    """A block that raised: the message and where."""

    message: str
    trace: str


def parcel(definition: Definition, index: np.ndarray) -> Parcel:
    """The parcel of the cases numbered `index` (n,), n > 0."""
    found = columns(definition.grid, index)
    found = {name: array if definition.grid.values[name][0] else array[:1] for name, array in found.items()}
    own = tuple(own_laws(found["micro"]))
    wanted = definition.x, definition.results, definition.profiles, definition.inputs, definition.stresses
    return Parcel(int(index[0]), int(index[-1]), found, *wanted, NUMERICS_VERSION, own)


def own_laws(micro: np.ndarray) -> list[Law]:
    """The laws among the words of `micro` that are not of this package."""
    return [law for law in map(laws.LAWS.get, set(micro.ravel().tolist())) if law not in laws.BUILT_IN]


def can_travel(definition: Definition) -> bool:
    """Whether another process can have the micro laws of a study: functions with a name, in a module that it can
    import, which the program itself is not."""
    for law in own_laws(definition.grid.values["micro"][1]):
        if any(getattr(part, "__module__", "") == "__main__" for part in vars(law).values() if callable(part)):
            return False
        try:
            pickle.dumps(law)
        except (pickle.PicklingError, AttributeError, TypeError):
            return False
    return True


def compute(wanted: Parcel) -> dict[str, np.ndarray]:
    """Solve a parcel: name -> (n, ...). Touches no file and no shared state: may run in any thread, on any machine."""
    for law in wanted.laws:
        laws.register(law)
    with going_on():  # the functions of a law of one's own
        problem = Problem.of(**wanted.parameters)
        solution = solve(problem, wanted.x)
        arrays = arrays_of(solution, wanted.results, wanted.profiles)
        arrays |= stresses_of(problem, solution) if wanted.stresses else {}
        return arrays | (derivatives_of(problem, solution, wanted) if wanted.inputs else {})


def arrays_of(solution: Solution, results: tuple[str, ...], profiles: tuple[str, ...]) -> dict[str, np.ndarray]:
    """What is stored of a solution: name in the vocabulary -> (B,), and (B, m) of the wanted profiles."""
    special = {"lam0": solution.lam[:, 0], "nodes_used": solution.nodes}
    kept = (*CONTROLS, *results, *INTEGERS)
    found = {name: special[name] if name in special else getattr(solution, name) for name in kept}
    found |= {name: getattr(solution, name) for name in profiles}
    return {name: np.asarray(array, dtype=INTEGERS.get(name, np.float64)) for name, array in found.items()}


def stresses_of(problem: Problem, solution: Solution) -> dict[str, np.ndarray]:
    """The largest stresses and their places: NAME, NAME_r, NAME_z -> (B,)."""
    from solver.yields.contact import of_contacts  # most studies want none

    found = of_contacts(problem, solution)
    return {
        f"{name}{end}": array for name, own in found.items() for end, array in zip(("", "_r", "_z"), own, strict=True)
    }


def derivatives_of(problem: Problem, solution: Solution, wanted: Parcel) -> dict[str, np.ndarray]:
    """NAME_by_input -> (B, k), and (B, k, m) of profiles, in the units of the solution."""
    solved = sensitivities(problem, solution, wanted.x if wanted.profiles else wanted.x[:1], wanted.inputs)
    found = {name: by * getattr(solution, name)[:, None] for name, by in solved.logs.items()}
    found |= {"lam0": solved.lam[..., 0]} | {name: getattr(solved, name) for name in wanted.profiles}
    return {f"{name}{BY_INPUT}": array for name, array in found.items()}


def guarded(wanted: Parcel) -> dict[str, np.ndarray] | Failure:
    """`compute`; an exception is returned as a Failure."""
    try:
        if wanted.numerics != NUMERICS_VERSION:
            raise RuntimeError(f"the worker has version {NUMERICS_VERSION} of the numerics, not {wanted.numerics}")
        return compute(wanted)
    except Exception as error:
        message = f"cases {wanted.first} to {wanted.last}: {type(error).__name__}: {error}"
        return Failure(message, traceback.format_exc())


def blocks_of(missing: np.ndarray, size: int, part: tuple[int, int] = (1, 1)) -> list[np.ndarray]:
    """The missing cases cut into blocks of at most `size`: the numbers of the cases of each.

    part : (i, n), only the i-th of n parts. Which cases belong to a part does not depend on what is missing, so that
        parts that start at different times share no case
    """
    mine = missing[missing // size % part[1] == part[0] - 1]
    return [mine[start : start + size] for start in range(0, len(mine), size)]
