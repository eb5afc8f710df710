"""The protocol of a micro law: all that the solver, its outputs and the derived quantities ask of one.

A micro law says what identical asperities do under a nominal pressure p: their additional displacement A[p], the
relative contact area λ and the largest real pressure p_max. It is written in an unknown y > 0,

    p = p* q(y),   A = A* g(y),   λ = area(y),   p_max = p* peak(y),

in which q and g are smooth and increase from 0 at y = 0, where g ~ y²: the solver's unknowns are the values of y at
its nodes. A :class:`Law` holds these functions and the parameters they depend on; ``law.bind`` gives a :class:`Bound`,
the law with the numbers of a batch of cases.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..numerics import batch
from ..parameters import Parameter

#: Most Newton steps of an inverse, far more than the laws of this package need; and the largest change of ln y in one.
_STEPS, _LONGEST = 100, 5.0
#: A step of ln y below _LAST is the last: the next one would be below rounding. Where a law saturates, rounding leaves
#: y less determined (tests/laws/test_micro.py): so a step below _ROUNDING that is not half the one before is the last.
_LAST, _ROUNDING = 1e-9, 1e-3


@batch.of_cases
class Curve(NamedTuple):
    """A law at some y.

    Attributes
    ----------
    q, g : p/p* and A/A*; arrays of the shape of y
    dq, dg : their derivatives by y
    """

    q: np.ndarray
    g: np.ndarray
    dq: np.ndarray
    dg: np.ndarray


class Spots(NamedTuple):
    """A law at some pressure p: A (unit of R), λ and p_max (unit of p); arrays of the shape of p."""

    A: np.ndarray
    lam: np.ndarray
    p_max: np.ndarray


@dataclass(frozen=True, eq=False)
class Law:
    """One micro law. The functions get arrays y, q or g (B, m), and then all that `scales` returns beside p* and A*.

    To travel to worker processes a law must be picklable: of functions that have a name in a module.

    Attributes
    ----------
    name : what a user writes for ``micro``
    parameters : name -> Parameter, with bounds, default, unit and words; each is an argument of `scales`
    scales : (E, **parameters) -> (p*, A*, *own); all (B,), in units R = E2* = 1. E is the modulus that the
        asperities feel: E1*, or E2* without a layer; over 1 + m under an elastic punch
    curve : (y, *own) -> Curve
    area : (y, q, *own) -> λ, from 0 to 1 (11)
    peak : (y, q, *own) -> p_max/p* (13)
    edge : (*own) -> (gamma, beta) of g ~ gamma q^beta for small q; floats, or arrays that broadcast to (B, m)
    version : text that changes whenever the numbers of the law may change; part of the keys of its cases
    rough : False of no asperities at all: A = 0, and the equation of the contact is linear in y = q
    error : largest relative error of A, λ and p_max in a law that comes from a table, else 0; part of `model_error`
    error_at : (p/E) -> that error at a nominal pressure, (B,) each, of a law whose rows err by different amounts; None:
        it is `error`
    least, most : smallest and largest p/E that the law knows; contacts outside get no numbers
    corners : whether λ(y) has corners, for example where the lowest summits touch; Ar/An then has its own quadrature
    smears : whether it spreads the pressure of the neighbours evenly, and so errs where the spots merge
    touching : (A, **parameters) -> share of the summits that touch where the displacement is A; None: all do
    poisson : whether `scales` and `allows` also get `nu`, Poisson's ratio of the layer, or of the body without one
    allows : (**parameters) -> (B,) bool, whether the parameters of a case go together; None: always
    yielded : (*own) -> λ above which the spots have yielded; None: they never do
    rise : how much the displacement of the asperities saves nodes on the mesh to begin with: 0.5 for power laws, 1.1
        for a law that saturates, fitted to random cases. A wrong value costs time, and nothing else
    from_pressure : (q, *own) -> y with q(y) = q >= 0. This and the next two may be left out: they are then found from
        `curve` and `edge`, which takes more time
    from_displacement : (g, *own) -> y with g(y) = g >= 0; NaN where g is larger than the law's limit
    guess : (q, *own) -> y with q(y) = q, roughly
    on_body : (kernel, m, h, E, **parameters) -> what `bind` returns, of a law of asperities that feel the coated body
        itself, not the half-space of its layer's material: `kernel`, that of B cases (solver/kernels/kernel.py), m and
        h (B,), thickness of the first layer; E (B,), as that of `scales`. None: the law does not know the body
    cell : the lattice of the cell of a spot on the body, "square", "hex" or "disc", or "summit" of spots of their own
        loads; None where `on_body` is
    spot : (y, q, *own) -> b/Bbar of the largest spot; None: sqrt(λ)
    end : (*own) -> largest p/p* that the law knows, which depends on the case; None: there is none
    body : parameter -> number or word, lengths in m, of the coated body on which a table holds that was computed on
        one: a study refuses contacts on another; None: a half-space, whatever lies under it
    """

    name: str
    scales: Callable
    curve: Callable
    area: Callable
    peak: Callable
    edge: Callable
    parameters: dict[str, Parameter] = field(default_factory=dict)
    version: str = ""
    rough: bool = True
    error: float = 0.0
    error_at: Callable | None = None
    least: float = 0.0
    most: float = np.inf
    corners: bool = False
    smears: bool = True
    touching: Callable | None = None
    poisson: bool = False
    allows: Callable | None = None
    yielded: Callable | None = None
    rise: float = 0.5
    from_pressure: Callable | None = None
    from_displacement: Callable | None = None
    guess: Callable | None = None
    on_body: Callable | None = None
    cell: str | None = None
    spot: Callable | None = None
    end: Callable | None = None
    body: Mapping | None = None

    @property
    def arguments(self) -> tuple[str, ...]:
        """Names of the arguments of `scales` beside E."""
        return (*self.parameters, *["nu"] * self.poisson)

    def bind(self, E: np.ndarray, **values: np.ndarray) -> "Bound":
        """The law of B cases, in units R = E2* = 1.

        Parameters
        ----------
        E : (B,), modulus that the asperities feel
        values : the `arguments` of the law, (B,) each

        Returns
        -------
        Bound
        """
        p_star, A_star, *own = self.scales(E, **{name: values[name] for name in self.arguments})
        one = np.ones(np.shape(E))
        return Bound(self, p_star * one, A_star * one, tuple((v * one)[:, None] for v in own))

    def at(self, p: ArrayLike, E: ArrayLike, **numbers: ArrayLike) -> Spots:
        """The law at a nominal pressure.

        Parameters
        ----------
        p : nominal pressure >= 0 (unit of E); NaN stays NaN
        E : modulus that the asperities feel, > 0
        numbers : the `arguments` of the law

        Returns
        -------
        Spots : A, lam and p_max, of the shape to which all arguments broadcast
        """
        names = self.arguments
        p, E, *values = np.broadcast_arrays(*(np.asarray(v, float) for v in (p, E, *(numbers[name] for name in names))))
        flat = {name: v.ravel() for name, v in zip(names, values, strict=True)}
        with np.errstate(all="ignore"):
            spots = self.bind(E.ravel(), **flat).at(p.reshape(-1, 1))
        return Spots(*(v.reshape(p.shape) for v in spots))


@batch.of_cases
class Bound(NamedTuple):
    """A law with the numbers of B cases: p* and A* (B,), and in `own` the other numbers, (B, 1) each, that its
    functions need."""

    law: Law
    p_star: np.ndarray
    A_star: np.ndarray
    own: tuple[np.ndarray, ...]

    @property
    def rough(self):
        return self.law.rough

    def evaluate(self, y):
        """:class:`Curve` at y (B, m)."""
        return self.law.curve(y, *self.own)

    def area(self, y, q):
        """λ (B, m), Eq. (11), at y and q (B, m) of the same points."""
        return self.law.area(y, q, *self.own)

    def bent(self, y, q):
        """(B,) bool: the cases whose λ bends, in corners or where spots begin to yield, at their y and q (B, m)."""
        if self.law.yielded is None:
            return np.full(len(y), self.law.corners)
        return np.any(self.area(y, q) > self.law.yielded(*self.own), axis=1)

    def peak(self, y, q):
        """p_max (B, m), Eq. (13), at y and q (B, m) of the same points."""
        return self.p_star[:, None] * self.law.peak(y, q, *self.own)

    def at(self, p):
        """:class:`Spots` at the nominal pressures p (B, m) >= 0."""
        q = p / self.p_star[:, None]
        y = self.from_pressure(q)
        g = np.where(y > 0, self.evaluate(y).g, y)  # at y = 0 a curve may be 0/0; NaN stays
        return Spots(self.A_star[:, None] * g, self.area(y, q), self.peak(y, q))

    def guess(self, q):
        """y (B, m) with q(y) = q, roughly: where a Newton iteration begins."""
        return self.law.guess(q, *self.own) if self.law.guess else self.from_pressure(q)

    def from_pressure(self, q):
        """y (B, m) with q(y) = q >= 0; NaN where q is NaN."""
        if self.law.from_pressure:
            return self.law.from_pressure(q, *self.own)
        gamma, beta = self.law.edge(*self.own)
        return inverse(lambda y: self.evaluate(y)[0::2], q, np.sqrt(gamma * np.maximum(q, 0.0) ** beta))

    def from_displacement(self, g):
        """y (B, m) with g(y) = g; 0 where g <= 0, NaN where no pressure makes it so large."""
        if self.law.from_displacement:
            return self.law.from_displacement(g, *self.own)
        return inverse(lambda y: self.evaluate(y)[1::2], g, np.sqrt(np.maximum(g, 0.0)))

    def edge(self):
        """gamma, beta (B,) of g ~ gamma q^beta for small q."""
        return (np.broadcast_to(v, (len(self.p_star), 1))[:, 0] for v in self.law.edge(*self.own))

    def sparse(self, g):
        """q (B, m) at g (B, m) by the power law of small pressures, g = gamma q^beta, whether g is small or not."""
        gamma, beta = self.law.edge(*self.own)
        return (g / gamma) ** (1 / beta)

    def limit(self, new, old):
        """`new`, y after a Newton step, limited to a fifth and to five times `old`: so it stays positive. Without
        asperities the step is exact, and y may have any sign."""
        return np.clip(new, 0.2 * old, 5.0 * old) if self.law.rough else new


def inverse(value, target, y):
    """y with value(y)[0] = target, by Newton on ln value against ln y, to a few units of rounding, each element by
    itself; 0 where target <= 0, NaN where it is NaN or no y is found.

    Where a law bends sharply, Newton's method may swing to and fro. So a step longer than half of the one before goes
    to the middle, in ln y, between the nearest y below and above the root, once both are known.

    value : y -> (value, its derivative), increasing from 0; target : array; y : first guess, an array of its shape
    """
    goal = np.where(target > 0, target, 1.0)
    y = np.where((target > 0) & (y > 0), y, 1.0)
    going, size = np.full(y.shape, True), np.full(y.shape, np.inf)
    low, high = np.zeros(y.shape), np.full(y.shape, np.inf)
    for _ in range(_STEPS):
        step = np.clip(log_step(value, goal, y), -_LONGEST, _LONGEST)
        low, high = np.where(step > 0, y, low), np.where(step < 0, y, high)
        astray = (np.abs(step) > np.maximum(size / 2, _ROUNDING)) & (low > 0) & (high < np.inf)
        middle = np.sqrt(np.where(astray, low, y)) * np.sqrt(np.where(astray, high, y))
        step = np.where(astray, np.log(middle / y), step)
        y = np.where(going, y * np.exp(step), y)
        size, before = np.where(going, np.abs(step), size), size
        going = going & (size > _LAST) & ((size > _ROUNDING) | (size < before / 2))
        if not going.any():
            break
    return where_positive(target, np.where(size < 1, y, np.nan))


def log_step(value, target, y):
    """The change of ln y in a Newton step on ln value against ln y; arguments as in :func:`inverse`."""
    now, slope = value(y)
    return np.log(target / now) * now / (slope * y)


def where_positive(target, y):
    """y where target > 0; 0 where it is not, and NaN where it is NaN."""
    return np.where(target > 0, y, np.where(np.isnan(target), np.nan, 0.0))
