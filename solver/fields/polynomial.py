"""The field of a pressure that is a polynomial in sqrt(1 - x²)."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..kernels.stack import Stack
from ..kernels.two_layers import TwoLayers
from ..numerics.mesh import mesh_of
from ..numerics.threads import one_blas_thread
from ..parameters import BONDINGS, COMMON, LAYER, MOST, allowed
from . import normal, sliding
from .field import integrals
from .pressure import Pressure
from .waves import farthest

#: Numbers of nodes that are tried in turn: the first that represents the polynomial exactly is used.
_NODES = (6, 16, 32, 64)
#: The pressure is represented exactly if its error between the nodes is at most _SAME times its largest value. If it is
#: above _NONE even with the most nodes, the pressure is not a polynomial of up to 63 degrees.
_SAME, _NONE = 1e-13, 1e-10
#: If points share few radii and depths, this many are computed at a time, at all of their radii and depths.
_SOME = 16
#: A point whose relative distance from h is at most this is at the interface.
_AT = 1e-12


@one_blas_thread()
def of_pressure(
    p: Callable[[np.ndarray], np.ndarray],
    r: ArrayLike,
    z: ArrayLike,
    *,
    h: float | None = None,
    n: float | None = None,
    nu1: float | None = None,
    nu2: float | None = None,
    bonding: str | None = None,
    layers: Sequence[tuple[float, float, float]] | None = None,
    interfaces: Sequence[str | tuple[float, float]] | None = None,
    rigid_base: bool = False,
    mu: float = 0.0,
    side: str | int | None = None,
) -> Mapping[str, np.ndarray]:
    """Stresses and displacements in layers and the body below them under a pressure p(x), x <= 1, of contact radius 1.

    z points down from the surface; tension is positive, and p > 0 is compression. For a half-space give n = 1, nu1 =
    nu2, "bonded", and any h; for one layer h, n, nu1 and bonding; for several, `layers`. The equations are in
    docs/stress_fields.md.

    Parameters
    ----------
    p : function of radii x (m,) in [0, 1], a polynomial of up to 60 degrees in sqrt(1 - x²)
    r, z : radii >= 0 and depths >= 0, in units of the contact radius; they broadcast
    h : thickness of the layer in the same unit, > 0
    n : E1*/E2* of layer and body, >= 0; 0 is a rigid body
    nu1, nu2 : Poisson ratios of layer and body in (-1, 0.5]
    bonding : "bonded" or "frictionless", the interface
    layers : in place of h, n, nu1 and bonding, at most 16 layers (h, n, nu), the one at the surface first
    interfaces : below each of the layers: "bonded" (all of them, by default), "frictionless", or compliances (cn, ct)
        of springs, >= 0, across and along it, in units of the contact radius over E2*
    rigid_base : whether the body under the layers is rigid; n is then E_j*/E_1*, and 1 for the first layer
    mu : >= 0; with mu > 0 the field of the traction mu p along x, in full sliding, is added as amplitudes
    side : the body to which a point at an interface belongs: "layer" or "base" at z = h; with `layers` the number of
        the body, 1 at the surface, len(layers) + 1 below the last layer. None: the upper one

    Returns
    -------
    dict : name -> array of the shape of r and z. sr, st, sz, trz are the stresses by p, in units of p; ur, uz are the
        displacements, in units of p times the contact radius over E2* (E1* on a rigid body; inside it all is NaN). With
        mu > 0, the other names are those of friction alone: sr_c, st_c, sz_c and uz_c must be multiplied by cos th, and
        srt_s by sin th; sxz is sxz_0 + sxz_2 cos 2th, ux is ux_0 + ux_2 cos 2th. ux_0 is NaN with a frictionless
        interface: nothing holds the layers above it

    Raises
    ------
    ValueError : an argument is out of its bounds or not finite; p is not such a polynomial

    Examples
    --------
    >>> hertz = lambda x: np.sqrt(1 - x**2)
    >>> field = of_pressure(hertz, 0.0, [0.0, 0.48], h=1.0, n=1.0, nu1=0.3, nu2=0.3, bonding="bonded")
    >>> (field["sr"] - field["sz"]).round(6).tolist()
    [0.2, 0.62004]
    >>> field = of_pressure(hertz, 0.0, 0.3, layers=[(0.2, 8.0, 0.2), (0.1, 0.5, 0.4)], nu2=0.3, side=3)
    >>> print(f"{field['sz'].item():.6f}")
    -0.881689
    """
    layer = {"h": h, "n": n, "nu1": nu1, "bonding": bonding}
    if layers is None:
        layered, h = _layer(layer, nu2), np.array([float(h)])
        _refuse({"interfaces": interfaces, "rigid_base": rigid_base or None}, "only beside layers")
    else:
        _refuse(layer, "each of the layers has its own")
        layered, h = _stack(layers, interfaces, nu2, rigid_base)
    r, z = (_checked(name, value) for name, value in (("r", r), ("z", z)))
    if not (np.ndim(mu) == 0 and np.isfinite(mu) and mu >= 0):
        raise ValueError(f"mu = {mu}: must be finite and at least 0")
    if r.max(initial=0.0) > (far := farthest(h[0])):
        raise ValueError(f"r = {r.max():g}: must be at most {far:.3g}: farther away the field takes minutes")
    number = _number(side, None if layers is None else len(layers))
    shape = np.broadcast_shapes(r.shape, z.shape)
    points = np.broadcast_to(r, shape).ravel(), np.broadcast_to(z, shape).ravel()
    pressure = _interpolated(p)
    region = _region(points[1], layered.tops(h)[0, 1:], number)
    names = {}
    for load, components, factor in (
        (normal.NORMAL, normal.components, 1.0),
        (sliding.SLIDING, sliding.components, mu),
    ):
        if factor:
            whole = _at_points(load, layered, h, pressure, *points, region)
            G2 = layered.shear[0, region]
            names |= {name: factor * v.reshape(shape) for name, v in components(whole, G2).items()}
    if "ux_0" in names and layered.slips[0]:
        names["ux_0"] = np.full(shape, np.nan)
    return names


def _refuse(values, reason):
    """Raise ValueError if one of the values is not None."""
    for name, value in values.items():
        if value is not None:
            raise ValueError(f"{name} is given: {reason}")


def _layer(layer, nu2):
    """:class:`TwoLayers` of one case. Raises ValueError for a number out of bounds."""
    h, n, nu1, bonding = layer.values()
    _check({"h": (h, None), "n": (n, COMMON["n"]), "nu1": (nu1, COMMON["nu1"]), "nu2": (nu2, COMMON["nu2"])})
    if bonding not in BONDINGS:
        raise ValueError(f'bonding = "{bonding}": must be one of {", ".join(BONDINGS)}')
    return TwoLayers(*(np.array([float(v)]) for v in (n, nu1, nu2)), np.array([bonding == "bonded"]))


def _check(numbers):
    """Raise ValueError for a number that is missing or out of the bounds of its row; without a row it must be > 0."""
    for name, (value, row) in numbers.items():
        good = np.ndim(value) == 0 and isinstance(value, (int, float, np.number)) and np.isfinite(value)
        if not good or (value <= 0 if row is None else not allowed(row, value)):
            bounds = "> 0" if row is None else f"in {row.interval}" + " or 0" * (0 in row.also)
            raise ValueError(f"{name} = {value}: must be a finite number {bounds}")


def _stack(layers, interfaces, nu2, rigid):
    """:class:`Stack` of one case, and the thickness (1,) of its first layer. Raises ValueError."""
    if isinstance(layers, str) or not hasattr(layers, "__len__") or not 1 <= len(layers) <= MOST:
        raise ValueError(f"layers = {layers!r:.60}: must be a list of 1 to {MOST} layers (h, n, nu)")
    for number, layer in enumerate(layers, 1):
        if isinstance(layer, str) or np.shape(layer) != (3,):
            raise ValueError(f"layers[{number}] = {layer!r:.60}: must be (h, n, nu)")
        h, n, nu = layer
        _check(
            {
                f"layers[{number}]: {name}": pair
                for name, pair in {"h": (h, None), "n": (n, LAYER["n"]), "nu": (nu, LAYER["nu"])}.items()
            }
        )
    if rigid and layers[0][1] != 1:
        raise ValueError(
            f"layers[1]: n = {layers[0][1]}: on a rigid base n is E_j*/E1*, so that of the first layer is 1"
        )
    if not rigid:
        _check({"nu2": (nu2, COMMON["nu2"])})
    h, n, nu = np.array(layers, dtype=float).T[:, None]
    free, cn, ct = _interfaces(interfaces, len(layers))
    unit = n[:, :1] / h[:, :1]
    nu2, rigid = np.array([0.0 if rigid else float(nu2)]), np.array([bool(rigid)])
    return Stack(n, nu, h / h[:, :1], free, cn * unit, ct * unit, nu2, rigid), h[:, 0]


def _interfaces(interfaces, count):
    """Whether each interface is frictionless, and its compliances, (1, N) each."""
    interfaces = ["bonded"] * count if interfaces is None else interfaces
    if isinstance(interfaces, str) or not hasattr(interfaces, "__len__") or len(interfaces) != count:
        raise ValueError(f"interfaces = {interfaces!r:.60}: must be a list of {count}, one below each layer")
    springs = np.zeros((count, 2))
    for number, interface in enumerate(interfaces, 1):
        if isinstance(interface, str) or np.shape(interface) != (2,):
            if not isinstance(interface, str) or interface not in BONDINGS:
                wanted = f"{', '.join(BONDINGS)} or compliances (cn, ct)"
                raise ValueError(f"interfaces[{number}] = {interface!r:.60}: must be one of {wanted}")
            continue
        pairs = zip(("cn", "ct"), interface, strict=True)
        _check({f"interfaces[{number}]: {name}": (value, LAYER[name]) for name, value in pairs})
        springs[number - 1] = interface
    free = np.array([[isinstance(interface, str) and interface == "frictionless" for interface in interfaces]])
    return free, *springs.T[:, None]


def _number(side, count):
    """The number, from 1, of the body to which points at an interface belong; 0 stands for the upper body. Raises
    ValueError.

    count : number of layers; None if the one layer is given by its numbers
    """
    if side is None:
        return 0
    if count is None:
        if side not in ("layer", "base"):
            raise ValueError(f'side = "{side}": must be None, "layer" or "base"')
        return 1 + (side == "base")
    if isinstance(side, (bool, str)) or side not in range(1, count + 2):
        raise ValueError(f"side = {side!r}: must be None or the number of a body, 1 to {count + 1}")
    return int(side)


def _region(z, ends, number):
    """The layer of the depths z (M,), counted from 0; len(ends) for the body. number : of the body to which depths at
    an interface belong, if it is next to that interface."""
    at = np.abs(z[:, None] - ends) <= _AT * ends
    return np.where(at, np.arange(1, len(ends) + 1) < number, z[:, None] > ends).sum(axis=1)


def _checked(name, values):
    values = np.asarray(values, dtype=float)
    bad = values[~(np.isfinite(values) & (values >= 0))]
    if bad.size:
        raise ValueError(f"{name} = {bad[0]}: must be finite and at least 0")
    return values


def _interpolated(p):
    """:class:`Pressure` of one case, on the fewest nodes that represent p exactly."""
    fine = np.linspace(0.02, 1.0, 197)  # nearer to the edge, 1 - x² loses digits
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


def _at_points(load, layers, h, pressure, r, z, region):
    """The integrals (fields, N) of a load at points (N,). If the points are most of the pairs of their radii and
    depths, they are computed at all pairs; otherwise for a few points at a time."""
    rows, row = np.unique(np.stack([z, region]), axis=1, return_inverse=True)
    radii, column = np.unique(r, return_inverse=True)
    if rows.shape[1] * len(radii) <= 4 * len(r) or len(r) <= _SOME:
        whole = integrals(load, layers, h, pressure, radii, rows[:1], rows[1])
        return whole[:, 0, row.ravel(), column.ravel()]
    order = np.lexsort((r, z))
    whole = np.zeros((len(load.orders), len(r)))
    for part in np.array_split(order, -(-len(r) // _SOME)):
        whole[:, part] = _at_points(load, layers, h, pressure, r[part], z[part], region[part])
    return whole
