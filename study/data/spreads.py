"""Spreads of results, to first order, from their derivatives by the solver's inputs."""

import numpy as np

from ..inputs.definition import Definition
from ..inputs.scene.changes import SCALES, of_spreads
from ..inputs.scene.pieces import matrix
from ..inputs.scene.scene import over
from ..inputs.vocabulary import VOCABULARY
from .dataset import Parts


def spreads_of(definition: Definition, parts: Parts) -> dict[str, np.ndarray]:
    """Result -> its standard deviation, of its shape and in its unit: the root of Σ g_i C_ij g_j.

    g_i is the change of the result with an input of the scene by its spread, and C are the correlations of inputs.
    """
    scene, grid, names = definition.scene, definition.grid, definition.inputs
    changes, dims = of_spreads(scene, grid.fitted), tuple(grid.sizes)

    def columns(keys: tuple[str, ...]) -> np.ndarray:
        """The changes of the solver's inputs or the scales `keys`, (..., keys, inputs of the scene)."""
        parts = [over(own.get(key, 0.0), dims) for key in keys for own in changes.values()]
        stacked = np.stack(np.broadcast_arrays(*parts), axis=-1)
        return stacked.reshape(*stacked.shape[:-1], len(keys), len(changes))

    of_inputs, of_scales = columns(names), columns(SCALES)
    correlation = matrix(scene, dims) if scene.correlations else None
    found = {}
    for name in parts.by_input.keys() & parts.variables.keys():  # the control has the spread that was given
        values, by_input, powers = parts.variables[name].values, parts.by_input[name], VOCABULARY[name].powers
        values, by_input = (
            array.reshape(*grid.shape, count, -1) for array, count in ((values, 1), (by_input, len(names)))
        )
        change = np.swapaxes(of_inputs, -1, -2) @ by_input
        change = change + values * np.einsum("...si,s->...i", of_scales, powers[::-1])[..., None]
        other = change if correlation is None else correlation @ change
        # of inputs that cancel the sum may be a little below 0
        found[name] = np.sqrt(np.maximum((change * other).sum(axis=-2), 0.0)).reshape(parts.variables[name].shape)
    return found
