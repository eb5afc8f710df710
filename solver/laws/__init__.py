"""Micro laws, one a file, and the registry of them: :func:`register` adds one (docs/extending.md)."""

from ..parameters import PARAMETERS
from . import disc_cell, power_law, smooth
from .law import Bound, Curve, Law, Spots

__all__ = ["LAWS", "Bound", "Curve", "Law", "Spots", "register"]

#: Name -> Law.
LAWS = {}


def register(law):
    """Make a :class:`Law` known by its name, and its parameters like any other. Returns the law.

    A law of the same name that was registered before is replaced.

    Raises
    ------
    ValueError
        A parameter of it is known already, with other bounds or another default.
    """
    laws, declared = LAWS | {law.name: law}, {}
    for one in laws.values():
        for name, own in one.parameters.items():
            earlier, names = declared.get(name, (own, ()))
            if own != earlier or (name in PARAMETERS and PARAMETERS[name].needed_by[0] != "micro"):
                raise ValueError(f"micro law {law.name}: the parameter {name} is known already, with other bounds")
            declared[name] = own, (*names, one.name)
    LAWS[law.name] = law
    for name, (own, names) in declared.items():
        PARAMETERS[name] = own._replace(needed_by=("micro", names))
    PARAMETERS["micro"] = PARAMETERS["micro"]._replace(choices=tuple(LAWS))
    return law


BUILT_IN = tuple(register(module.LAW) for module in (smooth, disc_cell, power_law))
