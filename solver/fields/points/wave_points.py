"""Stresses at single points with their derivatives by r and z, as sums over the waves of one rule: docs/stresses.md,
Extremes.

The constants of the waves of a case do not depend on the point and are formed once. The state at a depth is linear in
them; its derivatives by z are A and A² times the state, and those by r have Bessel functions of other orders.
"""

from typing import NamedTuple

import numpy as np

from ...compiled.library import sums_core
from ...compiled.wave_sums import sums_in_c
from ...kernels.transfer import (
    THIN,
    Bodies,
    StatePart,
    across_interface,
    antiplane,
    decaying,
    derivative,
    growing,
    radial_sum,
    state_below,
    thick_waves,
    thin_surface,
)
from ...numerics import special
from ...numerics.quadrature import gauss_legendre
from ..waves import SHORTEST, quadrature
from . import edge_waves

#: The sum for a field that decays like e^(-kz) ends at k = END/z: in 60 random layers the rest was at most 4e-13 of the
#: largest stress. With 28 it was 3e-11.
END = 32.0
#: A panel of 20 Gauss points spans at most _RADIANS radians of phase: the error is 1e-12 of the integral.
_RADIANS = 32.0
#: The first panel ends at FIRST times the shortest length of waves, 1/a, 1/h, or 1/n of these. With 1e-5, as with 1, no
#: stress and no first derivative of 520 random layers and 60 stacks changes by more than 5e-15 of the largest.
FIRST = 0.1
#: A panel of short waves at k is at most _SHARE k wide: at the points that they serve, their phase turns by at most
#: 260/k for each unit of k.
_SHARE = 0.125
#: For arguments below _SMALL, J2, J3, ... are series of _TERMS terms, because the recurrence loses digits there.
_SMALL, _TERMS = 1.0, 7
#: Most waves times points that are computed together: the size of an array of states.
_AT_ONCE = 60_000
#: Length of a jet: the value, and the derivatives by r, z, rr, rz, zz.
JET = 6


class OctaveWaves(NamedTuple):
    """The waves of B cases whose h lies in one octave.

    bodies : :class:`~solver.kernels.transfer.Bodies` (B, 1); h : (B,)
    k : (K,), ascending; the first `thin` of them are below THIN/h
    p : (B, K), k times the transform of the pressure times the weight of k; without the transform if f is given
    f : (B, K) of :mod:`.edge_waves`, for the short waves next to the edge; None for all other waves
    loads : traction (S, T) -> :class:`_Constants`
    """

    bodies: Bodies
    h: np.ndarray
    k: np.ndarray
    thin: int
    p: np.ndarray
    f: np.ndarray | None
    loads: dict

    def reach(self, kind, case, z):
        """How far from the source waves are at depths z (P,) of the cases `case`, in :class:`StatePart` `kind`."""
        return {StatePart.BODY: z, StatePart.LAYER: z, StatePart.DIFFERENCE: 2 * self.h[case] - z}[kind]

    def poisson(self, kind, case):
        """Poisson ratios (P, 1) there."""
        return (self.bodies.nu2 if kind == StatePart.BODY else self.bodies.nu1)[case]

    def state(self, load, kind, case, z, end):
        """State (4 of (P, end)) there under the first waves, times p, and the antiplane pair."""
        k, h, bodies, constants = self.k[:end], self.h[case, None], self.bodies, self.loads[load]
        X, x, middle = k * h, k * z[:, None], min(self.thin, end)
        nu1, p = bodies.nu1[case], self.p[case, :end]
        if kind == StatePart.BODY:
            v = decaying(x - X, bodies.nu2[case], *(part[case, :end] for part in constants.base))
        else:
            low, high, thick = slice(None, middle), slice(middle, end), slice(0, end - middle)
            parts = []
            if middle:
                state = state_below(x[:, low], nu1, [part[case, :middle] for part in constants.surface])
                if kind == StatePart.DIFFERENCE:
                    less = decaying(x[:, low], nu1, *(s * p[:, low] for s in load))
                    state = [a - b for a, b in zip(state, less, strict=True)]
                parts.append(state)
            if end > middle:
                down = constants.down_less if kind == StatePart.DIFFERENCE else constants.down
                falls = decaying(x[:, high], nu1, *(part[case, thick] for part in down))
                rises = growing((X - x)[:, high], nu1, *(part[case, thick] for part in constants.up))
                parts.append([a + b for a, b in zip(falls, rises, strict=True)])
            v = parts[0] if len(parts) == 1 else [np.concatenate(pair, axis=1) for pair in zip(*parts, strict=True)]
        if load[1] == 0:
            return v, 0.0, 0.0
        these = Bodies(*(values[case] for values in bodies))
        return v, *(p * values for values in antiplane(kind, these, X, x))

    def constants(self, load, kind, case, z, end):
        """The numbers and arrays from which the compiled core forms these states
        (:mod:`solver.compiled.wave_sums`)."""
        bodies, constants = self.bodies, self.loads[load]
        numbers = {"kind": int(kind), "size": len(self.h), "thin": self.thin, "S": load[0], "T": load[1]}
        arrays = {"h": self.h[case], "p": self.p, "surface": constants.surface, "up": constants.up}
        arrays |= {"down": constants.down_less if kind == StatePart.DIFFERENCE else constants.down}
        arrays |= {"base": constants.base}
        if load[1]:
            returned, passed = (values[:, 0][case] for values in across_interface(bodies))
            arrays |= {"returned": returned, "passed": passed}
        return numbers, arrays


