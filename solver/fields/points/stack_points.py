"""Stresses of one stack of layers at single points, of waves on one rule: docs/stresses.md, Extremes."""

from typing import NamedTuple

import numpy as np

from ...compiled.wave_sums import STATES
from ...kernels.transfer_stack import StackWaves
from .wave_points import END, FIRST, rules_of


class StackPoints(NamedTuple):
    """The waves of one stack, as :class:`~.wave_points.OctaveWaves`. A `kind` is the number of a region, from 0, and
    whether the state of a half-space of the first layer is left out.

    h : thickness of the first layer in a
    k : (K,), ascending; p : (K,), k times the transform of the pressure times the weight of k
    f : (1, K) of :mod:`.edge_waves`, of short waves next to the edge, or None: p is then without the transform
    loads : traction (S, T) -> :class:`~solver.kernels.transfer_stack.StackWaves`
    """

    h: float
    k: np.ndarray
    p: np.ndarray
    f: np.ndarray | None
    loads: dict[tuple, StackWaves]

    def reach(self, kind, case, z):
        """How far from the source waves are at depths z (P,)."""
        return 2 * self.h - z if kind[1] else z

    def poisson(self, kind, case):
        """Poisson ratio (1, 1) of the region."""
        return next(iter(self.loads.values())).nu[:, kind[0], None]

    def state(self, load, kind, case, z, end):
        """State (4 of (P, end)) there under the first waves, times p, and the antiplane pair."""
        waves, p = self.loads[load].up_to(end), self.p[:end]
        v = waves.state(kind[0], z[None], kind[1])[:, 0] * p
        if load[1] == 0:
            return v, 0.0, 0.0
        return v, *(waves.antiplane(kind[0], z[None], kind[1])[:, 0] * p)

    def constants(self, load, kind, case, z, end):
        """The states themselves for the compiled core, as :meth:`~.wave_points.OctaveWaves.constants`."""
        v, *pair = self.state(load, kind, case, z, end)
        states = np.concatenate([v, pair]) if load[1] else v
        return {"kind": STATES, "size": 1}, {"states": states}


def stack_points(stack, h, pressure, radius, least, tractions):
    """:class:`StackPoints` that reach radii up to `radius` and are felt at depths from `least` h on: those that are
    felt everywhere, and the short ones next to the edge, None if there are none.

    stack : :class:`~solver.kernels.stack.Stack` of one case; h : (1,), thickness of its first layer in a
    pressure : :class:`~..pressure.Pressure` of one case
    """
    octave = 2.0 ** np.floor(np.log2(h[0]))
    rules = rules_of(pressure, FIRST / stack.longest(h), END / (least * octave), radius)
    return [rule and _points(stack, h, *rule, tractions) for rule in rules]


def _points(stack, h, k, p, f, tractions):
    return StackPoints(h[0], k, p[0], f, {load: stack.waves(k, h, load) for load in tractions})
