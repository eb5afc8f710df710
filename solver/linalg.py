"""Stacks of small linear systems."""

import numpy as np


def solve_stack(matrix, rhs):
    """Solve (B, n, n) x = (B, n, k): a singular member cannot spoil the others, its own solution is NaN."""
    try:
        return np.linalg.solve(matrix, rhs)
    except np.linalg.LinAlgError:
        if len(matrix) == 1:
            return np.full_like(rhs, np.nan)
        half = len(matrix) // 2
        return np.concatenate([solve_stack(matrix[:half], rhs[:half]), solve_stack(matrix[half:], rhs[half:])])
