"""Shapes of indenters, one a file; the protocol is in :mod:`.shape`.

docs/extending.md says how to add one.
"""

from types import MappingProxyType

from . import blunt_cone, cone, flat, frustum, power, rounded_flat, sphere
from .shape import Kind, Shape

__all__ = ["PARABOLOID", "SHAPES", "Kind", "Shape", "shape_of", "shaped"]

#: The shape of the paper, which stands in :mod:`..punches.paraboloid` as well: the default.
PARABOLOID = "paraboloid"


def shape_of(problem) -> Shape:
    """The :class:`~.shape.Shape` of the cases of a problem in units R = 1, which have one `shape`, no paraboloid."""
    kind = problem.known.shapes[str(problem.shape[0])]
    return kind.of(**{name: getattr(problem, name) for name in kind.parameters}, size=len(problem))


def shaped(problem):
    """(B,) bool: the cases of a problem that have another shape than the paraboloid."""
    return problem.shape != PARABOLOID


BUILT_IN = (
    *(sphere.KIND, cone.KIND, *cone.PYRAMIDS, power.KIND, frustum.KIND, blunt_cone.KIND, flat.KIND),
    rounded_flat.KIND,
)
#: Name -> :class:`~.shape.Kind` of all shapes of this package except the paraboloid.
SHAPES = MappingProxyType({kind.name: kind for kind in BUILT_IN})
