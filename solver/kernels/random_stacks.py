"""Random stacks, by which the few nodes of kernels of :mod:`.stack` are chosen (:class:`~.kernel.Sampler`)."""

import numpy as np

from .kernel import Sampler
from .stack import Stack

#: Number of layers of a random stack. Neighbours may be equal, and so act as one layer. Deeper stacks have waves of the
#: same kinds.
_LAYERS = 3
#: Number of stacks that are drawn. From them those nearest to the wanted stiffness are taken.
_POOL = 4000
#: Share of cases that are softer than their class, so that the nodes also serve stacks whose class was chosen too high.
_SOFTER = 0.25


def random_stacks(random, stiffness):
    """:class:`~.stack.Stack` of S random cases of about the `stiffness` (S,); some are softer. Moduli, thicknesses and
    springs have all sizes that this allows. One interface in four is frictionless, one base in five is rigid."""
    wanted = np.where(random.random(len(stiffness)) < _SOFTER, stiffness ** random.random(len(stiffness)), stiffness)
    most, size = max(3.0, 2 * stiffness.max()), (_POOL, _LAYERS)
    contrast, thickness = (random.random((_POOL, 1)) * np.log(v) for v in (most, min(most, 1e4)))
    n, h = np.exp(random.uniform(-1, 1, size) * contrast), np.exp(random.uniform(-0.7, 1, size) * thickness)
    nu = np.where(random.random(size) < 0.8, random.uniform(0, 0.5, size), random.uniform(-1, 0, size))
    nu = np.where(random.random(size) < 0.1, 0.5, nu)
    h[:, 0] = 1.0
    for j in range(1, _LAYERS):
        for v in (n, nu):
            v[:, j] = np.where(random.random(_POOL) < 0.25, v[:, j - 1], v[:, j])
    springs = random.random(size) < 0.2
    cn = np.where(springs & (random.random(size) < 0.6), np.exp(random.uniform(-3, 1, size) * np.log(most)), 0.0)
    ct = np.where(springs, np.exp(random.uniform(-3, 3, size) * np.log(most)), 0.0)
    rigid = random.random(_POOL) < 0.2
    n = np.where(rigid[:, None], n / n[:, :1], n)
    stacks = Stack(n, nu, h, random.random(size) < 0.25, cn, ct, random.uniform(-0.2, 0.5, _POOL), rigid)
    order = np.argsort(stacks.stiffness)
    place = np.searchsorted(stacks.stiffness[order], wanted) + random.integers(-5, 6, len(wanted))
    return stacks.take(order[np.clip(place, 0, _POOL - 1)])


#: tests/kernels/test_stack.py (test_few_nodes_determine_a_stack) measures the error with these numbers of nodes.
SAMPLER = Sampler(random_stacks, (52, 120, 240, 360, 0, 88), (200, 300, 600, 600, 0, 300), mild=30.0)
