"""A block: some cases of a study, and all that a worker needs to solve them, wherever it is.

Imports neither xarray nor netCDF4: a worker process starts in half the time without them, and takes 44 MB less.
"""

import traceback
from dataclasses import dataclass

import numpy as np

from solver import NUMERICS_VERSION, Problem, Solution, laws, solve
from solver.laws import Law

from ..spec.definition import Definition
from ..spec.grid import columns
from ..spec.vocabulary import CONTROLS, INTEGERS, names


@dataclass(frozen=True, eq=False)
class Parcel:
    """Cases to be solved.

    first, last : numbers of its first and last case; parameters : name -> (n,) or (1,) for all its cases; x : (m,);
    numerics : version of the solver's numerics that is wanted; laws : those that a worker may not have registered
    """

    first: int
    last: int
    parameters: dict[str, np.ndarray]
    x: np.ndarray
    profiles: tuple[str, ...]
    numerics: str
    laws: tuple[Law, ...] = ()


@dataclass(frozen=True)
class Failure:
    """A block that raised: the message and where."""

    message: str
    trace: str


def parcel(definition: Definition, index: np.ndarray) -> Parcel:
    """The cases at `index` (n,), n > 0."""
    found = columns(definition.grid, index)
    found = {name: array if definition.grid.values[name][0] else array[:1] for name, array in found.items()}
    own = tuple(laws.LAWS[name] for name in set(found["micro"].tolist()) if laws.LAWS[name].version)
    return Parcel(int(index[0]), int(index[-1]), found, definition.x, definition.profiles, NUMERICS_VERSION, own)


def compute(wanted: Parcel) -> dict[str, np.ndarray]:
    """Solve a parcel: name -> (n, ...). Touches no file and no shared state: may run in any thread, on any machine."""
    for law in wanted.laws:
        laws.register(law)
    return arrays_of(solve(Problem.of(**wanted.parameters), wanted.x), wanted.profiles)


def arrays_of(solution: Solution, profiles: tuple[str, ...]) -> dict[str, np.ndarray]:
    """The columns that are stored, by their names in the vocabulary: (B,), and (B, m) of the wanted profiles."""
    special = {"lam0": solution.lam[:, 0], "nodes_used": solution.nodes}
    kept = (*CONTROLS, *names("result"), *INTEGERS)
    found = {name: special[name] if name in special else getattr(solution, name) for name in kept}
    found |= {name: getattr(solution, name) for name in profiles}
    return {name: np.asarray(array, dtype=INTEGERS.get(name, np.float64)) for name, array in found.items()}


def guarded(wanted: Parcel) -> dict[str, np.ndarray] | Failure:
    """`compute`, with an exception as a value."""
    try:
        if wanted.numerics != NUMERICS_VERSION:
            raise RuntimeError(f"the worker has version {NUMERICS_VERSION} of the numerics, not {wanted.numerics}")
        return compute(wanted)
    except Exception as error:
        message = f"cases {wanted.first} to {wanted.last}: {type(error).__name__}: {error}"
        return Failure(message, traceback.format_exc())


def cut(missing: np.ndarray, size: int, part: tuple[int, int] = (1, 1)) -> list[np.ndarray]:
    """The numbers of the missing cases in runs of at most `size`.

    part : (i, n), only those of the i-th of n parts. Which cases these are depends on `size` alone, not on what is
        missing: parts that start at different times share no case.
    """
    mine = missing[missing // size % part[1] == part[0] - 1]
    return [mine[start : start + size] for start in range(0, len(mine), size)]
