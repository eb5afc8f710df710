"""The states of stacks of layers under waves of unit traction: docs/stress_fields.md, Transfer.

The states are those of :mod:`.transfer`. The regions below a depth allow two states. Their 2x2 minors x are carried
from the body upwards (:mod:`.minors`). From the minors follow the displacements that belong to tractions (S, T),

    u = (x2 S - x3 T)/x5,   w = (x2 T - x4 S)/x5,

and the wave that the bottom of a layer reflects. Then the tractions are carried from the surface down. In a layer that
is thin for the wave, X = kh below about 1, the whole state is carried. In a thick one it is the sum of a wave that
decays downwards and one that decays upwards. So nothing overflows, and terms that cancel are no larger than the largest
stress in the layer.
"""

from typing import NamedTuple

import numpy as np

from .minors import LayerPowers, across, base, scaled, through
from .transfer import THIN, decaying, growing, state_below


class StackWaves(NamedTuple):
    """Waves k (K,) in B stacks of N layers; the regions are 0, the first layer, to N, the body.

    tops : (B, N + 1), the depth of the top of each region; nu : (B, N + 1), Poisson ratios
    thin : (N, K) bool, whether the layer is thin for the wave
    tractions : (N + 1, 2, B, K), S and T at the top of each region
    displacements : (N, 2, B, K), u and w at the top of each layer, where it is thin
    down, up : (N, 2, B, K), where the layer is thick: tractions of the wave that decays downwards from its top, less
        `tractions`, and of the wave that decays upwards from its bottom
    shear : (N + 1, B, K), Q at the top of each region under a unit Q on the surface
    at_bottom : (N, 2, B, K), -v' and 2 Q at the bottom of each layer, up to a common factor
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
    at_bottom: np.ndarray

    def up_to(self, end):
        """The first waves, as many as `end`."""
        constants = {"tops": self.tops, "nu": self.nu}
        return StackWaves(**{name: values[..., :end] for name, values in self._asdict().items()} | constants)

    def state(self, region, z, less=False):
        """u, w, S, T (4, B, Z, K) of :func:`~.transfer.wave_state` at depths z (B, Z) in a region. less : less those of
        a half-space of the first layer's material; the region must then be the first layer."""
        nu, x = self.nu[:, region, None, None], self.k * (z - self.tops[:, region, None])[..., None]
        if region == len(self.thin):
            return np.array(decaying(x, nu, *self.tractions[region][:, :, None]))
        thin = self.thin[region]
        thick = ~thin
        state = np.empty((4, *x.shape))
        S, T = self.tractions[region][:, :, None][..., thin]
        here = x[..., thin]
        state[..., thin] = state_below(here, nu, (*self.displacements[region][:, :, None][..., thin], S, T))
        if less:
            state[..., thin] -= decaying(here, nu, S, T)
        y = (self.k * (self.tops[:, region + 1, None] - z)[..., None])[..., thick]
        down = self.down[region] if less else self.down[region] + self.tractions[region]
        state[..., thick] = decaying(x[..., thick], nu, *down[:, :, None][..., thick])
        state[..., thick] += growing(y, nu, *self.up[region][:, :, None][..., thick])
        return state

    def antiplane(self, region, z, less=False):
        """Q and v' (2, B, Z, K) of :func:`~.transfer.antiplane` at depths z (B, Z) in a region."""
        q, x = self.shear[region][:, None], self.k * (z - self.tops[:, region, None])[..., None]
        e = q * np.exp(-x)
        if region == len(self.thin):
            return np.stack([e, -2 * e])
        X = self.k * np.diff(self.tops)[:, region, None, None]
        a, d = self.at_bottom[region][:, :, None]
        around = _around(a, d, X)
        if less:
            e, back = e * np.exp(-2 * X) * (a - d) / around, np.exp(2 * x)
            return np.stack([e * (1 - back), -2 * e * (1 + back)])
        rest = 2 * (x - X)
        gone, both = -np.expm1(rest), 1 + np.exp(rest)
        return np.stack([e * (a * gone + d * both), -2 * e * (a * both + d * gone)]) / around


