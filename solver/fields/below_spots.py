"""The field below a spot of a periodic cell, beside its axis too: docs/stresses.md, Below a spot.

Of the waves G != 0 of the lattice, averaged over the angle about the axis, with the transfer u, S, T, M of the coated
body per unit pressure and q^ of the spot,

    sz = 2 pi Nbar sum q^(G) S J0(Gr),   trz = 2 pi Nbar sum q^(G) T J1(Gr),
    sr + st = 2 pi Nbar sum q^(G) M J0(Gr),   sr - st = -2 pi Nbar sum q^(G) u J2(Gr).

In the layer the transfer is that of a half-space and a difference that falls as waves from the interface do. Of the
half-space the lone spot is a closed form over k, to which the sum over G less the integral over k of the long waves
comes, as on the axis (:mod:`~solver.laws.cell.axis`).
"""

import numpy as np

from ..kernels.transfer import Bodies, Kind, radial_sum, wave_state
from ..laws.cell.axis import lone_on_axis, long_waves, transform
from ..laws.cell.peak import pressures
from ..laws.cell.spot import panels_of, pieces
from ..laws.cell.summits import parts
from ..laws.cell.sums import lattice_waves, lone_waves
from ..numerics.mesh import Mesh, on_panels
from ..numerics.quadrature import radau_nodes
from . import normal
from .pressure import Pressure
from .waves import bessel

#: Waves above u = kh reach the interface with less than e^-u of their pressure: 1e-15; and where some 1e-7 do.
EXACT, ROUGH = 38.0, 18.0
#: Below this X = kh the state is carried from the surface down (:mod:`~solver.kernels.transfer`).
_THIN = 1.0
#: Nodes of the pressure of a spot on each panel of s = sqrt(1 - (r/b)²).
_NODES = 32
#: Numbers in an array of states: so many waves are taken at once.
_AT_ONCE = 200_000


def below_spot(cell, spot, layers, r, z, body, last=EXACT):
    """sr, st, sz and trz (4, Z, R) of the waves G != 0 below one spot, in units E = Ra = l = 1; tension is positive.

    cell, spot : :class:`~solver.laws.cell.spot.Cell` and :class:`~solver.laws.cell.spot.CellSpots` of one radius
    layers : :class:`~solver.kernels.two_layers.TwoLayers` of the case
    r, z : (R,), radii from the axis, which with b are less than the distance of neighbours; (Z,), depths, in l
    body : bool, in the body, z >= h; else in the layer, z <= h
    last : waves of u = kh up to this are taken
    """
    lattice, b, h = "hex" if cell.lattice == "disc" else cell.lattice, spot.b[0], 1 / cell.pitch
    k, c = lattice_waves(lattice, last * cell.pitch, b + r.max())
    whole = _of_layers(k, c * transform(spot, k), h, layers, r, z, body)
    if not body:
        whole += _in_half_space(lattice, spot, r, z, float(layers.nu1[0]))
    return np.stack([*normal.components(whole).values()])


def below_summit(cell, b, p, layers, r, z, body, last=EXACT):
    """The same below a spot of its own load, of random heights: the waves of the cells of equal heights with its
    radius b and the nominal pressure p, in units E = Ra = l = 1, and what it has beside these as a lone spot.

    cell : of disc cells; the other arguments are those of :func:`below_spot`
    """
    of_lattice, lone = pieces(cell, b), pieces(cell._replace(lattice="lone"), b)
    both = parts(cell, np.array([b]), of_lattice, lone)
    own, share = both.spots(np.array([p])), p / both.equal.p[0]
    equal = both.equal._replace(phi=share * both.equal.phi, fall=share * both.equal.fall)
    rest = own._replace(phi=own.phi - equal.phi, fall=own.fall - equal.fall)
    return below_spot(cell, equal, layers, r, z, body, last) + _below_lone(cell, rest, layers, r, z, body)


def _below_lone(cell, spot, layers, r, z, body):
    """sr, st, sz and trz (4, Z, R) below a lone spot, of waves to 1e-8 of their pressure."""
    k, c = lone_waves(cell.pitch, (spot.b[0] + r.max()) / 2)
    whole = _of_layers(k, c * k * transform(spot, k), 1 / cell.pitch, layers, r, z, body)
    if not body:
        whole += _lone(spot, r, z, float(layers.nu1[0]))
    return np.stack([*normal.components(whole).values()])


def _of_layers(k, weights, h, layers, r, z, body):
    """The four integrals (4, Z, R) of waves k with weights (K,), in the body, or in the layer less a half-space."""
    nu = float((layers.nu2 if body else layers.nu1)[0])
    bodies, kind, whole = Bodies.of(layers), Kind.BODY if body else Kind.DIFFERENCE, np.zeros((4, len(z), len(r)))
    for thin in (True, False):
        some = np.flatnonzero((k * h < _THIN) == thin)
        for part in np.array_split(some, 1 + len(some) * len(z) // _AT_ONCE) if len(some) else ():
            state = wave_state(kind, bodies, k[part] * h, np.outer(z, k[part]), (-1.0, 0.0), thin)
            whole += _summed(state, nu, weights[part], bessel(k[part], r, 2))
    return whole


def _summed(state, nu, weights, J):
    """The four integrals (4, Z, R) of states (Z, K) of waves with their weights (K,)."""
    u, _, S, T = state
    rows = (radial_sum(state, nu), 0), (-u, 2), (S, 0), (T, 1)
    return np.stack([(values * weights) @ J[order] for values, order in rows])


def _in_half_space(lattice, spot, r, z, nu):
    """The four integrals of the waves G != 0 in a half-space of the layer's material."""
    k, c, between, lows = long_waves(lattice, spot.b[0], r.max())
    k, c = np.append(k, between), np.append(c, -lows)
    x = np.outer(z, k)
    decay = np.exp(-x)
    state = decay * (x - 1 + 2 * nu), None, -decay * (1 + x), -decay * x
    return _summed(state, nu, c * transform(spot, k), bessel(k, r, 2)) + _lone(spot, r, z, nu)


def _lone(spot, r, z, nu):
    """The four integrals of a lone spot on a half-space, in closed form over k."""
    b = spot.b[0]
    if not r.any():
        E, F = lone_on_axis(spot, z)
        return np.stack([F - (1 + 2 * nu) * E, 0 * E, -(E + F), 0 * E])[..., None]
    return normal.in_closed_form(pressure_of(spot), r / b, z / b, np.array([nu]), False)[:, 0]


def pressure_of(spot):
    """The :class:`~.pressure.Pressure` of one spot, in units E = Ra = l = 1; its contact radius is b."""
    panels, _ = panels_of(len(spot.t[0]))
    ends = np.sqrt(1 - np.linspace(1, 0, 1 + max(1, panels // 2)) ** 2)
    breaks = tuple(ends.tolist())
    s = on_panels(radau_nodes(_NODES), breaks)
    s[-1] = 1.0
    none = np.zeros(0)
    mesh = Mesh(_NODES, breaks, s, np.sqrt((1 - s) * (1 + s)), none, none, none)
    return Pressure(mesh, pressures(spot, s))
