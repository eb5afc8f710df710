"""The punch of any :class:`~solver.shapes.shape.Shape`: what the equation of a rough contact needs of a profile f(r).

The drop is (2/a²) [f(a) - f(ax)], and at fixed x

    d drop/d ln a = (2/a) [f'(a) - x f'(ax)] - 2 drop.

First guesses of the radius come from closed forms of the shape, whose roots are found by bracketing: the loads P(a)
that a half-space, springs and asperities would each bear alone increase with a.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.bracket import false_position
from ..numerics.quadrature import gauss_legendre
from ..shapes.shape import Shape, column
from .paraboloid import HERTZ

#: A first guess of the radius is right to this part: Newton's method does the rest.
_ROUGHLY = 1e-3
#: Gauss points in s of the load that springs or asperities bear alone, where a few digits are enough.
_FEW = 24
#: A step of the radius leaves at least this part of its distance to a bound.
_LEFT = 0.1


class Shaped(NamedTuple):
    """The :class:`~solver.punches.punch.Punch` of B cases with the profiles `shape`."""

    shape: Shape

    def take(self, index):
        return Shaped(self.shape.take(index))

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
    """Radius a (B,) at which ``value(shape, a, *numbers)`` (B,), a (B, 1), which increases with a, is `target` (B,): to
    _ROUGHLY of its distance to the bounds of the shape. NaN where there is none."""
    least, most = shape.least(), shape.most()

    def missed(v, index):
        a = _between(v, least[index], most[index])
        values = value(shape.take(index), column(a), *(number[index] for number in numbers))
        return np.log(values / target[index])

    v, _ = false_position(missed, np.zeros(len(target)), np.full(len(target), _ROUGHLY))
    return _between(v, least, most)


def _between(v, least, most):
    """The radius (b,) between `least` and `most` (b,) for any number v (b,): ln(a - least) far from `most`."""
    above = np.exp(v)
    return least + above / (1 + above / (most - least))


def kept_within(shape, new, old):
    """ln a (B,) after a step from `old` to `new` (B,): no nearer to a bound of the shape than _LEFT of the distance
    that there was."""
    before, after = np.exp(old), np.exp(new)
    least, most = shape.least(), shape.most()
    low = least + _LEFT * (before - least)
    high = np.where(np.isfinite(most), most - _LEFT * (most - before), np.inf)
    return np.where((after < low) & (least > 0), np.log(low), np.where(after > high, np.log(high), new))
