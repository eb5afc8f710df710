"""Row jumps of a scanning probe: the instrument may shift each row of a map by an offset.

An offset is one number for the whole row, so it shows in the mean of the row. It differs from row to row, or jumps now
and then, so it shows in the differences between neighbouring rows.
"""

import math

import numpy as np

from .memory import compressed, median, row_blocks

#: Order of the differences across the rows. Fourth differences leave 7 % of a wave that is 12 rows long, and multiply
#: the mean square of independent offsets by 70. They show offsets of 2 nm on waves of 50 nm that are 12 points long;
#: second differences miss these in 9 of 15 maps of 64 rows.
_ORDER = 4
#: Number of harmonics along a row with which the mean of the row is compared.
_HARMONICS = 5
#: Least ratio of the mean square of the rows' means to that of their first harmonics. Without jumps it is about 1.
_STANDS_OUT = 4.0
#: Least share of jumps in the mean square of the second differences across the rows. A smaller share changes N̄ by less
#: than 3 %.
_MATTERS = 0.05
#: Largest correlation, between neighbouring rows, of the fourth differences of their offsets. Independent offsets have
#: -0.8, a random walk or single steps -0.75, grooves that the step resolves above -0.5. _SCATTER/√n allows for the
#: scatter over n rows. With these two values no jumps are reported on 200 isotropic, ground and white surfaces
#: (tests/specimen/heights/test_row_jumps.py), except on one in a hundred whose grooves are as narrow as the step.
_UNLIKE, _SCATTER = -0.6, 1.1


def aligned(z: np.ndarray) -> np.ndarray:
    """The map with each row shifted so that the median of its differences from the row before is 0.

    A row in which no point has a neighbour in the row before is shifted as far as that row. Subtracting the median of
    each row would do harm: it is the height of another point in every row, and makes N̄ 1.3 to 1.6 times too large on
    smooth surfaces without jumps (tests/specimen/heights/test_row_jumps.py).
    """
    medians = [median(z[i] - z[i - 1]) for i in range(1, len(z))]
    return z - np.cumsum([0.0, *np.nan_to_num(medians)])[:, None]


def jumps(z: np.ndarray) -> float | None:
    """Standard deviation of the row offsets (axis 0) of a map, taken as independent; None where no jumps are seen.

    Jumps are seen if three conditions hold: the means of the rows vary far more from row to row than their first
    harmonics do; the jumps matter for N̄; and neighbouring rows resemble each other less than on a surface that the
    step resolves.
    """
    pieces = [_means_and_harmonics(np.diff(z[rows], _ORDER, axis=0)) for rows in row_blocks(z, _ORDER)]
    means, harmonics = (np.concatenate(arrays) for arrays in zip(*pieces, strict=True))
    if len(means) < 4:
        return None
    offsets, expected = np.mean(means**2), np.mean(np.abs(harmonics) ** 2)
    variance = (offsets - expected) / math.comb(2 * _ORDER, _ORDER)  # of independent offsets
    if not (offsets > _STANDS_OUT * expected and 6 * variance > _MATTERS * _mean_bend(z)):
        return None
    middle, neighbours = means[1:-1], (means[2:] + means[:-2]) / 2
    loud = np.abs(middle) >= np.sqrt(offsets)  # where jumps are rare, these are the rows next to them
    if not loud.any() or np.sum((middle * neighbours)[loud]) > (
        (_UNLIKE - _SCATTER / np.sqrt(len(means))) * np.sum(middle[loud] ** 2)
    ):
        return None
    return float(np.sqrt(variance))


def _mean_bend(z: np.ndarray) -> float:
    """Mean square of the second differences across the rows."""
    bends = np.diff(z, 2, axis=0)
    bends = compressed(bends)
    bends *= bends
    return float(bends.mean())


def _means_and_harmonics(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean of each row that has values, and the first harmonics of its deviations; a missing deviation counts as 0."""
    present = np.isfinite(values)
    count = present.sum(axis=1)
    values, present, count = values[count > 0], present[count > 0], count[count > 0]
    means = np.where(present, values, 0.0).sum(axis=1) / count
    deviations = np.where(present, values - means[:, None], 0.0)
    return means, np.fft.rfft(deviations, axis=1)[:, 1 : _HARMONICS + 1] / count[:, None]
