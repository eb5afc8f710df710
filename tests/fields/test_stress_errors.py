"""The error of stresses against finer solutions; tools/errors/stress_errors.py takes more contacts."""

import numpy as np
from stress_errors import worst


def test_no_stress_is_farther_off_than_its_error_says():
    """By a tenth it may be: that is what the error of a profile may miss."""
    ratios = worst(30, 4)
    assert np.isfinite(ratios).sum() > 25 and np.nanmax(ratios) < 1.1 and np.nanmax(ratios) > 0.01
