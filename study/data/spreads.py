"""Spreads of results, to first order, from their derivatives by the solver's inputs."""

import numpy as np

from ..inputs.definition import Definition
from ..inputs.scene.bodies import matrix
from ..inputs.scene.changes import SCALES, changes_by_spread
from ..inputs.scene.scene import over
from ..inputs.vocabulary import VOCABULARY
from .dataset import DatasetParts


def spreads_of(definition: Definition, parts: DatasetParts) -> dict[str, np.ndarray]:
    """Result -> its standard deviation, of its shape and in its unit: the root of Σ g_i C_ij g_j.

    g_i is the change of the result when input i of the scene changes by its spread; C are the correlations of inputs.
    """
    scene, grid, names = definition.scene, definition.grid, definition.inputs
    changes, dims = changes_by_spread(scene, grid.fitted), tuple(grid.sizes)

    def columns(keys: tuple[str, ...]) -> np.ndarray:
        """The changes of the solver's inputs or the scales `keys`, (..., keys, inputs of the scene)."""
        parts = [over(change_of_input.get(key, 0.0), dims) for key in keys for change_of_input in changes.values()]
        stacked = np.stack(np.broadcast_arrays(*parts), axis=-1)
        return stacked.reshape(*stacked.shape[:-1], len(keys), len(changes))

    by_inputs, by_scales = columns(names), columns(SCALES)
    correlation = matrix(scene, dims) if scene.correlations else None
    spreads = {}
    for name in parts.by_input.keys() & parts.variables.keys():  # not the control, whose spread is an input
        result, count = parts.variables[name], len(names)
        values = result.values.reshape(*grid.shape, 1, -1)
        by_input = parts.by_input[name].reshape(*grid.shape, count, -1)
        by_unit = np.einsum("...si,s->...i", by_scales, VOCABULARY[name].powers[::-1])
        with np.errstate(invalid="ignore"):  # p may be infinite at an edge: its spread is NaN
            change = np.swapaxes(by_inputs, -1, -2) @ by_input + by_unit[..., None] * values
        other = change if correlation is None else correlation @ change
        variance = np.maximum((change * other).sum(axis=-2), 0.0)  # rounding makes it negative where inputs cancel
        spreads[name] = np.sqrt(variance).reshape(result.shape).astype(result.dtype, copy=False)
    return spreads
