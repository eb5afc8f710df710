"""Spreads of results, to first order, from their derivatives by the solver's inputs."""

import numpy as np

from ..inputs.definition import Definition
from ..inputs.scene.changes import SCALES, changes_by_spread
from ..inputs.scene.pieces import matrix
from ..inputs.scene.scene import over
from ..inputs.vocabulary import VOCABULARY
from .dataset import Parts


def spreads_of(definition: Definition, parts: Parts) -> dict[str, np.ndarray]:
    """Result -> its standard deviation, of its shape and in its unit: the root of Σ g_i C_ij g_j.

    g_i is the change of the result with an input of the scene by its spread, and C are the correlations of inputs.
    """
    scene, grid, names = definition.scene, definition.grid, definition.inputs
    changes, dims = changes_by_spread(scene, grid.fitted), tuple(grid.sizes)

    def columns(keys: tuple[str, ...]) -> np.ndarray:
        """The changes of the solver's inputs or the scales `keys`, (..., keys, inputs of the scene)."""
        parts = [over(own.get(key, 0.0), dims) for key in keys for own in changes.values()]
        stacked = np.stack(np.broadcast_arrays(*parts), axis=-1)
        return stacked.reshape(*stacked.shape[:-1], len(keys), len(changes))

    of_inputs, of_scales = columns(names), columns(SCALES)
    correlation = matrix(scene, dims) if scene.correlations else None
    found = {}
    for name in parts.by_input.keys() & parts.variables.keys():  # the control has the spread that was given
        own, count = parts.variables[name], len(names)
        values, by_input = own.values.reshape(*grid.shape, 1, -1), parts.by_input[name].reshape(*grid.shape, count, -1)
        of_unit = np.einsum("...si,s->...i", of_scales, VOCABULARY[name].powers[::-1])
        change = np.swapaxes(of_inputs, -1, -2) @ by_input + of_unit[..., None] * values
        other = change if correlation is None else correlation @ change
        variance = np.maximum((change * other).sum(axis=-2), 0.0)  # of inputs that cancel it may be a little below 0
        found[name] = np.sqrt(variance).reshape(own.shape).astype(own.dtype, copy=False)
    return found
