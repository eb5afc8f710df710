"""The paper's successive approximations, Eqs (8) and (10), and the load or depth by a search on the contact radius.

On a layer (C > 0), Eq. (8): p̂ = ((a² - r²)/(2R) - half-space part - A[p])/C, without a layer, Eq. (10): p̂ is the
pressure whose A is what the half-space part leaves; either is relaxed with the paper's k, p_new = (p̂ + k p)/(1 +
k), from p = 0, until successive pressures differ by less than TOLERANCE of the largest one. The slope of A ~ p^β, β
< 1, is infinite at the edge, and where A'(p) > (1 + 2k) C the iterates of (8) end in a cycle of two: the pressure
there never settles, the load does to 3 to 4 digits.
"""

from typing import NamedTuple

import numpy as np

from .bracket import false_position
from .equation import State, control_residual, groups, one_term_radii, operate
from .status import Status

TOLERANCE = 1e-6
#: Successive approximations at one radius.
LIMIT = 400
#: The load has settled when one more approximation changes it by less than this.
_SETTLED = 1e-2


class Fixed(NamedTuple):
    """Successive approximations at given radii: q (B, n), last change (B,), change of the load (B,), count (B,)."""

    q: np.ndarray
    change: np.ndarray
    load_change: np.ndarray
    count: np.ndarray


def solve(cases, law, mesh, k, limit):
    """State, status (B,) and total number of approximations (B,) of :class:`~solver.equation.Cases` by the paper's
    scheme.

    k : (B,) float, >= 0; limit : int, approximations at one radius (0: LIMIT).
    """
    limit = limit or LIMIT
    if cases.control == "a":
        eta = np.log(cases.value)
        fixed = approximate(cases, eta, law, mesh, k, limit)
        count = fixed.count
    else:
        eta, fixed, count = _search(cases, law, mesh, k, limit)
    with np.errstate(invalid="ignore"):
        status = np.select(
            [~np.isfinite(fixed.q).all(axis=1), fixed.change < TOLERANCE, fixed.load_change < _SETTLED],
            [Status.DIVERGED, Status.CONVERGED, Status.LIMIT_CYCLE],
            Status.ITERATION_LIMIT,
        )
    y = law.from_pressure(fixed.q, cases.exponent)
    return State(np.maximum(y, np.finfo(float).tiny), eta), status, count


def approximate(cases, eta, law, mesh, k, limit):
    """Successive approximations at the radii exp(eta) (B,): finished cases leave the batch."""
    size = len(eta)
    q = np.zeros((size, mesh.n))
    change, load_change = np.full(size, np.inf), np.full(size, np.inf)
    count = np.zeros(size, dtype=int)
    active = np.arange(size)
    XYZ, K = groups(cases, eta), operate(cases, eta, q, mesh).K
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(limit):
            here = K if len(K) == 1 else K[active]
            new = _next(q[active], cases.take(active), [v[active] for v in XYZ], law, mesh, here, k[active])
            change[active] = np.abs(new - q[active]).max(axis=1) / np.maximum(new.max(axis=1), np.finfo(float).tiny)
            load_change[active] = np.abs((q[active] @ mesh.w) / (new @ mesh.w) - 1)
            q[active] = new
            count[active] += 1
            active = active[change[active] >= TOLERANCE]  # NaN leaves as well: it has diverged
            if not len(active):
                break
    return Fixed(q, change, load_change, count)


def _next(q, cases, XYZ, law, mesh, K, k):
    X, Y, Z = XYZ
    left = mesh.s**2 - X * np.matmul(K, q[..., None])[..., 0]
    y = law.from_pressure(q, cases.exponent)
    by_layer = np.maximum((left - Z * law.evaluate(y, cases.exponent).g) / Y, 0.0)
    y_spots = law.from_displacement(np.maximum(left / Z, 0.0), cases.exponent)
    by_spots = law.evaluate(y_spots, cases.exponent).q
    target = np.where((cases.C > 0)[:, None], by_layer, by_spots)
    return (target + k[:, None] * q) / (1 + k[:, None])


def _search(cases, law, mesh, k, limit):
    """ln a for the load or depth by false position, each radius from the zero start; count of all approximations
    (B,)."""
    count = np.zeros(len(cases.value), dtype=int)

    def evaluate(eta):
        fixed = approximate(cases, eta, law, mesh, k, limit)
        count[:] += fixed.count
        X = groups(cases, eta)[0]
        edge_q = operate(cases, eta, fixed.q, mesh).edge_q
        with np.errstate(invalid="ignore", divide="ignore"):
            return control_residual(cases, eta, X, fixed.q, edge_q, mesh)

    eta = false_position(evaluate, *_bracket(cases, law), TOLERANCE)
    return eta, approximate(cases, eta, law, mesh, k, limit), count


def _bracket(cases, law):
    """First bracket of ln a: a compliant layer and roughness only widen Hertz's contact at one load."""
    if cases.control == "D":
        return 0.5 * np.log(cases.value), 0.5 * np.log(2 * cases.value)
    hertz, springs, spots = one_term_radii(cases, *law.power(cases.exponent))
    return np.log(hertz), np.log(hertz + springs + spots) + 0.1
