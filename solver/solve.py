"""``solve(problem, x) -> Solution``: each case goes the cheapest way that solves it."""

from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np

from .body import BODIES
from .contact import smooth
from .laws import LAWS
from .models import auto
from .models.model_error import closed_form, judged
from .models.range_of_law import RADII, edge_error, has_range, outside_law
from .scaling import as_cases, dimensionless, refused, restore, with_a_stiff_base, with_rigid_punch, without_springs
from .schemes import SCHEMES
from .solution import Solution
from .status import Status
from .threads import one_blas_thread


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN and a status
def solve(problem, x=(0.0, 1.0)):
    """:class:`~solver.solution.Solution` of a batch of cases: one row a case, in the order of the problem and in its
    units. A case that cannot be solved is a status and NaN.

    problem : :class:`~solver.problem.Problem`, cases of any mixture of bases, micro laws, bondings and schemes
    x : (m,), radii r/a in [0, 1] at which the profiles p and λ are wanted (else ValueError)

    Smooth on a half-space is Hertz's closed form; smooth on a thin layer one linear solve; rough cases, and all on the
    exact layer, iterate by their scheme. Successive approximations are for asperities: a smooth case with the scheme
    "picard" is ``Status.INVALID_INPUT``. The base "auto" is the cheapest model that meets `accuracy`. That may be a
    smooth punch, to which the asperities are added afterwards: then `scheme` has no effect.

    >>> from solver import Problem
    >>> layer, asperities = {"h": 0.02, "n": 0.5, "base": "thin_layer"}, {"Nbar": 250000, "Ra": 0.004}
    >>> case = Problem.of(a=0.04, **layer, **asperities, micro="power_law", B=0.1, beta=0.5)
    >>> print(f"{solve(case).P[0]:.5e}")
    2.70408e-05
    """
    x = np.asarray(x, dtype=float)
    if x.ndim != 1 or not np.all((x >= 0) & (x <= 1)):
        raise ValueError("x must be one-dimensional and within [0, 1]")
    radii = np.append(x, RADII) if has_range(problem) else x
    found = _solved(problem, radii, refused(problem, dimensionless(problem)) | problem.without_scheme())
    return found if radii is x else replace(found, p=found.p[:, : len(x)], lam=found.lam[:, : len(x)])


def _of_a_model(problem, x):
    """:func:`solve` of cases that :mod:`.models` has made from allowed ones. Their own parameters need not be within
    the bounds."""
    return _solved(problem, x, problem.without_scheme())


def _solved(given, x, invalid):
    """:func:`solve` of the problem `given`; `invalid` (B,) bool: cases that are not to be solved."""
    problem = with_a_stiff_base(with_rigid_punch(given))
    scaled = dimensionless(problem)
    no_springs = ~invalid & without_springs(scaled)
    status = np.select([invalid, no_springs], [Status.INVALID_INPUT, Status.THIN_LAYER_NOT_APPLICABLE], 0)
    size = len(problem), len(x)
    pieces = [(np.arange(len(problem)), Solution.of(*size, status=status))]
    for mask, solver in _routes(problem, ~(invalid | no_springs)):
        if mask.any():
            index = np.flatnonzero(mask)
            pieces.append((index, solver(scaled.take(index), x)))
    found = Solution.join(*size, pieces)
    missed = (found.status == Status.CONVERGED) & ~(found.error <= problem.rtol)
    found.status[missed] = Status.TOLERANCE_NOT_MET
    solution = _with_models(given, restore(found, problem))
    solution = solution.refused(outside_law(given, solution), Status.OUTSIDE_LAW)
    return replace(solution, **{given.control: given.value * 1.0})  # exactly as given, also where a case is refused


def _routes(problem, solvable):
    """(mask (B,), solver) of each way to solve: the mask is True for its cases."""
    half_space, thin, is_auto = (problem.base == base for base in ("half_space", "thin_layer", "auto"))
    is_judged, is_smooth = thin & (problem.model_check == "first_order"), ~problem.rough()
    yield solvable & is_judged, partial(judged, solve=_of_a_model)
    yield solvable & is_auto, partial(auto.cheapest, solve=_of_a_model)
    yield solvable & is_smooth & half_space, _smooth_half_space
    yield solvable & is_smooth & thin & ~is_judged, _smooth_layer
    iterated = solvable & ~is_judged & ~is_auto & ~(is_smooth & (half_space | thin))
    # of each kind the words that occur, and the cases that have them
    kinds = (LAWS, problem.micro), (BODIES, problem.base), (SCHEMES, problem.scheme)
    present = ([(word, words == word) for word in known if np.any(words == word)] for known, words in kinds)
    for (_, of_law), (_, on_body), (scheme, by_scheme) in product(*present):
        chosen = iterated & of_law & on_body & by_scheme
        for limit in np.unique(problem.max_iterations[chosen]):
            yield chosen & (problem.max_iterations == limit), SCHEMES[scheme]


def _smooth_half_space(part, x):
    return smooth.half_space(part.control, part.value, x)


def _smooth_layer(part, x):
    return smooth.thin_layer(part.control, part.value, as_cases(part).body.C, part.rtol, part.nodes, x)


def _with_models(problem, solution):
    """The solution with `model_used` and `model_error` of the cases whose base was asked for by name. `model_error` of
    all cases is at least the :func:`.range_of_law.edge_error`."""
    named, thin = problem.base != "auto", problem.base == "thin_layer"
    solved, error = np.isfinite(solution.p0), np.array(solution.model_error)
    error[solved & named & ~thin] = 0.0
    judged = np.flatnonzero(solved & thin & (problem.model_check == "closed_form"))
    if len(judged):
        error[judged] = closed_form(problem.take(judged), solution.a[judged])
    error += sum(law.error * (named & (problem.micro == name)) for name, law in LAWS.items())
    error = np.maximum(error, edge_error(problem, solution))
    used = np.where(named, auto.model_of(problem), solution.model_used)
    return replace(solution, model_used=used, model_error=error)
