"""The solution: arrays over a batch of cases."""

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from .parameters import one_of
from .status import Codes, Status

#: The error of a case is the largest relative error of these.
JUDGED = ("a", "P", "D", "p0", "p_max", "Ar_An")
#: Numbers of a converged case, in units R = E2* = 1: _POSITIVE are > 0; _NUMBERS, which include these, are >= 0.
_POSITIVE = (*JUDGED, "dP_dD")
_PROFILES = ("p", "lam")
_NUMBERS = (*_POSITIVE, "A0", "residual", "error", "profile_error", *_PROFILES)
#: Numbers that may be infinite under some shapes and under adhesion; and numbers that may be negative under adhesion.
_INFINITE = ("p0", "p_max", "dP_dD", "p")
_SIGNED = (*_INFINITE, "P", "D")
#: Numbers that depend on the pressure on the axis.
_OF_CENTRE = ("p0", "p_max", "A0", *_PROFILES)
#: Integers: codes and counts.
_WHOLE = {"status": np.int8, "model_used": np.int8, "iterations": np.int32, "nodes": np.int32, "stable": np.bool_}
#: Numbers of pull-off and pull-in, 0 without adhesion.
PULLS = ("P_off", "D_off", "a_off", "P_in", "a_in")
#: Defaults other than NaN, and other than 0 for whole numbers.
_DEFAULTS = {"stable": True} | dict.fromkeys(PULLS, 0.0)
#: Shares of an area are at most 1. A sum over 256 nodes may round to 1 + 256 eps, which is 1 + 6e-14. A number above
#: 1 + _ROUNDING is not due to rounding.
_SHARES, _ROUNDING = ("Ar_An", "lam"), 1e-10


class Model(Codes):
    """The model with which a case was solved. The code of a smooth model is that of the rough one plus 1. It solves a
    smooth punch; with "auto" the asperities are added afterwards.

    Examples
    --------
    >>> from solver import Problem, solve
    >>> Model(solve(Problem.of(P=1e-5, base="half_space", micro="smooth")).model_used.item()).name
    'SMOOTH_HALF_SPACE'
    """

    NONE = 0
    HALF_SPACE = 1
    SMOOTH_HALF_SPACE = 2
    LAYER_ALONE = 3
    SMOOTH_LAYER_ALONE = 4
    THIN_LAYER = 5
    SMOOTH_THIN_LAYER = 6
    LAYERED = 7
    SMOOTH_LAYERED = 8
    STACK = 9
    SMOOTH_STACK = 10
    THIN_STACK = 11
    SMOOTH_THIN_STACK = 12


