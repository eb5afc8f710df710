"""The state of layer and body under a wave of unit traction: docs/stress_fields.md, Transfer.

The traction on the surface is J0(kr) (normal, S) or J1(kr) (tangential, T). In each body it causes a state
v = (u, w, S, T), a function of x = kz: u and w are the displacements along r and z times 2 G k, S and T the stresses
sz and trz. They are amplitudes of J1, J0, J0 and J1. In a body dv/dx = A v, whose solutions are e^(-x) and e^x times
polynomials of degree one. Nothing is divided by 1 - 2 nu. Where X = kh is below about 1, the state is integrated from
the surface down, and nothing cancels. Where X is larger, the state is the sum of a wave that decays from the surface
and one that decays from the interface, and nothing overflows.
"""

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np

from ..status import Codes

#: The layer is thin for waves with X = kh below this. With 0.5 and with 1.5 the states are as near to those of 113
#: bits. So cases whose h differ by a factor of 2 may have one limit in k.
THIN = 1.0
#: Below _SERIES, x cosh x - sinh x is the sum of its first _TERMS powers: the difference loses digits.
_SERIES, _TERMS = 0.8, 10


class StatePart(Codes):
    """Which state is computed: that in the layer, that in the body, or the difference between that in the layer and
    that of a half-space of the layer's material. The difference is formed without cancellation. It decays like a wave
    that has been at the interface."""

    DIFFERENCE = 0
    LAYER = 1
    BODY = 2


class Bodies(NamedTuple):
    """Layers on bodies; the fields broadcast.

    alpha : G1/G2 = n (1 - nu1)/(1 - nu2), 0 on a rigid base; nu1, nu2 : Poisson ratios; bonded : bool
    """

    alpha: np.ndarray
    nu1: np.ndarray
    nu2: np.ndarray
    bonded: np.ndarray

    @classmethod
    def of(cls, layers):
        """The bodies of :class:`~solver.kernels.two_layers.TwoLayers`."""
        return cls(layers.n * (1 - layers.nu1) / (1 - layers.nu2), layers.nu1, layers.nu2, layers.bonded)

    def jumps(self, v):
        """Two arrays that must be 0 at an interface where v is the state in the layer, over 1 + alpha. Bonded: both
        displacements less those of the body. Frictionless: T, and the normal displacement less that of the body."""
        u, w, S, T = v
        above, below = 1 / (1 + self.alpha), self.alpha / (1 + self.alpha)
        normal, cross = 2 * (1 - self.nu2), 1 - 2 * self.nu2
        along = above * u - below * (cross * S - normal * T)
        deep = above * w + below * (normal * S - np.where(self.bonded, cross * T, 0.0))
        return np.where(self.bonded, along, T), deep


class Waves(Protocol):
    """Waves k (K,) in N layers and a body, which are the regions 0 to N: :class:`LayerWaves`,
    :class:`~.transfer_stack.StackWaves`. The state v = (u, w, S, T) obeys dv/dx = A v, x = kz, within each region.

    nu : (B, N + 1), Poisson ratio of each region
    """

    nu: np.ndarray

    def state(self, region, z, less=False):
        """u, w, S, T, (B, Z, K) each, at depths z (B, Z) in a region. `less`: less those of a half-space of the first
        layer's material; the region must then be the first layer."""

    def antiplane(self, region, z, less=False):
        """Q and v', (B, Z, K) each, of :func:`antiplane` at depths z (B, Z) in a region."""


class Layered(Protocol):
    """The protocol of N layers on a body, B cases, as the stress fields need it: :class:`~.two_layers.TwoLayers`,
    :class:`~.stack.Stack`.

    poisson, shear : (B, N + 1), Poisson ratio and 2 G of each region, in the unit of moduli. The shear modulus of a
        rigid body has no meaning
    rigid : (B,) bool, whether the body is rigid
    slips : (B,) bool, whether some interface is frictionless
    """

    poisson: np.ndarray
    shear: np.ndarray
    rigid: np.ndarray
    slips: np.ndarray
    take: Callable

    def tops(self, h):
        """(B, N + 1): depth of the top of each region, if the first layer has the thickness h (B,)."""

    def uniform(self):
        """Whether the layer makes no difference in any case."""

    def longest(self, h):
        """An upper bound of the lengths over which the state varies in any case; at least 1."""

    def few(self, k, h):
        """Number of the first of the ascending waves k that must be computed by themselves."""

    def waves(self, k, h, load):
        """:class:`Waves` of ascending k, either all among the `few` or none. `load` : S and T on the surface. The
        thickness of a layer must not differ between cases by more than a factor of 2."""


def decaying(x, nu, S, T):
    """State H(x) (S, T) of a half-space at the depth x under the surface tractions S, T."""
    decay, shift = np.exp(-x), x * (S - T)
    u = decay * ((1 - 2 * nu) * S - 2 * (1 - nu) * T - shift)
    w = decay * ((1 - 2 * nu) * T - 2 * (1 - nu) * S - shift)
    return u, w, decay * (S + shift), decay * (T + shift)


def growing(y, nu, S, T):
    """The mirror image of :func:`decaying`: the state at the height y above the tractions S, T, from where it decays
    upwards."""
    u, w, S, T = decaying(y, nu, S, -T)
    return u, -w, S, -T


def derivative(v, nu):
    """dv/dx = A v of a state."""
    u, w, S, T = v
    return w + 2 * T, ((1 - 2 * nu) * S - nu * u) / (1 - nu), -T, (u + nu * S) / (1 - nu)


