"""The paper's method: a uniform mesh in r, successive approximations from p = 0, and the radius by halving.

The paper gives neither mesh nor stopping rule; those here favour it (docs/tradeoff.md). The method serves for
comparison: `solver.solve` needs a tenth of the nodes and of the steps.
"""

from collections import namedtuple
from functools import lru_cache

import numpy as np
from scipy.special import ellipkm1

from solver import Problem, Status
from solver.numerics.threads import one_blas_thread
from solver.scaling import as_cases, dimensionless

LIMIT, LIMIT_RELAXED = 200, 40
"""Largest number of approximations at one radius: LIMIT, or LIMIT_RELAXED (1 + k) if that is more, since relaxation
slows them by 1 + k. Cases that need more end in a cycle."""
ROWS = 64  # so many rows of the operator are formed at a time. All at once would take 0.5 GB on 1100 intervals


UniformMesh = namedtuple("UniformMesh", "x w K")
"""Nodes x = i/n from the centre, except x = 1, where p = 0; x, w (n,), K (n, n).

For a pressure linear between the nodes, in units R = E2* = 1: u(x) - u(1) = 4 a/π K p is the displacement of the
half-space; 2 π a² w·p is the load, by the trapezoidal rule.
"""


@lru_cache(maxsize=16)
def uniform_mesh(intervals: int) -> UniformMesh:
    """The mesh of `intervals` equal intervals in x = r/a; K to 1e-9."""
    blocks = (np.arange(i, min(i + ROWS, intervals + 1)) for i in range(0, intervals + 1, ROWS))
    H = np.concatenate([rows(targets, intervals) for targets in blocks])[:, :-1]
    x = np.arange(intervals) / intervals
    return UniformMesh(x, x / intervals, H[:-1] - H[-1])


def rows(targets: np.ndarray, intervals: int) -> np.ndarray:
    """Integrals (m, n + 1) of the kernel of Eq. (3) at the nodes `targets` (m,) against the n + 1 hat functions."""
    integrals = np.zeros((len(targets), intervals + 1))
    target, cell = np.meshgrid(targets, np.arange(intervals), indexing="ij")
    (u, w), (v, wv) = (np.array(np.polynomial.legendre.leggauss(count)) / 2 for count in (8, 24))
    u, v = u + 0.5, v + 0.5  # on [0, 1]
    near, w_near = v**4, 4 * v**3 * wv  # towards the logarithmic singularity at one end
    for chosen, place, weight in (
        ((cell != target) & (cell != target - 1), u, w),
        (cell == target, near, w_near),
        (cell == target - 1, 1 - near, w_near),
    ):
        t, c = target[chosen], cell[chosen]
        kernel = weight * elliptic(t[:, None], c[:, None] + place) / intervals
        integrals[t - targets[0], c] += kernel @ (1 - place)  # += counts each pair (t, c) once, and none occurs twice
        integrals[t - targets[0], c + 1] += kernel @ place
    return integrals


def elliptic(x: np.ndarray, source: np.ndarray) -> np.ndarray:
    """K(k) source/(x + source) of Eq. (3), k = 2 sqrt(x source)/(x + source): by Landen K(x_</x_>) source/x_>."""
    outer = np.maximum(x, source)
    return ellipkm1(np.abs(x - source) * (x + source) / outer**2) * source / outer


UniformSolution = namedtuple("UniformSolution", "a P D p0 p_max Ar_An A0 status iterations")
"""The quantities with these names in `solver.Solution`, (B,) in units R = E2* = 1; NaN if a case diverged."""


@one_blas_thread()
def solve_uniform(
    problem: Problem, intervals: int, k: float, tolerance: float, limit: int | None = None
) -> UniformSolution:
    """Solve a batch of rough cases, or smooth ones on a thin layer, by the paper's method.

    problem : cases on "thin_layer", where its equation applies, or "half_space", given P or a, with R = E2* = 1; its
        scheme, k, rtol and nodes are not used
    intervals : of the uniform mesh on [0, a]
    k : the paper's relaxation, Eqs (8) and (10), >= 0
    tolerance : the approximations stop when |p̂ - p| is below a tenth of it, relative to the largest pressure; the
        halving stops when the bracket of ln a is
    limit : approximations at one radius; by default LIMIT, or LIMIT_RELAXED (1 + k) if that is more

    `status` is CONVERGED, ITERATION_LIMIT (with the last numbers), DIVERGED, or INVALID_INPUT. Raises ValueError for a
    base that is not in the paper, smooth cases on the half-space, or an elastic punch.

    >>> from solver import Problem
    >>> layer, asperities = {"h": 0.02, "n": 0.5, "base": "thin_layer"}, {"Nbar": 250000, "Ra": 0.004}
    >>> case = Problem.of(a=0.04, **layer, **asperities, micro="power_law", B=0.1, beta=0.5)
    >>> print(f"{solve_uniform(case, 40, 10.0, 1e-4).P[0]:.3e}")
    2.704e-05
    """
    pairs = {*zip(problem.base.tolist(), problem.micro.tolist(), strict=True)}
    wrong = [kind for kind in pairs if kind[0] not in ("thin_layer", "half_space") or kind == ("half_space", "smooth")]
    if wrong:
        raise ValueError(f"thin_layer, or rough cases on half_space, not {sorted(wrong)}")
    if (problem.m > 0).any():
        raise ValueError("the punch of the paper is rigid: m must be 0")
    invalid = problem.invalid()
    solution = UniformSolution(*np.full((7, len(problem)), np.nan), *np.zeros((2, len(problem)), dtype=int))
    for base, micro in pairs:
        index = np.flatnonzero((problem.base == base) & (problem.micro == micro) & ~invalid)
        if not len(index):
            continue
        part = Contact(problem.take(index), uniform_mesh(int(intervals)), k, 0.1 * tolerance, limit)
        with np.errstate(all="ignore"):  # a case that diverges becomes NaN and a status
            for array, values in zip(solution, part.solved(), strict=True):
                array[index] = values
    solution.status[invalid] = Status.INVALID_INPUT
    return solution


