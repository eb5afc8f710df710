"""Stresses on the axis of a spot of a periodic cell: docs/stresses.md, Below a spot.

The waves G != 0 of the lattice cause the stresses

    sz = 2 pi Nbar sum q^(G) S(Gz),   sr = st = pi Nbar sum q^(G) M(Gz),

where S and M are the transfer of the coated body per unit pressure, S(0) = -1. In the layer S and M are those of a
half-space of its material, S = -(1 + x) e^-x, M = (x - 1 - 2 nu) e^-x, x = kz, plus a difference that decays like waves
from the interface. For the half-space the sum over G has two parts: the integral over all k, in closed form; and the
difference between sum and integral of the long waves, weighted by w(k) = erfc((k - k0)/D)/2. So few waves are enough,
however near the surface the point is.
"""

import numpy as np
from numpy.typing import ArrayLike

from ...kernels.transfer import Bodies, StatePart, radial_sum, wave_state
from ...kernels.two_layers import TwoLayers
from ...numerics import special
from ...numerics.quadrature import gauss_legendre, lagrange
from .rows import of_kernel, refuse_cells, refuse_layers
from .spot import Cell, CellSpots, panels_of, spots
from .sums import LATTICES, lattice_waves

__all__ = ["axis_stresses", "cell_axis", "lone_on_axis", "long_waves", "transform"]

#: Waves above u = kh = _CUT reach the interface with less than 1e-15 of their pressure.
_CUT = 38.0
#: A point whose distance from the interface is at most this part of h counts as a point at the interface.
_AT = 1e-9
#: Below this X = kh the state is integrated from the surface down (:mod:`~solver.kernels.transfer`).
_THIN = 1.0
#: Points on each panel of t, and number of times that the panels are halved towards t = 0, as points of small depth
#: need them.
_POINTS, _HALVINGS = 20, 48
#: A transform has on each panel half as many points as phi, half as many as the phase of its shortest wave in radians,
#: and _MORE. So many waves at a time have the same points (tests/laws/cell/test_rows.py).
_MORE, _WAVES = 14, 200


def cell_axis(
    lattice: str,
    lam: float,
    l_over_h: float,
    z: ArrayLike,
    n: float,
    nu1: float,
    nu2: float,
    bonding: str,
    m: float = 0.0,
    side: int = 0,
) -> tuple[np.ndarray, np.ndarray]:
    """Stresses on the axis of a spot of the periodic cell, less those of the nominal pressure: docs/stresses.md.

    Parameters
    ----------
    lattice, lam, l_over_h, n, nu1, nu2, bonding, m : as in :func:`.cell_rows`, one number each
    z : depths (Z,) in units of the pitch l, >= 0; in the layer up to h, in the body from h on
    side : 0, in the layer; 1, in the body

    Returns
    -------
    sr, sz : (Z,), radial (and hoop) stress and normal stress, in E1* l/Ra; tension is positive

    Raises
    ------
    ValueError : an argument is out of its bounds

    Examples
    --------
    >>> sr, sz = cell_axis("square", 0.05, 8.0, [0.0], 10.0, 0.25, 0.3, "bonded")
    >>> print(f"{sr[0]:.4e} {sz[0]:.4e}")
    -6.1852e-02 -4.2927e-02
    """
    refuse_cells(lattice, *(np.asarray(v, float) for v in (lam, l_over_h, m)))
    refuse_layers(*(np.asarray(v, float) for v in (n, nu1, nu2)), np.asarray(bonding))
    if side not in (0, 1):
        raise ValueError(f"side = {side}: must be 0, in the layer, or 1, in the body")
    z, h = np.atleast_1d(np.asarray(z, dtype=float)), 1 / l_over_h
    there = (z >= 0) & (z <= h * (1 + _AT)) if side == 0 else (z >= h * (1 - _AT)) & np.isfinite(z)
    if not np.all(there):
        where = f"at most h = {h:g}, in the layer" if side == 0 else f"at least h = {h:g}, in the body"
        raise ValueError(f"z = {z[~there][0]}: must be finite, at least 0 and {where}")
    layers = TwoLayers(*(np.array([v]) for v in (n, nu1, nu2, bonding == "bonded")))
    cell = Cell(lattice, float(l_over_h), of_kernel(layers, m))
    spot = spots(cell, [np.sqrt(lam / np.pi)])
    sr, sz = axis_stresses(cell, spot, layers, z, side)
    return sr / (1 + m), sz / (1 + m)


