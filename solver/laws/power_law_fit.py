"""The least-squares fit A[p] ≈ B p^β of Section 4.1 of the paper."""

from typing import Literal, NamedTuple

import numpy as np

from ..numerics.threads import one_blas_thread
from .disc_cell import displacement


class Fit(NamedTuple):
    """A power law A = B p^β, fitted to the exact law.

    Attributes
    ----------
    B, beta : factor (unit Ra/E1*^β), and exponent β
    max_error : largest relative error |B p^β/A[p] - 1| over the interval `check`

    Examples
    --------
    >>> fitted = fit_power_law(4.0)
    >>> print(f"A = {fitted.B:.3f} p^{fitted.beta:.3f}, to {fitted.max_error:.1%}")
    A = 0.092 p^0.491, to 4.6%
    """

    B: float
    beta: float
    max_error: float


def pressures(p_min, p_max, step, mesh):
    """Abscissas of the fit in E1*: uniform with `step`, or equally many in geometric progression."""
    count = int(round((p_max - p_min) / step)) + 1
    return np.linspace(p_min, p_max, count) if mesh == "uniform" else np.geomspace(p_min, p_max, count)


@one_blas_thread()
def fit_power_law(
    Nbar_Ra2: float,
    *,
    p_min: float = 1e-4,
    p_max: float = 0.025,
    step: float = 1e-4,
    mesh: Literal["uniform", "graded"] = "uniform",
    check: tuple[float, float] = (0.0025, 0.025),
) -> Fit:
    """Fit A[p] = B p^β to the exact law by least squares, as in Section 4.1 of the paper (Table 1).

    Parameters
    ----------
    Nbar_Ra2 : N̄ Ra² > 0; B in Ra/E1*^β and β depend on nothing else
    p_min, p_max, step : range and spacing of the abscissas in E1*, 0 < p_min < p_max, 0 < step <= p_max - p_min
    mesh : "uniform", equal steps as in the paper, or "graded", as many points in geometric progression
    check : interval in E1*, 0 < low < high, over which `max_error` is taken (2001 points)

    Returns
    -------
    Fit : B, beta and max_error

    Raises
    ------
    ValueError : a number outside these bounds, or another mesh

    Examples
    --------
    >>> B, beta, _ = fit_power_law(4.0)
    >>> print(f"{B:.4f} {beta:.4f}")
    0.0919 0.4908
    """
    _check(Nbar_Ra2, p_min, p_max, step, mesh, check)
    p = pressures(p_min, p_max, step, mesh)
    B, beta = least_squares(p, displacement(p, 1.0, Nbar_Ra2, 1.0))
    return Fit(B, beta, power_law_error(B, beta, Nbar_Ra2, check))


def least_squares(p, A):
    """B and β of the least-squares fit A = B p^β to A (n,) at p (n,), which ascends."""
    from scipy.optimize import brentq  # imported here: it takes 0.3 s (python -X importtime), and only a fit needs it

    scale = np.sqrt(p[0] * p[-1])  # the fit is in p/scale, so that B and β are not nearly dependent
    logarithm = np.log(p / scale)

    def best(beta):
        """(p/scale)^β, its best factor, and A less the two multiplied."""
        power = np.exp(beta * logarithm)
        factor = (A @ power) / (power @ power)
        return power, factor, A - factor * power

    def slope(beta):
        """A function of β that is positive where the misfit falls with β, so that its root is the best β. A root can be
        computed to rounding, a minimum only to the square root of that."""
        power, _, rest = best(beta)
        return rest @ (power * logarithm)

    beta = brentq(slope, -1.0, 1.5, xtol=1e-15)  # A grows, by no more than p^(2/3)
    B = best(beta)[1] / scale**beta
    return float(B), float(beta)


def power_law_error(B, beta, Nbar_Ra2, check=(0.0025, 0.025)):
    """Largest relative error |B p^β/A[p] - 1| of a power law over `check`, in E1*; B is in Ra/E1*^β."""
    p = np.linspace(*check, 2001)
    return float(np.max(np.abs(B * p**beta / displacement(p, 1.0, Nbar_Ra2, 1.0) - 1)))


def _check(Nbar_Ra2, p_min, p_max, step, mesh, check):
    if not (np.isfinite(Nbar_Ra2) and Nbar_Ra2 > 0):
        raise ValueError(f"Nbar_Ra2 = {Nbar_Ra2}: must be > 0 and finite")
    if not 0 < p_min < p_max < np.inf:
        raise ValueError(f"p_min = {p_min}, p_max = {p_max}: must satisfy 0 < p_min < p_max")
    if not 0 < step <= p_max - p_min:
        raise ValueError(f"step = {step}: must be > 0 and at most p_max - p_min")
    if mesh not in ("uniform", "graded"):
        raise ValueError(f'mesh = "{mesh}": must be "uniform" or "graded"')
    if not 0 < check[0] < check[1] < np.inf:
        raise ValueError(f"check = {list(check)}: must be [low, high] with 0 < low < high")
