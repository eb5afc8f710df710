"""The work that one case may take, counted in what is done for it and not in seconds: the same on every machine.

Nearly all cases need a hundredth of it. Where it is spent, some seconds have gone into one case, and
`Status.BUDGET_SPENT` says that this, not the equation, was the end.
"""

import numpy as np

#: Successive approximations of a case at all radii but the last: a dozen radii to the limit of one, which is 1000.
APPROXIMATIONS = 12_000
#: Newton steps on a mesh of up to _NODES nodes, and the fewest; the finer the mesh, the longer a step takes. Of
#: random cases within the bounds of the parameters, those that searched for their radius took 230 at most.
_STEPS, _NODES, _FEWEST = 1000, 96, 60
#: Sum of (nodes)² over the meshes of panels of a case: entries of operators that are made for it alone.
PANELS = 1_500_000
#: What these cost on other bases than films, whose tables are dear.
_CHEAP = 0.2


def newton_steps(nodes):
    """Most Newton steps (...) of a case on a mesh of `nodes` (...)."""
    share = np.minimum(1.0, (_NODES / np.maximum(nodes, 1)) ** 2)
    return np.maximum(_FEWEST, (_STEPS * share).astype(int))


def panel_work(nodes, film):
    """What a mesh of panels counts towards PANELS."""
    return nodes**2 * (1.0 if film else _CHEAP)
