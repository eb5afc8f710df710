"""Integrals over the waves k in the layer and in the body: docs/stress_fields.md, Waves.

Each row is a depth. In the first layer it has either the whole field or its difference from that of a half-space of the
layer's material. The rows of one region are computed together, and each ends at its own largest k.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..numerics import special
from ..numerics.caches import Cache
from ..numerics.quadrature import gauss_legendre
from .points import edge_waves

#: A panel of _POINTS Gauss points covers at most _RADIANS of the phase of p^ J_m. It is no longer than its distance
#: from 0, over which the state is smooth however stiff the layer is. With half of the radians no stress changes by more
#: than 1e-15 of the largest.
_POINTS, _RADIANS = 20, 20.0
#: The first panel ends at this times min(1/a, 1/h). Stiff layers, which bend over n times that length, have n times
#: less.
_FIRST = 1e-4
#: The integral for a field that decays like e^(-kz) ends at k = _END/z.
_END = 36.0
#: It ends at SHORTEST at the latest: so many waves take some seconds. In films with h below THINNEST a stress near the
#: edge is then wrong by up to MISSED times the largest, farther away by far less (tests/fields/test_of_pressure.py).
SHORTEST, MISSED = 1.5e5, 1e-3
#: Largest number of nodes k of an integral, about, which take some seconds. The number grows with the radius.
_MOST = 1e6
#: Largest radius, in a: squares of larger radii overflow.
_FARTHEST = 1e9
#: These replace _FIRST, _END, SHORTEST and _RADIANS if an error of some percent is allowed, in stresses alone. Panels
#: twice as long change stresses by 1e-10 where the last wave is the same (tests/yields/test_largest_stresses.py).
#: Elsewhere the rule ends at another wave, which changed those of 60 random bodies by up to 1e-3: less than their error
#: of up to 5e-2.
_ROUGH_FIRST, _ROUGH_END, _ROUGH_SHORTEST, _ROUGH_RADIANS = 0.1, 8.0, 2e3, 40.0
THINNEST = _END / SHORTEST
#: The ends of rules and the reach of their panels are rounded up to whole numbers of 1/_OF_OCTAVE octave.
_OF_OCTAVE = 3
#: Below _SMALL, J3 is a series of _TERMS terms: computed from J1 and J2 it loses digits.
_SMALL, _TERMS = 3.0, 14
#: Largest number of entries of an array of states, which limits the number of waves at a time.
_AT_ONCE = 200_000
#: Bessel functions of coarse grids, which bodies of one octave of h/a share. They are half of the time of such grids.
_bessel = Cache(3e7)


class Load(NamedTuple):
    """A kind of load on the surface, normal or tangential, and the integrals that make its field.

    traction : (S, T) of its unit wave
    orders : order of the Bessel function in each integral. The first `stresses` integrals have a factor k; the others,
        if any, make the displacements
    amplitudes : ``amplitudes(waves, row, z)`` returns the remaining factor of each integrand, except p^, from the
        :class:`~solver.kernels.transfer.Waves` at depths z (B, Z) of the same kind as the :class:`Row`
    in_closed_form : ``in_closed_form(pressure, r, z, nu, displacements)`` returns the integrals (fields, B, Z, R) for
        half-spaces, all of them or only those of stresses
    """

    traction: tuple
    orders: tuple
    stresses: int
    amplitudes: Callable
    in_closed_form: Callable

    def of_stresses(self):
        """The load without displacements, which take the most time on the surface."""
        return self._replace(orders=self.orders[: self.stresses])


class Row(NamedTuple):
    """Depths z (B,), in a, of B cases in a region; 0 is the first layer. `less`: less the field of a half-space of the
    first layer's material."""

    region: int
    less: bool
    z: np.ndarray

    def reach(self, h):
        """The distance (B,) over which the waves have decayed."""
        return 2 * h - self.z if self.less else self.z


def farthest(h):
    """The largest radius, in a, at which fields are computed, for layers of the thickness h in a; it has the shape of
    h. h = inf stands for a half-space, whose field is a closed form there."""
    return np.minimum(_MOST * np.maximum(h / _END, 1 / SHORTEST) - 1, _FARTHEST)


