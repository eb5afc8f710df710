"""The thin layer, Eq. (3): a half-space that carries springs.

The displacement of the surface under an axisymmetric pressure is (2/E1*) ∫ L(kh) p̂ J0 dk. The thin-layer model takes
L(u) ≈ A1 + A2 u, Eq. (2): the displacement is then (4 A1/(π E1*)) a H[p] + C p with C = 2 A2 h/E1*, Eq. (3).
"""

import numpy as np

from .half_space import HalfSpace

#: n of a base that stands for a rigid one under the thin layer: the equation divides by the half-space's part X, which
#: must not be 0. Then X is below 1e-20 of the springs' part Y for every h and a within the bounds, and n³ is no
#: underflow.
STIFF = 1e-50


def local_compliance(h, kernel):
    """C = 2 A2 h/E1* of Eq. (3), (B,) in R/E2*; h (B,) in R, A2 the slope of the :class:`~solver.kernels.kernel.Kernel`
    of the layer. Where C <= 0 the thin-layer equation does not apply."""
    return 2 * kernel.slope * h / kernel.E1


def thin_layer(h, kernel, m):
    """The thin layer, Eq. (3): a half-space that carries springs, under a punch of m = E1*/E3*; arrays (B,)."""
    return HalfSpace(kernel.E1 / np.maximum(kernel.L0 + m, STIFF), local_compliance(h, kernel))
