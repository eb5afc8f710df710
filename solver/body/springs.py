"""The elastic base: the coefficients of the layered half-space.

Surface displacement under an axisymmetric pressure: u = (2/E1*) ∫ L(kh) p̂ J0 dk. The thin-layer model takes L(u) ≈
A1 + A2 u, Eq. (2), so that u = (4 A1/(π E1*)) a H[p] + C p with C = 2 A2 h/E1*, Eq. (3).
"""

import numpy as np

from .half_space import HalfSpace

#: n of a base that stands for a rigid one under the thin layer: the equation divides by the half-space's part X, which
#: must not be 0, and is here below 1e-20 of that of the springs for every h and a within the bounds. Squares and cubes
#: of it are still far from the least float.
STIFF = 1e-50


def thin_layer_coefficients(n, nu1, nu2, bonded):
    """Coefficients A1 and A2 of the thin-layer kernel L(u) ≈ A1 + A2 u, Eq. (2), for any Poisson ratios.

    Parameters
    ----------
    n : (B,) float, >= 0
        E1*/E2*; 0 on a rigid base.
    nu1, nu2 : (B,) float, (-1, 0.5]
        Poisson ratios of the layer and of the half-space; not used without friction.
    bonded : (B,) bool
        Perfect bond, or a frictionless interface.

    Returns
    -------
    A1, A2 : (B,) float
        A1 = n; A2 = 1/2 without friction. A2 <= 0 (bonded: nu1 = 1/2, or alpha >= (1 - 2 nu1)/(1 - 2 nu2)) means
        that the thin-layer equation does not apply.

    Notes
    -----
    With alpha = G1/G2 = n (1 - nu1)/(1 - nu2):
    A2 = (1 + alpha (1 - 2 nu2)) (1 - 2 nu1 - alpha (1 - 2 nu2)) / (2 (1 - nu1)²); for nu1 = nu2 it is the paper's
    Eq. (2).

    Examples
    --------
    >>> A1, A2 = thin_layer_coefficients(0.5, 0.3, 0.3, True)
    >>> print(float(A1), round(float(A2), 12))
    0.5 0.244897959184
    """
    n, nu1, nu2 = (np.asarray(v, dtype=float) for v in (n, nu1, nu2))
    stiffness = n * (1 - nu1) / (1 - nu2) * (1 - 2 * nu2)
    A2 = (1 + stiffness) * (1 - 2 * nu1 - stiffness) / (2 * (1 - nu1) ** 2)
    return n * 1.0, np.where(bonded, A2, 0.5)


def local_compliance(h, n, nu1, nu2, bonded):
    """C = 2 A2 h/E1* of Eq. (3), in R/E2*; <= 0 where the thin-layer equation does not apply. Shapes as above, h in
    R."""
    _, A2 = thin_layer_coefficients(n, nu1, nu2, bonded)
    return 2 * A2 * h / layer_modulus(n)


def layer_modulus(n):
    """E1* in the unit of moduli, which is E2*: n. On a rigid base, n = 0, the unit is E1* itself: 1."""
    return n + (n == 0)


def thin_layer(h, n, nu1, nu2, bonded, m):
    """The thin layer, Eq. (3): a half-space of E2* that carries springs, under a punch of m = E1*/E3*."""
    return HalfSpace(layer_modulus(n) / np.maximum(n + m, STIFF), local_compliance(h, n, nu1, nu2, bonded))
