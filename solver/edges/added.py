"""A pressure of known shape beside q: its column of the operator, for edges and whoever else adds one."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..body.operator import Operator


class Shape(NamedTuple):
    """A pressure g(x) on 0 <= x < 1 that is no polynomial in s = sqrt(1 - x²).

    pressure : s (m,) -> g (m,)
    waves : k (G,) in 1/a -> the Hankel transform ∫₀¹ g J0(kx) x dx (G,)
    load : ∫₀¹ g x dx
    half_space : s (m,) -> H[g](x) - H[g](1), (m,), of Eq. (3)
    edge : H[g](1)
    """

    pressure: Callable
    waves: Callable
    load: float
    half_space: Callable
    edge: float


#: 1/s, the pressure of a flat punch on a half-space, which it presses down evenly.
FLAT = Shape(
    pressure=lambda s: 1 / s, waves=lambda k: np.sin(k) / k, load=1.0, half_space=lambda s: 0 * s, edge=np.pi**2 / 4
)


class WithAdded(NamedTuple):
    """The :class:`~solver.body.operator.Operator` of q, which is `plain`, and of a `shape` together. The shape has the
    `strength`, whose derivative by ln a is `growth`, (B,) both. `column`, `d_column` (B, n + 1): K of the shape at the
    nodes, at last the displacement of the edge; and the derivative by ln a."""

    plain: Operator
    shape: Shape
    strength: np.ndarray
    growth: np.ndarray
    column: np.ndarray
    d_column: np.ndarray

    @classmethod
    def of(cls, plain, shape, strength, growth):
        half_space = np.append(shape.half_space(plain.mesh.s), shape.edge)
        columns = (
            np.broadcast_to(v, (len(strength), v.shape[1])) for v in plain.wave_products(shape.waves, half_space)
        )
        return cls(plain, shape, strength, growth, *columns)

    @property
    def mesh(self):
        return self.plain.mesh

    @property
    def K(self):
        return self.plain.K

    @property
    def edge(self):
        return self.plain.edge

    def take(self, index):
        return WithAdded(self.plain.take(index), self.shape, *(v[index] for v in self[2:]))

    def join(self, operators, places):
        plain = self.plain.join([operator.plain for operator in operators], places)
        order = np.argsort(np.concatenate(places))
        arrays = (np.concatenate(v)[order] for v in zip(*(operator[2:] for operator in operators), strict=True))
        return WithAdded(plain, self.shape, *arrays)

    def at_edge(self, q):
        return self.plain.at_edge(q) + self.strength * self.column[:, -1]

    def products(self, q):
        return self._plus(self.plain.products(q), self.strength[:, None] * self.column)

    def slopes(self, q):
        moved = self.growth[:, None] * self.column + self.strength[:, None] * self.d_column
        return self._plus(self.plain.slopes(q), moved)

    def _plus(self, products, column):
        """`products` at the nodes and at the edge, (B, n) and (B,), with a column (B, n + 1) added."""
        return products[0] + column[:, :-1], products[1] + column[:, -1]

    def between(self, q, s, half_space):
        column = self.plain.waves_between(self.shape.waves, s, self.shape.half_space(s))
        return self.plain.between(q, s, half_space) + self.strength[:, None] * column
