"""Stacks of layers, bonded or without friction, on a half-space or a rigid base: a kernel in one file.

In a layer the amplitudes of a wave, state (U, W, T, S) of displacements and tractions, obey a linear equation in
ζ = kz. The 2x2 minors of its two solutions that fit to what lies below, x = (UW, WS, -US, WT, TS), obey dx/dζ = B x
with B⁵ = 4 B³: so exp(ζB) has five terms, and all of it is formed without cancellation, also at nu = 1/2.
"""

from typing import NamedTuple

import numpy as np

from solver.kernels.kernel import Sampler


class Stack(NamedTuple):
    """The :class:`~solver.kernels.kernel.Kernel` of B stacks of N layers, the top first, arrays (B, N): moduli `n` =
    E_j*/E2* (over E1* where the base is `rigid`), Poisson ratios `nu`, thickness `h` over that of the first, and
    whether each is `bonded` to what lies below. nu2, rigid : (B,), the base."""

    n: np.ndarray
    nu: np.ndarray
    h: np.ndarray
    bonded: np.ndarray
    nu2: np.ndarray
    rigid: np.ndarray
    sampler: Sampler | None = None

    @property
    def E1(self):
        return self.n[:, 0]

    @property
    def L0(self):
        return np.where(self.rigid, 0.0, self.E1)

    @property
    def slope(self):
        return np.full(len(self.n), np.nan)  # not known: there is no thin layer of it

    @property
    def stiffness(self):
        """L varies with the thickness of the whole, and is the larger the softer a layer below the first."""
        return np.maximum((self.n[:, :1] / self.n).max(axis=1), np.maximum(self.L0, self.h.sum(axis=1)))

    def take(self, index):
        return Stack(*(field[index] for field in self[:-1]), self.sampler)

    def formulas(self):
        return [np.arange(len(self.n))]

    def whole(self, u):
        x, _, below, _, _ = self._surface(u.reshape(len(u), -1))
        return (x[..., 3] / below).reshape(u.shape)

    def decaying_part(self, u):
        x, dx, below, d_below, far = self._surface(u)
        near = u < 0.7  # where nothing cancels in a difference
        above = np.where(near, x[..., 3] - below, far[0])
        d_above = np.where(near, dx[..., 3] - d_below, far[1])
        return above / below, (d_above - above / below * d_below) / below

    def _surface(self, u):
        """x and dx/d ln u (B, M, 5) at the surface, up to a factor; of L = x4/below, below = (1 - nu1) x5 and its
        derivative; and x4 - below and its derivative, formed without a difference."""
        G = self.n * (1 - self.nu) / 2
        x = self._base(G[:, 0])[:, None] * np.ones_like(u)[..., None]
        dx = 0 * x
        for j in reversed(range(self.n.shape[1])):
            free = ~self.bonded[:, j, None, None]
            x, dx = (np.where(free, v[..., [3, 1, 4, 1, 1]] * [1, 0, 1, 0, 0], v) for v in (x, dx))
            size = np.abs(x).max(axis=-1, keepdims=True)
            powers, z = _powers(G[:, 0] / G[:, j], self.nu[:, j]), u * self.h[:, j, None]
            under = x / size, dx / size
            x, dx = _through(powers, z, *under)
        one = 1 - self.nu[:, :1]
        return x, dx, one * x[..., 4], one * dx[..., 4], _decaying(powers, z, *under, one)

    def _base(self, G1):
        g, nu = (1 - self.nu2) / 2 / G1, self.nu2
        half_space = np.stack(
            [3 - 4 * nu, 2 * g * (1 - 2 * nu), 4 * g * (1 - nu), 4 * g * (1 - nu), 4 * g * g], axis=-1
        )
        return np.where(self.rigid[:, None], [0.0, 0.0, 0.0, 0.0, 1.0], half_space)


def _powers(g, nu):
    """B, B², B³, B⁴ (B, 5, 5) each, of layers with G1/G = g."""
    c, d, e, o = g * (1 - 2 * nu) / (2 * (1 - nu)), 2 / (g * (1 - nu)), nu / (1 - nu), 0 * g
    rows = [o, o, c, g, o], [o, o, -e, o + 1, o], [o, o + 2, o, o, g], [d, -2 * e, o, o, c], [o, o, d, o, o]
    B = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
    return B, B @ B, B @ B @ B, B @ B @ B @ B


def _times(matrix, x):
    return x @ np.swapaxes(matrix, -1, -2)


def _through(powers, z, x, dx):
    """exp(zB) x and its derivative by ln z, both times e^(-2z)."""
    y, e = 2 * z, np.exp(-2 * z)
    small = np.minimum(y, 1.0) ** 2
    series = [1.0, 1.0]
    for j in range(12, 0, -1):
        series = [1 + small / ((2 * j + 2 + i) * (2 * j + 3 + i)) * series[i] for i in (0, 1)]
    sinh = np.where(y < 1, e * y**3 / 6 * series[0], -np.expm1(-2 * y) / 2 - y * e)
    cosh = np.where(y < 1, e * y**4 / 24 * series[1], (1 - e) ** 2 / 2 - y * y / 2 * e)
    terms = [v[..., None] for v in (z * e, z * z / 2 * e, sinh / 8, cosh / 16)]

    def power(v):
        return e[..., None] * v + sum(term * _times(B, v) for term, B in zip(terms, powers, strict=True))

    moved = power(x)
    return moved, power(dx) + z[..., None] * _times(powers[0], moved)


def _decaying(powers, z, x, dx, one):
    """(0, 0, 0, 1, -(1 - nu1)) exp(zB) x and its derivative by ln z, both times e^(-2z): what does not decay of exp(zB)
    is 0 there, and is left out."""
    B, B2, B3, B4 = powers
    e, z = np.exp(-2 * z)[..., None], z[..., None]

    def rest(v):
        slow = v - _times(B4, v) / 16 + z * _times(B - B3 / 4, v) + z * z / 2 * _times(B2 - B4 / 4, v)
        return e * slow + e * e * _times(B4 - 2 * B3, v) / 32

    r = rest(x)
    d = rest(dx) + z * _times(B, r)
    return tuple(v[..., 3] - one * v[..., 4] for v in (r, d))


def random_stacks(random, stiffness):
    """:class:`Stack` of three layers: one of the softest or the thickest layer makes the stiffness, at random."""
    size = len(stiffness)
    n = np.exp(random.uniform(-3, 3, (size, 3)))
    h = np.concatenate([np.ones((size, 1)), np.exp(random.uniform(-3, 1, (size, 2)))], axis=1)
    kind, by = random.integers(4, size=size), np.maximum(stiffness, 1e-9)
    n[:, 0] = np.where(kind == 0, by, n[:, 0])
    n[:, 1] = np.where(kind == 1, n[:, 0] / by, n[:, 1])
    n[:, 2] = np.where(kind == 2, n[:, 0] / by, n[:, 2])
    h[:, 2] = np.where((kind == 3) & (by > 3), by - 2, h[:, 2])
    nu, nu2 = random.uniform(0, 0.5, (size, 3)), random.uniform(0, 0.5, size)
    return Stack(n, nu, h, random.random((size, 3)) < 0.7, nu2, random.random(size) < 0.2, SAMPLER)


#: Few nodes of each class; test_few_nodes_determine_a_stack finds what they leave out.
SAMPLER = Sampler(random_stacks, (130, 200, 240, 280))