class _Constants(NamedTuple):
    """The constants of the waves of one load, multiplied by p.

    surface : (4, B, thin), the state at the surface, of waves for which the layer is thin
    down, down_less, up : (2, B, K - thin), tractions of the waves that decay downwards, of their difference to a
        half-space, and of the waves that decay upwards, where the layer is thick
    base : (2, B, K), S and T at the top of the body
    """

    surface: np.ndarray
    down: np.ndarray
    down_less: np.ndarray
    up: np.ndarray
    base: np.ndarray


def waves_of(layers, h, pressure, radius, least, tractions):
    """Two :class:`OctaveWaves` of the loads `tractions`, for radii up to `radius` and depths from `least` h on: the
    waves that count everywhere, and the short ones that count only next to the edge, None if there are none."""
    octave = 2.0 ** np.floor(np.log2(h.min()))
    first = FIRST * min(1.0, 0.5 / octave) / max(1.0, layers.n.max())
    long, short = rules_of(pressure, first, END / (least * octave), radius)
    return _waves(layers, h, *long, tractions), short and _waves(layers, h, *short, tractions)


def rules_of(pressure, first, last, radius):
    """k (K,), p and f of :class:`OctaveWaves` from `first` to `last`: of the waves that are felt everywhere, and of the
    short ones next to the edge, None if there are none."""
    split = last > 1.2 * edge_waves.LAST and edge_waves.have_edge_waves(pressure.mesh)
    first = min(first, _RADIANS / (1 + radius))
    k, weight = quadrature(first, edge_waves.LAST if split else min(last, SHORTEST), 1 + radius, _RADIANS)
    p = edge_waves.transform(pressure, k) * (k * weight * (edge_waves.longer(k) if split else 1.0))
    long = k, p, None
    if not split:
        return long, None
    panels = int(np.ceil(np.log(last / edge_waves.LEAST) / np.log1p(_SHARE)))
    ends = edge_waves.LEAST * (last / edge_waves.LEAST) ** (np.arange(panels + 1) / panels)
    t, w = gauss_legendre(20)
    k, weight = (ends[:-1, None] + np.diff(ends)[:, None] * t).ravel(), (np.diff(ends)[:, None] * w).ravel()
    p = np.tile(k * weight, (len(pressure.values), 1))
    return long, (k, p, edge_waves.of_edge(pressure, k))


def _waves(layers, h, k, p, f, tractions):
    bodies = Bodies(*(np.broadcast_to(v, len(h))[:, None] for v in Bodies.of(layers)))
    thin = int((np.sqrt(h.min() * h.max()) * k < THIN).sum())
    return OctaveWaves(bodies, h, k, thin, p, f, {load: _constants(bodies, h, k, thin, p, load) for load in tractions})


def _constants(bodies, h, k, thin, p, load):
    X, low, high = k * h[:, None], slice(None, thin), slice(thin, None)
    surface = np.stack(np.broadcast_arrays(*thin_surface(bodies, X[:, low], *load))) * p[:, low]
    down, up = (np.stack(v) for v in thick_waves(bodies, X[:, high], *load))
    whole, nu = (down + np.array(load)[:, None, None]) * p[:, high], bodies.nu1
    thin = state_below(X[:, low], nu, surface)[2:]
    thick = zip(decaying(X[:, high], nu, *whole), growing(0.0, nu, *(up * p[:, high])), strict=True)
    thick = [falls + rises for falls, rises in thick][2:]
    S, T = (np.concatenate(parts, axis=1) for parts in zip(thin, thick, strict=True))
    return _Constants(surface, whole, down * p[:, high], up * p[:, high], np.stack([S, np.where(bodies.bonded, T, 0)]))


