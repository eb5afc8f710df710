"""Graded layers as many uniform ones."""

import numpy as np

#: The thinnest sublayer of a graded layer at the surface begins this many octaves above its bottom.
_OCTAVES = 8
#: Sublayers where nothing says how many.
_USUAL = 16


def refined(layers, sublayers):
    """The `layers` of :func:`.stacked.layers_of` with each that is graded in some case cut into uniform ones, of the
    modulus in their middle. sublayers : (B,), one number for all cases.

    At the surface they are the thinner the nearer they are to it: as many in each octave of the depth. Short waves then
    find the gradient as well resolved as long ones.
    """
    graded = (layers["profile"] != "uniform").any(axis=0)
    if not graded.any():
        return layers
    pieces = [
        _cut(layers, j, int(sublayers[0]) or _USUAL) if graded[j] else _as_it_is(layers, j) for j in range(len(graded))
    ]
    return {name: np.concatenate([piece[name] for piece in pieces], axis=1) for name in pieces[0]}


def _as_it_is(layers, j):
    return {name: layers[name][:, j : j + 1] for name in ("h", "n", "nu", "bonding", "cn", "ct")}


def _cut(layers, j, count):
    """Layer j as uniform ones."""
    ends = cuts(count, at_surface=j == 0)
    middle, part = (ends[1:] + ends[:-1]) / 2, _as_it_is(layers, j)
    n, nu = (
        _along(layers["profile"][:, j : j + 1], part[v], layers[f"{v}_bottom"][:, j : j + 1], middle)
        for v in ("n", "nu")
    )
    last = np.arange(len(middle)) == len(middle) - 1
    bonding = np.where(last, part["bonding"], "bonded")
    return {"h": part["h"] * np.diff(ends), "n": n, "nu": nu, "bonding": bonding} | {
        name: np.where(last, part[name], 0.0) for name in ("cn", "ct")
    }


def cuts(count, at_surface):
    """The ends (N + 1,) of the sublayers, over the thickness: of `count` equal ones; at the surface of `count` in each
    octave, and as many in what is left above."""
    if not at_surface:
        return np.linspace(0.0, 1.0, count + 1)
    first = 2.0**-_OCTAVES
    return np.append(np.linspace(0.0, first, count + 1)[:-1], np.geomspace(first, 1.0, _OCTAVES * count + 1))


def _along(profile, top, bottom, z):
    """Values at depths z over the thickness."""
    bottom = np.where(np.isnan(bottom), top, bottom)
    linear = top + (bottom - top) * z
    exponential = top * (np.where(bottom > 0, bottom, 1.0) / np.where(top > 0, top, 1.0)) ** z
    return np.where(
        profile == "uniform", top, np.where((profile == "exponential") & (top > 0) & (bottom > 0), exponential, linear)
    )
