"""The states of stacks of layers under waves of unit traction: docs/stress_fields.md, Transfer.

The states are those of :mod:`.transfer`. What lies below a depth allows two states, whose 2x2 minors x are carried from
the body upwards (:mod:`.minors`). They give the displacements that belong to tractions (S, T),

    u = (x2 S - x3 T)/x5,   w = (x2 T - x4 S)/x5,

and, below a layer, what it returns of a wave that comes down. Then the tractions are carried from the surface down.
Through a layer that is thin for the wave, X = kh below about 1, the state is carried as it is. In a thick one it is the
sum of a wave that decays downwards and one that decays upwards. So nothing overflows, and what cancels is no larger
than the largest stress in the layer.
"""

from typing import NamedTuple

import numpy as np

from .minors import LayerPowers, across, base, scaled, through
from .transfer import THIN, carried, decaying, growing


class StackWaves(NamedTuple):
    """Waves k (K,) in B stacks of N layers; regions are counted from 0, the first layer, to N, the body.

    tops : (B, N + 1), the depth of the top of each region; nu : (B, N + 1), Poisson ratios
    thin : (N, K) bool, the layer is thin for the wave
    tractions : (N + 1, 2, B, K), S and T at the top of each region
    displacements : (N, 2, B, K), u and w at the top of each layer, where it is thin
    down, up : (N, 2, B, K), tractions of the wave that decays downwards from the top of a layer, less `tractions`, and
        of the one that decays upwards from its bottom, where it is thick
    shear : (N + 1, B, K), Q at the top of each region under a unit Q on the surface
    yields : (N, 2, B, K), -v' and 2 Q at the bottom of each layer, to a common factor
    """

    k: np.ndarray
    tops: np.ndarray
    nu: np.ndarray
    thin: np.ndarray
    tractions: np.ndarray
    displacements: np.ndarray
    down: np.ndarray
    up: np.ndarray
    shear: np.ndarray
    yields: np.ndarray

    def up_to(self, end):
        """The first waves, as many as `end`."""
        kept = {"tops": self.tops, "nu": self.nu}
        return StackWaves(**{name: values[..., :end] for name, values in self._asdict().items()} | kept)

    def state(self, region, z, less=False):
        """u, w, S, T (4, B, Z, K) of :func:`~.transfer.wave_state` at depths z (B, Z) of a region. less : less those of
        a half-space of the first layer, in which the region then is."""
        nu, x = self.nu[:, region, None, None], self.k * (z - self.tops[:, region, None])[..., None]
        if region == len(self.thin):
            return np.array(decaying(x, nu, *self.tractions[region][:, :, None]))
        thin = self.thin[region]
        thick = ~thin
        made = np.empty((4, *x.shape))
        S, T = self.tractions[region][:, :, None][..., thin]
        here = x[..., thin]
        made[..., thin] = carried(here, nu, (*self.displacements[region][:, :, None][..., thin], S, T))
        if less:
            made[..., thin] -= decaying(here, nu, S, T)
        y = (self.k * (self.tops[:, region + 1, None] - z)[..., None])[..., thick]
        down = self.down[region] if less else self.down[region] + self.tractions[region]
        made[..., thick] = decaying(x[..., thick], nu, *down[:, :, None][..., thick])
        made[..., thick] += growing(y, nu, *self.up[region][:, :, None][..., thick])
        return made

    def antiplane(self, region, z, less=False):
        """Q and v' (2, B, Z, K) of :func:`~.transfer.antiplane` at depths z (B, Z) of a region."""
        q, x = self.shear[region][:, None], self.k * (z - self.tops[:, region, None])[..., None]
        e = q * np.exp(-x)
        if region == len(self.thin):
            return np.stack([e, -2 * e])
        X = self.k * np.diff(self.tops)[:, region, None, None]
        a, d = self.yields[region][:, :, None]
        around = _around(a, d, X)
        if less:
            e, back = e * np.exp(-2 * X) * (a - d) / around, np.exp(2 * x)
            return np.stack([e * (1 - back), -2 * e * (1 + back)])
        rest = 2 * (x - X)
        gone, both = -np.expm1(rest), 1 + np.exp(rest)
        return np.stack([e * (a * gone + d * both), -2 * e * (a * both + d * gone)]) / around


