"""Stacks of layers on a half-space or a rigid base, by a recursion on five numbers.

In a layer the amplitudes of a wave, the state (U, W, T, S) of displacements and tractions, obey a linear equation in
ζ = kz. The 2x2 minors of its two solutions that fit to what lies below, x = (UW, WS, -US, WT, TS), obey dx/dζ = B x
(:mod:`.minors`). At the surface L = x4/((1 - nu1) x5). All of it is formed without cancellation, also at nu = 1/2.
"""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from .kernel import Sampler
from .minors import LayerPowers, across, at_surface, base, numerator, scaled, through
from .two_layers import thin_layer_coefficients

#: Below this u, L - 1 is the difference of two terms, none of which is small there.
_NEAR = 0.7
#: Values are computed for this many cases times nodes at a time: what stands in between stays in the cache.
_BLOCK = 2048


@batch.of_cases
class Stack(NamedTuple):
    """The :class:`~solver.kernels.kernel.Kernel` of B stacks of N layers, the top first.

    n, nu, depth : (B, N), moduli E_j*, Poisson ratios, and thickness over that of the first layer. The unit of moduli
        is E2*, or E1* on a rigid base, where the first layer has n = 1
    free, cn, ct : (B, N), the interface below each layer: whether it is frictionless; and its normal and tangential
        compliance times E1*/h1, 0 of a perfect bond
    nu2, rigid : (B,), Poisson ratio of the base, whose modulus is 1, and whether it is rigid
    sampler : of the family, or None: the kernel is then evaluated at all nodes
    """

    n: np.ndarray
    nu: np.ndarray
    depth: np.ndarray
    free: np.ndarray
    cn: np.ndarray
    ct: np.ndarray
    nu2: np.ndarray
    rigid: np.ndarray
    sampler: Sampler | None = None

    @property
    def E1(self):
        return self.n[:, 0]

    @property
    def L0(self):
        """E1*/E2*, whatever lies between; 0 on a rigid base."""
        return np.where(self.rigid, 0.0, self.E1)

    @property
    def slope(self):
        """dL/du at 0. Layers that are bonded to the base, and groups of layers that are bonded to each other above a
        frictionless interface, add their parts; so does the normal compliance of springs."""
        of_base = np.where(self.rigid[:, None], 0.0, self.n)
        _, A2 = thin_layer_coefficients(of_base, self.nu, self.nu2[:, None], True)
        softness, slope = self.n[:, :1] / self.n * self.depth, self.cn.sum(axis=1) / 2
        held = ~np.logical_or.accumulate(self.free[:, ::-1], axis=1)[:, ::-1]
        slope = slope + np.where(held, softness * A2, 0.0).sum(axis=1)
        group = np.cumsum(self.free[:, ::-1], axis=1)[:, ::-1]  # 0 is bonded to the base, 1 lies upon the lowest slip
        squeezed, one = softness * (1 - 2 * self.nu) / (1 - self.nu) ** 2, self.nu / (1 - self.nu)
        for number in range(1, int(group.max(initial=0)) + 1):
            own = group == number
            wide, stiff = ((own * v).sum(axis=1) for v in (self.depth * one, self.depth * self.n / self.n[:, :1]))
            stretched = wide**2 / np.where(stiff > 0, stiff, 1.0)
            slope = slope + ((own * squeezed).sum(axis=1) + stretched) / 2
        return slope

    @property
    def stiffness(self):
        """The largest of L, and of the lengths over h1 at which L varies: the thickness of the whole, and those over
        which plates and membranes spread what they carry, at most their thickness times their modulus over that of the
        softest body below."""
        softest = np.maximum((self.n[:, :1] / self.n).max(axis=1), self.L0) + self.cn.max(axis=1) / 2
        bodies = np.hstack([self.n, np.where(self.rigid, np.inf, 1.0)[:, None]])
        under = np.minimum.accumulate(bodies[:, ::-1], axis=1)[:, ::-1][:, 1:]
        return np.maximum(softest, (self.depth * np.maximum(1.0, self.n / under)).sum(axis=1))

    def formulas(self):
        return [np.arange(len(self.n))]

    def whole(self, u):
        out = np.empty((len(u), u[:1].size))
        for rows, part, layers, values in self._blocks(u.reshape(out.shape)):
            layer, X = part._under_top(values, layers, slopes=False)
            x4, x5 = at_surface(layer, values, X)[:, :, 0].transpose(1, 0, 2)
            out[rows] = x4 / ((1 - part.nu[:, :1]) * x5)
        return out.reshape(u.shape)

    def decaying_part(self, u):
        L1, uL = np.empty((2, *u.shape))
        for rows, part, layers, values in self._blocks(u):
            L1[rows], uL[rows] = part._near_and_far(values, layers)
        return L1, uL

    def _blocks(self, u):
        """Slices of cases, their kernel, its :class:`~.minors.LayerPowers` s, and their u (b, M)."""
        step, G = max(1, _BLOCK // max(1, u.shape[1])), self.n * (1 - self.nu)
        layers = [LayerPowers.of(G[:, 0] / G[:, j], self.nu[:, j]) for j in range(self.n.shape[1])]
        for low in range(0, len(u), step):
            rows = slice(low, low + step)
            yield rows, self.take(rows), [LayerPowers(layer.powers[rows]) for layer in layers], u[rows]

    def _near_and_far(self, u, layers):
        """L - 1 and u dL/du (B, M). The part of the numerator x4 - (1 - nu1) x5 and its derivative that vanishes but
        does not decay is left out where the rest is small."""
        layer, X = self._under_top(u, layers, slopes=True)
        x4, x5 = at_surface(layer, u, X).transpose(1, 2, 0, 3)
        one = 1 - self.nu[:, :1]
        below, d_below = one * x5
        above, d_above = x4[0] - below, x4[1] - d_below
        if np.any(far := u >= _NEAR):
            apart, d_apart = numerator(layer, u, X, self.nu[:, 0])
            above, d_above = np.where(far, apart, above), np.where(far, d_apart, d_above)
        L1 = above / below
        return L1, (d_above - L1 * d_below) / below

    def _under_top(self, u, layers, slopes):
        """The top layer (:class:`~.minors.LayerPowers`), and X below it; `slopes`: with derivatives by ln u."""
        g = (1 - self.nu2) / (self.n[:, 0] * (1 - self.nu[:, 0]))
        X = base(g, self.nu2, self.rigid, slopes, u.shape[1])
        for j in reversed(range(self.n.shape[1])):
            X = scaled(across(X, self.free[:, j], *self._springs(j, u)))
            if j:
                X = through(layers[j], u * self.depth[:, j, None], X)
        return layers[0], X

    def _springs(self, j, u):
        """G1 k times the compliances below layer j, (B, M) each, or None where there are none."""
        compliances = self.cn[:, j, None], self.ct[:, j, None]
        present = any(np.any(v) for v in compliances)
        return ((1 - self.nu[:, :1]) / 2 * v * u if present else None for v in compliances)
