"""The protocol of a micro law: everything that the solver, its outputs and the derived quantities need of a law.

A micro law gives the response of asperities to a nominal pressure p: their additional displacement A[p], the relative
contact area λ and the largest real pressure p_max. It is written in an unknown y > 0,

    p = p* q(y),   A = A* g(y),   λ = area(y),   p_max = p* peak(y).

q and g are smooth and increase from 0 at y = 0, where g ~ y². The solver's unknowns are the values of y at its nodes. A
:class:`Law` has these functions and the parameters on which they depend. ``law.bind`` returns a :class:`Bound`, the law
with the numbers of a batch of cases.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..numerics import batch
from ..parameters import Parameter

#: Most Newton steps of an inverse, far more than the laws of this package need; and the largest change of ln y in a
#: step.
_STEPS, _LONGEST = 100, 5.0
#: A step of ln y below _LAST is the last: the next one would be below rounding. Where a law saturates, rounding makes y
#: less certain (tests/laws/test_micro.py). So a step below _ROUNDING is also the last if it is more than half of the
#: step before.
_LAST, _ROUNDING = 1e-9, 1e-3


@batch.of_cases
class Curve(NamedTuple):
    """A law at some y.

    Attributes
    ----------
    q, g : p/p* and A/A*; arrays of the shape of y
    dq, dg : their derivatives by y

    Examples
    --------
    >>> import numpy as np
    >>> from solver.laws import LAWS
    >>> disc_cell = LAWS["disc_cell"].bind(np.ones(1), Nbar=np.array([250000.0]), Ra=np.array([0.004]))
    >>> point = disc_cell.evaluate(np.array([[0.1]]))
    >>> print(f"p/p* = {point.q.item():.5f}, A/A* = {point.g.item():.5f}")
    p/p* = 0.00063, A/A* = 0.00907
    """

    q: np.ndarray
    g: np.ndarray
    dq: np.ndarray
    dg: np.ndarray


class Spots(NamedTuple):
    """A law at some pressure p: A in the unit of R, λ, and p_max in the unit of p; arrays of the shape of p."""

    A: np.ndarray
    lam: np.ndarray
    p_max: np.ndarray


@dataclass(frozen=True, eq=False)
class Law:
    """One micro law. Its functions take arrays y, q or g (B, m), followed by `own`: all arrays that `scales` returns
    after p* and A*.

    A law that is sent to worker processes must be picklable: its functions must have names in a module.

    Attributes
    ----------
    name : the word that a user writes for ``micro``
    parameters : name -> Parameter, with bounds, default, unit and words; each is an argument of `scales`
    scales : (E, **parameters) -> (p*, A*, *own); all (B,), in units R = E2* = 1. E is the modulus that the
        asperities feel: E1*, or E2* without a layer; over 1 + m under an elastic punch
    curve : (y, *own) -> Curve
    area : (y, q, *own) -> λ, from 0 to 1 (11)
    peak : (y, q, *own) -> p_max/p* (13)
    edge : (*own) -> (gamma, beta) of g ~ gamma q^beta for small q; floats, or arrays that broadcast to (B, m)
    version : text that changes whenever the numbers of the law may change; part of the keys of its cases
    rough : False if there are no asperities at all: A = 0, and the equation of the contact is linear in y = q
    error : largest relative error of A, λ and p_max in a law that comes from a table, else 0; part of `model_error`
    error_at : (p/E) -> that error at a nominal pressure, (B,) each, of a law whose rows err by different amounts; None:
        it is `error`
    least, most : smallest and largest p/E for which the law has numbers; contacts outside get none
    corners : whether λ(y) has corners, for example where the lowest summits touch; Ar/An then has its own quadrature
    smears : whether it spreads the pressure of the neighbours evenly, and so errs where the spots merge
    touching : (A, **parameters) -> share of the summits that touch where the displacement is A; None: all do
    poisson : whether `scales` and `allows` also get `nu`, Poisson's ratio of the layer, or of the body if there is no
        layer
    allows : (**parameters) -> (B,) bool, whether the parameters of a case go together; None: always
    yielded : (*own) -> λ above which the spots have yielded; None: they never do
    rise : how many nodes the asperities save on the first mesh: 0.5 for power laws, 1.1 for a law that saturates,
        fitted to random cases. A wrong value only costs time
    from_pressure : (q, *own) -> y with q(y) = q >= 0. This and the next two may be left out: y is then computed from
        `curve` and `edge`, which takes more time
    from_displacement : (g, *own) -> y with g(y) = g >= 0; NaN where g is larger than the law's limit
    guess : (q, *own) -> y with q(y) = q, roughly
    on_body : (kernel, m, h, E, **parameters) -> Bound, as `bind`, for asperities that feel the coated body itself and
        not a half-space of its layer's material. `kernel` is that of B cases (solver/kernels/kernel.py), m (B,) is
        E1*/E3*, h (B,) the thickness of the first layer, E (B,) as in `scales`. None: asperities cannot feel the body
    cell : the lattice of the cell of a spot on the body, "square", "hex" or "disc", or "summit" if spots have loads of
        their own; None if `on_body` is None
    spot : (y, q, *own) -> b/Bbar of the largest spot; None: sqrt(λ)
    end : (*own) -> largest p/p* for which the law has numbers, if it depends on the case; None: there is no such limit
    body : parameter -> number or word, lengths in m: the coated body on which a table was computed. A study refuses
        contacts on another body. None: a half-space, whatever lies under it

    Examples
    --------
    >>> from solver.laws import LAWS
    >>> LAWS["disc_cell"].arguments, LAWS["smooth"].rough
    (('Nbar', 'Ra'), False)
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
        """Names of the arguments of `scales` other than E."""
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

        Examples
        --------
        >>> import numpy as np
        >>> from solver.laws import LAWS
        >>> disc_cell = LAWS["disc_cell"].bind(np.ones(1), Nbar=np.array([250000.0]), Ra=np.array([0.004]))
        >>> print(f"{disc_cell.p_star.item():.4f} {disc_cell.A_star.item():.3e}")
        0.1881 3.183e-04
        """
        p_star, A_star, *own = self.scales(E, **{name: values[name] for name in self.arguments})
        ones = np.ones(np.shape(E))
        return Bound(self, p_star * ones, A_star * ones, tuple((v * ones)[:, None] for v in own))

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

        Examples
        --------
        >>> from solver.laws import LAWS
        >>> spots = LAWS["disc_cell"].at(0.01, 1.0, Nbar=250000, Ra=0.004)
        >>> print(f"A = {spots.A:.3e}, λ = {spots.lam:.4f}, p_max = {spots.p_max:.4f}")
        A = 3.899e-05, λ = 0.1864, p_max = 0.0804
        """
        names = self.arguments
        p, E, *values = np.broadcast_arrays(*(np.asarray(v, float) for v in (p, E, *(numbers[name] for name in names))))
        flat = {name: v.ravel() for name, v in zip(names, values, strict=True)}
        with np.errstate(all="ignore"):
            spots = self.bind(E.ravel(), **flat).at(p.reshape(-1, 1))
        return Spots(*(v.reshape(p.shape) for v in spots))


