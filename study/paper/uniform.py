"""The paper's own way: a uniform mesh in r, successive approximations from p = 0, and the radius by halving.

The paper gives Eqs (8) and (10), the parameter k and the search for the contact radius by halving; mesh and stopping
rule it does not give. Here they are chosen in its favour: pressure linear between uniform nodes, the singular kernel
integrated exactly against that, a new approximation until it moves by no more than the tolerance, at each radius from
the pressure at the radius before, which halves their number. It serves for comparison: :func:`solve` of the package
needs a tenth of the nodes and of the steps.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.special import ellipkm1

from solver.contact import picard
from solver.contact.results import quantities
from solver.numerics.bracket import bisection
from solver.numerics.quadrature import gauss_legendre
from solver.scaling import as_cases, dimensionless, refused, restore, without_springs
from solver.solution import Solution
from solver.status import Status
from solver.threads import one_blas_thread

#: Approximations at one radius, and per 1 + k, by which relaxation slows them: where they take more they cycle.
LIMIT, LIMIT_RELAXED = 200, 40
#: Rows of the operator that are formed together.
_ROWS = 64


class UniformMesh(NamedTuple):
    """What the successive approximations need of a mesh, as a Mesh: s, x, w, edge (n,), K (n, n).

    The nodes are i/n, all but x = 1, where p = 0; `w` is the trapezoidal rule; K and edge are the half-space operator
    on the piecewise linear pressure.
    """

    s: np.ndarray
    x: np.ndarray
    w: np.ndarray
    K: np.ndarray
    edge: np.ndarray

    @property
    def n(self):
        """Number of nodes, and of intervals."""
        return len(self.s)


@lru_cache(maxsize=16)
def uniform_mesh(intervals):
    """The :class:`UniformMesh` of `intervals` equal intervals in x = r/a; K and edge to 1e-9."""
    rows = _operator(intervals)
    inner = np.arange(intervals)[::-1]  # ascending in s, the centre last, as on every mesh
    x = inner / intervals
    edge = rows[-1, inner]
    arrays = np.sqrt((1 - x) * (1 + x)), x, x / intervals, rows[np.ix_(inner, inner)] - edge, edge
    for array in arrays:
        array.flags.writeable = False
    return UniformMesh(*arrays)


def _operator(intervals):
    """H (n + 1, n + 1) of the hat functions at the n + 1 nodes i/n."""
    starts = range(0, intervals + 1, _ROWS)
    return np.concatenate([_rows(np.arange(i, min(i + _ROWS, intervals + 1)), intervals) for i in starts])


def _rows(targets, intervals):
    """Rows (m, n + 1) of H at the nodes `targets` (m,)."""
    rows = np.zeros((len(targets), intervals + 1))
    target, cell = np.meshgrid(targets, np.arange(intervals), indexing="ij")
    u, w = gauss_legendre(8)
    v, wv = gauss_legendre(24)
    near, w_near = v**4, 4 * v**3 * wv  # towards the logarithmic singularity at one end
    for chosen, place, weight in (
        ((cell != target) & (cell != target - 1), u, w),
        (cell == target, near, w_near),
        (cell == target - 1, 1 - near, w_near),
    ):
        t, c = target[chosen], cell[chosen]
        kernel = weight * _kernel(t[:, None], c[:, None] + place) / intervals
        rows[t - targets[0], c] += kernel @ (1 - place)  # no cell is there twice
        rows[t - targets[0], c + 1] += kernel @ place
    return rows


def _kernel(x, source):
    """K(k) source/(x + source) of Eq. (3), k = 2 sqrt(x source)/(x + source): by Landen K(x_</x_>) source/x_>."""
    outer = np.maximum(x, source)
    return ellipkm1(np.abs(x - source) * (x + source) / outer**2) * source / outer


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN and a status
def solve_uniform(problem, intervals, k, tolerance, limit=None):
    """Solve a batch of rough cases, or smooth ones on a thin layer, as the paper does.

    Parameters
    ----------
    problem : Problem
        B cases of one micro law on "thin_layer" or "half_space"; its scheme, k, rtol and nodes are not used.
    intervals : int
        Of the uniform mesh on [0, a].
    k : float, >= 0
        The paper's relaxation, Eqs (8) and (10).
    tolerance : float
        The approximations stop when |p̂ - p| is below a tenth of it, relative to the largest pressure; the halving of
        ln a when the bracket is.
    limit : int, optional
        Approximations at one radius; by default LIMIT, or LIMIT_RELAXED (1 + k) if that is more.

    Returns
    -------
    Solution
        Without profiles, stiffness and error estimate. `status` is CONVERGED where approximations and control have
        arrived; LIMIT_CYCLE, ITERATION_LIMIT keep the last numbers.

    Raises
    ------
    ValueError
        Several bases or laws in one batch, or a base that the paper does not have.

    Examples
    --------
    >>> from solver import Problem
    >>> layer, asperities = {"h": 0.02, "n": 0.5, "base": "thin_layer"}, {"Nbar": 250000, "Ra": 0.004}
    >>> case = Problem.of(a=0.04, **layer, **asperities, micro="power_law", B=0.1, beta=0.5)
    >>> print(f"{solve_uniform(case, 40, 10.0, 1e-4).P[0]:.3e}")
    2.704e-05
    """
    kinds = set(zip(problem.base.tolist(), problem.micro.tolist(), strict=True))
    if len(kinds) != 1 or kinds & {("layered", micro) for _, micro in kinds} or kinds == {("half_space", "smooth")}:
        raise ValueError(f"one micro law on thin_layer, or a rough one on half_space, not {sorted(kinds)}")
    scaled = dimensionless(problem)
    invalid = refused(problem, scaled)
    none = ~invalid & without_springs(scaled)
    status = np.select([invalid, none], [Status.INVALID_INPUT, Status.THIN_LAYER_NOT_APPLICABLE], 0)
    pieces = [(np.arange(len(problem)), Solution.of(len(problem), 0, status=status))]
    index = np.flatnonzero(~(invalid | none))
    if len(index):
        pieces.append((index, _solve(as_cases(scaled.take(index)), uniform_mesh(intervals), k, tolerance, limit)))
    return restore(Solution.join(len(problem), 0, pieces), problem, without=("dP_dD", "error"))


def _solve(cases, grid, k, tolerance, limit):
    """:class:`~solver.solution.Solution` of :class:`~solver.contact.equation.Cases`."""
    one = np.ones(len(cases.value))
    limit = limit or max(LIMIT, int(LIMIT_RELAXED * (1 + k)))
    way = {"search": bisection, "follow": True, "budget": np.iinfo(int).max}  # for comparison: at any cost
    (ev, _, count), status = picard.solve(cases, grid, k * one, tolerance * one, limit, **way)
    found = quantities(ev)
    line = np.append(np.ones(grid.n - 1), 0.5) / grid.n
    integral = found.a * cases.law.p_star * (ev.curve.q @ line)
    D = 2 * integral + cases.body.C * found.p0 + found.A0  # (14)
    ends = {"residual": ev.residual, "status": status, "iterations": count, "nodes": grid.n}
    solution = Solution.of(len(one), 0, **found._replace(D=D)._asdict(), **ends)
    return solution.refused(status == Status.DIVERGED, Status.DIVERGED)
