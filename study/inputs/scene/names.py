"""Values and dimensions of the inputs of a physical scene."""

import math
from typing import Any

from solver.parameters import is_ratio as of_solver

from ...specimen.quantities import Quantity, quantity
from ..lexicon import PACKAGE, Lexicon

#: The texts that say that a body is rigid, and so its modulus infinite; or flat, and so its radius.
RIGID_TEXTS, _FLAT_TEXTS = ("rigid", "inf", "infinite"), ("flat", "inf", "infinite")
#: Input that may be infinite -> the texts that say so.
INFINITE = {"E2": RIGID_TEXTS, "E_punch": RIGID_TEXTS, "R1": _FLAT_TEXTS, "R2": _FLAT_TEXTS, "k_machine": RIGID_TEXTS}


def is_ratio(name: str) -> bool:
    """Whether an input is a Poisson ratio: derivatives are by it, not by its logarithm."""
    return name == "nu_punch" or of_solver(name)


def dim_of(name: str, lexicon: Lexicon) -> str:
    """The dimension along which several values of a parameter lie while the cases are solved.

    For a parameter with a unit that is "h in SI". The name alone belongs to the dimensionless h/R, which may change
    along the dimension of R too.
    """
    return name if lexicon.all_rows[name].unit == "1" else f"{name} in SI"


def si(name: str, value: Any, label: str = "", lexicon: Lexicon = PACKAGE) -> Quantity:
    """The SI value of a parameter or result: a text, a number, a quantity of pint or a Quantity.

    label : its name in messages
    lexicon : that has the name

    Raises ValueError as `quantity` does.
    """
    if type(value) is Quantity:
        return value
    if name in INFINITE and (value.lower() in INFINITE[name] if isinstance(value, str) else value == math.inf):
        return Quantity(math.inf)
    return quantity(label or name, value, lexicon.all_rows[name].unit)
