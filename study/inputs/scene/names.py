"""Values and dimensions of the inputs of a physical scene."""

import math
from typing import Any, NamedTuple

from ...specimen.quantities import Quantity, quantity
from ..vocabulary import ROWS

#: The texts that say that a body is rigid, and so its modulus infinite; or flat, and so its radius.
RIGID_TEXTS, _FLAT_TEXTS = ("rigid", "inf", "infinite"), ("flat", "inf", "infinite")
#: What may be infinite, and the texts that say so.
INFINITE = {"E2": RIGID_TEXTS, "E_punch": RIGID_TEXTS, "R1": _FLAT_TEXTS, "R2": _FLAT_TEXTS}

#: The end of a message about `same_piece`.
NEEDS_NAMES = (
    "no two of punch, layer and body are of one material by name, such as punch and body of PMMA; leave it out"
)


class CaseValues(list):
    """The values of a parameter, as they were given, over the dimension `case`."""


class QuantityList(NamedTuple):
    """The values of a parameter in its SI unit along a dimension."""

    quantities: list[Quantity]
    dim: str

    def __str__(self) -> str:
        return f"[{', '.join(map(str, self.quantities))}]"


def dim_of(name: str) -> str:
    """The dimension along which several values of a parameter lie while the cases are solved.

    A parameter with a unit has a dimension "h in SI". The name alone is that of the dimensionless parameter h/R, which
    depends on the dimension of R as well.
    """
    return name if ROWS[name].unit == "1" else f"{name} in SI"


def si(name: str, given: Any, called: str = "") -> Quantity:
    """The SI value of a parameter or result given as text, quantity of pint or number; messages call it `called`.

    Raises ValueError as `quantity` does.
    """
    if name in INFINITE and (given.lower() in INFINITE[name] if isinstance(given, str) else given == math.inf):
        return Quantity(math.inf)
    return quantity(called or name, given, ROWS[name].unit)
