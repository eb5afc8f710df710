"""What describes a case: the one table of bounds, defaults and choices, and of who needs what."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

BONDINGS = ("frictionless", "bonded")
BASES = ("half_space", "thin_layer", "layered", "auto")
SCHEMES = ("newton", "picard")
#: How the model error of a thin layer asked for by name is estimated: free of cost, or by one step of the exact layer.
MODEL_CHECKS = ("closed_form", "first_order")


#: The condition of what every case needs.
EVERY = ("", ())


class Parameter(NamedTuple):
    """One parameter of a case.

    default : its value where it is not given; None: it has none, and must be given if a case needs it.
    choices : the words allowed, of a text; of a number ().
    whole : a number without fraction.
    interval : of a number, what is allowed, in units R = E2* = 1 and mathematical notation. Within it the solver is
        tested (tests/fuzz_solver.py): each case is solved, or has a status.
    also : single values allowed outside the interval.
    needed_by : name of another parameter, and those of its choices that need this one, which has no default then.
    """

    default: float | int | str | None = None
    choices: tuple[str, ...] = ()
    whole: bool = False
    interval: str = ""
    also: tuple = ()
    needed_by: tuple[str, tuple[str, ...]] = EVERY


#: The cases that have a layer.
LAYERED = ("base", ("thin_layer", "layered", "auto"))

#: What may be given; a case has one of them.
CONTROL = {
    "P": Parameter(interval="[1e-24, 1e3]"),
    "a": Parameter(interval="[1e-9, 1e3]"),
    "D": Parameter(interval="[1e-18, 1e3]"),
}

#: What a law needs it declares itself: `laws.register` adds it here, and the law to the choices of `micro`. Units are
#: said in :class:`~solver.problem.Problem`.
PARAMETERS = {
    "h": Parameter(interval="[1e-12, 1e6]", needed_by=LAYERED),
    "n": Parameter(interval="[1e-9, 1e9]", needed_by=LAYERED),
    "nu1": Parameter(0.3, interval="(-1, 0.5]"),
    "nu2": Parameter(0.3, interval="(-1, 0.5]"),
    "bonding": Parameter("frictionless", BONDINGS),
    "base": Parameter("layered", BASES),
    "accuracy": Parameter(1e-2, interval="(0, 1)"),
    "model_check": Parameter("closed_form", MODEL_CHECKS),
    "micro": Parameter("disc_cell"),
    "scheme": Parameter("newton", SCHEMES),
    "k": Parameter(1.0, interval="[0, 1e6]"),
    "rtol": Parameter(1e-6, interval="[1e-15, 1)"),
    "nodes": Parameter(0, whole=True, interval="[4, 256]", also=(0,)),
    "max_iterations": Parameter(0, whole=True, interval="[1, 100000]", also=(0,)),
    "R": Parameter(1.0, interval="(0, inf)"),
    "E2": Parameter(1.0, interval="(0, inf)"),
}

#: Numbers without a default of their own accord that only some cases look at, beside what `needed_by` says.
LOOKED_AT_BY = {"nu1": LAYERED, "nu2": LAYERED, "accuracy": ("base", ("auto",))}


@lru_cache(maxsize=64)
def ends(interval):
    """Low and high end of an interval in mathematical notation, and whether each belongs to it."""
    low, high = (float(end) for end in interval[1:-1].split(", "))
    return low, high, interval[0] == "[", interval[-1] == "]"


def allowed(own, values):
    """(...) bool: numbers that a :class:`Parameter`, or what has its interval, may have; NaN is none of them."""
    low, high, with_low, with_high = ends(own.interval)
    values = np.asarray(values)
    above = values >= low if with_low else values > low
    below = values <= high if with_high else values < high
    return (above & below) | np.isin(values, own.also) if own.also else above & below