@batch.of_cases
class Bound(NamedTuple):
    """A law with the numbers of B cases: p* and A* (B,), and in `own` all other numbers that its functions take, (B, 1)
    each."""

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
        """λ (B, m), Eq. (11), at y and q (B, m), which must belong together."""
        return self.law.area(y, q, *self.own)

    def bent(self, y, q):
        """(B,) bool: the cases in which λ, over the points with y and q (B, m), has a kink: a corner of the law, or the
        place where spots begin to yield."""
        if self.law.yielded is None:
            return np.full(len(y), self.law.corners)
        return np.any(self.area(y, q) > self.law.yielded(*self.own), axis=1)

    def peak(self, y, q):
        """p_max (B, m), Eq. (13), at y and q (B, m), which must belong together."""
        return self.p_star[:, None] * self.law.peak(y, q, *self.own)

    def at(self, p):
        """:class:`Spots` at the nominal pressures p (B, m) >= 0."""
        q = p / self.p_star[:, None]
        y = self.from_pressure(q)
        g = np.where(y > 0, self.evaluate(y).g, y)  # at y = 0 a curve may be 0/0; NaN stays NaN
        return Spots(self.A_star[:, None] * g, self.area(y, q), self.peak(y, q))

    def guess(self, q):
        """y (B, m) with q(y) = q, roughly: the start of a Newton iteration."""
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
        """q (B, m) at g (B, m) by the power law of small pressures, g = gamma q^beta, even if g is not small."""
        gamma, beta = self.law.edge(*self.own)
        return (g / gamma) ** (1 / beta)

    def limit(self, new, old):
        """`new`, y after a Newton step, limited to the range from a fifth of `old` to five times `old`: so it stays
        positive. Without asperities the step is exact, and y may have any sign."""
        return np.clip(new, 0.2 * old, 5.0 * old) if self.law.rough else new


def inverse(value, target, y):
    """y with value(y)[0] = target, to a few units of rounding, by Newton's method on ln value against ln y; each
    element by itself. It is 0 where target <= 0, and NaN where target is NaN or the method does not converge.

    Where a law bends sharply, Newton's method may oscillate. So in place of a step longer than half of the one before,
    y moves to the middle, in ln y, of the bracket of the root, once the bracket has both ends.

    value : y -> (value, its derivative), increasing from 0
    target : array
    y : first guess, an array of the shape of target
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
    """The change of ln y by one Newton step on ln value against ln y; arguments as in :func:`inverse`."""
    now, slope = value(y)
    return np.log(target / now) * now / (slope * y)


def where_positive(target, y):
    """y where target > 0; 0 where it is not, and NaN where it is NaN."""
    return np.where(target > 0, y, np.where(np.isnan(target), np.nan, 0.0))
