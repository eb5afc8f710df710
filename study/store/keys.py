"""A key of 128 bits for each case, made only of the values that count for it.

So a case has the same key on another grid, in another order of the axes and in another run. A million keys take a
fraction of a second. Whoever changes how keys are made must change NUMERICS_VERSION, since no case on disk is found by
the new keys.
"""

import hashlib

import numpy as np

from solver.laws import identity as law_identity

from ..spec.grid import Grid, along
from ..spec.identity import counts
from ..spec.vocabulary import PARAMETERS


def case_keys(grid: Grid) -> np.ndarray:
    """(B, 2) uint64: two independent sums of a hash of (name, value), over the parameters whose value counts.

    It is a sum so that a parameter is hashed along its own dimensions only. -0.0 counts as 0.0.
    """
    lanes = np.zeros((2, *grid.shape), dtype=np.uint64)
    for name in PARAMETERS:
        counted = counts(grid, name)
        if counted.any():
            lanes += np.where(counted, _hashed(name, along(grid, name)), np.uint64(0))
    return np.ascontiguousarray(lanes.reshape(2, -1).T)


def find(keys: np.ndarray, known: np.ndarray, rank: np.ndarray) -> np.ndarray:
    """(B,) int64: the row of each of the keys (B, 2) among the `known` (N, 2), that of lowest `rank`; -1: not there.

    Of two different known keys with the same first half one may be reported as not there.
    """
    if not len(known):
        return np.full(len(keys), -1)
    order = np.lexsort((rank, known[:, 0]))
    place = np.searchsorted(known[order, 0], keys[:, 0])
    row = order[np.minimum(place, len(known) - 1)]
    return np.where((known[row] == keys).all(axis=1), row, -1)


def _hashed(name: str, array: np.ndarray) -> np.ndarray:
    """(2, *shape) uint64: two hashes of each value of a parameter, which depend on its name."""
    if array.dtype.kind == "U":
        word = law_identity if name == "micro" else str
        bits, left = np.zeros(array.shape, np.uint64), np.ones(array.shape, bool)
        while left.any():  # word by word: there are few words, and np.unique of a million takes seconds
            here = array == array.flat[left.argmax()]
            bits[here] = _digest(word(str(array[here][0])), 8)[0]
            left &= ~here
    else:
        numbers = array.astype(np.float64) + 0.0
        bits = np.where(np.isnan(numbers), np.nan, numbers).view(np.uint64)  # every NaN has the same bits
    return _mixed(bits ^ _digest(name, 16).reshape(2, *[1] * array.ndim))


def _digest(text: str, size: int) -> np.ndarray:
    return np.frombuffer(hashlib.blake2b(text.encode(), digest_size=size).digest(), dtype="<u8").astype(np.uint64)


def _mixed(z: np.ndarray) -> np.ndarray:
    """The finalizer of splitmix64: every bit of the argument moves every bit of the result."""
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))
