"""Rules that compare the stresses of a contact with the strengths of its bodies and asperities."""

import numpy as np

from solver import Problem, Status, solve
from solver.laws import LAWS
from solver.laws.elastic_plastic import TABOR
from solver.parameters import one_of
from solver.yields import spots
from solver.yields.contact import of_contacts

from ..inputs.vocabulary import CONTROLS, NUMERICS, parameters_of
from .rule import have, rule

_BODIES = {"Y1": "mises1", "Y2": "mises2"}
#: The coarse grid misses at most this part of a stress, and has at most so much more: between, the stress is computed.
_MISSED, _MORE = 0.15, 1e-3


@rule(512, "a body would yield", "0.63")
def body_yields(v, times):
    """A body would yield: von Mises' stress in it exceeds its yield strength. The results are those of bodies that stay
    elastic."""
    known = [name for name in _BODIES if np.isfinite(v[name]).any()]
    found = np.False_
    for name in known:
        limit = times * np.broadcast_to(v[name], v["status"].shape)
        stored = _BODIES[name] in v
        found = found | ((v[_BODIES[name]] if stored else _stress(v, _BODIES[name], limit)) > limit)
    return found


@rule(1024, "asperities would yield", "0.65")
def asperities_yield(v, times):
    """The asperities would yield: on the axis of a spot the stress exceeds the yield strength, from hardness or
    yield_strength. The real area is then larger than this one, and pmax smaller (micro = "elastic_plastic")."""
    Y = np.where(np.isnan(v["yield_strength"]), v["hardness"] / TABOR, v["yield_strength"])
    elastic = have("rough", v["micro"]) & ~one_of(v["micro"], [name for name, law in LAWS.items() if law.yielded])
    limit = np.broadcast_to(np.where(elastic, times * Y, np.nan), v["status"].shape)
    index = np.flatnonzero(np.isfinite(limit))
    if not len(index):
        return np.False_
    problem, solution = again(v, index)
    found = np.zeros(limit.shape, dtype=bool)
    found.flat[index] = spots.of_contacts(problem, solution)[0] > limit.flat[index]
    return found


def _stress(v, name, limit):
    """The largest stress of a body, where it is near the limit; elsewhere that of the coarse grid."""
    index, found = np.flatnonzero(np.isfinite(limit)), np.full(limit.shape, np.nan)
    problem, solution = again(v, index)
    value = of_contacts(problem, solution, names=(name,), coarse=True)[name][0]
    near = np.flatnonzero((value < (1 + _MORE) * limit.flat[index]) & (value > (1 - _MISSED) * limit.flat[index]))
    if len(near):
        value[near] = of_contacts(problem.take(near), solution.take(near), names=(name,))[name][0]
    found.flat[index] = value
    return found


def again(v, index, x=(0.0, 1.0)):
    """The problem of some of the cases, given by their radii, and what it was solved with; profiles at the radii x."""
    shape = v["status"].shape
    own = {name: v[name] for name in parameters_of(v) if name in v and name not in (*NUMERICS, *CONTROLS)}
    own = {name: np.broadcast_to(values, shape).ravel()[index] for name, values in {"a": v["a"], **own}.items()}
    problem = Problem.of(**own)
    solution, solved = solve(problem, x), v["status"].ravel()[index] == Status.CONVERGED
    solution.status[~solved] = Status.INVALID_INPUT
    return problem, solution
