"""Graded layers as many uniform ones."""

import numpy as np

from ..bases import is_exact_stack
from ..layers import full_name, numbers_of

#: The sublayers are thinner and thinner over this many octaves of the depth: in a graded layer at the surface, which
#: waves of all lengths feel, and in a deeper one.
_OCTAVES, _DEEPER = 8, 4
#: A linear profile is not uneven where ln n changes by less than this; bisections that find a depth to rounding.
_EVEN, _HALVINGS = 0.1, 60
#: Sublayers where nothing says how many.
_USUAL = 16


def is_graded(problem):
    """(B,) bool: the cases with a graded layer, of which the number of sublayers is not given."""
    if not numbers_of(problem.parameters):
        return np.zeros(len(problem), dtype=bool)
    numbers = range(1, numbers_of(problem.parameters) + 1)
    graded = np.any([getattr(problem, full_name(i, "profile")) != "uniform" for i in numbers], axis=0)
    return graded & is_exact_stack(problem.base) & (problem.sublayers == 0)


def graded_first(problem):
    """(B,) bool: the stacks whose first layer is graded."""
    if not numbers_of(problem.parameters):
        return np.zeros(len(problem), dtype=bool)
    return (getattr(problem, full_name(1, "profile")) != "uniform") & is_exact_stack(problem.base)


def contrast(problem):
    """(B,): logarithm of the largest over the smallest modulus within the first layer; 0 of a uniform one."""
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
    """The `layers` of :func:`.stacked.layers_of` with each that is graded in some case cut into uniform ones, of the
    modulus in their middle. sublayers : (B,), one number for all cases; tables : word -> table of a profile; octaves :
    of the first layer.

    They are the thinner the nearer they are to the top of the layer, as many in each octave of the depth: short waves
    then find the gradient as well resolved as long ones.
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
    """(N,) bool: which of the `layers` of :func:`.stacked.layers_of` are graded in some case."""
    return (layers["profile"] != "uniform").any(axis=0)


def sublayers_of(layers, sublayers, octaves=_OCTAVES):
    """(N,) int: into how many uniform layers :func:`refined` cuts each; arguments as there."""
    count = int(sublayers[0]) or _USUAL
    deep = np.array([octaves] + [_DEEPER] * (len(layers["h"][0]) - 1))
    return np.where(graded_among(layers), count * (deep + 1), 1)


def at_depths(layers, j, z, tables):
    """E_j*/E2* and the Poisson ratio (B, Z) of layer j, from 0, at depths z (B, Z) over its thickness, without cuts."""
    part, profile, bottoms = _ends_of(layers, j)
    return _moduli(profile, part["n"], bottoms["n"], z, tables), _linear(part, bottoms, "nu", z)


def _ends_of(layers, j):
    """Layer j as it is at its top, its profile, and its modulus and Poisson ratio at the bottom."""
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
    """Layer j as uniform ones."""
    part, profile, bottoms = _ends_of(layers, j)
    ends = _depths(profile, part["n"], bottoms["n"], cuts(count, octaves))
    middle, last = (ends[:, 1:] + ends[:, :-1]) / 2, np.arange(ends.shape[1] - 1) == ends.shape[1] - 2
    n = _moduli(profile, part["n"], bottoms["n"], middle, tables)
    sublayers = {"h": part["h"] * np.diff(ends, axis=1), "n": n, "nu": _linear(part, bottoms, "nu", middle)}
    springs = {name: np.where(last, part[name], 0.0) for name in ("cn", "ct")}
    return sublayers | springs | {"bonding": np.where(last, part["bonding"], "bonded")}


def _moduli(profile, top, bottom, z, tables):
    """E*/E2* (B, N) at depths z over the thickness. A table is taken over its first modulus."""
    n = np.where(profile == "exponential", top * (bottom / top) ** z, top + (bottom - top) * z)
    for word in set(profile.ravel().tolist()) & set(tables):
        rows, table = profile[:, 0] == word, tables[word]
        n[rows] = top[rows] * np.interp(z[rows], table.z, table.n) / table.n[0]
    return n


def _linear(part, bottoms, name, z):
    return part[name] + (bottoms[name] - part[name]) * z


def _depths(profile, top, bottom, ends):
    """The ends (B, N + 1) of the sublayers over the thickness. In a linear profile they divide the mean of the depth
    and of the change of ln n evenly: so n changes by a small part of itself in each sublayer, also where n is small."""
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
    """The ends (N + 1,) of sublayers over the thickness: `count` in each octave, and as many in the rest above."""
    first = 2.0**-octaves
    return np.append(np.linspace(0.0, first, count + 1)[:-1], np.geomspace(first, 1.0, octaves * count + 1))