def stack_waves(stack, k, h, load):
    """:class:`StackWaves` of waves k (K,).

    stack : :class:`~.stack.Stack` of B cases; h : (B,), thickness of the first layer; the thickness of no layer differs
        by more than a factor of 2 between cases
    load : (S, T) on the surface, (-1, 0) or (0, 1)
    """
    N, u = stack.n.shape[1], k * h[:, None]
    G, nu = stack.shear / stack.shear[:, :1], stack.poisson
    thickness = h[:, None] * stack.depth
    thin = k * np.sqrt(thickness.min(axis=0) * thickness.max(axis=0))[:, None] < THIN
    tractions = np.zeros((N + 1, 2, *u.shape))
    tractions[0] += np.array(load)[:, None, None]
    displacements, down, up = np.zeros((3, N, 2, *u.shape))
    above = _minors(stack, u, G, nu)
    for j in range(N):
        X, (at_top, at_bottom) = k * thickness[:, j, None], above[j]
        few, many, ratio = thin[j], ~thin[j], nu[:, j, None]
        t, below, moved = tractions[j], tractions[j + 1], displacements[j]
        moved[..., few] = _moved(at_top[..., few], t[..., few])
        below[..., few] = carried(X[:, few], ratio, (*moved[..., few], *t[..., few]))[2:]
        c, b = _two_waves(at_bottom[..., many], X[:, many], ratio, t[..., many])
        down[j][..., many], up[j][..., many] = c - t[..., many], b
        below[..., many] = np.array(decaying(X[:, many], ratio, *c)[2:]) + b
        below[1] = np.where(stack.free[:, j, None], 0.0, below[1])
    shear, yields = _antiplane(stack, u, k * thickness.T[..., None], G)
    return StackWaves(k, stack.tops(h), nu, thin, tractions, displacements, down, up, shear, yields)


def _minors(stack, u, G, nu):
    """Of each layer the minors (B, 5, K) at its top and above its lower interface, in units in which u and w are 2 Gk
    times the displacements."""
    X, found = base(G[:, -1], nu[:, -1], stack.rigid, False, u.shape[1]), []
    for j in reversed(range(stack.n.shape[1])):
        bottom = scaled(across(X, stack.free[:, j], *stack.springs(j, u)))
        X = scaled(through(LayerPowers.of(1 / G[:, j], nu[:, j]), u * stack.depth[:, j, None], bottom))
        unit = (2 * G[:, j, None]) ** np.array([2, 1, 1, 1, 0])
        found.append([x[:, :, 0] * unit[..., None] for x in (X, bottom)])
    return found[::-1]


def _moved(x, t):
    """u and w (2, B, K) under tractions t (2, B, K)."""
    (S, T), x = t, x.transpose(1, 0, 2)
    return np.stack([x[1] * S - x[2] * T, x[1] * T - x[3] * S]) / x[4]


def _two_waves(x, X, nu, t):
    """Tractions (2, B, K) of the waves that decay downwards from the top of a layer and upwards from its bottom, where
    it has the minors x (B, 5, K)."""
    returned = _returned(x, nu)

    def column(S, T):
        return np.stack(growing(X, nu, *_times(returned, decaying(X, nu, S, T)[2:]))[2:])

    (a, c), (b, d) = column(1.0, 0.0), column(0.0, 1.0)  # of what comes back to the top
    S, T = t
    determinant = (1 + a) * (1 + d) - b * c
    down = np.stack([(1 + d) * S - b * T, (1 + a) * T - c * S]) / determinant
    return down, np.stack(_times(returned, decaying(X, nu, *down)[2:]))


def _times(matrix, v):
    (a, b), (c, d) = matrix
    return a * v[0] + b * v[1], c * v[0] + d * v[1]


def _returned(x, nu):
    """The matrix, two rows of two (B, K), from the tractions of a wave that comes down to those of the wave that goes
    up, both at the depth with the minors x.

    With q = 2 (1 - nu), m = 1 - 2 nu, r = (w - m T)/q, s = (u - m S)/q, the tractions are (S - r, T - s)/2 downwards
    and (S + r, T + s)/2 upwards, so that their minors are sums of those of S, T, r, s.
    """
    UW, WS, SU, WT, TS = x.transpose(1, 0, 2)
    q, m = 2 * (1 - nu), 1 - 2 * nu
    Ss, rT, Sr = SU / q, WT / q, (m * TS - WS) / q
    rs = (m * m * TS - 2 * m * WS - UW) / (q * q)
    below = rs - TS - Ss - rT
    return ((rT - TS - Ss - rs) / below, 2 * Sr / below), (2 * Sr / below, (rT - Ss + rs + TS) / -below)


def _antiplane(stack, u, X, G):
    """`shear` and `yields` of :class:`StackWaves`; X (N, B, K)."""
    N = stack.n.shape[1]
    yields, shear = np.empty((N, 2, *u.shape)), np.empty((N + 1, *u.shape))
    a, d = np.where(stack.rigid, 0.0, 1.0)[:, None] + 0 * u, np.ones(u.shape)
    for j in reversed(range(N)):
        _, Kt = stack.springs(j, u)
        a = a * (G[:, j] / G[:, j + 1])[:, None] + (0.0 if Kt is None else d * Kt * G[:, j, None])
        free = stack.free[:, j, None]
        whole = np.where(free, 1.0, a + d)
        a, d = yields[j] = np.where(free, 1.0, a / whole), np.where(free, 0.0, d / whole)
        a, d = _around(d, a, X[j]), _around(a, d, X[j])
    shear[0] = 1.0
    for j in range(N):
        a, d = yields[j]
        shear[j + 1] = 2 * shear[j] * np.exp(-X[j]) * d / _around(a, d, X[j])
    shear[N] = np.where(stack.rigid[:, None], 0.0, shear[N])
    return shear, yields


def _around(a, d, X):
    """(a + d) - (a - d) e^(-2X), where nothing cancels."""
    return 2 * d * np.exp(-2 * X) - (a + d) * np.expm1(-2 * X)
