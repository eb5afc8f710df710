"""Integrals over the waves k of the layer and of the body: docs/stresses.md, Waves.

Each row is a depth. In the first layer it is all of the field or its difference to that of a half-space of the layer's
material. The rows of one region go together, and each ends at its own largest k.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..numerics import special
from ..numerics.kept import Kept
from ..numerics.quadrature import gauss_legendre

#: A panel of _POINTS Gauss points holds at most so many radians of p^ J_m, and is no longer than its distance from 0,
#: over which the state is smooth however stiff the layer is. Half of the radians change no stress by more than 1e-15 of
#: the largest.
_POINTS, _RADIANS = 20, 20.0
#: The first panel ends at this times min(1/a, 1/h), over n of stiff layers, which bend over 1/n of that.
FIRST = 1e-4
#: A field that decays like e^(-kz) ends at k = _END/z.
_END = 36.0
#: But no later than at SHORTEST, whose waves take some seconds: in thinner films, h below THINNEST, a stress next to
#: the edge is wrong by up to MISSED of the largest, and farther away by far less (tests/fields/test_of_pressure.py).
SHORTEST, MISSED = 1.5e5, 1e-3
#: So many waves take some seconds; the farther away a radius is the more it takes.
_MOST = 1e6
#: No radius is looked at beyond this, in a: squares of larger ones overflow.
_FARTHEST = 1e9
#: Where some percent do, these are the ends.
_ROUGH_END, _ROUGH_SHORTEST = 8.0, 2e3
THINNEST = _END / SHORTEST
#: The ends of rules and the reach of their panels are rounded up to such parts of an octave.
_OF_OCTAVE = 3
#: Below _SMALL, J3 is a series of _TERMS terms: from J1 and J2 it loses digits.
_SMALL, _TERMS = 3.0, 14
#: Numbers in an array of states: so many waves are taken at once.
_AT_ONCE = 200_000
#: Bessel functions of coarse grids, which bodies of one octave of h/a share: half of their time.
_kept = Kept(3e7)


class Load(NamedTuple):
    """What presses or rubs on the surface, and which integrals make its field.

    traction : (S, T) of its unit wave
    orders : of the Bessel function of each integral; the first `stresses` of them have a factor k, the rest, if there,
        makes the displacements
    amplitudes : ``amplitudes(waves, row, z)``, the other factor of each integrand, but for p^, from the
        :class:`~solver.kernels.transfer.Waves` at depths z (B, Z) alike the :class:`Row`
    in_closed_form : ``in_closed_form(pressure, r, z, nu, displacements)``, the integrals of half-spaces (fields, B, Z,
        R), all or those of stresses
    """

    traction: tuple
    orders: tuple
    stresses: int
    amplitudes: Callable
    in_closed_form: Callable

    def of_stresses(self):
        """The same without displacements, which take the most time on the surface."""
        return self._replace(orders=self.orders[: self.stresses])


class Row(NamedTuple):
    """Depths z (B,) in a of B cases in a region, 0 the first layer; `less` the field of a half-space of that layer."""

    region: int
    less: bool
    z: np.ndarray

    def reach(self, h):
        """How far from the source the waves are, (B,)."""
        return 2 * h - self.z if self.less else self.z


def farthest(h):
    """The largest radius in a at which fields are computed, of layers of the thickness h in a; h = inf: of a
    half-space, which is a closed form there. Shape of h."""
    return np.minimum(_MOST * np.maximum(h / _END, 1 / SHORTEST) - 1, _FARTHEST)


def quadrature(first, last, reach, radians=_RADIANS):
    """Nodes k and weights (K,) from 0 to `last`: the first panel ends at `first`, further ones are as long as their
    distance from 0 until that is radians/reach. All three are rounded, so that many points and cases have one rule."""
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
    """The integrals of a :class:`Load` at the `rows` (Z) and radii r (R,): (fields, B, Z, R).

    layers : :class:`~solver.kernels.transfer.Layered` of B cases; h : (B,), thickness of the first in a. No two of a
    layer are as different as 1 and 2
    roughly : some percent do
    """
    end, shortest = (_ROUGH_END, _ROUGH_SHORTEST) if roughly else (_END, SHORTEST)
    z = np.array([row.z for row in rows]).T
    last = np.minimum(end / np.array([row.reach(h) for row in rows]).min(axis=1), shortest)
    k, weight = quadrature(FIRST / layers.longest(h), last.max(), 1 + r.max())
    kinds = dict.fromkeys(row[:2] for row in rows)
    p = (pressure.transform(k) * weight)[:, None]
    whole, most = np.zeros((len(load.orders), len(h), len(rows), len(r))), max(load.orders)
    kept = _kept.get((k.tobytes(), r.tobytes(), most), lambda: bessel(k, r, most)) if roughly else None
    for part in _parts(layers.few(k, h), len(k), z.size):
        J = [values[part] for values in kept] if roughly else bessel(k[part], r, most)
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
    """Slices of `count` nodes, the `few` first of which are by themselves."""
    size = max(_AT_ONCE // rows // _POINTS * _POINTS, _POINTS)
    starts = [*range(0, few, size), *range(few, count, size)]
    return [slice(*ends) for ends in zip(starts, [*starts[1:], count], strict=True)]


def bessel(k, r, most):
    """J_m (K, R) of k r, m from 0 to `most`, 2 or 3; right to 1e-15 absolutely."""
    x = k[:, None] * r
    away = np.where(x > 0, x, 1.0)
    J = [special.j0(x), special.j1(x)]
    J.append(2 * J[1] / away - J[0] * (x > 0))
    return (
        J if most == 2 else [*J, np.where(x < _SMALL, _series_of_third(np.minimum(x, _SMALL)), 4 * J[2] / away - J[1])]
    )


def _series_of_third(x):
    """J3 below _SMALL."""
    square, term, total = -((x / 2) ** 2), (x / 2) ** 3 / 6, 0.0
    for j in range(1, _TERMS + 1):
        total = total + term
        term = term * square / (j * (j + 3))
    return total
