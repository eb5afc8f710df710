"""The thin layer, Eq. (3): a half-space that carries springs, and the coefficients A1, A2 of both.

The displacement of the surface under an axisymmetric pressure is (2/E1*) ∫ L(kh) p̂ J0 dk. The thin-layer model takes
L(u) ≈ A1 + A2 u, Eq. (2): the displacement is then (4 A1/(π E1*)) a H[p] + C p with C = 2 A2 h/E1*, Eq. (3).
"""

import numpy as np

from .half_space import HalfSpace

#: n of a base that stands for a rigid one under the thin layer: the equation divides by the half-space's part X, which
#: must not be 0. Then X is below 1e-20 of the springs' part Y for every h and a within the bounds, and n³ is no
#: underflow.
STIFF = 1e-50


def thin_layer_coefficients(n, nu1, nu2, bonded):
    """Coefficients A1 and A2 (B,) of the thin-layer kernel L(u) ≈ A1 + A2 u, Eq. (2), for any Poisson ratios. Arguments
    as those of :func:`~solver.body.kernel.layered_kernel`, (B,) each.

    A1 = n; A2 = 1/2 without friction. Bonded, with alpha = G1/G2 = n (1 - nu1)/(1 - nu2), it is (1 + alpha (1 - 2 nu2))
    (1 - 2 nu1 - alpha (1 - 2 nu2)) / (2 (1 - nu1)²); for nu1 = nu2 that is the paper's Eq. (2). A2 <= 0 (nu1 = 1/2, or
    alpha >= (1 - 2 nu1)/(1 - 2 nu2)) means that the thin-layer equation does not apply.

    >>> A1, A2 = thin_layer_coefficients(0.5, 0.3, 0.3, True)
    >>> print(float(A1), round(float(A2), 12))
    0.5 0.244897959184
    """
    n, nu1, nu2 = (np.asarray(v, dtype=float) for v in (n, nu1, nu2))
    stiffness = n * (1 - nu1) / (1 - nu2) * (1 - 2 * nu2)
    A2 = (1 + stiffness) * (1 - 2 * nu1 - stiffness) / (2 * (1 - nu1) ** 2)
    return n * 1.0, np.where(bonded, A2, 0.5)


def local_compliance(h, n, nu1, nu2, bonded):
    """C = 2 A2 h/E1* of Eq. (3), (B,) in R/E2*; h (B,) in R, the other arguments as above. Where C <= 0 the thin-layer
    equation does not apply."""
    _, A2 = thin_layer_coefficients(n, nu1, nu2, bonded)
    return 2 * A2 * h / layer_modulus(n)


def layer_modulus(n):
    """E1* in the unit of moduli. That is E2*, so E1* is n; on a rigid base, n = 0, it is E1* itself, so E1* is 1."""
    return n + (n == 0)


def thin_layer(h, n, nu1, nu2, bonded, m):
    """The thin layer, Eq. (3): a half-space of E2* that carries springs, under a punch of m = E1*/E3*."""
    return HalfSpace(layer_modulus(n) / np.maximum(n + m, STIFF), local_compliance(h, n, nu1, nu2, bonded))
