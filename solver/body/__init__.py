"""The bodies under the punch, by name; each is a file. The protocol is in :mod:`.operator`."""

from ..kernels.two_layers import TwoLayers
from .half_space import half_space, thin_layer
from .hankel import Hankel
from .stacked import stack, thin_stack

#: Name -> ``body(problem)``: the body of the cases of a :class:`~solver.problem.Problem` in units R = E2* = 1.
BODIES = {
    "half_space": lambda problem: half_space(problem.m),
    "thin_layer": lambda problem: thin_layer(problem.h, TwoLayers.of(problem), problem.m),
    "layered": lambda problem: Hankel(TwoLayers.of(problem), problem.h, problem.m),
    "stack": stack,
    "thin_stack": thin_stack,
}
