"""The micro laws; each is a file. docs/own_law.md says how to add one."""

from types import MappingProxyType

from . import disc_cell, elastic_plastic, heights, lattice, own_table, power_law
from .cell.axis import cell_axis
from .cell.periodic import periodic_rows
from .cell.rows import cell_rows
from .law import Bound, Curve, Law, Spots
from .trial import try_out, untried

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


def identity(law):
    """Text that tells a law from all others: its name, and its version if it has one."""
    return f"{law.name} {law.version}" if law.version else law.name


def name_in(identity):
    """The name in a text of :func:`identity`. The path of a table may contain blanks, and so may the version of any
    other law."""
    return identity.rpartition(" ")[0] if identity.startswith(own_table.OF_FILES) else identity.partition(" ")[0]


BUILT_IN = (
    *(disc_cell.SMOOTH, disc_cell.LAW, power_law.LAW, lattice.SQUARE, lattice.HEX, heights.LAW, heights.UNIFORM_LAW),
    elastic_plastic.LAW,
)
#: Name -> Law, for the laws of this package.
LAWS = MappingProxyType({law.name: law for law in BUILT_IN})
