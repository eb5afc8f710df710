"""A layer on a half-space, frictionless or bonded: its kernel, formed by :mod:`.closed_form`, and the kernel A1 + A2 u
of a thin layer."""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from .closed_form import decaying_part, whole
from .kernel import Sampler
from .transfer import THIN, Bodies, LayerWaves


@batch.of_cases
class TwoLayers(NamedTuple):
    """The :class:`~solver.kernels.kernel.Kernel` and the :class:`~.transfer.Layered` of B layers on half-spaces, arrays
    (B,): n = E1*/E2*, the Poisson ratios nu1, nu2 of layer and half-space, and whether they are bonded."""

    n: np.ndarray
    nu1: np.ndarray
    nu2: np.ndarray
    bonded: np.ndarray

    @classmethod
    def of(cls, problem):
        """The kernel of the cases of a :class:`~solver.problem.Problem`."""
        return cls(problem.n, problem.nu1, problem.nu2, problem.bonding == "bonded")

    @property
    def E1(self):
        return layer_modulus(self.n)

    @property
    def L0(self):
        return self.n

    @property
    def slope(self):
        return thin_layer_coefficients(*self)[1]

    @property
    def stiffness(self):
        """A stiff layer is a plate, whose kernel falls at u ~ n^(-1/3), and if bonded also a membrane, whose kernel
        falls at u ~ 1/n."""
        return self.n

    @property
    def sampler(self):
        return SAMPLER

    def formulas(self):
        return [np.flatnonzero(self.bonded), np.flatnonzero(~self.bonded)]

    def whole(self, u):
        return whole(u, *(self if u.ndim == 1 else self._columns()))

    def decaying_part(self, u):
        return decaying_part(u, *self._columns())

    def _columns(self):
        return (field[:, None] for field in self)

    @property
    def poisson(self):
        return np.stack([self.nu1, self.nu2], axis=1)

    @property
    def shear(self):
        return np.stack([layer_modulus(self.n) * (1 - self.nu1), 1 - self.nu2], axis=1)

    @property
    def rigid(self):
        return self.n == 0

    @property
    def slips(self):
        return ~self.bonded

    def tops(self, h):
        return np.stack([0 * h, h], axis=1)

    def uniform(self):
        return bool(np.all((self.n == 1) & (self.nu1 == self.nu2) & self.bonded))

    def longest(self, h):
        return max(1.0, h.max()) * max(1.0, self.n.max())

    def few(self, k, h):
        return int((np.sqrt(h.min() * h.max()) * k < THIN).sum())

    def waves(self, k, h, load):
        return LayerWaves(Bodies.of(self), k, h, load, self.few(k[:1], h) == 1)


def random_layers(random, n):
    """:class:`TwoLayers` with the moduli n (S,). Two thirds of them are bonded; one Poisson ratio in five is below
    0."""
    size = len(n)
    bonded = random.random(size) < 0.67
    nu = np.where(random.random((2, size)) < 0.8, random.uniform(0, 0.5, (2, size)), random.uniform(-1, 0, (2, size)))
    return TwoLayers(n, *nu, bonded)


#: The numbers of few nodes are the largest that any octave of h/a needs; tests/body/test_wave_rule.py checks the error
#: that remains.
SAMPLER = Sampler(random_layers, (52, 90, 104, 104))


def thin_layer_coefficients(n, nu1, nu2, bonded):
    """Coefficients A1 and A2 (B,) of the thin-layer kernel L(u) ≈ A1 + A2 u, Eq. (2), for any Poisson ratios. Arguments
    as those of :func:`.closed_form.layered_kernel`, (B,) each.

    A1 = n. Without friction A2 = 1/2. With a bond, A2 = (1 + alpha (1 - 2 nu2)) (1 - 2 nu1 - alpha (1 - 2 nu2)) /
    (2 (1 - nu1)²), alpha = G1/G2 = n (1 - nu1)/(1 - nu2); for nu1 = nu2 that is the paper's Eq. (2). A2 <= 0 (nu1 =
    1/2, or alpha >= (1 - 2 nu1)/(1 - 2 nu2)) means that the thin-layer equation does not apply.

    >>> A1, A2 = thin_layer_coefficients(0.5, 0.3, 0.3, True)
    >>> print(float(A1), round(float(A2), 12))
    0.5 0.244897959184
    """
    n, nu1, nu2 = (np.asarray(v, dtype=float) for v in (n, nu1, nu2))
    stiffness = n * (1 - nu1) / (1 - nu2) * (1 - 2 * nu2)
    A2 = (1 + stiffness) * (1 - 2 * nu1 - stiffness) / (2 * (1 - nu1) ** 2)
    return n * 1.0, np.where(bonded, A2, 0.5)


def layer_modulus(n):
    """E1* in the unit of moduli. The unit is E2*, and E1* is n. On a rigid base, n = 0, the unit is E1* itself, and E1*
    is 1."""
    return n + (n == 0)
