"""The stresses of one whole contact on a stack near its surface, to which those of asperities are added."""

from typing import NamedTuple

import numpy as np

from ...fields.stacks.section import Section


class UpperLayer(NamedTuple):
    """One contact on a stack, with the attributes that :class:`~..loaded.Loaded` has for bodies of one layer.

    section : :class:`~...fields.stacks.section.Section`
    """

    section: Section

    @property
    def pressure(self):
        return self.section.pressure

    @property
    def h(self):
        """(1,), thickness of the first given layer, in a."""
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
        """Itself, because there is only one case."""
        return self

    def stresses(self, r, z, body, roughly=False):
        """sr, st, sz, trz (4, 1, S, Z, R), as :meth:`~..loaded.Loaded.stresses` returns them, at depths z (1, Z) or
        (Z,): in the layer that contains the depth, or in the body if `body`."""
        z = np.asarray(z).reshape(-1)
        number = np.full(len(z), len(self.section.ends)) if body else self.section.numbers(z)
        return self.section.stresses(r, z, number, roughly)[:, None]
