"""One 128-bit key per case, made of its parameter values alone: the same case in another order of the axes, on another
grid or in another run has the same key. Numpy only, a million cases in a fraction of a second.
"""

import hashlib

import numpy as np

from ..spec.grid import Grid
from ..spec.vocabulary import PARAMETERS

NOT_GIVEN = (), np.array(np.nan)


def case_keys(grid: Grid) -> np.ndarray:
    """(B, 2) uint64: two independent sums over the parameters of a hash of (name, value).

    A sum, so that each parameter is hashed along its own dimensions only. A parameter that no case has is like one
    that is not given (NaN); -0.0 is 0.0.
    """
    lanes = np.zeros((2, *grid.shape), dtype=np.uint64)
    for name in PARAMETERS:
        dims, array = grid.values.get(name, NOT_GIVEN)
        lanes += _hashed(name, _along(grid, dims, array))
    return np.ascontiguousarray(lanes.reshape(2, -1).T)


def find(keys: np.ndarray, known: np.ndarray, rank: np.ndarray) -> np.ndarray:
    """(B,) int64: for each of the keys (B, 2) its row among the `known` (N, 2), the one of lowest `rank`; -1: none.

    Two different known keys with the same first half are not told apart: one of them may be reported as not there.
    """
    if not len(known):
        return np.full(len(keys), -1)
    order = np.lexsort((rank, known[:, 0]))
    place = np.searchsorted(known[order, 0], keys[:, 0])
    row = order[np.minimum(place, len(known) - 1)]
    return np.where((known[row] == keys).all(axis=1), row, -1)


def _along(grid: Grid, dims: tuple[str, ...], array: np.ndarray) -> np.ndarray:
    """The array with its dimensions in the order of the grid and length 1 along the others."""
    order = sorted(range(len(dims)), key=lambda i: list(grid.sizes).index(dims[i]))
    return array.transpose(order).reshape([size if dim in dims else 1 for dim, size in grid.sizes.items()])


def _hashed(name: str, array: np.ndarray) -> np.ndarray:
    """(2, *shape) uint64 from a parameter's values, a seed of its name in each lane."""
    if array.dtype.kind == "U":
        words, places = np.unique(array, return_inverse=True)
        bits = np.array([_digest(str(word), 8)[0] for word in words])[places.reshape(array.shape)]
    else:
        numbers = array.astype(np.float64) + 0.0
        bits = np.where(np.isnan(numbers), np.nan, numbers).view(np.uint64)  # one NaN of many
    return _mixed(bits ^ _digest(name, 16).reshape(2, *[1] * array.ndim))


def _digest(text: str, size: int) -> np.ndarray:
    return np.frombuffer(hashlib.blake2b(text.encode(), digest_size=size).digest(), dtype="<u8").astype(np.uint64)


def _mixed(z: np.ndarray) -> np.ndarray:
    """The finalizer of splitmix64: every bit of the argument moves every bit of the result."""
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))
