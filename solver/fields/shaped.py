"""Pressures of smooth contacts that are not paraboloids, or have adhesion, as the fields need them: on panels that
shrink towards the kinks and the sharp tip of the shape."""

import numpy as np

from ..body import BODIES
from ..numerics.mesh import Mesh, mesh_of, on_panels
from ..numerics.quadrature import radau_nodes
from ..shapes import shape_of, shaped
from ..shapes.shape import has_radius
from ..smooth.contact import kinds_of
from ..smooth.galerkin import respond
from ..smooth.pressure import pressure_changes, without_edge
from .pressure import Pressure

#: Nodes of a single panel under shapes that are smooth in r², and of each of several panels. With half as many, the
#: stresses of tests/fields/test_shaped.py differ by 1e-7 and 1e-6.
_WHOLE, _EACH = 64, 16
#: Panels shrink by the factor _SHRINK, _TIMES times on each side of a kink, to 1e-8 a, and _TIP_TIMES times towards a
#: tip, to 1e-6 a, as r² is about 2 a² (1 - s) there. The rest of a pressure like ln r does not change the eighth digit.
_SHRINK, _TIMES, _TIP_TIMES = 0.4, 20, 30
#: At a kink or a tip p may be infinite. There p is evaluated at a distance of this part of the smallest panel.
_OFF_KINK = 0.1
#: The slope of a shape jumps if a change of the radius by its _NEXT_TO-th part changes it by more than _JUMP times the
#: slope at the edge.
_NEXT_TO, _JUMP = 1e-14, 1e-3
#: Radii at which the polynomials are compared with the pressure.
_LOOKED_AT = np.sin(np.pi / 2 * (np.arange(40) + 0.37) / 40)


def shaped_pressures(scaled, a, D):
    """Yield indices of smooth cases that are not paraboloids, or have adhesion at the edge; their
    :class:`~.pressure.Pressure` in units of E2*; and its error (b,), over the largest pressure at _LOOKED_AT."""
    for index in kinds_of(scaled):
        part, at = scaled.take(index), a[index]
        shape, body = shape_of(part), BODIES[str(part.base[0])](part)
        response, even = respond(shape, body, at), shape.even
        A_jkr = -np.sqrt(2 * np.pi * at * part.w_adhesion / body.E)
        A = D[index] / response.flat_D if has_radius(shape).all() else A_jkr
        several = np.flatnonzero(~even)
        for rows in (np.flatnonzero(even), *several[:, None]):
            if len(rows):
                mesh = mesh_of(_WHOLE) if even[rows[0]] else _panels(shape.take(rows), at[rows])
                yield index[rows], *_on(mesh, shape.take(rows), response.take(rows), A[rows])


def corners(scaled, a):
    """Smallest radius (B,), in a, at which the slope of the shape jumps inside the contact; 0 for a sharp tip, NaN if
    there is none. The pressure of a smooth punch is infinite there, like a logarithm."""
    at = np.full(len(scaled), np.nan)
    for index in kinds_of(scaled) if shaped(scaled).any() else ():
        shape = shape_of(scaled.take(index))
        kinks = shape.kinks()
        jumps = shape.slope(kinks * (1 + _NEXT_TO)) - shape.slope(kinks * (1 - _NEXT_TO))
        sharp = (jumps > _JUMP * shape.slope(a[index, None])) & (kinks < a[index, None])
        first = np.min(np.where(sharp, kinks, np.inf), axis=1, initial=np.inf) / a[index]
        at[index] = np.where(shape.pointed, 0.0, np.where(np.isfinite(first), first, np.nan))
    return at


def _on(mesh, shape, response, A):
    edge = A * response.E / (np.pi * response.a)
    pressure = Pressure(mesh, without_edge(shape, response, A, mesh.x), edge if edge.any() else None)
    p = without_edge(shape, response, A, _LOOKED_AT)
    changes = np.abs(pressure_changes(response, A, _LOOKED_AT)).max(axis=1)
    off = np.abs(pressure._replace(A=None).at(_LOOKED_AT) - p).max(axis=1)
    largest = np.abs(p + edge[:, None] / np.sqrt((1 - _LOOKED_AT) * (1 + _LOOKED_AT))).max(axis=1)
    load = 2 * np.pi * pressure.mean(np.ones(1))[:, 0] * response.a**2
    of_shape, of_edge = response.P, A * response.flat_P
    return pressure, (off + changes) / largest + np.abs(load - of_shape - of_edge) / (of_shape + np.abs(of_edge))


def _panels(shape, a):
    """The :class:`~..numerics.mesh.Mesh` of one case, without its operator."""
    kinks = shape.kinks()[0] / a[0]
    singular = [1.0] * bool(shape.pointed[0]) + [float(s) for s in np.sqrt(1 - kinks[kinks < 1] ** 2)]
    ends = sorted({0.0, 1.0, *singular})
    breaks = set(ends)
    for low, high in zip(ends[:-1], ends[1:], strict=True):
        sides = (low in singular) + (high in singular)
        gaps = (high - low) / max(sides, 1) * _SHRINK ** np.arange(1, _TIP_TIMES + 1)
        breaks |= {low + gap for gap in gaps[:_TIMES]} if low in singular else set()
        breaks |= {high - gap for gap in (gaps if high == 1 else gaps[:_TIMES])} if high in singular else set()
        breaks |= {(low + high) / 2} if sides == 2 else set()
    breaks = tuple(sorted(breaks))
    s = on_panels(radau_nodes(_EACH), breaks)
    s[-1] = 1.0
    least = np.diff(breaks).min()
    singular_node = np.abs(s[:, None] - np.array([*singular, 9.0])).min(axis=1) < _OFF_KINK * least
    at = np.where(singular_node, s - _OFF_KINK * least, s)
    none = np.zeros(0)
    return Mesh(_EACH, breaks, s, np.sqrt((1 - at) * (1 + at)), none, none, none)
