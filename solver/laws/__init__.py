"""Micro laws, one a file, and the registry of them. docs/extending.md says how to add one."""

import re
from functools import cache
from weakref import WeakSet

import numpy as np

from ..parameters import CONTROL, COUPLED, LAYERED, PARAMETERS, Register
from . import disc_cell, elastic_plastic, heights, lattice, own_table, power_law, trial
from .cell.axis import cell_axis
from .cell.periodic import periodic_rows
from .cell.rows import cell_rows
from .law import Bound, Curve, Law, Spots

__all__ = [
    "LAWS",
    "Bound",
    "Curve",
    "Law",
    "Spots",
    "cell_axis",
    "cell_rows",
    "identity",
    "load",
    "name_in",
    "named",
    "periodic_rows",
    "register",
    "try_out",
    "untried",
]

#: Entry points of this group are laws of installed packages.
GROUP = "roughcoat.laws"
#: Names that no parameter of a law can have: the attributes of a Problem, and E and nu, which `scales` gets. The
#: package `study` adds results and its other inputs.
_OF_PROBLEM = (
    *("control", "value", "parameters", "of", "take", "but", "rough", "invalid", "may_pull", "without_scheme"),
    *("can_feel", "feels_layer"),
)
RESERVED = {*CONTROL, *_OF_PROBLEM, "E", "nu"}
#: Laws whose functions have been tried.
_TRIED: WeakSet[Law] = WeakSet()


def register(law: Law) -> Law:
    """Make a law known by its name, in place of one registered before, and its parameters like any other.

    To travel to worker processes with the cases, its functions must have a name in a module that can be imported there.

    Parameters
    ----------
    law : :class:`Law`

    Returns
    -------
    Law : the same

    Raises
    ------
    ValueError : the name is not allowed, or is that of a law of this package; there is no version; a parameter is
        declared wrongly, or has the name of something else, or of one of another law with other bounds

    Examples
    --------
    docs/extending.md has a law in one file.
    """
    if LAWS.get(law.name) is law:
        return law
    if LAWS.get(law.name, law) in BUILT_IN or not re.fullmatch(rf"[A-Za-z]\w*|{own_table.PREFIX}.+", law.name):
        raise ValueError(f'micro law "{law.name}": must have a name of its own, of letters, digits and _')
    if not (law.version and isinstance(law.version, str)):
        raise ValueError(f"micro law {law.name}: version must be a text, which changes whenever its numbers may")
    if wrong := trial.declaration(law):
        raise ValueError(f"micro law {law.name}: {wrong}")
    with LAWS.lock:
        _declare(LAWS | {law.name: law})
        LAWS[law.name] = law
    return law


def untried(law):
    """Whether a law is somebody else's, and its functions have not been tried."""
    return bool(law.version) and not law.name.startswith(own_table.PREFIX) and law not in _TRIED


def try_out(law, E, parameters):
    """Try the functions of a law that is :func:`untried` at some of its cases: see :func:`.trial.tried`.

    That takes a seventh of a millisecond, once a process. Without it a law with a wrong derivative gives a dP/dD that
    is 2 % off, as converged (tests/laws/test_trial.py).
    """
    if untried(law):
        trial.tried(law, E, parameters)
        _TRIED.add(law)


