"""Correlations of the spreads of inputs: of bodies that are one piece of material, and by the user."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np

from ...arrays import xarray_later as xr
from ...terminal import shown
from ..vocabulary import BODIES, bodies_of, finite
from .scene import Scene, over

_RIGID = "rigid"  # the name of what has no modulus
#: A matrix of correlations has eigenvalues >= 0; those of one with a correlation of 1 are 0 but for rounding.
_ROUNDING = 1e-9
FORM = 'must be a number from -1 to 1 for each pair of inputs, such as {("E1", "E2"): 0.5}'


def alike(names: dict, body: str, other_body: str) -> Any:
    """Where two bodies are of one material: a bool, or a DataArray over the dimensions of their names.

    names : as those of a Scene
    """
    if body not in names or other_body not in names:
        return False
    first, second = (_labelled(*names[name]) for name in (body, other_body))
    same = (first == second) & (first != _RIGID)
    return same if same.any() and not same.all() else bool(same.all())


def none_alike(names: dict) -> bool:
    """Whether no case has two bodies of one material."""
    return not any(np.any(alike(names, *pair)) for pair in combinations(bodies_of(names), 2))


def of_one_piece(scene: Scene) -> dict[tuple[str, str], Any]:
    """The correlations of bodies that are one piece: their moduli are too high or too low together, and so
    are their Poisson ratios."""
    correlations = {}
    for body, other_body in combinations(bodies_of(scene.names), 2):
        same = alike(scene.names, body, other_body)
        for pair in zip(BODIES[body][:2], BODIES[other_body][:2], strict=True):
            if {*pair} <= {*scene.spreads} and np.any(same):
                correlations[pair] = 1.0 * same
    return correlations


def correlate(scene: Scene, pairs: Any, errors: list[str]) -> None:
    """Give the scene its correlations. Mistakes in the `pairs` that the user gives become messages."""
    scene.correlations = correlations = of_one_piece(scene) if scene.same_piece else {}
    if not isinstance(pairs, dict) or not all(isinstance(pair, tuple) and len(pair) == 2 for pair in pairs):
        errors.append(f"correlations = {shown(pairs)}: {FORM}")
        return
    for pair, value in pairs.items():
        without = [name for name in pair if name not in scene.spreads]
        called = f"correlations: {' and '.join(map(str, pair))}"
        if without:
            errors.append(f"{called}: {without[0]} has no spread; {', '.join(scene.spreads) or 'no input'} has one")
        elif pair[0] == pair[1] or pair in correlations or pair[::-1] in correlations:
            errors.append(f"{called}: " + ("are one input" if pair[0] == pair[1] else "have a correlation already"))
        elif not finite(value) or not -1 <= value <= 1:
            errors.append(f"{called} = {shown(value)}: must be a number from -1 to 1")
        else:
            correlations[pair] = float(value)
    dims = tuple({dim for value in correlations.values() for dim in getattr(value, "dims", ())})
    if pairs and not errors and np.linalg.eigvalsh(matrix(scene, dims)).min() < -_ROUNDING:
        errors.append("correlations: these cannot all hold: their matrix has a negative eigenvalue")


def matrix(scene: Scene, dims: tuple[str, ...]) -> np.ndarray:
    """The correlations of the k inputs with spreads, (..., k, k) over the dimensions `dims`."""
    names = list(scene.spreads)
    parts = [over(value, dims) for value in scene.correlations.values()]
    shape = np.broadcast_shapes((1,) * len(dims), *(part.shape for part in parts))
    array = np.broadcast_to(np.eye(len(names)), (*shape, len(names), len(names))).copy()
    for (first, second), part in zip(scene.correlations, parts, strict=True):
        i, j = names.index(first), names.index(second)
        array[..., i, j] = array[..., j, i] = part
    return array


def _labelled(dim: str, texts: list[str]) -> xr.DataArray:
    return xr.DataArray(texts, dims=dim) if dim else xr.DataArray(texts[0])
