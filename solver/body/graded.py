"""Graded layers as many uniform ones."""

import numpy as np

from ..bases import is_exact_stack
from ..layers import full_name, numbers_of

#: Number of octaves of the depth over which the sublayers become thinner towards the top: in a graded layer at the
#: surface, which feels waves of all lengths, and in a deeper one.
_OCTAVES, _DEEPER = 8, 4
#: A linear profile is cut like any other where ln n changes by less than _EVEN. _HALVINGS bisections give a depth to
#: rounding.
_EVEN, _HALVINGS = 0.1, 60
#: Number of sublayers in an octave where the case does not give it.
_USUAL = 16


def is_graded(problem):
    """(B,) bool: the cases of an exact stack with a graded layer whose number of sublayers is left to the program."""
    if not numbers_of(problem.parameters):
        return np.zeros(len(problem), dtype=bool)
    numbers = range(1, numbers_of(problem.parameters) + 1)
    graded = np.any([getattr(problem, full_name(i, "profile")) != "uniform" for i in numbers], axis=0)
    return graded & is_exact_stack(problem.base) & (problem.sublayers == 0)


def graded_first(problem):
    """(B,) bool: the cases of an exact stack whose first layer is graded."""
    if not numbers_of(problem.parameters):
        return np.zeros(len(problem), dtype=bool)
    return (getattr(problem, full_name(1, "profile")) != "uniform") & is_exact_stack(problem.base)


def contrast(problem):
    """(B,): logarithm of the largest over the smallest modulus within the first layer; 0 if it is uniform."""
    logs = np.zeros(len(problem))
    index = np.flatnonzero(graded_first(problem))
    if len(index):
        part = problem.take(index)
        word, bottom = getattr(part, full_name(1, "profile")), getattr(part, full_name(1, "n_bottom"))
        logs[index] = np.abs(np.log(np.where(np.isnan(bottom), 1.0, bottom / (part.n + (part.n == 0)))))
        tables = problem.known.profiles
        for name in set(word.tolist()) & set(tables):
            logs[index[word == name]] = np.log(tables[name].n.max() / tables[name].n.min())
    return logs


def refined(layers, sublayers, tables, octaves=_OCTAVES):
    """The `layers` of :func:`.stacked.layers_of`, in which each layer that is graded in some case is cut into uniform
    sublayers. Each has the modulus in its middle.

    sublayers : (B,), number of sublayers in an octave of the depth, the same for all cases
    tables : word -> table of a profile
    octaves : number of octaves in the first layer

    The sublayers are thinner towards the top of the layer, with equally many in each octave of the depth: so the
    gradient is as well resolved for short waves as for long ones.
    """
    graded = graded_among(layers)
    if not graded.any():
        return layers
    count = int(sublayers[0]) or _USUAL
    pieces = [
        _cut(layers, j, count, _DEEPER if j else octaves, tables) if graded[j] else _as_it_is(layers, j)
        for j in range(len(graded))
    ]
    return {name: np.concatenate([piece[name] for piece in pieces], axis=1) for name in pieces[0]}


def graded_among(layers):
    """(N,) bool: the `layers` of :func:`.stacked.layers_of` that are graded in some case."""
    return (layers["profile"] != "uniform").any(axis=0)


def sublayers_of(layers, sublayers, octaves=_OCTAVES):
    """(N,) int: number of sublayers into which :func:`refined` cuts each layer, 1 for a uniform one; arguments as
    there."""
    count = int(sublayers[0]) or _USUAL
    deep = np.array([octaves] + [_DEEPER] * (len(layers["h"][0]) - 1))
    return np.where(graded_among(layers), count * (deep + 1), 1)


def at_depths(layers, j, z, tables):
    """E_j*/E2* and the Poisson ratio (B, Z) of layer j, counted from 0, at depths z (B, Z) over its thickness. The
    profile is continuous, not cut into sublayers."""
    part, profile, bottoms = _ends_of(layers, j)
    return _moduli(profile, part["n"], bottoms["n"], z, tables), _linear(part, bottoms, "nu", z)


def _ends_of(layers, j):
    """Three parts of layer j: its numbers at the top, its profile, and its modulus and Poisson ratio at the bottom."""
    part, profile = _as_it_is(layers, j), layers["profile"][:, j : j + 1]
    bottoms = {name: layers[f"{name}_bottom"][:, j : j + 1] for name in ("n", "nu")}
    return (
        part,
        profile,
        {name: np.where(np.isnan(v) | (profile == "uniform"), part[name], v) for name, v in bottoms.items()},
    )


def _as_it_is(layers, j):
    return {name: layers[name][:, j : j + 1] for name in ("h", "n", "nu", "bonding", "cn", "ct")}


def _cut(layers, j, count, octaves, tables):
    """Layer j, cut into uniform sublayers."""
    part, profile, bottoms = _ends_of(layers, j)
    ends = _depths(profile, part["n"], bottoms["n"], cuts(count, octaves))
    middle, last = (ends[:, 1:] + ends[:, :-1]) / 2, np.arange(ends.shape[1] - 1) == ends.shape[1] - 2
    n = _moduli(profile, part["n"], bottoms["n"], middle, tables)
    sublayers = {"h": part["h"] * np.diff(ends, axis=1), "n": n, "nu": _linear(part, bottoms, "nu", middle)}
    springs = {name: np.where(last, part[name], 0.0) for name in ("cn", "ct")}
    return sublayers | springs | {"bonding": np.where(last, part["bonding"], "bonded")}


def _moduli(profile, top, bottom, z, tables):
    """E*/E2* (B, N) at depths z over the thickness. A table is scaled so that its first modulus is `top`."""
    n = np.where(profile == "exponential", top * (bottom / top) ** z, top + (bottom - top) * z)
    for word in set(profile.ravel().tolist()) & set(tables):
        rows, table = profile[:, 0] == word, tables[word]
        n[rows] = top[rows] * np.interp(z[rows], table.z, table.n) / table.n[0]
    return n


def _linear(part, bottoms, name, z):
    return part[name] + (bottoms[name] - part[name]) * z


def _depths(profile, top, bottom, ends):
    """The ends (B, N + 1) of the sublayers over the thickness. In a linear profile they are not `ends` of the depth
    itself: they are `ends` of the mean of the depth and of the relative change of ln n. So n changes by a small part of
    itself in each sublayer, even where n is small."""
    ratio = np.log(bottom / top)
    uneven = np.flatnonzero((profile[:, 0] == "linear") & (np.abs(ratio[:, 0]) > _EVEN))
    depths = np.repeat(ends[None], len(top), axis=0)
    if len(uneven):
        ratio = ratio[uneven]
        low, high = np.zeros((2, len(uneven), len(ends)))
        high += 1.0
        for _ in range(_HALVINGS):
            z = (low + high) / 2
            below = (z + np.log1p(np.expm1(ratio) * z) / ratio) / 2 < ends
            low, high = np.where(below, z, low), np.where(below, high, z)
        depths[uneven] = np.where((ends == 0) | (ends == 1), ends, (low + high) / 2)
    return depths


def cuts(count, octaves):
    """The ends (N + 1,) of sublayers over the thickness: `count` in each octave of the depth, and as many above them,
    in the rest next to the surface."""
    first = 2.0**-octaves
    return np.append(np.linspace(0.0, first, count + 1)[:-1], np.geomspace(first, 1.0, octaves * count + 1))