def quadrature(first, last, reach, radians=_RADIANS):
    """Nodes k and weights (K,) from 0 to `last`. The first panel ends at `first`; further panels are as long as their
    distance from 0, up to radians/reach. All three arguments are rounded, so that many points and cases share a
    rule."""
    first, last, reach = 2.0 ** np.floor(np.log2(first)), _above(last), _above(reach)
    widest = radians / reach
    doubling = first * 2.0 ** np.arange(max(np.ceil(np.log2(min(widest, last) / first)), 0) + 1)
    rest = np.arange(doubling[-1], last, widest)[1:] if doubling[-1] < last else []
    ends = np.concatenate([[0.0], doubling, rest, [last] if last > doubling[-1] else []])
    t, weight = gauss_legendre(_POINTS)
    width = np.diff(ends)[:, None]
    return (ends[:-1, None] + width * t).ravel(), (width * weight).ravel()


def _above(value):
    return 2.0 ** (np.ceil(np.log2(value) * _OF_OCTAVE) / _OF_OCTAVE)


def integrals(load, layers, h, pressure, r, rows, roughly=False):
    """The integrals of a :class:`Load`, (fields, B, Z, R), at the `rows` (Z) and radii r (R,).

    layers : :class:`~solver.kernels.transfer.Layered` of B cases
    h : (B,), thickness of the first layer in a. No layer's thickness may differ between cases by a factor of 2 or more
    roughly : whether an error of some percent is allowed
    """
    rough = _ROUGH_FIRST, _ROUGH_END, _ROUGH_SHORTEST, _ROUGH_RADIANS
    first, end, shortest, radians = rough if roughly else (_FIRST, _END, SHORTEST, _RADIANS)
    z = np.array([row.z for row in rows]).T
    last = np.minimum(end / np.array([row.reach(h) for row in rows]).min(axis=1), shortest)
    reach = 1 + r.max()
    k, weight = quadrature(min(first / layers.longest(h), radians / reach), last.max(), reach, radians)
    kinds = dict.fromkeys(row[:2] for row in rows)
    p = ((edge_waves.transform(pressure, k) if roughly else pressure.transform(k)) * weight)[:, None]
    whole, most = np.zeros((len(load.orders), len(h), len(rows), len(r))), max(load.orders)
    values_of = _bessel.get((k.tobytes(), r.tobytes(), most), lambda: bessel(k, r, most)) if roughly else None
    for part in _parts(layers.few(k, h), len(k), z.size):
        J = [values[part] for values in values_of] if roughly else bessel(k[part], r, most)
        waves = layers.waves(k[part], h, load.traction)
        for kind in kinds:
            index = np.array(
                [i for i, row in enumerate(rows) if row[:2] == kind and last[i] > k[part.start]], dtype=int
            )
            if len(index):
                amplitudes = load.amplitudes(waves, rows[index[0]], z[:, index])
                for i, order in enumerate(load.orders):
                    weights = p[..., part] * k[part] if i < load.stresses else p[..., part]
                    whole[i][:, index] += (amplitudes[i] * weights) @ J[order]
    return whole


def _parts(few, count, rows):
    """Slices of `count` nodes; the first `few` nodes are in slices of their own."""
    size = max(_AT_ONCE // rows // _POINTS * _POINTS, _POINTS)
    starts = [*range(0, few, size), *range(few, count, size)]
    return [slice(*ends) for ends in zip(starts, [*starts[1:], count], strict=True)]


def bessel(k, r, most):
    """J_m(k r), (K, R) each, for m from 0 to `most`, which is 2 or 3; the absolute error is 1e-15."""
    x = k[:, None] * r
    away = np.where(x > 0, x, 1.0)
    J = [special.j0(x), special.j1(x)]
    J.append(2 * J[1] / away - J[0] * (x > 0))
    return (
        J if most == 2 else [*J, np.where(x < _SMALL, _series_of_third(np.minimum(x, _SMALL)), 4 * J[2] / away - J[1])]
    )


def _series_of_third(x):
    """J3(x) for x below _SMALL."""
    square, term, total = -((x / 2) ** 2), (x / 2) ** 3 / 6, 0.0
    for j in range(1, _TERMS + 1):
        total = total + term
        term = term * square / (j * (j + 3))
    return total
