"""The key of a case and the digest of a study, made of the values that can change a number.

A value counts if its case uses the parameter (`needed_by`, `used_by` in the solver's table) and if it is not the
default. So keys and digests stay the same when a value that no case uses is edited, or when a parameter with a default
is added to the program. A case has the same key on another grid, in another order of the axes and in another run.

Whoever changes a default, or the way keys are made, must change NUMERICS_VERSION, which is in the digest and beside
every key. Otherwise the key of one case could find another case on disk.
"""

import hashlib
import json
from functools import partial

import numpy as np

from solver import NUMERICS_VERSION
from solver.laws import identity as law_identity
from solver.laws.own_table import OF_SCAN
from solver.numerics.profiles import identity as profile_identity
from solver.shapes.table import identity as shape_identity

from .grid import Grid, along
from .punch.micro_laws import stand_apart
from .vocabulary import CONTROLS

#: Strengths. Results are compared with them: no case depends on them, but the flags in a results file do.
STRENGTHS = ("Y1", "Y2", "Y_punch", "hardness", "yield_strength")
#: In the digests of studies with strengths, also those of named materials: raised when the masks of `validity` that
#: compare with strengths change.
_OF_STRENGTHS = "4"
#: In the keys of rough cases on layers thinner than the pitch: raised when only their numbers change.
_OF_CELLS = "asperities far apart on a layer, 2"
#: Stresses depend on these even where the contact does not, as on nu2 of a body on which the layer slides.
RATIOS = ("nu1", "nu2")
#: In the keys and digests of stored stresses: raised when the search for the largest ones finds others.
_OF_STRESSES = "5"
#: In the keys of cases that stick, or whose shape is not the paraboloid, beside NUMERICS_VERSION: raised when only
#: their numbers change.
_OF_SHAPES = "4"


def acts(grid: Grid, name: str) -> np.ndarray:
    """Whether the answer depends on a parameter: bool along the dimensions of the grid, some of them of length 1."""
    return grid.lexicon.known.uses(name, partial(along, grid))


def counts(grid: Grid, name: str) -> np.ndarray:
    """Whether the value of a parameter counts in a key: it acts, and is not the default. Shape as in `acts`."""
    value, default = along(grid, name), grid.lexicon.parameter(name).default
    changed = ~np.isnan(value) if default is None else value != default
    return changed & acts(grid, name)


def law_versions(grid: Grid) -> list[str]:
    """ "NAME VERSION" of each micro law in the grid that does not come with this package."""
    words = set(grid.values["micro"][1].ravel().tolist()) if "micro" in grid.values else ()
    laws = [grid.lexicon.known.laws[word] for word in words if word in grid.lexicon.known.laws]
    return sorted(law_identity(law) for law in laws if law.version)


def is_strength(name: str) -> bool:
    """Whether an input is a strength, such as "Y1" or "layers.2.Y": results are compared with it, none depends on
    it."""
    return name in STRENGTHS or name.startswith("layers.") and name.endswith(".Y")


def digest_of(definition) -> str:
    """sha256 over all that determines the results of a `Definition`: not title, comments or block size.

    The values of a dimension are always in it, since results are selected by them. Of the other parameters only the
    values that count are.
    """
    grid = definition.grid
    arrays = {**grid.labels, "x": (("x",), definition.x)}
    arrays |= {name: (dims, array) for name, (dims, array) in grid.values.items() if name in grid.sizes}
    parameters = grid.lexicon.parameters_of(grid.values)
    content = {
        "numerics_version": NUMERICS_VERSION,
        "sizes": list(grid.sizes.items()),
        "arrays": {name: (dims, digest_of_array(array)) for name, (dims, array) in arrays.items()},
        "values": {name: _digest_of_values(grid, name) for name in parameters if name not in grid.sizes},
        "profiles": definition.profiles,
        "dtype": definition.dtype,
    }
    content["values"] = {name: digests for name, digests in content["values"].items() if digests}
    content |= {"shapes": _OF_SHAPES} if {"shape", "w_adhesion"} & {*content["values"], *grid.sizes} else {}
    compared = [name for name in sorted(grid.values) if is_strength(name) and name not in grid.sizes]
    strengths = {name: digest_of_array(along(grid, name)) for name in compared}
    content |= {"strengths": strengths | {"masks": _OF_STRENGTHS}} if compared else {}
    content |= {"stresses": [_OF_STRESSES, *_digest_of_ratios(grid)]} if definition.stresses else {}
    content |= {"laws": law_versions(grid)} if law_versions(grid) else {}
    content |= {"cells": _OF_CELLS} if stand_apart(grid).any() else {}
    digest = hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
    if definition.scene is None:
        return digest
    # older results have no derivatives by inputs with their default values, and their ± leaves out those spreads
    at_default = [name for name in definition.inputs if name not in CONTROLS and not counts(grid, name).any()]
    return _digest_of_scene(digest, definition.scene, at_default)


def _digest_of_ratios(grid: Grid) -> list[str]:
    """Digests of the Poisson ratios, which always count for stresses."""
    return [digest_of_array(along(grid, name)) for name in RATIOS]


