"""How far the thin-layer model is from the exact layer, for a smooth punch: an estimate that can be worked by hand.

Near the edge of a contact with h << a the exact kernel and A1 + A2 u give half-plane problems, which the Wiener-Hopf
method solves. Away from the edge the two solutions differ by a shift of the edge alone: with the thin layer the
contact is wider by κ h,

    κ = (1/π) ∫₀^∞ ln[(A1 + A2 u)/L(u)] du/u².

So at given load the radius is wrong by κ h/a, while depth and central pressure have no error of first order; at given
radius the load is wrong by -m κ h/a with m = d ln P/d ln a. For h >> a the load of the thin layer tends to
(3π/(32 A2)) (a/h) of the true one, (4/3) E1* a³/R. The estimate is the simplest fraction with both limits.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ..body.kernel import whole
from ..body.springs import thin_layer_coefficients
from ..threads import one_blas_thread

#: Points and step of the trapezoidal rule for κ in ln u, at both ends of which the integrand decays like e^-|ln u|.
_STEP = 0.5
_U = np.exp(np.arange(-16.0, 36.0, _STEP))
#: Largest |ln n| of the table without friction.
_RANGE = 25.0
#: Number of points up to u = 45; beyond, L = 1 to rounding.
_NEAR = int(np.sum(_U < 45.0))


class ThinLayerError(NamedTuple):
    """Relative errors of the thin-layer model: of the load P at given radius, of the radius a at given load."""

    P: np.ndarray
    a: np.ndarray


@one_blas_thread()
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
    given = np.broadcast_arrays(np.asarray(n, float), nu1, nu2, bonded)
    n, nu1, nu2, bonded = (v.ravel() for v in given)
    kappa, tabulated = np.empty(len(n)), (bonded == 0) & (np.abs(np.log(n)) < _RANGE)
    kappa[tabulated] = _without_friction()(np.log(n[tabulated]))
    rest = np.flatnonzero(~tabulated)
    if len(rest):  # a batch has few materials: each is integrated once
        materials, places = np.unique([v[rest] for v in (n, nu1, nu2, bonded)], axis=1, return_inverse=True)
        kappa[rest] = _integrated(*materials)[places.ravel()]
    return kappa.reshape(given[0].shape)


@lru_cache(maxsize=1)
def _without_friction():
    """κ over ln n without friction, a spline to 1e-8."""
    ln_n = np.linspace(-_RANGE, _RANGE, 1001)
    none = np.zeros_like(ln_n)
    return CubicSpline(ln_n, _integrated(np.exp(ln_n), none, none, none))


def _integrated(n, nu1, nu2, bonded):
    """κ (B,) of B materials, by the trapezoidal rule."""
    n, nu1, nu2, bonded = (v[:, None] for v in (n, nu1, nu2, bonded))
    A1, A2 = thin_layer_coefficients(n, nu1, nu2, bonded)
    L = np.ones((len(n), len(_U)))
    L[:, :_NEAR] = whole(_U[:_NEAR] + 0 * n, n, nu1, nu2, bonded != 0)
    return np.log((A1 + np.where(A2 > 0, A2, np.nan) * _U) / L) @ (_STEP / np.pi / _U)


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
    edge, far, m = _terms(h_a, n, nu1, nu2, bonded)
    P = 1 + edge + far
    return ThinLayerError(1 / P - 1, P ** (1 / m) - 1)


def largest_error(control, h_a, n, nu1, nu2, bonded):
    """Estimated size of the largest relative error over a, P, D, p(0), p_max, Ar/An of the thin-layer model.

    Parameters
    ----------
    control : "P", "a" or "D"
        What is given.
    h_a, n, nu1, nu2, bonded
        As in :func:`thin_layer_error`.

    Returns
    -------
    array
        For errors from 0.001 to 1 of a smooth sphere, 0.24 to 4.6 times the true one, most often 1 to 2 times; more
        under asperities at small h/a. NaN where the thin-layer equation does not apply.

    Notes
    -----
    The two terms of P/P_thin are taken to add: where they cancel, other quantities are as wrong. Only at given a does
    the edge shift tell on the load in full; at given P or D it tells on a, and, where it is inwards (κ < 0), twice as
    much on p(0).
    """
    edge, far, m = _terms(h_a, n, nu1, nu2, bonded)
    inwards = np.where(edge < 0, 2, 1)
    if control == "P":
        return (1 + np.abs(edge) + far) ** (inwards / m) - 1
    return 1 - 1 / (1 + np.abs(edge) * (inwards / m if control == "D" else 1) + far)


def _terms(h_a, n, nu1, nu2, bonded):
    """The terms of the edge and of thick layers in P/P_thin - 1, and m."""
    x = np.asarray(h_a, dtype=float)
    kappa = edge_shift(n, nu1, nu2, bonded)
    g = 32 / (3 * np.pi) * thin_layer_coefficients(n, nu1, nu2, bonded)[1]
    z = g * x / n
    m = 3 + z / (1 + z)
    x0 = np.where(bonded, 1.5 + 2.3 * kappa, 1.55 - 1.16 * np.asarray(n, dtype=float))
    return x * m * kappa * x0 / (x0 + x), g * x * x / (x0 + x), m
