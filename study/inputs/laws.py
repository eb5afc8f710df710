"""Micro laws that users register with the solver, and how their parameters become part of the vocabulary."""

from contextlib import suppress

from solver import laws
from solver.laws.own_table import PREFIX
from solver.parameters import PARAMETERS as SOLVER_PARAMETERS

from .vocabulary import PARAMETERS, VOCABULARY, Entry, names

# A law must not call a parameter like a result, or like what `study.solve` is told beside parameters.
laws.RESERVED.update({*VOCABULARY, "cases", "profiles", "title", "workers"} - set(SOLVER_PARAMETERS))
laws.RESERVED.update(f"{name}_spread" for name in VOCABULARY)


def update_vocabulary() -> None:
    """Make PARAMETERS and VOCABULARY fit the micro laws that are registered now."""
    own = names("control", "material", "roughness", "numerics")
    for name in set(PARAMETERS) - set(own):  # their laws may have been replaced
        del VOCABULARY[name]
    PARAMETERS[:] = own
    for name, declared in [parameter for law in laws.LAWS.values() for parameter in law.parameters.items()]:
        if name not in PARAMETERS:
            owners = " and ".join(SOLVER_PARAMETERS[name].needed_by[1])
            words = declared.long_name or f"parameter of the micro law {owners}"
            VOCABULARY[name] = Entry(name, "roughness", words, declared.symbol or name, declared.powers)
            PARAMETERS.append(name)


def law_names(given: list) -> list:
    """The values of `micro` as names. A law given as an object is registered under its name.

    If a name is not known, the laws of installed packages are loaded. Raises ValueError for a law that cannot be used.
    """
    found = laws.named(given)
    laws.load((), [word for word in found if isinstance(word, str)])
    update_vocabulary()
    return found


def recall(versions: str) -> None:
    """Register laws of results, a line "NAME VERSION" for each, that are not known but installed.

    A table of one's own is not read: whoever sends a results file must not choose which files are opened.
    """
    for line in versions.splitlines():
        if (name := laws.name_in(line)) not in laws.LAWS and not name.startswith(PREFIX):
            with suppress(ValueError):  # then it stays unknown
                law_names([name])


def is_parameter(name: str) -> bool:
    """Whether a name is that of a parameter. If it is not known, the laws of installed packages are loaded first."""
    if name not in PARAMETERS:
        with suppress(ValueError):  # a law that cannot be loaded is an error when `micro` names it
            laws.load([name], ())
        update_vocabulary()
    return name in PARAMETERS


def smooth_laws() -> list[str]:
    """Names of the laws without asperities."""
    return [name for name, law in laws.LAWS.items() if not law.rough]
