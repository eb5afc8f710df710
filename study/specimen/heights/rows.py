"""Row jumps of a scanning probe: each row of a map may have an offset of its own, of the instrument.

An offset is one number for the whole row, so it shows in the mean of a row, and it is drawn anew for each row or jumps
now and then, so it shows in what neighbouring rows differ by.
"""

import numpy as np

#: Harmonics of the rows with which their mean is compared.
_HARMONICS = 5
#: Least ratio of the mean square of the rows' means to that of their first harmonics; 1 is expected without jumps.
_STANDS_OUT = 4.0
#: Least part of the mean square of the second differences across the rows that jumps make. Less moves N̄ by below 3 %.
_MATTERS = 0.05
#: Largest correlation of the second differences of neighbouring rows' offsets. That of independent offsets is -2/3, of
#: a random walk or of single steps -1/2, of grooves that the step resolves above 0. The second number allows for the
#: scatter over n rows, times 1/√n. Chosen on 4000 random surfaces, isotropic and ground
#: (tests/specimen/heights/test_row_jumps.py has some of them).
_UNLIKE, _SCATTER = -0.3, 1.5


def without_medians(z: np.ndarray) -> np.ndarray:
    """The map without the median of each row; a row without heights stays."""
    present = np.isfinite(z).any(axis=1)
    medians = np.zeros(len(z))
    medians[present] = np.nanmedian(z[present], axis=1)
    return z - medians[:, None]


def jumps(z: np.ndarray) -> float | None:
    """Standard deviation of the offsets of rows (axis 0) of a map, as if independent; None where no jumps are seen.

    Jumps are seen if the rows' means vary far more from row to row than the first harmonics of the rows do, by an
    amount that matters for N̄, and without the memory that a surface has, which the step resolves.
    """
    bends = np.diff(z, 2, axis=0)
    present = np.isfinite(bends)
    count = present.sum(axis=1)
    bends, present = bends[count > 0], present[count > 0]
    if len(bends) < 4:
        return None
    means = np.where(present, bends, 0.0).sum(axis=1) / present.sum(axis=1)
    deviations = np.where(present, bends - means[:, None], 0.0)
    harmonics = np.fft.rfft(deviations, axis=1)[:, 1 : _HARMONICS + 1] / present.sum(axis=1)[:, None]
    offsets, expected, all_ = np.mean(means**2), np.mean(np.abs(harmonics) ** 2), np.mean(bends[present] ** 2)
    if not (offsets > _STANDS_OUT * expected and offsets - expected > _MATTERS * all_):
        return None
    middle, neighbours = means[1:-1], (means[2:] + means[:-2]) / 2
    loud = np.abs(middle) >= np.sqrt(offsets)  # of rare steps these rows alone
    if not loud.any() or np.sum((middle * neighbours)[loud]) > (
        (_UNLIKE - _SCATTER / np.sqrt(len(means))) * np.sum(middle[loud] ** 2)
    ):
        return None
    return float(np.sqrt((offsets - expected) / 6))  # <(z1 - 2 z2 + z3)²> of independent z
