"""Shapes of indenters; each is a file. The protocol is in :mod:`.shape`.

docs/own_shape.md says how to add one.
"""

from types import MappingProxyType

import numpy as np

from . import blunt_cone, cone, flat, frustum, paraboloid, power, rounded_flat, sphere
from .shape import Kind, Shape, has_radius

__all__ = ["PARABOLOID", "ROUND", "SHAPES", "Kind", "Shape", "is_flat", "shape_of", "shaped"]

#: The shape of the paper: the default.
PARABOLOID = paraboloid.KIND.name


def shape_of(problem) -> Shape:
    """The :class:`~.shape.Shape` of the cases of a problem in units R = 1, all of which have the same `shape`."""
    kind = problem.known.shapes[str(problem.shape[0])]
    return kind.of(**{name: getattr(problem, name) for name in kind.parameters}, size=len(problem))


def shaped(problem):
    """(B,) bool: the cases of a problem whose shape is not the paraboloid."""
    return problem.shape != PARABOLOID


def is_flat(problem):
    """(B,) bool: the cases of a problem whose contact radius is that of the punch under any load."""
    flat_ones, others = np.zeros(len(problem), dtype=bool), shaped(problem)
    for word in np.unique(problem.shape[others]).tolist():
        index = np.flatnonzero(problem.shape == word)
        flat_ones[index] = has_radius(shape_of(problem.take(index)))
    return flat_ones


BUILT_IN = (
    *(paraboloid.KIND, sphere.KIND, cone.KIND, *cone.PYRAMIDS, power.KIND, frustum.KIND, blunt_cone.KIND, flat.KIND),
    rounded_flat.KIND,
)
#: The names of the shapes whose profile depends on the radius R.
ROUND = tuple(kind.name for kind in BUILT_IN if kind.round)
#: Name -> :class:`~.shape.Kind` of all shapes of this package.
SHAPES = MappingProxyType({kind.name: kind for kind in BUILT_IN})
