"""Points that an instrument did not measure: filled in, left out of the statistics, or refused."""

import itertools

import numpy as np
from scipy.sparse import csr_matrix, diags
from scipy.sparse.linalg import cg

from ...terminal import rounded

#: Largest share of missing points that is interpolated. Interpolated points are too smooth: N̄ and Ra of random
#: surfaces change by less than 1 % if 1 % of the points are taken out (tests/specimen/heights/test_missing_points.py).
FILLED = 0.01
#: Tension of the membrane over a gap relative to its stiffness, in steps. Of 0, 0.1, 0.3 and 1, this value has the
#: smallest error at borders: 20 % of the rms two points deep (33 % with 1). Single points of smooth surfaces are off by
#: 0.4 % (0.3 % with 0, 1.2 % with 1; tests/specimen/heights/test_missing_points.py).
TENSION = 0.3
CHOICES = ("fill", "skip", "refuse")


def treated(z: np.ndarray, missing: str, name: str, spikes: int = 0) -> tuple[np.ndarray, tuple[str, ...]]:
    """The heights with their missing points (NaN) treated as `missing` says, and sentences about the treatment.

    spikes : how many of these points `despike` has taken out

    "fill": interpolated from their neighbours; "skip": NaN, which `measure` leaves out; "refuse": none may be missing.

    Raises ValueError: an unknown `missing`, infinite heights, missing points that are refused or too many to fill.
    """
    if missing not in CHOICES:
        raise ValueError(f'{name}: missing = {missing!r}; allowed are "fill", "skip" and "refuse"')
    infinite, absent = np.isinf(z), np.isnan(z)
    if infinite.any():
        raise ValueError(
            f"{name}: {infinite.sum()} of {z.size} heights are infinite, the first in {_place(infinite)}; "
            "a point that is missing must be NaN"
        )
    count, share = int(absent.sum()), float(absent.mean())
    if count == 0:
        return z, ()
    if count == z.size:
        raise ValueError(f"{name}: all {z.size} heights are not numbers (NaN)")
    gaps = (
        f"{count} of {z.size} heights are not numbers (NaN), the first in {_place(absent)}: {_percent(share)} missing"
    )
    of_spikes = (
        f"despike took out {spikes} {'point, which counts' if spikes == 1 else 'points, which count'} as missing"
    )
    gaps += f" ({of_spikes})" * bool(spikes)
    out = 'missing="skip" takes the statistics of the points that are there, or crop the scan to a part without gaps'
    if missing == "refuse":
        raise ValueError(
            f'{name}: {gaps}, and missing="refuse" allows none; missing="fill" interpolates up to 1 %, {out}'
        )
    if missing == "fill" and share > FILLED:
        raise ValueError(f"{name}: {gaps}, and at most {FILLED:.0%} is interpolated; {out}")
    if missing == "fill":
        verb = "was" if count == 1 else "were"
        return filled(z), (
            *[of_spikes] * bool(spikes),
            f"{count} of {z.size} heights ({_percent(share)}) {verb} missing, and interpolated",
        )
    return z, (
        *[of_spikes] * bool(spikes),
        f"{_percent(share)} of the heights are missing: the numbers are of the points that have all their neighbours",
    )


def filled(z: np.ndarray, most: int = 3000) -> np.ndarray:
    """The heights with their gaps filled by a stiff membrane, which is bent and stretched as little as possible.

    The missing heights minimise the sum, along all axes, of the squared second differences and of `TENSION`² times the
    squared first differences. A plate without tension would run off in gaps at the border. A membrane without
    stiffness has kinks along the edge of the gap, which would count as curvature. After `most` steps, a point that is
    more than `most` points away from the edge of its gap may not have settled.
    """
    absent, middle = np.isnan(z), np.nanmean(z)
    square, side = _equations(z, absent, middle)
    heights, _ = cg(square, side, rtol=1e-8, maxiter=most, M=diags(1 / square.diagonal()))
    del square  # of many gaps it is as large as the map
    whole = z.copy()
    whole[absent] = heights + middle
    return whole


def _equations(z: np.ndarray, absent: np.ndarray, middle: float) -> tuple[csr_matrix, np.ndarray]:
    """The matrix (N, N) and the right side (N,) whose solution is the N absent heights above `middle`."""
    count = int(absent.sum())
    place = np.full(z.shape, -1, dtype=np.int32)
    place[absent] = np.arange(count, dtype=np.int32)
    square, side = csr_matrix((count, count)), np.zeros(count)
    for axis, weights in itertools.product(range(z.ndim), (np.array([1, -2, 1]), TENSION * np.array([-1, 1]))):
        length = z.shape[axis] - len(weights) + 1
        windows = [(slice(None),) * axis + (slice(i, i + length),) for i in range(len(weights))]
        touched = np.logical_or.reduce([absent[window] for window in windows])
        unknowns = np.stack([place[window][touched] for window in windows])
        measured = [np.nan_to_num(z[window][touched] - middle) for window in windows]
        which, row = np.nonzero(unknowns >= 0)
        entries = weights[which], (row, unknowns[which, row])
        matrix = csr_matrix(entries, shape=(unknowns.shape[1], count))
        square = square + matrix.T @ matrix
        side -= matrix.T @ sum(weight * heights for weight, heights in zip(weights, measured, strict=True))
    return square.tocsr(), side


def _place(where: np.ndarray) -> str:
    """The first place, counted from 1: "row 3, column 5"."""
    return ", ".join(f"{axis} {i + 1}" for axis, i in zip(("row", "column"), np.argwhere(where)[0], strict=False))


def _percent(share: float) -> str:
    return f"{rounded(100 * share)} %"