class Contact:
    """B cases of one law on one base, with the last pressure p (B, n) and the number of approximations of each."""

    def __init__(self, problem: Problem, mesh: UniformMesh, k: float, tolerance: float, limit: int | None):
        cases = as_cases(dimensionless(problem))
        self.law, self.C = cases.law, cases.body.C
        self.control, self.value = problem.control, problem.value
        self.mesh, self.k, self.tolerance = mesh, k, tolerance
        self.limit = limit or max(LIMIT, int(LIMIT_RELAXED * (1 + k)))
        self.p, self.count = np.zeros((len(problem), len(mesh.x))), np.zeros(len(problem), dtype=int)

    def approximate(self, a: np.ndarray, index: np.ndarray) -> np.ndarray:
        """Approximate the cases `index` at the radii a, from their last pressure. Returns whether each settled."""
        active, settled = np.arange(len(index)), np.zeros(len(index), dtype=bool)
        gap = (a**2 / 2)[:, None] * (1 - self.mesh.x**2)
        for _ in range(self.limit):
            part, pressure = index[active], self.p[index[active]]
            law, C = self.law.take(part), self.C[part, None]
            remainder = gap[active] - (4 / np.pi * a[active])[:, None] * (
                pressure @ self.mesh.K.T
            )  # C p + A[p] of Eq. (4)
            if C.any():  # (8)
                y = law.from_pressure(pressure / law.p_star[:, None])
                wanted = np.maximum((remainder - law.A_star[:, None] * law.evaluate(y).g) / C, 0.0)
            else:  # (10)
                y = law.from_displacement(np.maximum(remainder / law.A_star[:, None], 0.0))
                wanted = law.p_star[:, None] * law.evaluate(y).q
            self.p[part] = new = (wanted + self.k * pressure) / (1 + self.k)
            self.count[part] += 1
            change = (1 + self.k) * np.abs(new - pressure).max(axis=1) / new.max(axis=1)
            settled[active] = change < self.tolerance
            active = active[change >= self.tolerance]  # a diverged case, NaN, leaves as well
            if not len(active):
                break
        return settled

    def load_error(self, eta: np.ndarray, index: np.ndarray) -> np.ndarray:
        """Logarithm of the load (5) at eta = ln a over the given load."""
        settled = self.approximate(np.exp(eta), index)
        load = 2 * np.pi * np.exp(2 * eta) * (self.p[index] @ self.mesh.w)
        self.p[index[~settled]] = 0.0  # the next radius must not start from a cycle
        return np.log(load / self.value[index])

    def start(self) -> np.ndarray:
        """First radii, combined from those on the half-space, the layer, and asperities A ~ p^β, each alone."""
        law, P = self.law, self.value
        gamma, beta = law.edge()
        e = 1 / beta
        spots = (P / (2 * np.pi * law.p_star) * (2 * law.A_star * gamma) ** e * (2 * e + 2)) ** (1 / (2 + 2 * e))
        return ((0.75 * P) ** (4 / 3) + 4 / np.pi * self.C * P + spots**4) ** 0.25

    def solved(self) -> UniformSolution:
        """The solution at the final radius; D by Eq. (14), whose integral along r is trapezoidal too."""
        all_cases, law, mesh = np.arange(len(self.value)), self.law, self.mesh
        a = self.value
        if self.control == "P":
            a = np.exp(halved(self.load_error, np.log(self.start()), self.tolerance))
        settled, p = self.approximate(a, all_cases), self.p
        P = 2 * np.pi * a**2 * (p @ mesh.w)  # (5)
        if self.control == "P":
            settled &= np.abs(np.log(P / self.value)) < 10 * self.tolerance
            P = self.value  # without the error of the search
        status = np.where(settled, Status.CONVERGED, Status.ITERATION_LIMIT)
        status = np.where(np.isfinite(p).all(axis=1), status, Status.DIVERGED)
        q = p / law.p_star[:, None]
        y = law.from_pressure(q)
        A0, peak = law.A_star * law.evaluate(y[:, :1]).g[:, 0], law.peak(y[:, :1], q[:, :1])[:, 0]  # (6), (13)
        D = 2 * a / len(mesh.x) * (p.sum(axis=1) - p[:, 0] / 2) + self.C * p[:, 0] + A0  # (14)
        arrays = a, P, D, p[:, 0], peak, 2 * (law.area(y, q) @ mesh.w), A0  # (12)
        return UniformSolution(*np.where(status == Status.DIVERGED, np.nan, arrays), status, self.count)


def halved(load_error, start: np.ndarray, tolerance: float) -> np.ndarray:
    """Roots (B,) of increasing functions `load_error(x, index)` by halving. The bracket is start ± 0.1 at first, and
    its ends move outwards, in steps that double, until they enclose the root. A case ends when its bracket is shorter
    than the tolerance, or when its function is NaN."""
    low, high = start - 0.1, start + 0.1
    for sign, end in ((-1, low), (1, high)):
        step, short = 0.1, np.arange(len(start))
        while len(short) and step < 1000:
            short = short[sign * load_error(end[short], short) < 0]
            step *= 2
            end[short] += sign * step
    active = np.arange(len(start))
    while len(active):
        middle = (low[active] + high[active]) / 2
        error = load_error(middle, active)
        low[active], high[active] = np.where(error < 0, [middle, high[active]], [low[active], middle])
        active = active[(high[active] - low[active] > tolerance) & ~np.isnan(error)]
    return (low + high) / 2
