"""What lies under the punch, one body a file, by its name; the protocol is in :mod:`.operator`."""

from .half_space import half_space
from .layered import Layered
from .springs import thin_layer

#: Name -> body of (h, n, nu1, nu2, bonded, m), (B,) each, in units R = E2* = 1.
BODIES = {"half_space": half_space, "thin_layer": thin_layer, "layered": Layered}
