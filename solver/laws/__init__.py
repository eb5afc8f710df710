"""Micro laws, one a file. docs/extending.md says how to add one."""

from types import MappingProxyType
from weakref import WeakSet

from ..numerics.kept import shared_lock
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
    "name_in",
    "periodic_rows",
    "try_out",
    "untried",
]

#: Laws whose functions have been tried.
_TRIED: WeakSet[Law] = WeakSet()
_trying = shared_lock()


def untried(law):
    """Whether a law is somebody else's, and its functions have not been tried."""
    if not law.version or law.name.startswith(own_table.PREFIX):
        return False
    with _trying:
        return law not in _TRIED


def try_out(law, E, parameters):
    """Try the functions of a law that is :func:`untried` at some of its cases: see :func:`.trial.tried`.

    That takes a seventh of a millisecond, once a process. Without it a law with a wrong derivative gives a dP/dD that
    is 2 % off, as converged (tests/laws/test_trial.py).
    """
    if untried(law):
        trial.tried(law, E, parameters)
        with _trying:
            _TRIED.add(law)


def identity(law):
    """Text that tells a law from all others: its name, and its version if it has one."""
    return f"{law.name} {law.version}" if law.version else law.name


def name_in(identity):
    """The name in a text of :func:`identity`. The path of a table may have blanks, the version of another law too."""
    return identity.rpartition(" ")[0] if identity.startswith(own_table.PREFIX) else identity.partition(" ")[0]


BUILT_IN = (
    *(disc_cell.SMOOTH, disc_cell.LAW, power_law.LAW, lattice.SQUARE, lattice.HEX, heights.LAW, heights.UNIFORM_LAW),
    elastic_plastic.LAW,
)
#: Name -> Law of this package.
LAWS = MappingProxyType({law.name: law for law in BUILT_IN})
