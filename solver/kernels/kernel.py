"""The protocol of a kernel L(u), the body under the surface. One file has one kernel: :mod:`.two_layers`.

:class:`~solver.body.hankel.Hankel` uses nothing of a kernel except this protocol. A pressure with the Hankel transform
p̂(k) moves the surface by (2/E1*) ∫ L(kh) p̂(k) J0(kr) dk. E1* and h are the modulus and the thickness of the layer at
the surface; u = kh. So L(∞) = 1, and L - 1 must decay like e^(-2u).
"""

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np


class Sampler(NamedTuple):
    """Random kernels of a family. With their help a few nodes k are chosen: the values of any kernel of the family at
    these determine its values at all nodes (:func:`~solver.body.wave_rule.few`).

    draw : ``draw(random, stiffness)`` returns the kernel of S cases of about the `stiffness` (S,). In all else they
        differ as much as the cases of users do; `random` is a numpy Generator
    few : number of few nodes for each class of stiffness of :mod:`~solver.body.wave_rule`. They come from a test: the
        error is then no more than rounding
    samples : number of random kernels that are drawn for each class
    mild : if it is not 0, the second class is divided at this stiffness. The kernels below it have a number of few
        nodes and of samples of their own, at index :data:`~solver.body.wave_rule.MILD` of `few` and `samples`
    """

    draw: Callable
    few: tuple[int, ...]
    samples: tuple[int, ...] = (200, 200, 200, 200)
    mild: float = 0.0


class Kernel(Protocol):
    """L of B cases.

    E1 : (B,), E1* in E2*; on a rigid base in the unit of moduli there
    L0 : (B,), L at u = 0
    slope : (B,), dL/du at u = 0: the thin layer of Eq. (3) has the kernel L0 + slope u
    stiffness : (B,), the larger of the largest L and the longest length, over h, at which L still varies. Where it is
        above 2, L is a straight line below u = 0.15/stiffness
    sampler : Sampler of the family; None: L is evaluated at all nodes, some hundreds to two thousand
    take : the kernel of a sub-batch, :func:`~solver.numerics.batch.take`
    """

    E1: np.ndarray
    L0: np.ndarray
    slope: np.ndarray
    stiffness: np.ndarray
    sampler: Sampler | None
    take: Callable

    def formulas(self):
        """Groups of cases that share a formula: a list of indices (b,). Each group is evaluated by itself."""

    def whole(self, u):
        """L at u (B,) or (B, M), of the shape of u."""

    def decaying_part(self, u):
        """L - 1 and u dL/du at u (B, M), (B, M) each, formed without cancellation: they have all digits even where they
        are small."""
