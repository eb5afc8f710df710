"""`solve` and `solve_at_radii`: each case is solved by the cheapest way for it, or without its pull-off."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from .bases import is_chosen, is_stack, named, on_springs
from .body.graded import is_graded
from .models.auto import cheapest
from .models.law_error import beyond_end, has_yield, left_out, radii_of, without_family
from .models.model_error import judged
from .models.named import model_of, solve_named
from .models.plastic_share import plastic_share
from .models.spot_pressure import pressure_in_spots
from .models.sublayers import solve_graded
from .models.table_ends import beyond_table
from .numerics.threads import one_blas_thread
from .problem import Problem
from .scaling import dimensionless, refused, restore, with_a_stiff_base, with_rigid_punch
from .shapes import shaped
from .smooth.contact import kinds_of, sticking
from .solution import Solution
from .status import Status
from .ways import unfit

#: Contacts whose error is above this are solved with their pull-off, in whose terms errors are then.
_SURE = 1e-6


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN and a status
def solve(problem: Problem, x: ArrayLike = (0.0, 1.0), *, extrapolate: bool = False) -> Solution:
    """Solve a batch of cases. A case that cannot be solved has a status and NaN.

    A smooth punch on a half-space is Hertz's closed form; a smooth punch on a thin layer is one linear system. Rough
    cases, and all cases on the exact layer, iterate by their scheme. Successive approximations are for asperities: a
    smooth case with the scheme "picard" gets ``Status.INVALID_INPUT``. The base "auto" is the cheapest model that meets
    `accuracy`. That may be a smooth punch, to which the asperities are added afterwards: then `scheme` has no effect.

    Parameters
    ----------
    problem : :class:`~solver.problem.Problem`, cases with any mixture of bases, micro laws, bondings and schemes
    x : (m,), radii r/a in [0, 1] of the profiles p and λ
    extrapolate : whether a contact has numbers even if its spots, which feel the coated body, are too large for their
        law. Beyond its end the curves of the law are straight lines in their logarithms

    Returns
    -------
    Solution : one row for each case, in the order of the problem and in its units; the equations are in docs/model.md

    Raises
    ------
    ValueError : x is not one-dimensional, or not within [0, 1]

    Examples
    --------
    >>> from solver import Problem
    >>> layer, asperities = {"h": 0.02, "n": 0.5, "base": "thin_layer"}, {"Nbar": 250000, "Ra": 0.004}
    >>> case = Problem.of(a=0.04, **layer, **asperities, micro="power_law", B=0.1, beta=0.5)
    >>> print(f"{solve(case).P[0]:.5e}")
    2.70408e-05
    """
    x = np.asarray(x, dtype=float)
    if x.ndim != 1 or not np.all((x >= 0) & (x <= 1)):
        raise ValueError("x must be one-dimensional and within [0, 1]")
    felt = problem.feels_layer()
    if not felt.any() or felt.all():
        return _solved(problem, x, extrapolate)
    # cases that feel the layer have further radii, which must not change the other cases by rounding
    parts = [(index, problem.take(index)) for index in (np.flatnonzero(~felt), np.flatnonzero(felt))]
    return Solution.join(len(problem), len(x), [(index, _solved(part, x, extrapolate)) for index, part in parts])


def _solved(problem, x, extrapolate):
    """:func:`solve` for cases whose asperities all feel the layer, or of which none feels it."""
    yields, felt = has_yield(problem).any(), problem.feels_layer()
    radii = np.append(x, radii_of(problem, yields))
    scaled, special = dimensionless(problem), shaped(problem) | (problem.w_adhesion > 0) | felt
    invalid = refused(problem, scaled) | problem.without_scheme() | unfit(scaled)
    hopeless = ~invalid & felt & without_family(problem)
    if np.any(exact := special & is_chosen(problem.base)):
        problem = problem.but(base=np.where(exact, named(problem.base), problem.base))
    is_auto = is_chosen(problem.base)
    is_judged = on_springs(problem.base) & (is_stack(problem.base) | (problem.model_check == "first_order"))
    graded = is_graded(problem)
    size = len(problem), len(radii)
    pieces = []
    rest = ~(is_judged | is_auto | graded)
    for mask, way in (is_judged, judged), (is_auto, cheapest), (graded, solve_graded), (rest, solve_named):
        index = np.flatnonzero(mask & ~invalid & ~hopeless)
        if len(index):
            part = problem if len(index) == len(problem) else problem.take(index)
            pieces.append((index, way(part, radii)))
    unsolved = np.where(hopeless, Status.OUTSIDE_LAW, Status.INVALID_INPUT)
    solution = Solution.join(*size, pieces, status=unsolved, model_used=model_of(problem))
    if shaped(problem).any():
        outside = ~invalid & beyond_table(scaled, solution)
        solution = solution.refused(outside, Status.OUTSIDE_LAW)
    if not extrapolate and felt.any():
        solution = solution.refused(~invalid & beyond_end(problem, solution), Status.OUTSIDE_LAW)
    new = {"model_error": solution.model_error + left_out(problem, solution)}
    if yields:
        new["plastic_share"] = plastic_share(problem, solution.lam[:, len(x) :])
    if not extrapolate and felt.any():  # the last of their radii is the centre
        new["p_spot"], new["r_spot"] = pressure_in_spots(problem, solution, solution.lam[:, -1])
    new |= {name: getattr(solution, name)[:, : len(x)] for name in ("p", "lam")}
    new[problem.control] = problem.value * 1.0  # exactly as given, even if a case is refused
    return replace(solution, **new)


@one_blas_thread()
@np.errstate(all="ignore")
def solve_at_radii(problem: Problem, x: np.ndarray) -> Solution:
    """The :class:`Solution` of smooth contacts with w > 0 given by their radii, at the radii x (m,); P_off, D_off,
    a_off, P_in, a_in are 0, and `stable` is True. Graded layers, and contacts that lose their digits, have all
    numbers, and take as long as by :func:`~solver.solve.solve`."""
    if problem.control != "a" or not (problem.w_adhesion > 0).all() or problem.rough().any():
        raise ValueError("for smooth contacts with adhesion that are given by their radii")
    problem = problem.but(base=named(problem.base))
    if is_graded(problem).any():
        return solve(problem, x)
    rigid = with_a_stiff_base(with_rigid_punch(problem))
    part, size = dimensionless(rigid), (len(problem), len(x))
    pieces = [(index, sticking(part.take(index), x, ends=False)) for index in kinds_of(part)]
    solution = restore(Solution.join(*size, pieces), rigid)
    sure = (solution.status == Status.CONVERGED) & (solution.error <= _SURE) | (solution.status == Status.OUTSIDE_LAW)
    rest = np.flatnonzero(~sure)
    if not len(rest):
        return solution
    pieces = [(np.flatnonzero(sure), solution.take(sure)), (rest, solve(problem.take(rest), x))]
    return Solution.join(*size, pieces)
