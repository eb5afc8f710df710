"""A micro law from the rows of a table: smooth, rising curves near the rows, whose behaviour at both ends is imposed.

The unknown y > 0 is defined by q = y t^s with t = y/(1 + y), which goes from 0 to 1. For small y, q is y^(1 + s): with
s = 2/β - 1, g ~ y² means g ~ q^β. For large y, q is y - s. A quantity X that begins as t^m and tends to a limit as
exp(-rate q) is written

    X = 1/(1/limit + exp(-rate q - V(t))/t^m).

V is then smooth up to both ends, and is fitted by a polynomial. A spline through the rows would follow their noise, and
a mesh would need more nodes to resolve it. For an X without a limit, `limit` is infinity and the rate 0. A/A*, λ and
(p_max - p)/p* are such quantities.
"""

from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev, polynomial

from .law import Curve, Law, inverse, where_positive

#: Above this q, y equals q to rounding.
_LARGE = 1e30
_TINY = np.finfo(float).tiny


class TableCurve(NamedTuple):
    """One quantity X of the module's equation, with m = `power`. V has the coefficients of a polynomial in 2 t - 1,
    ascending.

    span : the smallest and the largest t of the polynomial. Below it V is a straight line in t; above it V + m ln t is.
    """

    power: int
    rate: float
    limit: float
    V: np.ndarray
    span: tuple[float, float] = (0.0, 1.0)

    def at(self, t, q):
        """X at t and q; any shape."""
        return 1 / (1 / self.limit + self.rest(t, q, self.exponent(t)[0]))

    def rest(self, t, q, V):
        """1/X - 1/limit."""
        return np.exp(-self.rate * q - V) / t**self.power

    def exponent(self, t):
        """V and dV/dt."""
        low, high = self.span
        inside = np.clip(t, low, high)
        x = 2 * inside - 1
        V, slope = np.full_like(x, self.V[-1]), np.zeros_like(x)
        for coefficient in self.V[-2::-1]:
            slope *= x
            slope += V
            V *= x
            V += coefficient
        slope *= 2
        if low > 0 or high < 1:
            above = t > high
            slope = slope + above * self.power / high
            V = V + slope * (t - inside) - self.power * np.log(np.maximum(t, high) / high)
            slope = slope - above * self.power / np.maximum(t, high)
        return V, slope

    def with_slope(self, t, q, dq):
        """X, :meth:`rest`, and d ln(1/rest)/dy; `dq` is dq/dy, and dt/dy = (1 - t)²."""
        V, dV = self.exponent(t)
        rest = self.rest(t, q, V)
        return 1 / (1 / self.limit + rest), rest, (self.power / t + dV) * (1 - t) ** 2 + self.rate * dq


class LawTable(NamedTuple):
    """The quantities of a law: A/A*, λ, and (p_max - p)/p* (`above`); and the exponent s of q = y t^s."""

    A: TableCurve
    lam: TableCurve
    above: TableCurve
    s: float = 2.0

    def pressure(self, y):
        """t, q and dq/dy at y."""
        t = y / (1 + y)
        power = t * t if self.s == 2 else t**self.s
        return t, y * power, power * (1 + self.s * (1 - t))