@dataclass(frozen=True)
class Solution:
    """The answers: arrays (B,), and profiles (B, m) at m radii. Units are those of the problem, made of its R and E2.

    A case that fails raises nothing: `status` says why, and whether it has the last numbers of the iteration. A case
    without numbers has NaN everywhere except in the quantity that was given. The bounds below are those of a converged
    case.

    Attributes
    ----------
    a, P, D : > 0; radius of the nominal contact area (unit R), load (E2 R²), indentation depth (14) (R)
    p0, p_max : > 0; nominal pressure p(0), and real pressure in the middle of the central spot (13), which is p(0)
        under a smooth punch (E2)
    p_spot, r_spot : if asperities feel the coated body, the largest pressure in the central spot (E2), which is p_max
        if its place is the middle, and the radius of its place over that of the spot, in [0, 1); else NaN
    Ar_An : in (0, 1]; real over nominal contact area (12), 1 for a smooth punch
    plastic_share : in [0, 1]; share of the nominal contact area whose spots have yielded; NaN for a law without yield
    A0 : >= 0; additional displacement A[p(0)] of the asperities (6) (R)
    dP_dD : > 0; contact stiffness (E2 R)
    residual : >= 0; largest residual of the discrete equation, relative to its right-hand side
    error : in [0, rtol]; estimated relative error, the largest over a, P, D, p0, p_max, Ar_An
    profile_error : >= error; estimated error of the profiles at any radius, over the largest p or λ. It may exceed rtol
    model_error : >= 0; estimated relative error of the model used, over the same six, against the exact layer with its
        asperities. 0 for the exact layer, and for the base "half_space"; with "auto" at most `accuracy`. It includes
        the error of a law that comes from a table, which may alone be above `accuracy`, and the effects of the coated
        body that the law of asperities leaves out
    status, model_used : int8; a :class:`~solver.status.Status` and a :class:`Model`
    iterations, nodes : int32; total number of iterations, and nodes of the last mesh; 0 nodes: a closed form
    stable : bool; under adhesion, whether a >= a_off; else True
    P_off, D_off, a_off : load, depth and radius at which the machine that holds the punch (`k_machine`) pulls it off; 0
        without adhesion, like the next two
    P_in, a_in : load and radius to which the contact jumps when the punch touches
    p : (B, m); nominal pressure at the radii (E2)
    lam : (B, m), in [0, 1]; relative contact area λ (11) at the radii, 1 inside the contact of a smooth punch

    Examples
    --------
    >>> from solver import Problem, solve
    >>> solution = solve(Problem.of(P=[1e-5, 2e-5], base="half_space", micro="smooth"))
    >>> solution
    Solution(2 cases: 2 converged; profiles at 2 radii)
    >>> print(f"{solution.a[1]:.5f}")
    0.02466
    """

    a: np.ndarray
    P: np.ndarray
    D: np.ndarray
    p0: np.ndarray
    p_max: np.ndarray
    p_spot: np.ndarray
    r_spot: np.ndarray
    Ar_An: np.ndarray
    plastic_share: np.ndarray
    A0: np.ndarray
    dP_dD: np.ndarray
    residual: np.ndarray
    error: np.ndarray
    profile_error: np.ndarray
    model_error: np.ndarray
    status: np.ndarray
    model_used: np.ndarray
    iterations: np.ndarray
    nodes: np.ndarray
    stable: np.ndarray
    P_off: np.ndarray
    D_off: np.ndarray
    a_off: np.ndarray
    P_in: np.ndarray
    a_in: np.ndarray
    p: np.ndarray
    lam: np.ndarray

    def __repr__(self):
        values, counts = (array.tolist() for array in np.unique(self.status, return_counts=True))
        ended = ", ".join(f"{n} {Status(v).name.lower()}" for v, n in zip(values, counts, strict=True))
        return f"Solution({len(self.a)} cases: {ended or 'none'}; profiles at {self.p.shape[1]} radii)"

    @classmethod
    def of(cls, size: int, points: int, **values: Any) -> "Solution":
        """Cases with the same values, or with arrays of them.

        Parameters
        ----------
        size, points : number of cases, B, and of radii of the profiles, m
        values : arrays (B,), profiles (B, m), or one value for all. Others are NaN, and counts are 0

        Returns
        -------
        Solution

        Examples
        --------
        >>> Solution.of(2, 0, a=0.04).a.tolist()
        [0.04, 0.04]
        """

        def array(name):
            shape = (size, points) if name in _PROFILES else (size,)
            kind = _WHOLE.get(name, float)
            default = _DEFAULTS.get(name, np.nan if kind is float else 0)
            return np.full(shape, values.get(name, default), dtype=kind)

        return cls(**{f.name: array(f.name) for f in fields(cls)})

    @classmethod
    def join(cls, size: int, points: int, pieces: Iterable[tuple[Any, "Solution"]], **values: Any) -> "Solution":
        """Put pieces together.

        Parameters
        ----------
        size, points : number of cases, B, and of radii of the profiles, m
        pieces : pairs of an index into the cases and their solution. If a case is in two pieces, the last one counts.
            If the last piece has all cases in their order, it is the result itself
        values : the values of cases in no piece, as in :meth:`of`

        Returns
        -------
        Solution

        Examples
        --------
        >>> first, last = Solution.of(1, 0, a=0.04), Solution.of(1, 0, a=0.05)
        >>> Solution.join(2, 0, [([0], first), ([1], last)]).a.tolist()
        [0.04, 0.05]
        """
        pieces = list(pieces)
        if pieces and _is_all(pieces[-1][0], size) and pieces[-1][1].p.shape == (size, points):
            return pieces[-1][1]
        whole = vars(cls.of(size, points, **values))
        for index, piece in pieces:
            for name, values in vars(piece).items():
                whole[name][index] = values
        return cls(**whole)

    def take(self, index: Any) -> "Solution":
        """Some of the cases.

        Parameters
        ----------
        index : whole numbers, a slice, or bool (B,)

        Returns
        -------
        Solution

        Examples
        --------
        >>> from solver import Problem, solve
        >>> solution = solve(Problem.of(P=[1e-5, 2e-5], base="half_space", micro="smooth"))
        >>> len(solution.take([1]).a)
        1
        """
        return Solution(**{name: values[index] for name, values in vars(self).items()})

    def not_finite(self, infinite: Any = False, unknown: Any = False) -> np.ndarray:
        """Which cases lack a number that they should have.

        Parameters
        ----------
        infinite : (B,) bool, the cases whose pressures and stiffness may be infinite: with pointed or flat shapes, or
            with adhesion
        unknown : (B,) bool, the cases whose pressure on the axis is unknown: it may be NaN, and so may the numbers that
            depend on it

        Returns
        -------
        numpy.ndarray : (B,) bool: by its status the case has numbers, but one of them other than `model_error` is NaN
            or infinite

        Examples
        --------
        >>> from solver import Problem, solve
        >>> solution = solve(Problem.of(P=[1e-5, 2e-5], base="half_space", micro="smooth"))
        >>> solution.not_finite().tolist()
        [False, False]
        """
        ended = one_of(self.status, (Status.CONVERGED, Status.TOLERANCE_NOT_MET))
        right = ended.copy()
        for name in _NUMBERS:
            values = getattr(self, name)
            allowed = infinite & _of_all(~np.isnan(values)) if name in _INFINITE else False
            allowed = allowed | unknown if name in _OF_CENTRE else allowed
            right &= _of_all(np.isfinite(values)) | allowed
        return ended & ~right

    def out_of_range(self, pulls: Any = False, unknown: Any = False) -> np.ndarray:
        """Which cases have converged to an impossible number.

        The solution must be in units R = E2* = 1: in other units a positive number may underflow to 0.

        Parameters
        ----------
        pulls : (B,) bool, the cases with adhesion: loads, depths, pressures and the stiffness may be negative
        unknown : (B,) bool, as in :meth:`not_finite`

        Returns
        -------
        numpy.ndarray : (B,) bool: some number is negative, 0 or above 1, although it cannot be

        Examples
        --------
        >>> from solver import Problem, solve
        >>> solution = solve(Problem.of(P=[1e-5, 2e-5], base="half_space", micro="smooth"))
        >>> solution.out_of_range().tolist()
        [False, False]
        """
        ended = self.status == Status.CONVERGED
        right = ended.copy()
        for name in _NUMBERS:
            values = getattr(self, name)
            sign = _of_all(values > 0 if name in _POSITIVE else ~(values < 0))
            sign = sign | unknown & _of_all(~(values < 0)) if name in _OF_CENTRE else sign
            right &= sign | pulls & _of_all(~np.isnan(values)) if name in _SIGNED else sign
            if name in _SHARES:
                right &= _of_all(~(values > 1 + _ROUNDING))
        return ended & ~right

    def refused(self, mask: np.ndarray, status: Status) -> "Solution":
        """The solution without the numbers of some cases.

        Parameters
        ----------
        mask : (B,) bool, these cases
        status : their new status

        Returns
        -------
        Solution

        Examples
        --------
        >>> import numpy as np
        >>> refused = Solution.of(2, 0, a=0.04).refused(np.array([False, True]), Status.LIFT_OFF)
        >>> refused.a.tolist(), refused.status.tolist()
        ([0.04, nan], [0, 8])
        """
        if not mask.any():
            return self
        arrays = {name: np.array(values) for name, values in vars(self).items()}
        for values in arrays.values():
            if values.dtype == float:
                values[mask] = np.nan
        arrays["status"][mask] = status
        return Solution(**arrays)


def _is_all(index, size):
    """Whether an index selects all cases in their order."""
    whole = isinstance(index, np.ndarray) and index.dtype.kind == "i" and len(index) == size
    return whole and np.array_equal(index, np.arange(size))


def _of_all(right):
    """(B,) bool: whether all values of a case are True, in an array (B,) or (B, m)."""
    return right if right.ndim == 1 else right.all(axis=1)