def axis_stresses(cell: Cell, spot: CellSpots, layers: TwoLayers, z: np.ndarray, side: int) -> tuple:
    """sr and sz (Z,) below one spot at depths z (Z,), in units E = Ra = l = 1; arguments as in :func:`cell_axis`."""
    b, h, lattice = spot.b[0], 1 / cell.pitch, "hex" if cell.lattice == "disc" else cell.lattice
    bodies, load, x = Bodies.of(layers), (-1.0, 0.0), np.asarray(z, dtype=float)[:, None]
    k, c = lattice_waves(lattice, _CUT * cell.pitch, b)
    amplitudes, X = c * transform(spot, k), k * h
    nu = float(layers.nu1[0] if side == 0 else layers.nu2[0])
    kind = StatePart.DIFFERENCE if side == 0 else StatePart.BODY
    sz, sr = np.zeros(len(z)), np.zeros(len(z))
    for thin in (True, False):
        some = np.flatnonzero((X < _THIN) == thin)
        if len(some):
            state = wave_state(kind, bodies, X[some], k[some] * x, load, thin)
            sz += state[2] @ amplitudes[some]
            sr += radial_sum(state, nu) @ amplitudes[some] / 2
    if side == 0:
        near_sr, near_sz = _half_space(spot, lattice, np.asarray(z, dtype=float), nu)
        sr, sz = sr + near_sr, sz + near_sz
    return sr, sz


def _half_space(spot, lattice, z, nu):
    """sr and sz (Z,) of the waves G != 0 in a half-space of the layer's material."""
    b = spot.b[0]
    low, weights, between, lows = long_waves(lattice, b)
    of_low, of_between = weights * transform(spot, low), lows * transform(spot, between)

    def less(shape):
        """Sum less integral of the long waves, of a function of kz, (Z,)."""
        return shape(np.outer(z, low)) @ of_low - shape(np.outer(z, between)) @ of_between

    E, F = lone_on_axis(spot, z)
    sz = less(lambda x: -(1 + x) * np.exp(-x)) - (E + F)
    sr = less(lambda x: (x - 1 - 2 * nu) * np.exp(-x)) + F - (1 + 2 * nu) * E
    return sr / 2, sz


def long_waves(lattice, b, r=0.0):
    """The long waves of the field of a spot of radius b, at radii up to r from its axis: the waves of the lattice (W,)
    with their weights c w, and points k (K,) with the weights of ∫ w k dk."""
    D = 12 / (LATTICES[lattice] - b - r)
    k, c = lattice_waves(lattice, 0.0, b + r)
    nodes, weights = gauss_legendre(16)
    panels = max(12, int(np.ceil(12 * D * (b + r) / 4)))
    between = ((np.arange(panels)[:, None] + nodes) / panels * 12 * D).ravel()
    lows = np.tile(weights / panels * 12 * D, panels) * between * special.erfc((between - 6 * D) / D) / 2
    return k, c, between, lows


def lone_on_axis(spot, z):
    """E = ∫ q^ k e^(-kz) dk and F = ∫ q^ k (kz) e^(-kz) dk (Z,) of one spot, from -phi'(t)/t on panels that are halved
    towards t = 0."""
    edges = np.append(0.0, spot.b[0] * 0.5 ** np.arange(_HALVINGS, -1, -1.0))
    nodes, weights = gauss_legendre(_POINTS)
    t = (edges[:-1, None] + np.diff(edges)[:, None] * nodes).ravel()
    near = _between(spot, spot.fall[0], t) * t * t * (np.diff(edges)[:, None] * weights).ravel()
    below = t * t + z[:, None] ** 2
    return (near / below).sum(axis=1), (2 * near * (z[:, None] / below) ** 2).sum(axis=1)


def _between(spot, values, t):
    """A function interpolated to t (T,) from its `values` at the points of a spot, by a polynomial on each panel."""
    b, (panels, size) = spot.b[0], panels_of(len(values))
    index = np.clip((t / b * panels).astype(int), 0, panels - 1)
    out = np.empty_like(t)
    for j in range(panels):
        here = index == j
        out[here] = lagrange(gauss_legendre(size)[0], t[here] / b * panels - j) @ values[j * size : (j + 1) * size]
    return out


def transform(spot, k):
    """q^(k) = ∫ phi cos kt dt (K,) of one spot, to rounding; shorter waves have more points."""
    b, (panels, size) = spot.b[0], panels_of(len(spot.phi[0]))
    order, out = np.argsort(k), np.empty_like(k)
    for some in np.array_split(order, 1 + len(k) // _WAVES) if len(k) else ():
        x, w = gauss_legendre(_MORE + size // 2 + int(np.ceil(k[some[-1]] * b / panels / 2)))
        t = ((np.arange(panels)[:, None] + x) * (b / panels)).ravel()
        phi = _between(spot, spot.phi[0], t) * np.tile(w * (b / panels), panels)
        out[some] = np.cos(np.outer(k[some], t)) @ phi
    return out