def sums(waves, integrands, load, orders, kind, case, r, z):
    """The integrals over k for a load and their derivatives, (JET, fields, P), at the points r, z (P,) of the cases
    `case` (P,).

    waves : :class:`OctaveWaves`, or :class:`~.stack_points.StackPoints`
    integrands : ``integrands(v, nu, Q, across)`` returns the integrands, linear in the state v and the pair Q, across
    orders : of the Bessel function of each integrand
    kind : where all points are: :class:`~solver.kernels.transfer.StatePart`, or in which region of the stack
    """
    reach = waves.reach(kind, case, z)
    ends, most = np.searchsorted(waves.k, END / reach), _AT_ONCE
    of_some = _of_some
    if sums_core() and integrands in (of_normal, of_sliding):
        of_some, most = _in_c, np.inf if isinstance(waves, OctaveWaves) else _AT_ONCE
    integrals = np.empty((JET, len(orders), len(r)))
    order, start = np.argsort(-reach), 0
    while start < len(order):
        stop = start + 1
        while stop < len(order) and (stop + 1 - start) * ends[order[stop]] <= most:
            stop += 1
        some = order[start:stop]
        integrals[..., some] = of_some(waves, integrands, load, orders, kind, case[some], r[some], z[some], ends[some])
        start = stop
    return integrals


def _in_c(waves, integrands, load, orders, kind, case, r, z, ends):
    """As :func:`_of_some`, by the compiled core."""
    end = int(ends.max())
    numbers, arrays = waves.constants(load, kind, case, z, end)
    nu = np.broadcast_to(waves.poisson(kind, case)[:, 0], len(r))
    arrays |= {"orders": orders, "cases": case, "ends": ends, "r": r, "z": z, "nu": nu, "k": waves.k}
    if waves.f is not None:
        octave, which = np.unique(edge_waves.last_octave(r), return_inverse=True)
        arrays |= {"f": waves.f, "windows": edge_waves.shorter(waves.k[:end], octave), "window": which}
    return sums_in_c(numbers | {"columns": end}, arrays)


def _of_some(waves, integrands, load, orders, kind, case, r, z, ends):
    end = int(ends.max())
    k, nu = waves.k[:end], waves.poisson(kind, case)
    v, Q, across = waves.state(load, kind, case, z, end)
    first = [k * values for values in derivative(v, nu)]
    second = [k * values for values in derivative(first, nu)]
    antiplane = (Q, across), (k * across / 2, 2 * k * Q), (k * k * Q, k * k * across)
    rows = [integrands(state, nu, *pair) for state, pair in zip((v, first, second), antiplane, strict=True)]
    if waves.f is None:
        J = _bessels(k, r, max(orders))
    else:
        octave, which = np.unique(edge_waves.last_octave(r), return_inverse=True)
        window = edge_waves.shorter(k, octave)[which]
        J = edge_waves.bessels(k, r, waves.f[case, :end] * window, max(orders))
    slopes = {m: _slopes(J, m, k) for m in set(orders)}
    integrals = np.empty((JET, len(orders), len(r)))
    for i, m in enumerate(orders):
        f, down, twice = (row[i] for row in rows)
        across, bent = slopes[m]
        pairs = (f, J[m]), (f, across), (down, J[m]), (f, bent), (down, across), (twice, J[m])
        for j, (values, wave) in enumerate(pairs):
            integrals[j, i] = np.einsum("pk,pk->p", values, wave)
    return integrals


def _slopes(J, m, k):
    """First and second derivatives by r of J_m(kr)."""
    first = J[1] * -k if m == 0 else (J[m - 1] - J[m + 1]) * (k / 2)
    return first, ((J[2] if m == 0 else -J[1] if m == 1 else J[m - 2]) + J[m + 2] - 2 * J[m]) * (k * k / 4)


def _bessels(k, r, most):
    """J_m(kr) (P, K), a list over m from 0 to `most` + 2."""
    x = r[:, None] * k
    small, inverse = np.nonzero(x < _SMALL), 2 / np.maximum(x, _SMALL)
    J, few = [special.j0(x), special.j1(x)], x[small]
    for m in range(1, most + 2):
        values = m * inverse * J[m] - J[m - 1]
        values[small] = _series(m + 1, few)
        J.append(values)
    return J


def _series(m, x):
    """J_m(x) for x < _SMALL."""
    square, term, total = -((x / 2) ** 2), (x / 2) ** m / np.prod(np.arange(1.0, m + 1)), 0.0
    for j in range(1, _TERMS + 1):
        total = total + term
        term = term * square / (j * (j + m))
    return total


def of_normal(v, nu, Q, across):
    """Integrands of :data:`~..normal.NORMAL`."""
    u, _, S, T = v
    return radial_sum(v, nu), -u, S, T


def of_sliding(v, nu, Q, across):
    """Integrands of :data:`~..sliding.SLIDING`."""
    u, _, S, T = v
    return radial_sum(v, nu), u + across, across - u, S, T + Q, T - Q
