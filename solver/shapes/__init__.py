"""Shapes of indenters, one a file, and the registry of them; the protocol is in :mod:`.shape`.

docs/extending.md says how to add one.
"""

from typing import Any

import numpy as np

from ..parameters import PARAMETERS, Register
from . import blunt_cone, cone, flat, frustum, paraboloid, power, rounded_flat, sphere, table
from .shape import Kind, Shape, has_radius

__all__ = ["PARABOLOID", "ROUND", "SHAPES", "Kind", "Shape", "is_flat", "named", "register", "shape_of", "shaped"]

#: The shape of the paper: the default.
PARABOLOID = paraboloid.KIND.name


def register(kind: Kind) -> Kind:
    """Make a shape known by its name, and its parameters like any other.

    Parameters
    ----------
    kind : :class:`~.shape.Kind`

    Returns
    -------
    Kind : the same

    Raises
    ------
    ValueError : the name is that of a shape of this package; a parameter has the name of something else, or that of
        one of another shape with other bounds

    Examples
    --------
    docs/extending.md has a shape in one file.
    """
    if SHAPES.get(kind.name, kind) in BUILT_IN and kind not in BUILT_IN:
        raise ValueError(f"shape {kind.name}: is one of this package: take another name")
    with SHAPES.lock:
        _declare(SHAPES | {kind.name: kind})
        SHAPES[kind.name] = kind
    return kind


def _declare(shapes):
    """Put the parameters of `shapes` (name -> Kind), which are returned, into the table of parameters, and their names
    into the choices of `shape`. Raises ValueError, and changes nothing, where a parameter cannot have its name."""
    declared: dict[str, Any] = {}
    for kind in shapes.values():
        for name, row in kind.parameters.items():
            there, words = declared.get(name, (row, ()))
            if row != there or name in PARAMETERS and PARAMETERS[name].needed_by[0] != "shape":
                raise ValueError(f"shape {kind.name}: the parameter {name} is that of something else")
            declared[name] = there, (*words, kind.name)
    PARAMETERS.update({name: row._replace(needed_by=("shape", words)) for name, (row, words) in declared.items()})
    PARAMETERS["shape"] = PARAMETERS["shape"]._replace(choices=tuple(shapes))
    return shapes


def named(shapes: Any) -> None:
    """Read the tables that are named among the words of shapes, and register them; ValueError."""
    for word in set(np.ravel(shapes).tolist()):
        if isinstance(word, str) and word.startswith(table.PREFIX) and word not in SHAPES:
            register(table.read(word))


def shape_of(problem) -> Shape:
    """The :class:`~.shape.Shape` of the cases of a problem in units R = 1, which have one `shape`."""
    kind = SHAPES[str(problem.shape[0])]
    return kind.of(**{name: getattr(problem, name) for name in kind.parameters}, size=len(problem))


def shaped(problem):
    """(B,) bool: the cases of a problem that have another shape than the paraboloid."""
    return problem.shape != PARABOLOID


def is_flat(problem):
    """(B,) bool: the cases of a problem whose contact radius is that of the punch, whatever the load."""
    flat_ones, others = np.zeros(len(problem), dtype=bool), shaped(problem)
    for word in np.unique(problem.shape[others]).tolist():
        index = np.flatnonzero(problem.shape == word)
        flat_ones[index] = has_radius(shape_of(problem.take(index)))
    return flat_ones


BUILT_IN = (
    *(paraboloid.KIND, sphere.KIND, cone.KIND, *cone.PYRAMIDS, power.KIND, frustum.KIND, blunt_cone.KIND, flat.KIND),
    rounded_flat.KIND,
)
#: The names of those whose profile has the radius R in it.
ROUND = tuple(kind.name for kind in BUILT_IN if kind.round)
#: Name -> :class:`~.shape.Kind` of all shapes.
SHAPES = Register(_declare({kind.name: kind for kind in BUILT_IN}))