def stack_waves(stack, k, h, load):
    """:class:`StackWaves` of waves k (K,).

    stack : :class:`~.stack.Stack` of B cases
    h : (B,), thickness of the first layer. No layer's thickness may differ between cases by more than a factor of 2
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
        is_thin, is_thick, ratio = thin[j], ~thin[j], nu[:, j, None]
        t, below, moved = tractions[j], tractions[j + 1], displacements[j]
        moved[..., is_thin] = _moved(at_top[..., is_thin], t[..., is_thin])
        below[..., is_thin] = state_below(X[:, is_thin], ratio, (*moved[..., is_thin], *t[..., is_thin]))[2:]
        c, b = _two_waves(at_bottom[..., is_thick], X[:, is_thick], ratio, t[..., is_thick])
        down[j][..., is_thick], up[j][..., is_thick] = c - t[..., is_thick], b
        below[..., is_thick] = np.array(decaying(X[:, is_thick], ratio, *c)[2:]) + b
        below[1] = np.where(stack.free[:, j, None], 0.0, below[1])
    shear, pairs = _antiplane(stack, u, k * thickness.T[..., None], G)
    return StackWaves(k, stack.tops(h), nu, thin, tractions, displacements, down, up, shear, pairs)


def _minors(stack, u, G, nu):
    """For each layer its minors (B, 5, K) at the top and just above the lower interface, in units in which u and w are
    2 Gk times the displacements."""
    X, minors = base(G[:, -1], nu[:, -1], stack.rigid, False, u.shape[1]), []
    for j in reversed(range(stack.n.shape[1])):
        bottom = scaled(across(X, stack.free[:, j], *stack.springs(j, u)))
        X = scaled(through(LayerPowers.of(1 / G[:, j], nu[:, j]), u * stack.depth[:, j, None], bottom))
        unit = (2 * G[:, j, None]) ** np.array([2, 1, 1, 1, 0])
        minors.append([x[:, :, 0] * unit[..., None] for x in (X, bottom)])
    return minors[::-1]


def _moved(x, t):
    """u and w (2, B, K) under tractions t (2, B, K)."""
    (S, T), x = t, x.transpose(1, 0, 2)
    return np.stack([x[1] * S - x[2] * T, x[1] * T - x[3] * S]) / x[4]


def _two_waves(x, X, nu, t):
    """Tractions (2, B, K) of the waves that decay downwards from the top of a layer and upwards from its bottom. x (B,
    5, K) are the minors at the bottom, t the tractions at the top."""
    returned = _returned(x, nu)

    def column(S, T):
        return np.stack(growing(X, nu, *_times(returned, decaying(X, nu, S, T)[2:]))[2:])

    (a, c), (b, d) = column(1.0, 0.0), column(0.0, 1.0)  # the matrix of the waves that come back to the top
    S, T = t
    determinant = (1 + a) * (1 + d) - b * c
    down = np.stack([(1 + d) * S - b * T, (1 + a) * T - c * S]) / determinant
    return down, np.stack(_times(returned, decaying(X, nu, *down)[2:]))


def _times(matrix, v):
    (a, b), (c, d) = matrix
    return a * v[0] + b * v[1], c * v[0] + d * v[1]


def _returned(x, nu):
    """The reflection matrix at a depth with the minors x, two rows of two arrays (B, K): it makes the tractions of the
    wave that goes up from those of the wave that comes down.

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
    """`shear` and `at_bottom` of :class:`StackWaves`; X (N, B, K)."""
    N = stack.n.shape[1]
    at_bottom, shear = np.empty((N, 2, *u.shape)), np.empty((N + 1, *u.shape))
    a, d = np.where(stack.rigid, 0.0, 1.0)[:, None] + 0 * u, np.ones(u.shape)
    for j in reversed(range(N)):
        _, Kt = stack.springs(j, u)
        a = a * (G[:, j] / G[:, j + 1])[:, None] + (0.0 if Kt is None else d * Kt * G[:, j, None])
        free = stack.free[:, j, None]
        whole = np.where(free, 1.0, a + d)
        a, d = at_bottom[j] = np.where(free, 1.0, a / whole), np.where(free, 0.0, d / whole)
        a, d = _around(d, a, X[j]), _around(a, d, X[j])
    shear[0] = 1.0
    for j in range(N):
        a, d = at_bottom[j]
        shear[j + 1] = 2 * shear[j] * np.exp(-X[j]) * d / _around(a, d, X[j])
    shear[N] = np.where(stack.rigid[:, None], 0.0, shear[N])
    return shear, at_bottom


def _around(a, d, X):
    """(a + d) - (a - d) e^(-2X), formed without cancellation."""
    return 2 * d * np.exp(-2 * X) - (a + d) * np.expm1(-2 * X)
