"""Stresses at points of regions of loaded bodies, with their first and second derivatives: docs/stresses.md, Extremes.

A jet is an array (6, 4, P): sr, st, sz, trz at P points, and their derivatives by u, v, uu, uv, vv. v is the depth. u
is the radius r; along the surface next to the edge it is sqrt(1 - r²) inside of the contact and -sqrt(r² - 1) outside.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...fields import normal, sliding
from ...fields.half_space import on_surface
from ...fields.points import half_space_points
from ...fields.points.edge_waves import last_octave
from ...fields.points.wave_points import of_normal, of_sliding, sums, waves_of
from ...kernels.transfer import StatePart

#: Above the depth NEAR h the stresses of the half-space are taken in closed form and the waves add only the difference
#: of the layered body: their sums need fewer waves.
NEAR = 0.8
#: Least depth at which the closed form is evaluated below the surface: at smaller depths it loses all digits.
LEAST = 1e-12
#: Each rule of waves serves the points up to one of these values of 1 + r.
REACHES = np.append(2.0 ** np.array([1, 4 / 3]), 2.0 ** np.arange(2, 40))
#: Step of u in the differences that differentiate the closed forms on the surface.
_STEP = 1e-3


class JetLoad(NamedTuple):
    """What presses or rubs on the surface: `traction` (S, T) of its unit wave, `integrands` with the `orders` of their
    Bessel functions, the closed form of half-spaces, and the `components` of the stress from the integrals."""

    traction: tuple
    integrands: Callable
    orders: tuple
    in_closed_form: Callable
    components: Callable

    def fields(self, whole, mu):
        """Name -> jets (6, P) of the components of integrals (6, fields, P)."""
        factor = mu if self is _LOADS[1] else 1.0
        return {name: factor * values for name, values in self.components(np.swapaxes(whole, 0, 1)).items()}


_LOADS = (
    JetLoad((-1.0, 0.0), of_normal, normal.NORMAL.orders[:4], half_space_points.normal_below, normal.components),
    JetLoad((0.0, 1.0), of_sliding, sliding.SLIDING.orders[:6], half_space_points.sliding_below, sliding.components),
)


def loads_of(mu):
    """The :class:`JetLoad` s of contacts with this friction."""
    return _LOADS[: 1 + (mu > 0)]


def reach_of(r):
    """Which of :data:`REACHES` the waves of radii r (P,) have."""
    return np.searchsorted(REACHES, 1 + r)


def stresses_of(fields, mu, signs, side):
    """Jets (6, 4, P) of sr, st, sz, trz from those of the components, each on its side (P,)."""
    if mu > 0:
        sides = [sliding.in_plane(fields, sign < 0) for sign in signs]
        fields = {name: np.where(side == 0, sides[0][name], sides[1][name]) for name in sides[0]}
    return np.stack([fields[name] for name in ("sr", "st", "sz", "trz")], axis=1)


class Jets:
    """Jets of the cases of a :class:`~..loaded.Loaded`; a rule of waves is formed when a point first needs it."""

    def __init__(self, loaded):
        self.loaded, self._waves = loaded, {}
        self.loads = loads_of(loaded.mu)

    def __call__(self, region, case, side, root, u, v):
        """Jets (6, 4, P) at points of a region of :data:`~..extremes.EXTREMES`.

        case, side, root : (P,), the case, the side, and whether u is the coordinate of the surface next to the edge
        u, v : (P,)
        """
        loaded, body = self.loaded, region == "body" and not self.loaded.bare
        r = np.where(root, np.sqrt(np.maximum(1 - u * np.abs(u), 0.0)), u)
        on_top, outside = region in ("inside", "outside"), region == "outside"
        fields = {}
        for load in self.loads:
            whole = np.zeros((6, len(load.orders), len(r)))
            if not loaded.bare:
                whole += self._of_waves(load, on_top, body, case, r, v)
            if on_top:
                nu = loaded.layers.nu2 if loaded.bare else loaded.layers.nu1
                whole = along(whole, r, u, root, outside) + of_surface(
                    load, loaded.pressure, nu, case, u, root, outside
                )
            elif not body:
                near = np.ones(len(r), dtype=bool) if loaded.bare else self._is_near(case, v)
                if near.any():
                    here = case[near]
                    nu = (loaded.layers.nu1 if not loaded.bare else loaded.layers.nu2)[here]
                    whole[..., near] += load.in_closed_form(
                        loaded.pressure, here, nu, r[near], np.maximum(v[near], LEAST)
                    )
            fields |= load.fields(whole, loaded.mu)
        stresses = stresses_of(fields, loaded.mu, loaded.signs, side)
        if not body and not loaded.bare:
            stresses[0, :2] += loaded.residual[case]
        return stresses

    def _is_near(self, case, z):
        return z < NEAR * self.loaded.h[case]

    def _of_waves(self, load, on_top, body, case, r, v):
        whole = np.zeros((6, len(load.orders), len(r)))
        reach = reach_of(r)
        near = on_top | self._is_near(case, v)
        kinds = (
            np.full(len(r), int(StatePart.BODY))
            if body
            else np.where(near, int(StatePart.DIFFERENCE), int(StatePart.LAYER))
        )
        for far in np.unique(reach):
            rules = self._reaching(int(far))
            for kind in np.unique(kinds[reach == far]):
                some = np.flatnonzero((reach == far) & (kinds == kind))
                whole[..., some] += of_rules(rules, load, StatePart(kind), case[some], r[some], v[some])
        return whole

    def _reaching(self, far):
        if far not in self._waves:
            loaded = self.loaded
            self._waves[far] = waves_of(
                loaded.layers, loaded.h, loaded.pressure, REACHES[far] - 1, NEAR, [load.traction for load in self.loads]
            )
        return self._waves[far]


def of_rules(rules, load, kind, case, r, z):
    """The integrals (6, fields, P) of waves at points r, z (P,).

    rules : the waves that are felt everywhere, and the short ones next to the edge or None
    kind : of :func:`~...fields.points.wave_points.sums`
    """
    long, short = rules
    whole = sums(long, load.integrands, load.traction, load.orders, kind, case, r, z)
    some = np.flatnonzero(last_octave(r) >= 0) if short is not None else ()
    if len(some):
        whole[..., some] += sums(short, load.integrands, load.traction, load.orders, kind, case[some], r[some], z[some])
    return whole


def of_surface(load, pressure, nu, case, u, root, outside):
    """The closed form on the surface (6, fields, P) at u (P,), whose derivatives are differences.

    load : :class:`JetLoad`; pressure, nu : of the cases, and the Poisson ratios (B,) of what is touched
    """
    low, high = (-np.inf, 0.0) if outside else (0.0, 1.0)
    middle = np.clip(u, low + _STEP, high - _STEP)
    points = np.concatenate([u, middle - _STEP, middle, middle + _STEP])
    integrals = _on_surface(load, pressure, nu, np.tile(case, 4), points, np.tile(root, 4), outside)
    values, before, at, after = np.split(integrals, 4, axis=1)
    first, second = (after - before) / (2 * _STEP), (after - 2 * at + before) / _STEP**2
    none = np.zeros_like(values)
    return np.stack([values, first + second * (u - middle), none, second, none, none])


def _on_surface(load, pressure, nu, case, u, root, outside):
    """The integrals (fields, P) of half-spaces at the surface; at the edge, the limit from inside, or from
    `outside`."""
    r = np.where(root, np.sqrt(np.maximum(1 - u * np.abs(u), 0.0)), np.abs(u))
    nu, (p, mean) = nu[case], pressure.of_each(case, r)
    p = 0.0 * p if outside else p
    if load is _LOADS[0]:
        return np.stack([-(1 + 2 * nu) * p, (1 - 2 * nu) * (2 * mean - p), -p, 0 * p])
    first, third = np.empty((2, len(r)))
    for i in np.unique(case):
        here = np.flatnonzero(case == i)
        first[here], third[here] = on_surface(pressure.take([i]), r[here])[:, 0]
    parts = -2 * (1 + nu) * first, -2 * (2 - nu) * first, -2 * nu * third, 0 * p, 2 * p, 0 * p
    return np.stack(parts)


def along(whole, r, u, root, outside):
    """Change the derivatives by r into derivatives by u: where u is the `root`, r² is 1 - u² inside of the contact and
    1 + u² outside."""
    r, sign = np.where(root, np.maximum(r, _STEP), 1.0), 1.0 if outside else -1.0
    first, second = np.where(root, sign * u / r, 1.0), np.where(root, sign / r**3, 0.0)
    value, by_r, _, rr, _, _ = whole
    none = np.zeros_like(value)
    return np.stack([value, by_r * first, none, rr * first**2 + by_r * second, none, none])
