"""The free edge: there is no pressure at r = a, and nothing is added to q."""

from typing import NamedTuple


class Free(NamedTuple):
    """The :class:`~solver.edges.edge.Edge` of all cases: it has no numbers."""

    pulls = False

    def take(self, index):
        return self

    def at(self, body, a, mesh, near=None):
        return body.at(a, mesh, near)

    def load(self, a):
        return 0.0, 0.0

    def pressure(self, a, s):
        return 0.0


FREE = Free()
