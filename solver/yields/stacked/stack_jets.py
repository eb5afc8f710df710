"""Stresses at points of one stack of layers, with their first and second derivatives, as :mod:`..search.jets`."""

import numpy as np

from ...fields.points.stack_points import stack_points
from ..search.jets import LEAST, NEAR, REACHES, along, loads_of, of_rules, of_surface, reach_of, stresses_of

#: By this part of its thickness depths differ by which the modulus of a graded layer is differentiated.
_STEP = 1e-4


class StackJets:
    """Of a :class:`~...fields.stacks.section.Section`; the waves are formed when a point first needs them."""

    def __init__(self, stacked):
        self.stacked, self._rules = stacked, {}
        self.loads = loads_of(stacked.mu)

    def __call__(self, region, case, side, root, u, v):
        """Jets (6, 4, P) at points of a region: the number of the layer, from 0, or of the body, and "inside" or
        "outside", which are on the surface, or another word.

        case : (P,), 0; side, root : (P,), on which side, and whether u is that of the surface next to the edge
        u, v : (P,)
        """
        stacked, (number, part) = self.stacked, region
        r = np.where(root, np.sqrt(np.maximum(1 - u * np.abs(u), 0.0)), u)
        on_top, outside = part in ("inside", "outside"), part == "outside"
        sublayers = stacked.region_of(v, np.full(len(v), number))
        near = on_top | ((sublayers == 0) & (v < NEAR * stacked.h[0]))
        nu, fields = stacked.stack.poisson[:, 0], {}
        for load in self.loads:
            whole = self._of_waves(load, sublayers, near, r, v)
            if on_top:
                whole = along(whole, r, u, root, outside)
                whole += of_surface(load, stacked.pressure, nu, case, u, root, outside)
            elif near.any():
                here = case[near], nu[case[near]], r[near], np.maximum(v[near], LEAST)
                whole[..., near] += load.in_closed_form(stacked.pressure, *here)
            fields |= load.fields(whole, stacked.mu)
        stresses = stresses_of(fields, stacked.mu, stacked.signs, side)
        if stacked.is_graded(number):
            stresses[:, :2] = _at_their_depth(stacked, stresses, number, sublayers, v)
        stresses[0, :2] += np.append(stacked.residual, 0.0)[number]
        return stresses

    def _of_waves(self, load, sublayers, near, r, v):
        whole, reach = np.zeros((6, len(load.orders), len(r))), reach_of(r)
        kinds = np.stack([reach, sublayers, near])
        for kind in np.unique(kinds, axis=1).T:
            some = np.flatnonzero((kinds == kind[:, None]).all(axis=0))
            far, number, less = kind.tolist()
            here = (number, bool(less)), np.zeros(len(some), dtype=int), r[some], v[some]
            whole[..., some] += of_rules(self._reaching(far), load, *here)
        return whole

    def _reaching(self, far):
        if far not in self._rules:
            stacked = self.stacked
            tractions = [load.traction for load in self.loads]
            reach = REACHES[far] - 1
            self._rules[far] = stack_points(stacked.stack, stacked.h, stacked.pressure, reach, NEAR, tractions)
        return self._rules[far]


def _at_their_depth(stacked, jets, number, sublayers, z):
    """The jets (6, 2, P) of sr and st in a graded layer, from those (6, 4, P) of its sublayers."""
    tops = np.append(0.0, stacked.ends)
    least, most = tops[number], tops[number + 1]
    step = _STEP * (most - least)
    middle = np.clip(z, least + step, most - step)
    low, here, high = (
        np.array(stacked.of_depth(number, sublayers, depth)) for depth in (middle - step, z, middle + step)
    )
    centre = np.array(stacked.of_depth(number, sublayers, middle))
    second = (high - 2 * centre + low) / step**2
    first = (high - low) / (2 * step) + second * (z - middle)
    sr, st, sz = jets[:, 0], jets[:, 1], jets[:, 2]
    of_total, of_axial, of_difference = (np.stack(factor) for factor in zip(here, first, second, strict=True))
    total = _times(of_total, sr + st) + _times(of_axial, sz)
    difference = _times(of_difference, sr - st)
    return np.stack([total + difference, total - difference], axis=1) / 2


def _times(factor, jets):
    """The jets (6, P) of a product with a function of the depth, with its derivatives, (3, P)."""
    value, first, second = factor
    f, by_u, by_v, uu, uv, vv = jets
    products = f, by_u, by_v, uu, uv, vv
    added = 0, 0, first * f, 0, first * by_u, 2 * first * by_v + second * f
    return np.stack([value * product + more for product, more in zip(products, added, strict=True)])
