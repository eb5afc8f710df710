"""Tables of smooth contacts of one pair of bodies over h/a, which serve all contacts of the pair: of an octave of h/a
the stresses on the coarse grid and the loads, and at single nodes the stress itself. Each is kept when it was made."""

from typing import NamedTuple

import numpy as np

from ...numerics.caches import Cache
from ...problem import Problem
from .unit_contacts import Sought, unit_contacts

#: Nodes of an octave of h/a: a step between two is below the largest that is allowed near a strength.
EACH = 8
#: Bytes of tables that are kept: some ten thousand octaves.
_cache = Cache(2_000_000)
#: What of a case makes its stress over a/R at one h/a.
_OF_PAIR = ("n", "nu1", "nu2", "m", "bonding")


def thickness(node):
    """ln(h/a) at nodes, whole numbers or others between them; it falls with the node. Nodes 8 i to 8 i + 7 are in one
    octave of h/a."""
    return -(np.asarray(node) + 0.5) * (np.log(2) / EACH)


def node_at(log_t):
    """The inverse of :func:`thickness`, not whole."""
    return -np.asarray(log_t) * (EACH / np.log(2)) - 0.5


class Logs(NamedTuple):
    """ln of the stress and of the load of contacts at a = R, of any one shape."""

    mises: np.ndarray
    P: np.ndarray


class StressTable(NamedTuple):
    """The stresses of B cases for which :func:`~.unit_contacts.are_similar`.

    scaled : the cases, in units R = E2* = 1; neither the control nor h counts
    sought : :class:`~.unit_contacts.Sought`
    punch : (B,), Poisson ratios of the punches; nothing where these are not looked at
    """

    scaled: Problem
    sought: Sought
    punch: np.ndarray

    def at(self, index, log_t, coarse=False):
        """:class:`~.unit_contacts.UnitContacts` of the cases `index` at ln(h/a) (b,), which are not kept."""
        part = self.scaled.take(index)
        return unit_contacts(part, np.exp(log_t), self.sought, self.punch[index], coarse)

    def octaves(self, index, number):
        """:class:`Logs` (b, EACH) of the cases `index` at the nodes of octaves, from the node EACH times `number` (b,)
        on; the stress is that of the coarse grid."""

        def make(rows):
            nodes = EACH * number[rows, None] + np.arange(EACH)
            contacts = self.at(np.repeat(index[rows], EACH), thickness(nodes).ravel(), coarse=True)
            return np.log(np.stack([contacts.mises, contacts.P], axis=1)).reshape(-1, EACH, 2)

        return Logs(*np.moveaxis(self._looked_up("octave", index, number, make), -1, 0))

    def nodes(self, index, node):
        """:class:`Logs` (b,) of the cases `index` at `node` (b,), whole numbers."""

        def make(rows):
            contacts = self.at(index[rows], thickness(node[rows]))
            return np.log(np.stack([contacts.mises, contacts.P], axis=1))

        return Logs(*np.moveaxis(self._looked_up("node", index, node, make), -1, 0))

    def _looked_up(self, kind, index, number, make):
        """The kept values (b, ...); those that are not kept are made together, at the rows that first ask for them."""
        of_pair = [getattr(self.scaled, name)[index].tolist() for name in _OF_PAIR]
        pairs = zip(number.tolist(), self.punch[index].tolist(), *of_pair, strict=True)
        keys = [(kind, self.sought, *pair) for pair in pairs]
        values = {key: _cache.find(key) for key in keys}
        rows = {}
        for row, key in enumerate(keys):
            if values[key] is None:
                rows.setdefault(key, row)
        if rows:
            columns = make(np.array([*rows.values()]))
            values |= {key: _cache.get(key, value.copy) for key, value in zip(rows, columns, strict=True)}
        return np.array([values[key] for key in keys])
