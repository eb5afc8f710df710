"""Row jumps of a scanning probe: the instrument may shift each row of a map by an offset.

An offset is one number for the whole row: so it shows in the mean of the row. It is drawn anew for each row, or jumps
now and then: so it shows in the differences of neighbouring rows.
"""

import math

import numpy as np

from .memory import mean, row_blocks

#: Order of the differences across the rows. Those of fourth order leave 7 % of a wave of 12 rows, and 70 times the mean
#: square of independent offsets: offsets of 2 nm are seen on 50 nm in waves of 12 points. Second differences miss them
#: in 9 of 15 maps of 64 rows.
_ORDER = 4
#: Harmonics of the rows with which their mean is compared.
_HARMONICS = 5
#: Least ratio of the mean square of the rows' means to that of their first harmonics; 1 is expected without jumps.
_STANDS_OUT = 4.0
#: Least part of the mean square of the second differences across the rows that jumps make. Less moves N̄ by below 3 %.
_MATTERS = 0.05
#: Largest correlation between neighbouring rows of the fourth differences of their offsets. Independent offsets have
#: -0.8, a random walk or single steps -0.75, grooves that the step resolves above -0.5. _SCATTER/√n allows for the
#: scatter over n rows. With both no jumps are seen on 200 isotropic, ground and white surfaces
#: (tests/specimen/heights/test_row_jumps.py), except on one in a hundred whose grooves are as narrow as the step.
_UNLIKE, _SCATTER = -0.6, 1.1


def aligned(z: np.ndarray) -> np.ndarray:
    """The map, each row shifted so that the median of its differences from the row before is 0.

    A row that has no point next to one of the row before is shifted as that row. The median of each row itself would
    do harm: it is the height of another point from row to row, and makes N̄ 1.3 to 1.6 times too large on smooth
    surfaces without jumps (tests/specimen/heights/test_row_jumps.py).
    """
    differences = np.diff(z, axis=0)
    present = np.isfinite(differences).any(axis=1)
    shifts = np.zeros(len(z))
    shifts[1:][present] = np.nanmedian(differences[present], axis=1)
    return z - np.cumsum(shifts)[:, None]


def jumps(z: np.ndarray) -> float | None:
    """Standard deviation of the offsets of rows (axis 0) of a map, as if independent; None where no jumps are seen.

    Jumps are seen if three conditions hold: the means of the rows vary far more from row to row than the first
    harmonics do; that matters for N̄; and neighbouring rows resemble each other less than on a surface that the step
    resolves.
    """
    pieces = [_of_rows(np.diff(z[rows], _ORDER, axis=0)) for rows in row_blocks(z, _ORDER)]
    means, harmonics = (np.concatenate(arrays) for arrays in zip(*pieces, strict=True))
    if len(means) < 4:
        return None
    offsets, expected = np.mean(means**2), np.mean(np.abs(harmonics) ** 2)
    variance = (offsets - expected) / math.comb(2 * _ORDER, _ORDER)  # of independent offsets
    if not (offsets > _STANDS_OUT * expected and 6 * variance > _MATTERS * _mean_bend(z)):
        return None
    middle, neighbours = means[1:-1], (means[2:] + means[:-2]) / 2
    loud = np.abs(middle) >= np.sqrt(offsets)  # where steps are rare, the rows beside them
    if not loud.any() or np.sum((middle * neighbours)[loud]) > (
        (_UNLIKE - _SCATTER / np.sqrt(len(means))) * np.sum(middle[loud] ** 2)
    ):
        return None
    return float(np.sqrt(variance))


def _mean_bend(z: np.ndarray) -> float:
    """Mean square of the second differences across the rows."""
    bends = np.diff(z, 2, axis=0)
    bends *= bends
    return mean(bends)


def _of_rows(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean of each row that has values, and the first harmonics of the deviations from it, 0 where one is missing."""
    present = np.isfinite(values)
    count = present.sum(axis=1)
    values, present, count = values[count > 0], present[count > 0], count[count > 0]
    means = np.where(present, values, 0.0).sum(axis=1) / count
    deviations = np.where(present, values - means[:, None], 0.0)
    return means, np.fft.rfft(deviations, axis=1)[:, 1 : _HARMONICS + 1] / count[:, None]
