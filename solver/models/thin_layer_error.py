"""The error of the thin-layer model against the exact layer, for a smooth punch: a closed form that can be worked out
by hand.

docs/accuracy.md has the formula and its accuracy. For h << a the contact of the thin layer is wider by κ h,

    κ = (1/π) ∫₀^∞ ln[(A1 + A2 u)/L(u)] du/u²,

so that at given radius the relative error of its load is -m κ h/a, m = d ln P/d ln a. For h >> a its load tends to
(3π/(32 A2)) (a/h) times the true one. The estimate is the simplest fraction with both limits;
tests/models/test_thin_layer_error.py compares it with the solver.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..kernels.closed_form import whole
from ..kernels.two_layers import thin_layer_coefficients
from ..numerics.threads import one_blas_thread

#: Step of the trapezoidal rule for κ in ln u, and its points u. The integrand decays like e^-|ln u| at both ends. κ is
#: right to 2e-6 (tests/models/test_thin_layer_error.py, test_edge_shift_is_the_integral_and_what_the_solver_finds).
_STEP = 0.5
_U = np.exp(np.arange(-16.0, 36.0, _STEP))
#: Number of these points below u = 45. Beyond, L - 1 < e^-90: L is 1 and is not evaluated.
_NEAR = int(np.sum(_U < 45.0))
#: Smallest x0, the fitted number of :func:`_terms`. For stiff layers without friction (n > 1.33) and for soft bonded
#: layers that are nearly incompressible, the fit falls below 0, where the estimate would have a pole. All values from
#: 0.2 to 0.5 do equally well (test_materials_beyond_the_fit in tests/models/test_thin_layer_error.py).
_LEAST_LENGTH = 0.3
#: The smallest |κ| in :func:`largest_error`, over the integral of the absolute value, under a smooth punch and under
#: asperities. In some bonded materials long and short waves cancel in κ, but they do not cancel in the terms of second
#: order, nor under asperities, which weight the waves differently. With these values, and the factor of the base
#: "auto", bounds are larger than the errors (test_kappa_of_waves_that_cancel in
#: tests/models/test_waves_that_cancel.py).
_UNCANCELLED, _UNDER_ASPERITIES = 0.1, 0.25
#: A bonded layer that is nearly incompressible is softer than its springs, because it is squeezed out sideways. Then
#: the error is at least (L/(A1 + A2 u))^power - 1 at u = wave h/a. These are (wave, power) for each control, fitted to
#: random layers (test_squeezed_layers of tests/models/test_thin_layer_error.py).
_SQUEEZED = {"P": (2.0, 0.5), "a": (3.5, 0.9), "D": (2.0, 1.0)}
#: Largest |ln n| of the table of κ without friction; it is beyond the bounds of n. Integrating κ for each case would
#: take longer than the whole solution of a smooth case on a thin layer.
_RANGE = 25.0


class ThinLayerError(NamedTuple):
    """Relative errors of the thin-layer model: of the load P at given radius, and of the radius a at given load."""

    P: np.ndarray
    a: np.ndarray


@one_blas_thread()
def edge_shift(n, nu1, nu2, bonded):
    """κ, to about 1e-6. For h << a the radius of the contact is larger by κ h on the thin layer than on the exact
    layer, or smaller if κ < 0. NaN where the thin-layer equation does not apply (A2 <= 0).

    Arguments as those of :func:`~solver.kernels.closed_form.layered_kernel`.

    >>> print(f"{edge_shift(0.5, 0.3, 0.3, False):.4f} {edge_shift(0.5, 0.3, 0.3, True):.4f}")
    0.2326 0.1447
    """
    return _shift_and_size(n, nu1, nu2, bonded)[0]


def _shift_and_size(n, nu1, nu2, bonded):
    """κ, and the same integral over the absolute value."""
    arrays = np.broadcast_arrays(np.asarray(n, float), nu1, nu2, bonded)
    n, nu1, nu2, bonded = (v.ravel() for v in arrays)
    with np.errstate(divide="ignore"):  # n = 0
        both, tabulated = np.empty((2, len(n))), (bonded == 0) & (np.abs(np.log(n)) < _RANGE)
    if tabulated.any():
        both[:, tabulated] = _without_friction()(np.log(n[tabulated]))  # its integrand is positive
    rest = np.flatnonzero(~tabulated)
    if len(rest):  # a batch has few materials: each is integrated once
        materials, places = _different(np.array([v[rest] for v in (n, nu1, nu2, bonded)]))
        both[:, rest] = _integrated(*materials)[:, places]
    return both.reshape(2, *arrays[0].shape)


def _different(columns):
    """The distinct columns among `columns` (k, B), in ascending order, and the place (B,) of each column among them.

    It does the same as `numpy.unique(axis=1)` in a twentieth of the time, which had been a sixth of the time for thin
    cases (B = 8,000).
    """
    order = np.lexsort(columns[::-1])
    ordered = columns[:, order]
    first = np.append(True, (ordered[:, 1:] != ordered[:, :-1]).any(axis=0))
    places = np.empty(len(order), dtype=int)
    places[order] = np.cumsum(first) - 1
    return ordered[:, first], places


@lru_cache(maxsize=1)
def _without_friction():
    """κ without friction as a cubic spline over ln n, right to 1e-8. It does not depend on Poisson ratios."""
    from scipy.interpolate import CubicSpline  # imported here: it takes 0.4 s (python -X importtime), and few need it

    ln_n = np.linspace(-_RANGE, _RANGE, 1001)
    none = np.zeros_like(ln_n)
    return CubicSpline(ln_n, _integrated(np.exp(ln_n), none, none, none)[0])


def _integrated(n, nu1, nu2, bonded):
    """:func:`_shift_and_size` (2, B) of B materials by the trapezoidal rule; NaN where A2 <= 0."""
    n, nu1, nu2, bonded = (v[:, None] for v in (n, nu1, nu2, bonded))
    A1, A2 = thin_layer_coefficients(n, nu1, nu2, bonded)
    L = np.ones((len(n), len(_U)))
    L[:, :_NEAR] = whole(_U[:_NEAR] + 0 * n, n, nu1, nu2, bonded != 0)
    integrand = np.log((A1 + np.where(A2 > 0, A2, np.nan) * _U) / L)
    return np.stack([integrand, np.abs(integrand)]) @ (_STEP / np.pi / _U)


def thin_layer_error(h_a, n, nu1=0.3, nu2=0.3, bonded=False):
    """:class:`ThinLayerError` of a smooth sphere: P_thin/P - 1 at given a and a_thin/a - 1 at given P, estimated; NaN
    where the thin-layer equation does not apply.

    h_a : x = h/a > 0, thickness of the layer over the true contact radius
    n, nu1, nu2, bonded : the layer, as in :func:`edge_shift`; all broadcast

    If A2 almost vanishes (ν1 > ν2), P_thin/P is right only to 30 %. Asperities soften the edge: with them the error at
    h/a < 0.3 is smaller.

    >>> error = thin_layer_error(0.5, 0.5)
    >>> print(f"{error.P:.2f} {error.a:.2f}")
    -0.36 0.13
    """
    edge, far, m = _terms(h_a, n, nu1, nu2, bonded)
    P = 1 + edge + far
    return ThinLayerError(1 / P - 1, P ** (1 / m) - 1)


def largest_error(control, h_a, n, nu1, nu2, bonded, rough=False):
    """Estimated relative error of the thin-layer model: the largest over a, P, D, p(0), p_max and Ar/An; NaN where the
    thin-layer equation does not apply.

    For a smooth sphere with a true error above 0.001, the estimate is 0.23 to 9 times the true error, most often 1 to 2
    times (tests/models/test_thin_layer_error.py and test_auto.py). Under asperities that are more compliant than the
    layer it may be a hundred times too large.

    control : "P", "a" or "D", the quantity that is given, which has no error itself
    h_a, n, nu1, nu2, bonded : as in :func:`thin_layer_error`; rough : whether the punch has asperities

    P/P_thin - 1 has a term of the edge and a term of thick layers. Where these cancel in P, other quantities still have
    errors: so their absolute values are added. At given a the term of the edge counts in full, since it changes the
    load. At given P or D it changes the radius, and counts 1/m times; if the contact of the thin layer is the narrower
    one (κ < 0), the error of p(0) is twice that of the radius, and it counts 2/m times. In some bonded materials long
    and short waves cancel in κ, but not in other effects: so |κ| counts as at least a part of the integral of the
    absolute value (_UNCANCELLED, _UNDER_ASPERITIES).
    """
    edge, far, m = _terms(h_a, n, nu1, nu2, bonded, np.where(rough, _UNDER_ASPERITIES, _UNCANCELLED))
    inwards = np.where(edge < 0, 2, 1)
    if control == "P":
        error = (1 + np.abs(edge) + far) ** (inwards / m) - 1
    else:
        error = 1 - 1 / (1 + np.abs(edge) * (inwards / m if control == "D" else 1) + far)
    return np.maximum(error, _squeezed(*_SQUEEZED[control], h_a, n, nu1, nu2, bonded))


def _squeezed(wave, power, h_a, *material):
    """The error of layers that are squeezed out; for others it is below 0. Without springs it is NaN or below 0."""
    u, n, nu1, nu2, bonded = np.broadcast_arrays(wave * np.asarray(h_a, dtype=float), *material)
    error, i = np.zeros(u.shape), np.nonzero(bonded)
    if len(i[0]):
        A1, A2 = thin_layer_coefficients(*(v[i] for v in (n, nu1, nu2, bonded)))
        error[i] = (whole(*(v[i] for v in (u, n, nu1, nu2, bonded))) / (A1 + A2 * u[i])) ** power - 1
    return error


def _terms(h_a, n, nu1, nu2, bonded, least=0.0):
    """The term of the edge and the term of thick layers, whose sum is P/P_thin - 1; and m = d ln P/d ln a. `least` is
    the smallest |κ|, over the integral of the absolute value."""
    x = np.asarray(h_a, dtype=float)
    kappa, size = _shift_and_size(n, nu1, nu2, bonded)
    g = 32 / (3 * np.pi) * thin_layer_coefficients(n, nu1, nu2, bonded)[1]
    m = 3 + g * x / (n + g * x)
    x0 = np.where(bonded, 1.5 + 2.3 * kappa, 1.55 - 1.16 * np.asarray(n, dtype=float))
    x0 = np.maximum(x0, _LEAST_LENGTH)
    kappa = np.copysign(np.maximum(np.abs(kappa), least * size), kappa)
    return x * m * kappa * x0 / (x0 + x), g * x * x / (x0 + x), m
