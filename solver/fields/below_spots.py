"""The field below a spot of a periodic cell, on its axis and off it: docs/stresses.md, Below a spot.

The waves G != 0 of the lattice, averaged over the angle about the axis, cause the stresses

    sz = 2 pi Nbar sum q^(G) S J0(Gr),   trz = 2 pi Nbar sum q^(G) T J1(Gr),
    sr + st = 2 pi Nbar sum q^(G) M J0(Gr),   sr - st = -2 pi Nbar sum q^(G) u J2(Gr),

where u, S, T, M are the transfer of the coated body per unit pressure, and q^ is that of the spot. In the layer the
transfer is that of a half-space plus a difference that decays like waves from the interface. For the half-space, a lone
spot is a closed form over k. To it is added the difference, for the long waves, between the sum over G and the integral
over k, as on the axis (:mod:`~solver.laws.cell.axis`).
"""

import numpy as np

from ..kernels.transfer import radial_sum
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

#: Largest u = kh of the waves: they reach the interface with e^-u of their pressure, less than 1e-15; and for a rough
#: field, some 1e-8.
EXACT, ROUGH = 38.0, 18.0
#: Below this X = kh the state is integrated from the surface down (:mod:`~solver.kernels.transfer`).
_THIN = 1.0
#: Nodes of the pressure of a spot on each panel of s = sqrt(1 - (r/b)²).
_NODES = 32
#: Largest number of entries of an array of states, which limits the number of waves at a time.
_AT_ONCE = 200_000


def below_spot(cell, spot, layers, r, z, region, last=EXACT):
    """sr, st, sz and trz (4, Z, R) of the waves G != 0 below one spot, in units E = Ra = l = 1; tension is positive.

    cell, spot : :class:`~solver.laws.cell.spot.Cell` and :class:`~solver.laws.cell.spot.CellSpots` of one radius
    layers : :class:`~solver.kernels.transfer.Layered` of the case
    r : (R,), radii from the axis, in l; r + b must be less than the distance of neighbours
    z : (Z,), depths in l
    region : the region of all depths: 0, the first layer, z <= h, to N, the body under N layers
    last : largest u = kh of the waves
    """
    lattice, b, h = "hex" if cell.lattice == "disc" else cell.lattice, spot.b[0], 1 / cell.pitch
    k, c = lattice_waves(lattice, last * cell.pitch, b + r.max())
    whole = _of_layers(k, c * transform(spot, k), h, layers, r, z, region)
    if not region:
        whole += _in_half_space(lattice, spot, r, z, float(layers.poisson[0, 0]))
    return np.stack([*normal.components(whole).values()])


def below_summit(cell, b, p, layers, r, z, region, last=EXACT):
    """As :func:`below_spot`, for a spot with a load of its own, as with random heights: the field of the cells of equal
    heights with the same radius b and nominal pressure p, plus the field of the rest of its pressure as a lone spot.

    cell : a disc cell; p : in units E = Ra = l = 1
    """
    of_lattice, lone = pieces(cell, b), pieces(cell._replace(lattice="lone"), b)
    both = parts(cell, np.array([b]), of_lattice, lone)
    spot, share = both.spots(np.array([p])), p / both.equal.p[0]
    equal = both.equal._replace(phi=share * both.equal.phi, fall=share * both.equal.fall)
    rest = spot._replace(phi=spot.phi - equal.phi, fall=spot.fall - equal.fall)
    return below_spot(cell, equal, layers, r, z, region, last) + _below_lone(cell, rest, layers, r, z, region)


def _below_lone(cell, spot, layers, r, z, region):
    """sr, st, sz and trz (4, Z, R) below a lone spot, by waves down to 1e-8 of their pressure."""
    k, c = lone_waves(cell.pitch, (spot.b[0] + r.max()) / 2)
    whole = _of_layers(k, c * k * transform(spot, k), 1 / cell.pitch, layers, r, z, region)
    if not region:
        whole += _lone(spot, r, z, float(layers.poisson[0, 0]))
    return np.stack([*normal.components(whole).values()])


def _of_layers(k, weights, h, layers, r, z, region):
    """The four integrals (4, Z, R) over waves k with weights (K,) in a region. In the first layer they are less those
    of a half-space."""
    region = int(region)
    nu, whole = float(layers.poisson[0, region]), np.zeros((4, len(z), len(r)))
    for thin in (True, False):
        some = np.flatnonzero((k * h < _THIN) == thin)
        for part in np.array_split(some, 1 + len(some) * len(z) // _AT_ONCE) if len(some) else ():
            waves = layers.waves(k[part], np.array([h]), (-1.0, 0.0))
            state = [v[0] for v in waves.state(region, z[None], region == 0)]
            whole += _summed(state, nu, weights[part], bessel(k[part], r, 2))
    return whole


def _summed(state, nu, weights, J):
    """The four integrals (4, Z, R) from the states (Z, K) of waves and their weights (K,)."""
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
