"""Stacks of layers on a half-space or a rigid base, by a recursion on five numbers.

The amplitudes of a wave in a layer are its state (U, W, T, S), displacements and tractions. It obeys a linear equation
in ζ = kz. Two of the solutions fit to the layers below. Their 2x2 minors x = (UW, WS, -US, WT, TS) obey dx/dζ = B x
(:mod:`.minors`). At the surface L = x4/((1 - nu1) x5). Nothing cancels, not even at nu = 1/2.
"""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from .kernel import Sampler
from .minors import LayerPowers, across, at_surface, base, numerator, scaled, through
from .transfer_stack import stack_waves
from .two_layers import thin_layer_coefficients

#: Below this u, L - 1 is formed as the difference of two terms, neither of which is small there.
_NEAR = 0.7
#: Number of values, cases times nodes, that are computed at a time, so that intermediate arrays stay in the cache.
_BLOCK = 2048


@batch.of_cases
class Stack(NamedTuple):
    """The :class:`~solver.kernels.kernel.Kernel` and the :class:`~.transfer.Layered` of B stacks of N layers, the top
    first.

    n, nu, depth : (B, N), modulus E_j*, Poisson ratio, and thickness over that of the first layer, for each layer. The
        unit of moduli is E2*, or E1* on a rigid base, where the first layer has n = 1
    free, cn, ct : (B, N), for the interface below each layer: whether it is frictionless; and its normal and tangential
        compliance times E1*/h1, 0 for a perfect bond
    nu2, rigid : (B,), Poisson ratio of the base, whose modulus is 1, and whether it is rigid
    sampler : Sampler of the family; None: the kernel is evaluated at all nodes
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
        """dL/du at u = 0, a sum of three kinds of parts: one for each layer that is bonded to the base, one for each
        group of layers that are bonded to each other above a frictionless interface, and one for the normal compliance
        of springs."""
        of_base = np.where(self.rigid[:, None], 0.0, self.n)
        _, A2 = thin_layer_coefficients(of_base, self.nu, self.nu2[:, None], True)
        softness, slope = self.n[:, :1] / self.n * self.depth, self.cn.sum(axis=1) / 2
        on_base = ~np.logical_or.accumulate(self.free[:, ::-1], axis=1)[:, ::-1]
        slope = slope + np.where(on_base, softness * A2, 0.0).sum(axis=1)
        group = np.cumsum(self.free[:, ::-1], axis=1)[:, ::-1]  # 0: bonded to the base; 1: on the lowest slip plane
        squeezed, lateral = softness * (1 - 2 * self.nu) / (1 - self.nu) ** 2, self.nu / (1 - self.nu)
        for number in range(1, int(group.max(initial=0)) + 1):
            in_group = group == number
            wide, stiff = (
                (in_group * v).sum(axis=1) for v in (self.depth * lateral, self.depth * self.n / self.n[:, :1])
            )
            stretched = wide**2 / np.where(stiff > 0, stiff, 1.0)
            slope = slope + ((in_group * squeezed).sum(axis=1) + stretched) / 2
        return slope

    @property
    def stiffness(self):
        """The larger of the largest L and the longest length, over h1, at which L varies. Such lengths are the
        thickness of the whole stack, and those over which plates and membranes spread their load: at most their
        thickness times their modulus over that of the softest body below."""
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
        """Yield for each block of cases: their slice, their kernel, the :class:`~.minors.LayerPowers` of each layer,
        and their u (b, M)."""
        step, G = max(1, _BLOCK // max(1, u.shape[1])), self.n * (1 - self.nu)
        layers = [LayerPowers.of(G[:, 0] / G[:, j], self.nu[:, j]) for j in range(self.n.shape[1])]
        for low in range(0, len(u), step):
            rows = slice(low, low + step)
            yield rows, self.take(rows), [LayerPowers(layer.powers[rows]) for layer in layers], u[rows]

    def _near_and_far(self, u, layers):
        """L - 1 and u dL/du (B, M). A part of the numerator x4 - (1 - nu1) x5, and of its derivative, is exactly 0, but
        its rounding does not decay with u. It is left out where the rest is small."""
        layer, X = self._under_top(u, layers, slopes=True)
        x4, x5 = at_surface(layer, u, X).transpose(1, 2, 0, 3)
        complement = 1 - self.nu[:, :1]
        below, d_below = complement * x5
        above, d_above = x4[0] - below, x4[1] - d_below
        if np.any(far := u >= _NEAR):
            decaying, d_decaying = numerator(layer, u, X, self.nu[:, 0])
            above, d_above = np.where(far, decaying, above), np.where(far, d_decaying, d_above)
        L1 = above / below
        return L1, (d_above - L1 * d_below) / below

    def _under_top(self, u, layers, slopes):
        """The :class:`~.minors.LayerPowers` of the top layer, and X below it; `slopes`: whether X has derivatives."""
        g = (1 - self.nu2) / (self.n[:, 0] * (1 - self.nu[:, 0]))
        X = base(g, self.nu2, self.rigid, slopes, u.shape[1])
        for j in reversed(range(self.n.shape[1])):
            X = scaled(across(X, self.free[:, j], *self.springs(j, u)))
            if j:
                X = through(layers[j], u * self.depth[:, j, None], X)
        return layers[0], X

    def springs(self, j, u):
        """G1 k times the compliances below layer j, (B, M) each, or None where there are none."""
        compliances = self.cn[:, j, None], self.ct[:, j, None]
        present = any(np.any(v) for v in compliances)
        return ((1 - self.nu[:, :1]) / 2 * v * u if present else None for v in compliances)

    @property
    def poisson(self):
        return np.hstack([self.nu, self.nu2[:, None]])

    @property
    def shear(self):
        return np.hstack([self.n * (1 - self.nu), (1 - self.nu2)[:, None]])

    @property
    def slips(self):
        return self.free.any(axis=1)

    def tops(self, h):
        return h[:, None] * np.hstack([np.zeros((len(h), 1)), np.cumsum(self.depth, axis=1)])

    def uniform(self):
        return False

    def longest(self, h):
        """Tangential springs at an interface spread the tractions that drag the layers over a length sqrt(G h ct)."""
        dragged = (self.depth * self.n / self.n[:, :1]).sum(axis=1) * self.ct.sum(axis=1)
        return max(1.0, (h * np.maximum(self.stiffness, np.sqrt(dragged))).max())

    def few(self, k, h):
        return 0

    def waves(self, k, h, load):
        return stack_waves(self, k, h, load)
