"""Stacks of small linear systems. Their matrices are one for all systems, or one for each; to each a diagonal of its
own is added."""

import numpy as np

#: Fewest systems that are eliminated together, and most unknowns of each. With fewer systems or more unknowns, LAPACK
#: is faster, which solves the systems one by one.
_FEWEST, _LARGEST = 200, 32


def solve_stack(K, diagonal, rhs):
    """The solution x (B, n, k) of (K + diag(diagonal)) x = rhs: K (B or 1, n, n), diagonal (B, n), rhs (B, n, k). A
    singular system has NaN, and does not spoil the others.

    Large stacks are eliminated without exchanging rows: the systems of an elastic body do not need it, since their
    numbers do not grow during elimination. LAPACK solves the systems that have a pivot which is not positive.
    """
    size, n, _ = rhs.shape
    if size < _FEWEST or n > _LARGEST:
        return _one_by_one(K, diagonal, rhs)
    with np.errstate(all="ignore"):
        solution, sound = _eliminate(K, diagonal, rhs)
    if not sound.all():
        failed = np.flatnonzero(~sound)
        solution[failed] = _one_by_one(K if len(K) == 1 else K[failed], diagonal[failed], rhs[failed])
    return solution


def _eliminate(K, diagonal, rhs):
    """Solution (B, n, k) by LU decomposition of all systems at once, and (B,) bool: whether all pivots are positive."""
    size, n, columns = rhs.shape
    system = np.empty((n, n + columns, size))
    system[:, :n], system[:, n:] = K.transpose(1, 2, 0), rhs.transpose(1, 2, 0)
    pivots, x = np.einsum("kkb->kb", system[:, :n]), system[:, n:]
    pivots += diagonal.T
    for k in range(n):
        above, left = system[:k], system[k:, :k]
        system[k, k:] -= np.einsum("jb,jmb->mb", left[0], above[:, k:])
        below = system[k + 1 :, k]
        below -= np.einsum("mjb,jb->mb", left[1:], above[:, k])
        below /= pivots[k]
    for k in reversed(range(n)):
        x[k] -= np.einsum("jb,jmb->mb", system[k, k + 1 : n], x[k + 1 :])
        x[k] /= pivots[k]
    return x.transpose(2, 0, 1), (pivots > 0).all(axis=0)


def _one_by_one(K, diagonal, rhs):
    matrix = np.zeros((*rhs.shape[:2], rhs.shape[1])) + K
    np.einsum("bii->bi", matrix)[...] += diagonal
    return _lapack(matrix, rhs)


def _lapack(matrix, rhs):
    try:
        return np.linalg.solve(matrix, rhs)
    except np.linalg.LinAlgError:
        if len(matrix) == 1:
            return np.full_like(rhs, np.nan)
        half = len(matrix) // 2
        return np.concatenate([_lapack(matrix[:half], rhs[:half]), _lapack(matrix[half:], rhs[half:])])
