"""Micro laws of others: how what is registered with the solver becomes part of the vocabulary."""

from contextlib import suppress

from solver import laws
from solver.parameters import PARAMETERS as OF_THE_SOLVER

from .vocabulary import PARAMETERS, VOCABULARY, Entry, names

laws.RESERVED.update(set(VOCABULARY) - set(OF_THE_SOLVER))


def learn() -> None:
    """Take up the micro laws that have been registered since the last time: their names and their parameters."""
    own = names("control", "material", "roughness", "numerics")
    for name in set(PARAMETERS) - set(own):  # of laws that may have been replaced
        del VOCABULARY[name]
    PARAMETERS[:] = own
    for name, told in [parameter for law in laws.LAWS.values() for parameter in law.parameters.items()]:
        if name not in PARAMETERS:
            words = told.long_name or f"parameter of the micro law {' and '.join(OF_THE_SOLVER[name].needed_by[1])}"
            VOCABULARY[name] = Entry(name, told.symbol or name, words, "roughness", told.powers)
            PARAMETERS.append(name)


def law_names(given: list) -> list:
    """What stands for `micro`, with names in place of laws given as objects, which become known by them; and a law that
    is not known is looked for among those of installed packages. Raises ValueError for a law that cannot be used."""
    found = laws.named(given)
    if not laws.known((), [word for word in found if isinstance(word, str)]):
        laws.load()
    learn()
    return found


def is_parameter(name: str) -> bool:
    """Whether a name is that of a parameter, if need be of a law of an installed package."""
    if name not in PARAMETERS:
        with suppress(ValueError):  # one that cannot be loaded is told of where `micro` names it
            laws.load()
        learn()
    return name in PARAMETERS


def smooth_laws() -> list[str]:
    """Names of the laws without asperities."""
    return [name for name, law in laws.LAWS.items() if not law.rough]
