"""The punch, as the equation of a rough contact sees the shape f(r) of the indenter: the protocol, and any shape.

The contact uses nothing of a punch except this protocol. Lengths are in R; a is the contact radius, x = r/a and
s = sqrt(1 - x²). At x the surface must be displaced by f(a) - f(ax) more than at the edge. The equation of the contact
is divided by a²/2, and so is this:

    X K[q] + Y q + Z g = drop,              drop = (2/a²) [f(a) - f(ax)],
    D = (a²/2) (depth + X edge @ q),        depth = 2 f(a)/a²,

and at fixed x

    d drop/d ln a = (2/a) [f'(a) - x f'(ax)] - 2 drop.

A shape that has closed forms of all this, such as the paraboloid, is a punch itself; :class:`Shaped` makes a punch of
any other shape. It guesses the radius from the loads P(a) that a half-space, springs and asperities would each bear
alone. These increase with a, and bracketing gives the root.
"""

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np

from ..numerics import batch
from ..numerics.bracket import false_position
from ..numerics.quadrature import gauss_legendre
from ..shapes.paraboloid import HERTZ
from ..shapes.shape import Shape, column

#: Relative error of a first guess of the radius: Newton's method does the rest.
_ROUGHLY = 1e-3
#: Gauss points in s for the load that springs or asperities bear alone, of which a few digits are enough.
_FEW = 24
#: A step of the radius leaves at least this part of the distance to a bound.
_LEFT = 0.1


class Punch(Protocol):
    """The punch in B cases. An array that is the same for all cases may have one row in place of B.

    take : the punch of a sub-batch, :func:`~solver.numerics.batch.take`
    polynomial : whether the drop is a polynomial in s²: an error on one panel then does not spoil its neighbours
    """

    polynomial: bool
    take: Callable

    def drop(self, a, s):
        """(2/a²) [f(a) - f(ax)] at the points s (m,), for contact radii a (B,): (B or 1, m). It is formed from s
        without cancellation: no digits are lost near the edge."""

    def drop_slope(self, a, s):
        """Derivative of :meth:`drop` by ln a at fixed x."""

    def depth(self, a):
        """2 f(a)/a², (B,) or one number."""

    def depth_slope(self, a):
        """Derivative of :meth:`depth` by ln a."""

    def radius_at_depth(self, D):
        """First guess (B,) of the contact radius at the depth D (B,), between those on a half-space and on springs."""

    def on_half_space(self, P, E, softness):
        """Contact radius (B,) under the load P (B,) on a half-space of modulus E/softness."""

    def on_springs(self, P, C):
        """Contact radius (B,) under the load P (B,) on springs of compliance C (B,) alone."""

    def on_asperities(self, P, p_star, A_star, e):
        """Contact radius (B,) under the load P (B,) if only asperities are displaced, by A = A* (p/p*)^(1/e)."""

    def stiffness(self, a, s, half_space, springs):
        """First guess of 1/q, (B, m) at s (m,) > 0, without asperities: nearly the sum of the 1/q on a half-space,
        whose X is `half_space` (B, 1), and on springs, whose Y is `springs` (B, 1)."""


def punch_of(shape):
    """The :class:`Punch` of a shape; it is the shape itself if that has the closed forms."""
    return shape if hasattr(shape, "drop_slope") else Shaped(shape)


def largest(punch, a):
    """Largest right-hand side (B or 1,) of the equation: the drop in the centre."""
    return punch.drop(a, np.ones(1))[..., 0]


@batch.of_cases
class Shaped(NamedTuple):
    """The :class:`Punch` of B cases with the profiles `shape`."""

    shape: Shape

    polynomial = False

    def drop(self, a, s):
        return self.shape.drop(a, s)

    def drop_slope(self, a, s):
        x, radius = np.sqrt((1 - s) * (1 + s)), column(a)
        slopes = self.shape.slope(radius) - x * self.shape.slope(radius * x)
        return 2 / radius * slopes - 2 * self.drop(a, s)

    def depth(self, a):
        return 2 * self.shape.height(column(a))[:, 0] / a**2

    def depth_slope(self, a):
        return 2 * self.shape.slope(column(a))[:, 0] / a - 2 * self.depth(a)

    def radius_at_depth(self, D):
        """A half-space is touched up to a at the depth F(a), springs at f(a): at the mean of both here."""
        return radius_at(self.shape, lambda shape, a: (shape.lifted(a) + shape.height(a))[:, 0] / 2, D)

    def on_half_space(self, P, E, softness):
        return radius_at(self.shape, lambda shape, a: 2 * shape.lifted_load(a[:, 0]), P * softness / E)

    def on_springs(self, P, C):
        """The load of springs is (π a⁴/C) ∫ drop s ds, from p = [f(a) - f(r)]/C."""
        P = np.where(C > 0, C * P / np.pi, 0.0)
        return np.where(C > 0, radius_at(self.shape, _spring_load, np.where(C > 0, P, 1.0)), 0.0)

    def on_asperities(self, P, p_star, A_star, e):
        """The load of asperities is 2π a² p* ∫ [a² drop/(2 A*)]^e s ds."""
        e = np.broadcast_to(e, P.shape)
        target = (P / (2 * np.pi * p_star)) ** (1 / e) * 2 * A_star  # e-th roots: so that nothing overflows

        def load(shape, a, power):
            drop, (s, w) = shape.drop(a[:, 0], _points()[0]), _points()
            largest = drop.max(axis=1, keepdims=True)
            mean = ((drop / largest) ** power[:, None]) @ (w * s)
            return a[:, 0] ** (2 + 2 / power) * largest[:, 0] * mean ** (1 / power)

        return radius_at(self.shape, load, target, e)

    def stiffness(self, a, s, half_space, springs):
        return (half_space * HERTZ * s + springs) / self.drop(a, s)


def _points():
    return gauss_legendre(_FEW)


def _spring_load(shape, a):
    s, w = _points()
    return a[:, 0] ** 4 * (shape.drop(a[:, 0], s) @ (w * s))


def radius_at(shape, value, target, *numbers):
    """Radius a (B,) at which ``value(shape, a, *numbers)`` (B,), with a (B, 1), is `target` (B,). The function must
    increase with a. The error is _ROUGHLY times the distance of a from the bounds of the shape. NaN where there is no
    such radius."""
    least, most = shape.least(), shape.most()

    def missed(v, index):
        a = _between(v, least[index], most[index])
        values = value(shape.take(index), column(a), *(number[index] for number in numbers))
        return np.log(values / target[index])

    v, _ = false_position(missed, np.zeros(len(target)), np.full(len(target), _ROUGHLY))
    return _between(v, least, most)


def _between(v, least, most):
    """The radius a (b,) between `least` and `most` (b,) for any number v (b,), which is ln(a - least) far from
    `most`."""
    above = np.exp(v)
    return least + above / (1 + above / (most - least))


def keep_within(shape, new, old):
    """ln a (B,) after a step from `old` to `new` (B,), shortened so that at least _LEFT of the distance to any bound of
    the shape is left."""
    least, most = shape.least(), shape.most()
    if not least.any() and np.isinf(most).all():
        return new
    before, after = np.exp(old), np.exp(new)
    low = least + _LEFT * (before - least)
    high = np.where(np.isfinite(most), most - _LEFT * (most - before), np.inf)
    return np.where((after < low) & (least > 0), np.log(low), np.where(after > high, np.log(high), new))
