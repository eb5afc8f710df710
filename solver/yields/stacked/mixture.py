"""The largest stresses of a batch in which some contacts are on stacks of layers and some are not."""

import numpy as np

from ..contact import of_contacts as of_one_layer
from .largest import DIMENSION, EXTREMES
from .largest import of_contacts as of_stacks

#: Of a stack of one layer the names of one layer -> the same over layers.
OF_ONE_LAYER = {"mises1": "mises_layer", "tresca1": "tresca_layer", "sr_interface1": "sr_interface"}


def of_mixture(problem, solution, mu=0.0, residual=0.0):
    """Extremes by the names of :data:`~.largest.EXTREMES`, (3, B, N) or (3, B): those of stacks, and of contacts on one
    layer or none what no layer has. Of stacks of one layer by the names of one layer too.

    problem, solution : B cases, whose parameters are those of stacks, and their
        :class:`~solver.solution.Solution`
    mu : >= 0, friction; residual : (B, N) or a number, biaxial stress of each layer, in the unit of E2
    """
    values = of_stacks(problem, solution, mu, residual)
    alone = [name for name, (_, place) in EXTREMES.items() if not DIMENSION[place]]
    first = residual[:, 0] if np.ndim(residual) else residual
    if values["mises_layer"].shape[2] == 1:
        values |= {name: values[same][..., 0] for name, same in OF_ONE_LAYER.items()}
        alone += OF_ONE_LAYER
    others = of_one_layer(problem, solution, mu, first, tuple(alone))
    return values | {name: np.where(np.isnan(values[name][0]), others[name], values[name]) for name in alone}
