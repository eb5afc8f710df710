"""One contact on a stack as asperities see it: the stresses of the whole contact near the surface."""

from typing import NamedTuple

import numpy as np

from ...fields.stacks.section import Section


class UpperLayer(NamedTuple):
    """What :class:`~..loaded.Loaded` is of one layer, of one contact on a stack.

    section : :class:`~...fields.stacks.section.Section`
    """

    section: Section

    @property
    def pressure(self):
        return self.section.pressure

    @property
    def h(self):
        """(1,), thickness in a of the first layer that is given."""
        return self.section.ends[:1]

    @property
    def bare(self):
        return False

    @property
    def mu(self):
        return self.section.mu

    @property
    def signs(self):
        return self.section.signs

    @property
    def layers(self):
        return self.section.stack

    def take(self, index):
        """Itself: there is one case."""
        return self

    def stresses(self, r, z, body, roughly=False):
        """sr, st, sz, trz (4, 1, S, Z, R), as of :class:`~..loaded.Loaded`: at depths z (1, Z) or (Z,) in whichever
        layer is there, or in the `body`."""
        z = np.asarray(z).reshape(-1)
        number = np.full(len(z), len(self.section.ends)) if body else self.section.numbers(z)
        return self.section.stresses(r, z, number, roughly)[:, None]
