"""What is asked and what is answered: arrays over a batch of cases."""

from dataclasses import dataclass, fields
from enum import IntEnum

import numpy as np

from .base import BONDINGS
from .equation import CONTROLS
from .micro import MICROS

BASES = ("half_space", "thin_layer", "layered", "auto")
SCHEMES = ("newton", "picard")
#: How the model error of a thin layer asked for by name is estimated: free of cost, or by one step of the exact layer.
MODEL_CHECKS = ("closed_form", "first_order")

_TEXT = {"bonding": BONDINGS, "base": BASES, "micro": MICROS, "scheme": SCHEMES, "model_check": MODEL_CHECKS}
_WHOLE = ("nodes", "max_iterations")

#: Value of each parameter that is not given, in the order of the fields of :class:`Problem`.
DEFAULTS = {
    "h": 1.0,
    "n": 1.0,
    "nu1": 0.3,
    "nu2": 0.3,
    "bonding": "frictionless",
    "Nbar": 1.0,
    "Ra": 1.0,
    "base": "thin_layer",
    "accuracy": 1e-2,
    "model_check": "closed_form",
    "micro": "disc_cell",
    "B": 1.0,
    "beta": 0.5,
    "scheme": "newton",
    "k": 1.0,
    "rtol": 1e-6,
    "nodes": 0,
    "max_iterations": 0,
    "R": 1.0,
    "E2": 1.0,
}


class Model(IntEnum):
    """What a case was solved with; smooth models get their asperities afterwards, from the nominal pressure."""

    NONE = 0
    HALF_SPACE = 1
    SMOOTH_HALF_SPACE = 2
    LAYER_ALONE = 3
    SMOOTH_LAYER_ALONE = 4
    THIN_LAYER = 5
    SMOOTH_THIN_LAYER = 6
    LAYERED = 7
    SMOOTH_LAYERED = 8


@dataclass(frozen=True)
class Problem:
    """A batch of B cases; every field but `control` an array (B,). Build it with :meth:`of`.

    `value` is the controlled quantity (`control`: "P", "a" or "D"). Lengths in the unit of `R`, moduli and pressures
    in the unit of `E2` (E2*), loads in E2 R²; with R = E2 = 1 these are the units of the paper.
    """

    control: str
    value: np.ndarray
    h: np.ndarray
    n: np.ndarray
    nu1: np.ndarray
    nu2: np.ndarray
    bonding: np.ndarray
    Nbar: np.ndarray
    Ra: np.ndarray
    base: np.ndarray
    accuracy: np.ndarray
    model_check: np.ndarray
    micro: np.ndarray
    B: np.ndarray
    beta: np.ndarray
    scheme: np.ndarray
    k: np.ndarray
    rtol: np.ndarray
    nodes: np.ndarray
    max_iterations: np.ndarray
    R: np.ndarray
    E2: np.ndarray

    @classmethod
    def of(cls, *, P=None, a=None, D=None, **parameters):
        """Broadcast scalars and (B,) arrays to a batch.

        Exactly one of P, a, D is given; the other parameters as in DEFAULTS. `nodes` = 0 chooses the mesh by `rtol`;
        `max_iterations` = 0 is the scheme's own limit.

        Raises
        ------
        TypeError
            A parameter that does not exist.
        ValueError
            Not exactly one control; shapes that do not broadcast to (B,); a text argument outside its choices. A
            number out of bounds is not an error: that case gets ``Status.INVALID_INPUT``.
        """
        given = {name: v for name, v in zip(CONTROLS, (P, a, D), strict=True) if v is not None}
        if len(given) != 1:
            raise ValueError(f"give exactly one of P, a, D (got {', '.join(given) or 'none'})")
        ((control, value),) = given.items()
        unknown = sorted(set(parameters) - set(DEFAULTS))
        if unknown:
            raise TypeError(f"unknown parameter {unknown[0]}")
        values = {"value": value} | DEFAULTS | parameters
        arrays = [_array(name, v) for name, v in values.items()]
        shape = np.broadcast_shapes((1,), *(v.shape for v in arrays))
        if len(shape) != 1:
            raise ValueError(f"parameters broadcast to shape {shape}: give scalars and one-dimensional arrays")
        return cls(control, *(np.broadcast_to(v, shape) for v in arrays))

    def __len__(self):
        return len(self.value)

    def take(self, index):
        """The sub-batch at `index`."""
        return Problem(self.control, *(getattr(self, f.name)[index] for f in fields(self)[1:]))

    def invalid(self):
        """(B,) bool: a number that the case needs is not finite or outside its bounds."""
        rough, layered = self.micro != "smooth", self.base != "half_space"
        power = self.micro == "power_law"
        bad = _not_positive(self.value) | _not_positive(self.R) | _not_positive(self.E2)
        bad |= layered & (_not_positive(self.h) | _not_positive(self.n))
        bad |= layered & ~((self.nu1 > -1) & (self.nu1 <= 0.5) & (self.nu2 > -1) & (self.nu2 <= 0.5))
        bad |= rough & (_not_positive(self.Nbar) | _not_positive(self.Ra))
        bad |= power & (_not_positive(self.B) | ~((self.beta > 0) & (self.beta <= 1)))
        bad |= (self.base == "auto") & ~((self.accuracy > 0) & (self.accuracy < 1))
        bad |= ~((self.rtol > 0) & (self.rtol < 1)) | ~((self.k >= 0) & np.isfinite(self.k))
        return bad | ((self.nodes != 0) & ((self.nodes < 4) | (self.nodes > 256))) | (self.max_iterations < 0)


