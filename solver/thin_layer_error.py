"""How far the thin-layer model is from the exact layer, for a smooth punch: an estimate that can be worked by hand.

Near the edge of a contact with h << a the exact kernel and A1 + A2 u give half-plane problems, which the Wiener-Hopf
method solves. Away from the edge the two solutions differ by a shift of the edge alone: with the thin layer the
contact is wider by κ h,

    κ = (1/π) ∫₀^∞ ln[(A1 + A2 u)/L(u)] du/u².

So at given load the radius is wrong by κ h/a, while depth and central pressure have no error of first order; at given
radius the load is wrong by -m κ h/a with m = d ln P/d ln a. For h >> a the load of the thin layer tends to
(3π/(32 A2)) (a/h) of the true one, (4/3) E1* a³/R. The estimate is the simplest fraction with both limits.
"""

from typing import NamedTuple

import numpy as np

from .base import thin_layer_coefficients
from .kernel import layered_kernel
from .quadrature import gauss_legendre

#: Panels in ln u of the integral κ: what lies below is of the order of the first u, 1e-7; beyond the last, L = 1.
_PANELS = np.append(np.arange(-16.0, 3.0), np.log(40.0))


class ThinLayerError(NamedTuple):
    """Relative errors of the thin-layer model: of the load P at given radius, of the radius a at given load."""

    P: np.ndarray
    a: np.ndarray


def edge_shift(n, nu1, nu2, bonded):
    """κ: by how many thicknesses the thin-layer contact is wider than the exact one, for h << a.

    Parameters
    ----------
    n : array, > 0
        E1*/E2*.
    nu1, nu2 : array, (-1, 0.5]; used when bonded
        Poisson ratios of layer and half-space.
    bonded : array of bool
        Perfect bond or frictionless interface.

    Returns
    -------
    array
        κ to about 1e-6; NaN where the thin-layer equation does not apply (A2 <= 0). Negative: narrower.

    Examples
    --------
    >>> print(f"{edge_shift(0.5, 0.3, 0.3, False):.4f} {edge_shift(0.5, 0.3, 0.3, True):.4f}")
    0.2326 0.1447
    """
    n, nu1, nu2, bonded = np.broadcast_arrays(np.asarray(n, float), nu1, nu2, bonded)
    A1, A2 = thin_layer_coefficients(n, nu1, nu2, bonded)
    A2 = np.where(A2 > 0, A2, np.nan)
    t, w = gauss_legendre(20)
    width = np.diff(_PANELS)[:, None]
    u = np.exp(_PANELS[:-1, None] + width * t).ravel()
    weight = (width * w).ravel() / u
    L = layered_kernel(u, *(v[..., None] for v in (n, nu1, nu2, bonded))).L
    inner = np.log((A1[..., None] + A2[..., None] * u) / L) @ weight
    end = np.exp(_PANELS[-1])
    outer = np.log(A1 + A2 * end) / end + A2 / A1 * np.log1p(A1 / (A2 * end))
    return (inner + outer) / np.pi


def thin_layer_error(h_a, n, nu1=0.3, nu2=0.3, bonded=False):
    """Estimated relative errors of the thin-layer model for a smooth sphere.

    Parameters
    ----------
    h_a : array, > 0
        Thickness over the (true) contact radius, x = h/a.
    n, nu1, nu2, bonded
        The layer, as in :func:`edge_shift`; all broadcast.

    Returns
    -------
    ThinLayerError
        P_thin/P - 1 at given a and a_thin/a - 1 at given P; NaN where the thin-layer equation does not apply.

    Notes
    -----
    P/P_thin = 1 + x (m κ x0 + g x)/(x0 + x), g = 32 A2/(3π), m = 3 + (g x/n)/(1 + g x/n); x0 = 1.55 - 1.16 n
    (frictionless) or 1.5 + 2.3 κ (bonded) is fitted. a_thin/a = (P/P_thin)^(1/m). Over h/a = 0.01 to 20, n = 0.01 to
    0.95: P_thin/P to 5 % frictionless, 8 % bonded ν <= 0.3, 13 % bonded ν = 0.45, exact in both limits; 30 % where
    A2 almost vanishes (ν1 > ν2). Roughness makes the edge softer, and the error at h/a < 0.3 smaller.

    Examples
    --------
    >>> error = thin_layer_error(0.5, 0.5)
    >>> print(f"{error.P:.2f} {error.a:.2f}")
    -0.36 0.13
    """
    x = np.asarray(h_a, dtype=float)
    kappa = edge_shift(n, nu1, nu2, bonded)
    g = 32 / (3 * np.pi) * thin_layer_coefficients(n, nu1, nu2, bonded)[1]
    z = g * x / n
    m = 3 + z / (1 + z)
    x0 = np.where(bonded, 1.5 + 2.3 * kappa, 1.55 - 1.16 * np.asarray(n, dtype=float))
    P = 1 + x * (m * kappa * x0 + g * x) / (x0 + x)
    return ThinLayerError(1 / P - 1, P ** (1 / m) - 1)
