"""The field of a pressure that is a polynomial in sqrt(1 - x²)."""

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from ..kernels.two_layers import TwoLayers, layer_modulus
from ..numerics.mesh import mesh_of
from ..numerics.threads import one_blas_thread
from ..parameters import BONDINGS, COMMON, allowed
from . import normal, sliding
from .field import integrals
from .pressure import Pressure
from .waves import farthest

#: Nodes that are tried: a polynomial of fewer degrees is told by the first that has all of it.
_NODES = (6, 16, 32, 64)
#: A polynomial is right to this part of its largest value at points between the nodes; a pressure that is none of up
#: to 63 degrees is not.
_SAME, _NONE = 1e-13, 1e-10
#: Points that have little in common are computed so many at a time, at all radii and depths of these.
_SOME = 16
#: At this relative distance from h and less a point is at the interface.
_AT = 1e-12


@one_blas_thread()
def of_pressure(
    p: Callable[[np.ndarray], np.ndarray],
    r: ArrayLike,
    z: ArrayLike,
    *,
    h: float,
    n: float,
    nu1: float,
    nu2: float,
    bonding: str,
    mu: float = 0.0,
    side: str | None = None,
) -> Mapping[str, np.ndarray]:
    """Stresses and displacements in a layer and the body below it under a pressure p(x), x <= 1, of contact radius 1.

    z points down from the surface; tension is positive, and p > 0 presses. A half-space is n = 1, nu1 = nu2, bonded,
    with any h. The equations are in docs/stresses.md.

    Parameters
    ----------
    p : function of radii x (m,) in [0, 1], a polynomial of up to 60 degrees in sqrt(1 - x²)
    r, z : radii >= 0 and depths >= 0, in units of the contact radius; they broadcast
    h : thickness of the layer in that unit, > 0
    n : E1*/E2* of layer and body, >= 0; 0 is a rigid body
    nu1, nu2 : Poisson ratios of layer and body in (-1, 0.5]
    bonding : "bonded" or "frictionless", the interface
    mu : >= 0; with mu > 0 the field of the traction mu p along x, in full sliding, is added as amplitudes
    side : "layer" or "base", in which of the two a point at z = h is; None: the layer

    Returns
    -------
    dict : name -> array of the shape of r and z. sr, st, sz, trz, in units of p, are the stresses by p; ur, uz the
        displacements, in units of p times the contact radius over E2* (E1* on a rigid body, in which all is NaN). With
        mu > 0, of the friction alone: sr_c, st_c, sz_c and uz_c are to be multiplied by cos th, srt_s by sin th; sxz is
        sxz_0 + sxz_2 cos 2th, ux is ux_0 + ux_2 cos 2th. ux_0 is NaN over a frictionless interface: nothing holds the
        layer

    Raises
    ------
    ValueError : an argument is out of its bounds or not finite; p is no such polynomial

    Examples
    --------
    >>> hertz = lambda x: np.sqrt(1 - x**2)
    >>> field = of_pressure(hertz, 0.0, [0.0, 0.48], h=1.0, n=1.0, nu1=0.3, nu2=0.3, bonding="bonded")
    >>> (field["sr"] - field["sz"]).round(6).tolist()
    [0.2, 0.62004]
    """
    layers = _layers(h, n, nu1, nu2, bonding)
    r, z = (_checked(name, value) for name, value in (("r", r), ("z", z)))
    if not (np.ndim(mu) == 0 and np.isfinite(mu) and mu >= 0):
        raise ValueError(f"mu = {mu}: must be finite and at least 0")
    if r.max(initial=0.0) > farthest(h):
        raise ValueError(f"r = {r.max():g}: must be at most {farthest(h):.3g}: farther away the field takes minutes")
    if side not in (None, "layer", "base"):
        raise ValueError(f'side = "{side}": must be None, "layer" or "base"')
    shape = np.broadcast_shapes(r.shape, z.shape)
    points = np.broadcast_to(r, shape).ravel(), np.broadcast_to(z, shape).ravel()
    pressure = _interpolated(p)
    at_interface = np.abs(points[1] - h) <= _AT * h
    below = np.where(at_interface, side == "base", points[1] > h)
    names = {}
    for load, components, factor in (
        (normal.NORMAL, normal.components, 1.0),
        (sliding.SLIDING, sliding.components, mu),
    ):
        if factor:
            whole = _at_points(load, layers, np.array([float(h)]), pressure, *points, below)
            G2 = np.where(below, (1 - nu2) + 0.0, layer_modulus(n) * (1 - nu1))
            names |= {name: factor * v.reshape(shape) for name, v in components(whole, G2).items()}
    if "ux_0" in names and bonding == "frictionless":
        names["ux_0"] = np.full(shape, np.nan)
    return names