def fitted(t, q, X, degree, guides=((), (), 0.0), first=None, trust=1.0, **form):
    """:class:`TableCurve` near the rows X (n,) at t and q (n,), and its relative error (n,) at each row: the distance
    of the row from the curve that is fitted to the other rows alone. Where the gaps between the rows are wide, both the
    curve and this error may be wrong.

    degree : degree of the polynomial
    guides : t and V (k,) at guiding points where there are no rows, and their weight, small beside those of the rows
    first : the limit of X/t^power for t -> 0, which the curve meets exactly; None: it is free
    trust : how much each row counts, (n,) or 1
    form : power, and rate, limit and span of the TableCurve
    """
    quantity = TableCurve(**{"rate": 0.0, "limit": np.inf} | form, V=np.zeros(1))
    share = 1 - X / quantity.limit  # dX/X = (1 - X/limit) dV
    V = -quantity.rate * q - np.log((1 / X - 1 / quantity.limit) * t**quantity.power)
    points, values = np.append(t, guides[0]), np.append(V, guides[1])
    weights = np.append(share * trust, np.full(len(guides[0]), guides[2]))[:, None]
    lowest, factor = (0.0, np.ones_like(points)) if first is None else (np.log(first), points)
    basis = factor[:, None] * chebyshev.chebvander(2 * points - 1, degree)
    Q, R = np.linalg.qr(basis * weights)
    coefficients = np.linalg.solve(R, Q.T @ ((values - lowest) * weights[:, 0]))
    V = chebyshev.cheb2poly(coefficients)
    if first is not None:
        V = polynomial.polyadd(polynomial.polymul(V, [0.5, 0.5]), [lowest])
    quantity = quantity._replace(V=V)
    leverage = (Q[: len(t)] ** 2).sum(axis=1)  # leverage: how much of the curve at a row comes from that row itself
    return quantity, np.abs(quantity.at(t, q) / X - 1) / np.maximum(1 - leverage, 1e-9)


def t_of(q, s=2.0):
    """t (n,) at which y t^s = q (n,) > 0."""
    y = _from_pressure(LawTable(None, None, None, s), np.asarray(q, dtype=float))
    return y / (1 + y)


def law_of(table, **rest):
    """:class:`~solver.laws.law.Law` of a :class:`LawTable`; it can be pickled. `rest`: its name, its `scales` and
    everything else that is not in the table."""
    functions = {"curve": _curve, "area": _area, "peak": _peak, "edge": _edge}
    functions |= {"from_pressure": _from_pressure, "from_displacement": partial(_from_displacement, _inverse(table))}
    return Law(**{name: partial(function, table) for name, function in functions.items()}, **rest)


def _curve(table, y):
    t, q, dq = table.pressure(np.asarray(y, dtype=float))
    g, rest, slope = table.A.with_slope(t, q, dq)
    return Curve(q, g, dq, g * (g * rest) * slope)


def _area(table, y, q):
    return np.minimum(table.lam.at(y / (1 + y), q), 1.0)


def _peak(table, y, q):
    return q + table.above.at(y / (1 + y), q)


def _edge(table):
    return float(np.exp(table.A.exponent(np.zeros(1))[0][0])), 2 / (1 + table.s)


def _from_pressure(table, q):
    start = np.maximum(q, 0.0)
    if table.s == 2:
        return where_positive(q, _root(start))
    return inverse(lambda y: table.pressure(y)[1:], q, start ** (1 / (1 + table.s)) + start)


def _root(q):
    """y >= 0 with y³ = q (1 + y)², that is q = y t², by Cardano's formula. No terms cancel: y is right to a few units
    of rounding."""
    bounded = np.minimum(q, _LARGE)
    t = np.cbrt(bounded * (0.5 + np.sqrt(0.25 + bounded / 27) + bounded / 3 * (1 + bounded / 9)))
    return np.where(q > _LARGE, q, bounded / 3 + t + bounded * (bounded + 6) / (9 * np.maximum(t, _TINY)))


def _inverse(table):
    """ln(1/rest) of A and ln y at points of the curve, (2, n), ascending: interpolation in it gives a first guess of
    y."""
    t = np.append(np.geomspace(1e-6, 0.01, 40), np.linspace(0.01, 1, 400)[1:-1])
    y = t / (1 - t)
    rest = table.A.rest(t, table.pressure(y)[1], table.A.exponent(t)[0])
    return np.log([1 / rest[rest > 0], y[rest > 0]])


def _from_displacement(inverse_curve, table, g):
    """y (B, m) at which A/A* is g. The equation is solved for 1/rest, which is g where A has no limit, and tends to
    infinity where g tends to its limit."""
    A, g = table.A, np.asarray(g, dtype=float)
    odds = 1 / (1 / np.where(g < A.limit, g, np.nan) - 1 / A.limit)

    def value(y):
        t, q, dq = table.pressure(y)
        _, rest, slope = A.with_slope(t, q, dq)
        return 1 / rest, slope / rest

    return inverse(value, odds, np.exp(np.interp(np.log(odds), *inverse_curve)))
