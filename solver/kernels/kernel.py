"""The protocol of a kernel L(u), the body under the surface. One file has one kernel: :mod:`.two_layers`.

:class:`~solver.body.hankel.Hankel` asks a kernel for nothing else, nor which kernel it is. A pressure with the
Hankel transform p̂(k) moves the surface by (2/E1*) ∫ L(kh) p̂(k) J0(kr) dk. E1* is the modulus of what lies at the
surface, and h the thickness of the layer there; u = kh. So L(∞) = 1, and L - 1 must decay like e^(-2u).
"""

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np


class Sampler(NamedTuple):
    """Random kernels of a family. They choose the few nodes k at which L determines L at all others, for the family
    (:func:`~solver.body.wave_rule.few`).

    draw : ``draw(random, stiffness)`` gives the kernel of S cases of about the `stiffness` (S,), and else as different
        as the cases of users are; `random` is a numpy Generator
    few : number of few nodes of each class of stiffness of :mod:`~solver.body.wave_rule`. A test finds them: with so
        many nodes, the others leave out no more than rounding
    samples : number of random kernels that choose those of each class
    mild : the second class is divided at this stiffness, where it is not 0: kernels below it have `few` and `samples`
        of their own, which stand after those of all classes and one that has no meaning
    """

    draw: Callable
    few: tuple[int, ...]
    samples: tuple[int, ...] = (200, 200, 200, 200)
    mild: float = 0.0


class Kernel(Protocol):
    """L of B cases.

    E1 : (B,), E1* in E2*; on a rigid base in the unit of moduli there
    L0 : (B,), L at u = 0
    slope : (B,), dL/du at u = 0: the thin layer of Eq. (3) is L0 + slope u
    stiffness : (B,), the largest of L, and of the lengths over h at which L still varies: below u = 0.15/stiffness
        (where that is above 2) L is a straight line
    sampler : Sampler of the family, or None: L is then evaluated at all nodes, some hundreds to two thousand
    take : the kernel of a sub-batch, :func:`~solver.numerics.batch.take`
    """

    E1: np.ndarray
    L0: np.ndarray
    slope: np.ndarray
    stiffness: np.ndarray
    sampler: Sampler | None
    take: Callable

    def formulas(self):
        """Indices of the cases that one formula serves, a list of (b,): each is evaluated by itself."""

    def whole(self, u):
        """L at u (B,) or (B, M), of the shape of u."""

    def decaying_part(self, u):
        """L - 1 and u dL/du at u (B, M), (B, M) each: formed without a difference, so that they are right where they
        are small."""