def _layers(h, n, nu1, nu2, bonding):
    """:class:`TwoLayers` of one case; ValueError for a number out of bounds."""
    for name, value in {"h": h, "n": n, "nu1": nu1, "nu2": nu2}.items():
        good = np.ndim(value) == 0 and np.isfinite(value)
        if not good or (value <= 0 if name == "h" else not allowed(COMMON[name], value)):
            bounds = "> 0" if name == "h" else f"in {COMMON[name].interval}" + " or 0" * (name == "n")
            raise ValueError(f"{name} = {value}: must be a finite number {bounds}")
    if bonding not in BONDINGS:
        raise ValueError(f'bonding = "{bonding}": must be one of {", ".join(BONDINGS)}')
    return TwoLayers(*(np.array([float(v)]) for v in (n, nu1, nu2)), np.array([bonding == "bonded"]))


def _checked(name, values):
    values = np.asarray(values, dtype=float)
    bad = values[~(np.isfinite(values) & (values >= 0))]
    if bad.size:
        raise ValueError(f"{name} = {bad[0]}: must be finite and at least 0")
    return values


def _interpolated(p):
    """:class:`Pressure` of one case, on as few nodes as have all of p."""
    fine = np.linspace(0.02, 1.0, 197)  # nearer to the edge 1 - x² has lost digits
    wanted = _values(p, fine)
    for nodes in _NODES:
        mesh = mesh_of(nodes)
        pressure = Pressure(mesh, _values(p, mesh.s)[None])
        missed = np.abs(pressure.values[0] @ mesh.basis(fine).T - wanted).max()
        if missed <= _SAME * np.abs(wanted).max():
            return pressure
    if missed > _NONE * np.abs(wanted).max():
        raise ValueError("p: must be a polynomial of up to 60 degrees in sqrt(1 - x²)")
    return pressure


def _values(p, s):
    values = np.asarray(p(np.sqrt((1 - s) * (1 + s))), dtype=float)
    if values.shape != s.shape or not np.all(np.isfinite(values)):
        raise ValueError(f"p: must give a finite number for each radius x in [0, 1] (got shape {values.shape})")
    return values


def _at_points(load, layers, h, pressure, r, z, body):
    """The integrals (fields, N) of a load at points (N,): where most pairs of their radii and depths are wanted, at all
    of them, else at those of some points after the others."""
    rows, row = np.unique(np.stack([z, body]), axis=1, return_inverse=True)
    radii, column = np.unique(r, return_inverse=True)
    if rows.shape[1] * len(radii) <= 4 * len(r) or len(r) <= _SOME:
        whole = integrals(load, layers, h, pressure, radii, rows[:1], rows[1] > 0)
        return whole[:, 0, row.ravel(), column.ravel()]
    order = np.lexsort((r, z))
    made = np.zeros((len(load.orders), len(r)))
    for part in np.array_split(order, -(-len(r) // _SOME)):
        made[:, part] = _at_points(load, layers, h, pressure, r[part], z[part], body[part])
    return made