def _not_positive(v):
    return ~((v > 0) & np.isfinite(v))


def _array(name, value):
    if name in _TEXT:
        array = np.asarray(value, dtype=str)
        unknown = sorted(set(array.ravel()) - set(_TEXT[name]))
        if unknown:
            raise ValueError(f'{name} = "{unknown[0]}": must be one of {", ".join(_TEXT[name])}')
        return array
    return np.asarray(value, dtype=int if name in _WHOLE else float)


@dataclass(frozen=True)
class Solution:
    """The answers, arrays (B,) and, for the profiles over the m radii asked for, (B, m).

    a, D in R; P in E2 R²; p0 = p(0), p_max (13), p in E2; A0 = A[p(0)] in R; Ar_An (12) and lam = λ(r/a) (11)
    without unit; dP_dD in E2 R. `status` is a :class:`~solver.status.Status`; `residual` the largest residual of the
    equation relative to its right-hand side; `error` the estimated relative error, the largest over a, P, D, p0,
    p_max, Ar_An (the profiles between the nodes are not in it); `iterations`; `nodes` used (0: closed form);
    `model_error` the same for the model used against the exact layered rough one (0 for that one, and for a half-space
    asked for by name); `model_used` a :class:`Model`. A case without numbers holds NaN everywhere but in the controlled
    quantity.
    """

    a: np.ndarray
    P: np.ndarray
    D: np.ndarray
    p0: np.ndarray
    p_max: np.ndarray
    Ar_An: np.ndarray
    A0: np.ndarray
    dP_dD: np.ndarray
    residual: np.ndarray
    error: np.ndarray
    model_error: np.ndarray
    status: np.ndarray
    model_used: np.ndarray
    iterations: np.ndarray
    nodes: np.ndarray
    p: np.ndarray
    lam: np.ndarray

    @classmethod
    def empty(cls, size, points):
        """`size` cases without numbers, with profiles of `points` radii."""
        values = {f.name: np.full(size, np.nan) for f in fields(cls)}
        for name in ("status", "model_used"):
            values[name] = np.zeros(size, dtype=np.int8)
        for name in ("iterations", "nodes"):
            values[name] = np.zeros(size, dtype=np.int32)
        for name in ("p", "lam"):
            values[name] = np.full((size, points), np.nan)
        return cls(**values)

    def put(self, index, part):
        """Write the values of the dict `part` (name -> array) into the cases `index`, in place."""
        for name, value in part.items():
            getattr(self, name)[index] = value
