"""The least-squares fit A[p] ≈ B p^β of Section 4.1 of the paper."""

from typing import NamedTuple

import numpy as np

from ..threads import one_blas_thread
from .disc_cell import displacement

#: Pressures of the fit, and those at which its error is found, in E1*: the ranges of the paper.
PRESSURES, _CHECKED = np.linspace(1e-4, 0.025, 250), np.linspace(0.0025, 0.025, 2001)


class Fit(NamedTuple):
    """B (unit Ra/E1*^β), β, and the largest relative error |B p^β/A[p] - 1| from 0.0025 to 0.025 E1*."""

    B: float
    beta: float
    max_error: float


@one_blas_thread()
def fit_power_law(Nbar_Ra2):
    """:class:`Fit` of A[p] = B p^β to the exact law, by least squares at pressures from 1e-4 to 0.025 E1* in steps of
    1e-4 (Table 1 of the paper).

    Nbar_Ra2 : N̄ Ra² > 0, finite (else ValueError). B in Ra/E1*^β and β depend on nothing else

    >>> B, beta, _ = fit_power_law(4.0)
    >>> print(f"{B:.4f} {beta:.4f}")
    0.0919 0.4908
    """
    if not 0 < Nbar_Ra2 < np.inf:
        raise ValueError(f"Nbar_Ra2 = {Nbar_Ra2}: must be > 0 and finite")
    B, beta = least_squares(PRESSURES, displacement(PRESSURES, 1.0, Nbar_Ra2, 1.0))
    return Fit(B, beta, power_law_error(B, beta, Nbar_Ra2))


def least_squares(p, A):
    """B and β of the least-squares fit A = B p^β to A (n,) at p (n,), which ascends."""
    from scipy.optimize import brentq  # imported here: it takes 0.3 s (python -X importtime), and only a fit needs it

    scale = np.sqrt(p[0] * p[-1])  # powers of p/scale, so that B and β are not nearly dependent
    logarithm = np.log(p / scale)

    def best(beta):
        """(p/scale)^β, its best factor, and A less the two multiplied."""
        power = np.exp(beta * logarithm)
        factor = (A @ power) / (power @ power)
        return power, factor, A - factor * power

    def slope(beta):
        """The misfit falls with β where this is positive: its root is the best β, to rounding. A minimum is found only
        to the square root of that."""
        power, _, rest = best(beta)
        return rest @ (power * logarithm)

    beta = brentq(slope, -1.0, 1.5, xtol=1e-15)  # A grows, by no more than p^(2/3)
    B = best(beta)[1] / scale**beta
    return float(B), float(beta)


def power_law_error(B, beta, Nbar_Ra2):
    """Largest relative error |B p^β/A[p] - 1| of a power law from 0.0025 to 0.025 E1*, B in Ra/E1*^β."""
    A = displacement(_CHECKED, 1.0, Nbar_Ra2, 1.0)
    return float(np.max(np.abs(B * _CHECKED**beta / A - 1)))
