"""A body with a kernel L: the half-space of E1* at its surface, plus a Hankel integral over L - 1.

    K q = H[q] + (π/2) Λ[q], both less their values at the edge,
    Λ_ij = ∫₀^∞ (L(kh/a) - 1) J0(k x_i) φ_j(k) dk,   φ_j(k) = ∫₀¹ l_j J0(kx) x dx,

with k in units of 1/a, and l_j the Lagrange polynomials of the mesh. H carries the whole singularity. L - 1 decays like
e^(-2u), so Λ is smooth for every h/a. The factors that depend only on k and the mesh are tabulated for each octave of
h/a (:mod:`.tables`). The matrices of a batch are one product with that table, and the derivatives by ln a come from
u dL/du. Where two octaves meet, they agree to the error of the quadrature. Layers with h/a below the first octave are
films. They all share one quadrature, which ends at k = CUT; :mod:`.film` adds the waves beyond it. The kernels are in
:mod:`..kernels`.
"""

from typing import NamedTuple

import numpy as np

from ..kernels.kernel import Kernel
from ..numerics import batch
from .half_space import thin_layer
from .hankel_operator import HankelOperator, rows_of
from .operator import fitted_nodes
from .part import parts_of
from .wave_rule import CUT, FILM, place_of

#: A layer thinner than this times the radius is displaced nearly as the thin layer is.
_THIN = 0.02
#: Work of a lone case in the unit of :meth:`.operator.Body.work`; each pair is for films and for thicker layers. A new
#: mesh takes _MESH for each node of a film, or for each entry of the matrix of a thicker layer. A Newton step takes
#: _STEP, and _ENTRY for each entry. They are ratios of processor times, right to a factor of two: BUDGET needs no more.
_MESH, _STEP, _ENTRY = (1000.0, 2.0), (4000.0, 600.0), (0.3, 0.1)
#: The rounding error, 1e-14 for each node, is divided by L at this k; the first is for films, the second for thicker
#: layers. A layer on a rigid base hardly gives way to a long wave: there L is a small difference of large terms, and of
#: more terms in films. With k = 10 the depth of a film of nu1 = 1/2 on a rigid base is 30 times as far off as its error
#: bar says (test_rounding of tests/body/test_rigid_base.py).
_ROUNDED = (2.5, 4.0)
#: The kernel has a rounding error of _PLATE times its largest value, n. The displacement by short waves is n times
#: smaller, and so the pressure has a relative rounding error of n _PLATE. In a plate that nearly lifts off, p(0) is a
#: hundred times below the largest pressure: without this term p(0) is up to a hundred times as far off as its error bar
#: says (tests/rough/errors/test_plates.py).
_PLATE = 3 * np.finfo(float).eps
#: Waves with u = kh above _SHORT feel only the layer. Up to there the integral of :meth:`Hankel.unseen` has _POINTS
#: points, evenly spaced in ln u (test_the_estimate_encloses_films_that_no_mesh_sees of
#: tests/rough/errors/test_accuracy.py).
_SHORT, _POINTS = 45.0, 64


@batch.of_cases
class Hankel(NamedTuple):
    """The :class:`~solver.body.operator.Body` of B cases with a kernel. Arrays (B,): h, the thickness of the layer at
    the surface, in R, and m = E1*/E3*.

    The punch is displaced like a half-space of E3*. So relative to E1* the kernel of body and punch together is L + m.
    Relative to their common modulus E, 1/E = 1/E1* + 1/E3*, it is (L + m)/(1 + m), and L - 1 becomes (L - 1)/(1 + m).
    """

    kernel: Kernel
    h: np.ndarray
    m: np.ndarray

    @property
    def E(self):
        return self.kernel.E1 / (1 + self.m)

    @property
    def L0(self):
        """The kernel (B,) at u = 0."""
        return (self.kernel.L0 + self.m) / (1 + self.m)

    def whole(self, u):
        """The kernel (L + m)/(1 + m) (B,) at u (B,)."""
        return (self.kernel.whole(u) + self.m) / (1 + self.m)

    @property
    def C(self):
        return 0 * self.m

    def at(self, a, mesh, near=None):
        """A case whose radius is the same as in `near` takes the values of L from there."""
        parts, far = [], np.ones(len(a), dtype=bool)
        for part in () if near is None else near.parts:
            same = np.flatnonzero(a[part.index] == part.radius)
            if len(same):
                far[part.index[same]] = False
                parts.append(part.take(same))
        if near is not None and near.mesh == mesh and not far.any():
            return near
        parts += parts_of(self, a, np.flatnonzero(far))
        return HankelOperator(mesh, parts, rows_of(parts, mesh))

    def softness(self, a):
        """The kernel at the wave number 1.5/a."""
        return self.whole(1.5 * self.h / a)

    def error(self, a, nodes):
        """The rounding error, and for films the error of the convolution."""
        octave, _ = place_of(self, a)
        L = self.whole(np.where(octave == FILM, *_ROUNDED) * self.h / a)
        error, film = 1e-14 * nodes / np.minimum(L, 1.0), np.flatnonzero(octave == FILM)
        if len(film):
            thin = self.take(film)
            L, L0 = thin.whole(10 * thin.h / a[film]), thin.L0
            error[film] += np.abs(L - L0) / np.maximum(L, L0) / CUT**2
        return error

    def rounding(self):
        return _PLATE * np.maximum(self.L0, 1.0)

    def unseen(self, a, s1):
        """The solution has waves of k up to 1/s1². Shorter ones, u > u1 = h/(a s1²), move the edge by
        (h/π) ∫ ln[L(u)/L(u1)] du/u², as in :mod:`..models.thin_layer_error`. Here the integral is over |ln|, because
        waves that cancel at the edge may not cancel in the pressure. Beyond _SHORT the logarithm is constant."""
        h_a, shift = self.h / a, np.zeros(len(a))
        thin = np.flatnonzero(h_a < _SHORT * s1**2)
        if not len(thin):
            return shift
        u = np.geomspace(h_a[thin] / s1**2, _SHORT, _POINTS, axis=1)
        level = np.log(self.kernel.take(thin).whole(u) + self.m[thin, None])
        f = np.abs(level - level[:, :1]) / u
        shift[thin] = (np.trapezoid(f, np.log(u), axis=1) + f[:, -1]) * h_a[thin] / np.pi
        return shift

    def work(self, a, nodes):
        film = place_of(self, a)[0] == FILM
        mesh, least, entry = (np.where(film, *pair) for pair in (_MESH, _STEP, _ENTRY))
        return mesh * np.where(film, nodes, nodes**2), least + entry * nodes**2

    def order(self, a):
        """Cases with the same table become neighbours: so there are fewer and larger matrix products."""
        return np.lexsort(place_of(self, a))

    def alike(self, a):
        """The thin layer, if in all cases the layer is much thinner than a and the thin-layer equation applies."""
        thin = thin_layer(self.h, self.kernel, self.m)
        return thin if np.all((self.h < _THIN * a) & (thin.C > 0)) else None

    def first_nodes(self, rtol, a, rise=None):
        """Under asperities the number is that on a half-space. Under a smooth punch it falls with the thickness."""
        smooth = 0.9 * np.clip(self.h / a, 0.0, 1.0), 2.3
        return fitted_nodes(rtol, *(smooth if rise is None else (rise, 1.1)))