def _declare(laws):
    """Put the parameters of `laws` (name -> Law), which are returned, into the table of parameters, and their names
    into the choices of `micro`. Raises ValueError, and changes nothing, where a parameter cannot have its name."""
    declared = {}
    for law in laws.values():
        for name, own in law.parameters.items():
            known, names = declared.get(name, (own, ()))
            if name in RESERVED or name in PARAMETERS and PARAMETERS[name].needed_by[0] != "micro":
                raise ValueError(f"micro law {law.name}: the name of the parameter {name} is that of something else")
            if own != known:
                reason = f"another interval, default, unit or words than that of {names[0]}: give it another name"
                raise ValueError(f"micro law {law.name}: the parameter {name} has {reason}")
            declared[name] = known, (*names, law.name)
    for name in [name for name, own in PARAMETERS.items() if own.needed_by[0] == "micro" and name not in declared]:
        PARAMETERS.pop(name, None)  # of a law that has been replaced
    PARAMETERS.update({name: own._replace(needed_by=("micro", names)) for name, (own, names) in declared.items()})
    PARAMETERS["micro"] = PARAMETERS["micro"]._replace(choices=tuple(laws))
    of_laws = "micro", tuple(law.name for law in laws.values() if law.on_body)
    PARAMETERS["asperities_on"] = PARAMETERS["asperities_on"]._replace(used_by=of_laws)
    of_laws = "micro", tuple(law.name for law in laws.values() if law.poisson)
    PARAMETERS["nu1"] = PARAMETERS["nu1"]._replace(used_by=(*COUPLED, *of_laws))
    PARAMETERS["nu2"] = PARAMETERS["nu2"]._replace(needed_by=(*LAYERED, *of_laws), used_by=(*COUPLED, *of_laws))
    return laws


def load(parameters, micro):
    """Register the laws of installed packages, if some of the `parameters` (names), or of the words of `micro` (one, or
    an array), is not known. A law of the same name that the program has registered stays.

    Raises ValueError where it is still not known, and a law of an entry point cannot be had.
    """
    if not _known(parameters, micro) and (wrong := _load_installed()) and not _known(parameters, micro):
        raise ValueError("\n".join(wrong))


@cache
def _load_installed():
    """Register the laws of all entry points, each a :class:`Law` or a list of them; texts of what is wrong."""
    from importlib.metadata import entry_points  # takes a while, and most studies have no need of it

    wrong, places, present = [], {}, set(LAWS)
    for entry in entry_points(group=GROUP):
        where = f"entry point {entry.name} = {entry.value} of {GROUP}"
        try:
            with trial.going_on():
                laws = entry.load()
            for law in laws if isinstance(laws, (list, tuple)) else [laws]:
                places.setdefault(law.name, {}).setdefault(law, where)
        except MemoryError:
            raise
        except Exception as error:
            wrong.append(f"{where}: {error}")
    for name, laws in places.items():
        if len(laws) > 1:
            wrong.append(f"{' and '.join(laws.values())} have laws of one name, {name}: one must go")
        elif name not in present:
            ((law, where),) = laws.items()
            try:
                register(law)
            except ValueError as error:
                wrong.append(f"{where}: {error}")
    return wrong


def named(law):
    """The name of a law, or the names of a list of laws. A law that comes as an object, or as "table:" and the path of
    a table of one's own (ValueError if it cannot be used), is registered first."""
    if isinstance(law, (list, tuple)):
        return [named(each) for each in law]
    if isinstance(law, str) and law.startswith(own_table.PREFIX):
        law = own_table.read(law)
    return register(law).name if isinstance(law, Law) else law


def _known(parameters, micro):
    """Whether all `parameters` (names) and all words of `micro` (one, or an array) are known."""
    return set(parameters) <= set(PARAMETERS) and set(np.ravel(micro).tolist()) <= set(LAWS)


def identity(name):
    """Text that tells the law of this name from all others: its name, and its version if it has one."""
    law = LAWS.get(name)
    return f"{name} {law.version}" if law and law.version else name


def name_in(identity):
    """The name in a text of :func:`identity`. The path of a table may have blanks, the version of another law too."""
    return identity.rpartition(" ")[0] if identity.startswith(own_table.PREFIX) else identity.partition(" ")[0]


BUILT_IN = (
    *(disc_cell.SMOOTH, disc_cell.LAW, power_law.LAW, lattice.SQUARE, lattice.HEX, heights.LAW, heights.UNIFORM_LAW),
    elastic_plastic.LAW,
)
#: Name -> Law.
LAWS = Register(_declare({law.name: law for law in BUILT_IN}))