def _digest_of_scene(digest: str, scene, at_default: list[str]) -> str:
    """sha256 of the digest of dimensionless numbers, and of the SI values from which they follow."""
    content = [digest, scene.labels, sorted(scene.names.items())]
    correlations = {f"{first} and {second}": value for (first, second), value in scene.correlations.items()}
    for table, end in ((scene.values, ""), (scene.spreads, "_spread"), (correlations, "")):
        for name, value in sorted(table.items()):
            content.append((name + end, getattr(value, "dims", ()), digest_of_array(np.asarray(value))))
    content += [at_default] if at_default else []
    content += [_OF_STRENGTHS, sorted(scene.strengths.items())] if scene.strengths else []
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _digest_of_values(grid: Grid, name: str) -> tuple:
    """Shape of a parameter, digest of the places whose value counts in some case, and digest of these values.

    () if no value counts.
    """
    dims, array = grid.values.get(name, ((), None))
    if not dims and (array is None or array == grid.lexicon.parameter(name).default):  # quick: most parameters end here
        return ()
    values = along(grid, name)
    if name == "shape" or name.endswith(".profile"):  # the numbers of a table count
        values = np.array([_identity(grid, name, word) for word in values.ravel().tolist()]).reshape(values.shape)
    several = tuple(np.flatnonzero(np.array(values.shape) == 1))
    mask = np.broadcast_to(counts(grid, name).any(axis=several, keepdims=True), values.shape)
    return (values.shape, digest_of_array(mask), digest_of_array(values[mask])) if mask.any() else ()


def digest_of_array(array: np.ndarray) -> str:
    """The digest of numbers by their float64 bytes, and of others, such as dates that label a DataArray, by text."""
    numbers = array.dtype.kind in "iufb"
    raw = (array.astype("<f8") + 0.0).tobytes() if numbers else "\0".join(map(str, array.ravel().tolist())).encode()
    return hashlib.sha256(raw).hexdigest()


def case_keys(grid: Grid, stresses: bool = False) -> np.ndarray:
    """(B, 2) uint64: keys of 128 bits, two sums of a hash of (name, value) over the parameters whose value counts.

    The hashes are summed so that a parameter is hashed along its own dimensions only. -0.0 counts as 0.0. With
    `stresses` the keys differ, and Poisson ratios always count. A million keys take a fraction of a second.
    """
    lanes = np.zeros((2, *grid.shape), dtype=np.uint64)
    for name in grid.lexicon.parameters_of(grid.values):
        counted = counts(grid, name)
        if counted.any():
            lanes += np.where(counted, _hashed(grid, name, along(grid, name)), np.uint64(0))
    if (far := stand_apart(grid)).any():
        of_cells = np.array(_OF_CELLS).reshape((1,) * len(grid.shape))
        lanes += np.where(far, _hashed(grid, "cells", of_cells), np.uint64(0))
    for name in RATIOS if stresses else ():
        lanes += _hashed(grid, f"{name} of stresses {_OF_STRESSES}", along(grid, name))
    return np.ascontiguousarray(lanes.reshape(2, -1).T)


def find(keys: np.ndarray, stored: np.ndarray, rank: np.ndarray) -> np.ndarray:
    """(B,) int64: the row of each of the keys (B, 2) in `stored` (N, 2), or -1 if it is not there. Of several rows the
    one of lowest `rank` is taken.

    If two different stored keys have the same first half, one of them may be reported as not there.
    """
    if not len(stored):
        return np.full(len(keys), -1)
    order = np.lexsort((rank, stored[:, 0]))
    place = np.searchsorted(stored[order, 0], keys[:, 0])
    row = order[np.minimum(place, len(stored) - 1)]
    return np.where((stored[row] == keys).all(axis=1), row, -1)


def _identity(grid: Grid, name: str, word: str) -> str:
    """A text that identifies the meaning of a parameter's word."""
    known = grid.lexicon.known
    if name.endswith(".profile"):
        return profile_identity(word, known.profiles)
    if name == "micro":
        if word.startswith(OF_SCAN) and word in known.laws:  # wherever the file is, and on however many bodies
            return f"{OF_SCAN} {known.laws[word].version}"
        return law_identity(known.laws[word]) if word in known.laws else word
    if name == "shape":
        return f"{shape_identity(known.shapes[word]) if word in known.shapes else word} {_OF_SHAPES}"
    return word


def _hashed(grid: Grid, name: str, array: np.ndarray) -> np.ndarray:
    """(2, *shape) uint64: two hashes of each value of a parameter, which depend on its name."""
    if array.dtype.kind == "U":
        bits, left = np.zeros(array.shape, np.uint64), np.ones(array.shape, bool)
        while left.any():  # word by word: there are few words, and np.unique of a million takes seconds
            here = array == array.flat[left.argmax()]
            bits[here] = _digest(_identity(grid, name, str(array[here][0])), 8)[0]
            left &= ~here
    else:
        numbers = array.astype(np.float64) + 0.0
        bits = np.where(np.isnan(numbers), np.nan, numbers).view(np.uint64)  # every NaN has the same bits
    name = f"{name} {_OF_SHAPES}" if name == "w_adhesion" else name
    return _mixed(bits ^ _digest(name, 16).reshape(2, *[1] * array.ndim))


def _digest(text: str, size: int) -> np.ndarray:
    return np.frombuffer(hashlib.blake2b(text.encode(), digest_size=size).digest(), dtype="<u8").astype(np.uint64)


def _mixed(z: np.ndarray) -> np.ndarray:
    """The finalizer of splitmix64: every bit of the argument moves every bit of the result."""
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))
