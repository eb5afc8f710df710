"""Roots of many monotone scalar functions at once, by bracketing."""

import numpy as np


def false_position(evaluate, low, high, tolerance, limit=80):
    """Root of an increasing function of each of B cases by false position (Illinois), from brackets that are widened
    as needed.

    Parameters
    ----------
    evaluate : callable
        ``evaluate(x) -> g`` for x (B,); NaN where there is no value: that case is given up.
    low, high : (B,) float
        First brackets; moved outwards, doubling, while they do not enclose the root (60 times at most).
    tolerance : float
        A case is done when abs(g) or its bracket is below this.

    Returns
    -------
    (B,) float
        The last x of each case.
    """
    low, g_low = _outwards(evaluate, low, high, -1)
    high, g_high = _outwards(evaluate, high, low, +1)
    x = high
    for _ in range(limit):
        with np.errstate(invalid="ignore", divide="ignore"):
            x = low - g_low * (high - low) / (g_high - g_low)
        x = np.where((x > low) & (x < high), x, 0.5 * (low + high))
        g = evaluate(x)
        below = g < 0
        g_high = np.where(below, 0.5 * g_high, g)
        g_low = np.where(below, g, 0.5 * g_low)
        low, high = np.where(below, x, low), np.where(below, high, x)
        if np.all((np.abs(g) < tolerance) | (high - low < tolerance) | np.isnan(g)):
            break
    return x


def _outwards(evaluate, end, other, sign):
    """Move `end` away from `other` until the function has the sign there."""
    step = np.maximum(np.abs(end - other), 0.1)
    g = evaluate(end)
    for _ in range(60):
        short = sign * g < 0
        if not short.any():
            break
        end = np.where(short, end + sign * step, end)
        step = 2 * step
        g = np.where(short, evaluate(end), g)
    return end, g
