"""The kernel and the body of a problem's stack of layers, exact and as a thin layer."""

import numpy as np

from ..kernels.random_stacks import SAMPLER
from ..kernels.stack import Stack
from ..kernels.two_layers import layer_modulus
from ..layers import full_name, numbers_of
from .graded import refined
from .half_space import thin_layer
from .hankel import Hankel

#: Stacks of more layers than this have waves of many lengths, and their kernel is evaluated at all nodes.
_FEW = 8


def layers_of(problem):
    """The numbers and words of the layers: key of :data:`~..layers.LAYER` -> (B, N), from the first layer down. On a
    rigid base, n = 0, moduli are in E1*."""
    numbers = range(1, max(1, numbers_of(problem.parameters)) + 1)
    names = ("h", "n", "nu", "bonding", "cn", "ct", "profile", "n_bottom", "nu_bottom")
    layers = {name: np.stack([getattr(problem, full_name(i, name)) for i in numbers], axis=1) for name in names}
    return layers | {"n": np.hstack([layer_modulus(layers["n"][:, :1]), layers["n"][:, 1:]])}


def kernel_of(problem, **octaves):
    """The :class:`~..kernels.stack.Stack` of the cases, and the thickness (B,) of its first layer in R. A graded layer
    is cut into uniform ones, `sublayers` in each octave. `octaves` : see :func:`.graded.refined`."""
    layers = refined(layers_of(problem), problem.sublayers, problem.known.profiles, **octaves)
    h, unit = layers["h"], layers["n"][:, :1] / layers["h"][:, :1]
    slips = layers["bonding"] == "frictionless"
    arrays = layers["n"], layers["nu"], h / h[:, :1], slips, layers["cn"] * unit, layers["ct"] * unit
    sampler = SAMPLER if h.shape[1] <= _FEW else None
    return Stack(*arrays, problem.nu2, problem.n == 0, sampler), h[:, 0]


def stack(problem, **octaves):
    """The exact body. Its m = E1*/E3* has the modulus at the surface, which in a graded layer is that of the first
    sublayer. `octaves` : as in :func:`kernel_of`."""
    kernel, h = kernel_of(problem, **octaves)
    return Hankel(kernel, h, problem.m * (kernel.E1 / layer_modulus(problem.n)))


def thin_stack(problem):
    """A half-space that carries springs: its kernel is L(0) + u dL/du, with dL/du at u = 0."""
    kernel, h = kernel_of(problem)
    return thin_layer(h, kernel, problem.m * (kernel.E1 / layer_modulus(problem.n)))