def state_below(x, nu, v):
    """State e^(Ax) v at the distance x below a plane with the state v; for x below about 1.5. With N = A A - 1,

    e^(Ax) = cosh x + sinh x A + (x sinh x)/2 N + (x cosh x - sinh x)/2 A N.
    """
    first = derivative(v, nu)
    second = tuple(a - b for a, b in zip(derivative(first, nu), v, strict=True))
    third = derivative(second, nu)
    cosh, sinh = np.cosh(x), np.sinh(x)
    half, rest = x * sinh / 2, np.where(x < _SERIES, _odd_series(np.minimum(x, _SERIES)), x * cosh - sinh) / 2
    return tuple(cosh * a + sinh * b + half * c + rest * d for a, b, c, d in zip(v, first, second, third, strict=True))


def _odd_series(x):
    """x cosh x - sinh x, the sum of 2j x^(2j + 1)/(2j + 1)!."""
    square, term, total = x * x, x, 0.0
    for j in range(1, _TERMS + 1):
        term = term * square / (2 * j * (2 * j + 1))
        total = total + 2 * j * term
    return total


def _solved(first, second, right):
    """The two numbers c, d with c `first` + d `second` = `right`; all three are pairs of arrays."""
    (a, c), (b, d), (e, f) = first, second, right
    determinant = a * d - b * c
    return (e * d - b * f) / determinant, (a * f - e * c) / determinant


def thin_surface(bodies, X, S, T):
    """State of the surface of a thin layer under the tractions S, T."""
    nu = bodies.nu1
    ends = (bodies.jumps(state_below(X, nu, v)) for v in ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, S, T)))
    along, deep, right = ends
    u, w = _solved(along, deep, tuple(-v for v in right))
    return u, w, S, T


def thick_waves(bodies, X, S, T):
    """Tractions (S, T) of the two waves in a thick layer: of the wave that decays from the surface, less those of a
    half-space; and of the wave that decays from the interface."""
    nu = bodies.nu1

    def column(S, T):
        up = growing(X, nu, S, T)[2:]
        here = growing(0.0, nu, S, T)
        return bodies.jumps(tuple(a - b for a, b in zip(here, decaying(X, nu, *up), strict=True)))

    right = bodies.jumps(decaying(X, nu, S, T))
    b = _solved(column(1.0, 0.0), column(0.0, 1.0), tuple(-v for v in right))
    return tuple(-v for v in growing(X, nu, *b)[2:]), b


def wave_state(kind, bodies, X, x, load, thin):
    """State (u, w, S, T) under a unit wave.

    kind : :class:`StatePart`; bodies : :class:`Bodies`; X, x : kh and kz; all broadcast
    load : (S, T) at the surface, (-1, 0) or (0, 1)
    thin : bool, whether all X are below about 1 (:data:`THIN`)
    """
    if kind == StatePart.BODY:
        _, _, S, T = wave_state(StatePart.LAYER, bodies, X, X, load, thin)
        return decaying(x - X, bodies.nu2, S, np.where(bodies.bonded, T, 0.0))
    nu, less = bodies.nu1, kind == StatePart.DIFFERENCE
    if thin:
        v = state_below(x, nu, thin_surface(bodies, X, *load))
        return tuple(a - b for a, b in zip(v, decaying(x, nu, *load), strict=True)) if less else v
    down, up = thick_waves(bodies, X, *load)
    down = down if less else tuple(a + b for a, b in zip(down, load, strict=True))
    return tuple(a + b for a, b in zip(decaying(x, nu, *down), growing(X - x, nu, *up), strict=True))


def across_interface(bodies):
    """The parts of an antiplane wave in the layer that the interface returns and lets pass."""
    alpha, bonded = bodies.alpha, bodies.bonded
    return np.where(bonded, (alpha - 1) / (alpha + 1), 1.0), np.where(bonded, 2 / (alpha + 1), 0.0)


def antiplane(kind, bodies, X, x):
    """The pair (Q, v') of a wave of tangential traction: shear stress and displacement across the plane of the wave.
    In a body below a frictionless interface, and in a rigid one, both are 0."""
    returned, passed = across_interface(bodies)
    around = passed * np.exp(-2 * X) - np.expm1(-2 * X)  # 1 - returned e^(-2X)
    if kind == StatePart.BODY:
        Q = np.where(bodies.alpha > 0, passed, 0.0) * np.exp(-x) / around
        return Q, -2 * Q
    up = returned * np.exp(x - 2 * X)
    down = returned * np.exp(-2 * X - x) if kind == StatePart.DIFFERENCE else np.exp(-x)
    return (down - up) / around, -2 * (down + up) / around


def radial_sum(v, nu):
    """M of sr + st = ∫ M p^ J0 k dk, from a state v."""
    return (2 * nu * v[2] + (1 + nu) * v[0]) / (1 - nu)


class LayerWaves(NamedTuple):
    """The :class:`Waves` of one layer.

    bodies : :class:`Bodies`, (B,) each; h : (B,), its thickness
    thin : bool, whether all kh are below about 1 (:data:`THIN`)
    """

    bodies: Bodies
    k: np.ndarray
    h: np.ndarray
    load: tuple
    thin: bool

    @property
    def nu(self):
        return np.stack([self.bodies.nu1, self.bodies.nu2], axis=1)

    def state(self, region, z, less=False):
        return wave_state(*self._at(region, z, less), self.load, self.thin)

    def antiplane(self, region, z, less=False):
        return antiplane(*self._at(region, z, less))

    def _at(self, region, z, less):
        kind = StatePart.BODY if region else StatePart.DIFFERENCE if less else StatePart.LAYER
        bodies = Bodies(*(v[:, None, None] for v in self.bodies))
        return kind, bodies, self.k * self.h[:, None, None], self.k * z[..., None]
