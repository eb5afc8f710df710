"""The nodes on the contact radius and the half-space operator on them, built once per node count and cached.

The variable is s = sqrt(1 - x²), x = r/a. In it the pressure is smooth at the centre (it is a function of x²) and at
the edge (an expansion in sqrt(1 - x)), Hertz's pressure is the polynomial s, the right-hand side of Eq. (4) is s², and
x dx = -s ds. The nodes are Gauss-Radau with the centre s = 1 among them, so that p(0) is an unknown and not an
interpolate.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.special import ellipkm1

from .quadrature import gauss_legendre, lagrange, log_rule, radau_nodes

#: For Hertz's pressure the operator is (H[s])(x) - (H[s])(1) = HERTZ s², which makes the first guess exact there.
HERTZ = np.pi**2 / 16


@dataclass(frozen=True)
class Mesh:
    """Discretisation of the contact radius with n nodes.

    Attributes
    ----------
    s, x : (n,) float
        Nodes sqrt(1 - x²), ascending, the last one the centre s = 1; and the radii x = r/a.
    w : (n,) float
        Weights of ∫₀¹ q x dx; exact for polynomials in s of degree n - 1, and to degree 2n - 3 at these nodes.
    K : (n, n) float
        Half-space operator H[q](x_i) - H[q](1), where H[q](x) = ∫₀¹ q(x') K(k)/(x + x') x' dx' of Eq. (3), K(k) the
        complete elliptic integral of the first kind. For q = s it is (π²/16) s².
    edge : (n,) float
        H[q](1): the displacement at the edge of the contact, which gives D without an interpolation.
    """

    s: np.ndarray
    x: np.ndarray
    w: np.ndarray
    K: np.ndarray
    edge: np.ndarray

    @property
    def n(self):
        """Number of nodes."""
        return len(self.s)


@lru_cache(maxsize=64)
def mesh(n):
    """The :class:`Mesh` with `n` nodes (n >= 2); cached, the arrays are read-only."""
    s = radau_nodes(n)
    edge = half_space_rows(s, np.zeros(1))[0]
    K = half_space_rows(s, s) - edge
    points, weights = gauss_legendre(n)
    w = (weights * points) @ lagrange(s, points)
    x = np.sqrt((1 - s) * (1 + s))
    for array in (x, w, K, edge):
        array.flags.writeable = False
    return Mesh(s=s, x=x, w=w, K=K, edge=edge)


def half_space_rows(nodes, s_out):
    """Half-space operator H[q](x), Eq. (3), against the Lagrange basis in s.

    Parameters
    ----------
    nodes : (n,) float
        Nodes in s of the basis.
    s_out : (m,) float, [0, 1]
        Where the displacement is wanted, s = sqrt(1 - x²).

    Returns
    -------
    (m, n) float
        Rows that give H[q] at the points from q at the nodes.

    Notes
    -----
    K(k)/(x + x') = K(x_</x_>)/x_> (Landen), so the integrand has the one singularity log|s - s'|: the integral is
    split there, each side has dyadic panels towards it. The complementary parameter 1 - k² is formed from the
    distance to the singularity, so nothing is lost near it. Accurate to about 1e-15 of the largest entry.
    """
    distance, weight = log_rule(16 + len(nodes) // 2)
    rows = np.empty((len(s_out), len(nodes)))
    for i, s in enumerate(s_out):
        rows[i] = _outside(nodes, s, distance, weight) + _inside(nodes, s, distance, weight)
    return rows


def _outside(nodes, s, distance, weight):
    """Part x' > x of the integral: s' from 0 to s."""
    if s == 0.0:
        return np.zeros(len(nodes))
    if s == 1.0:  # the centre: K = pi/2 and dx' = s' ds'/x'; s' = sin(phi) removes the root
        phi, w = gauss_legendre(64 + len(nodes))
        sin = np.sin(np.pi / 2 * phi)
        return (np.pi / 2) * ((np.pi / 2 * w * sin) @ lagrange(nodes, sin))
    gap = s * distance
    point = s - gap
    outer2 = (1 - point) * (1 + point)  # x'^2
    kernel = ellipkm1(gap * (s + point) / outer2) / np.sqrt(outer2)
    return (s * weight * kernel * point) @ lagrange(nodes, point)


def _inside(nodes, s, distance, weight):
    """Part x' < x of the integral: s' from s to 1."""
    if s == 1.0:
        return np.zeros(len(nodes))
    gap = (1 - s) * distance
    point = s + gap
    outer2 = (1 - s) * (1 + s)  # x^2
    kernel = ellipkm1(np.minimum(gap * (s + point) / outer2, 1.0)) / np.sqrt(outer2)
    return ((1 - s) * weight * kernel * point) @ lagrange(nodes, point)
