"""Roots of many increasing scalar functions at once, by bracketing."""

import numpy as np

from .batch import march


def false_position(evaluate, start, tolerance):
    """Roots of one increasing function for each of B cases, by false position (Illinois) from a bracket around `start`.
    Returns the last x (B,) of each case, and the function there (B,).

    evaluate : ``evaluate(x, index) -> g`` at x (b,) for the cases `index` (b,), in which a case may occur twice. A case
        whose g is NaN is abandoned
    start : (B,); the bracket begins as start ± 0.1. Its ends move outwards by steps that double until they enclose the
        root
    tolerance : (B,); a case is done when abs(g) or the width of its bracket is below this
    """
    (low, high), (g_low, g_high) = _outwards(evaluate, start)
    return between(evaluate, low, high, g_low, g_high, tolerance)


def between(evaluate, low, high, g_low, g_high, tolerance):
    """As :func:`false_position`, from a bracket with the ends `low`, `high` (B,) and the function there, `g_low`,
    `g_high` (B,). All four are changed in place. A case whose function is NaN at an end is abandoned."""
    x, g = high.copy(), g_high.copy()
    was_below = np.full(len(low), np.nan)

    def step(active):
        lo, hi, gl, gh = low[active], high[active], g_low[active], g_high[active]
        guess = lo - gl * (hi - lo) / (gh - gl)
        x[active] = np.where((guess > lo) & (guess < hi), guess, 0.5 * (lo + hi))
        g[active] = value = evaluate(x[active], active)
        below = value < 0
        share = np.where(below == was_below[active], 0.5, 1.0)  # the value at an end that stays twice is halved
        g_high[active], g_low[active] = np.where(below, share * gh, value), np.where(below, value, share * gl)
        was_below[active] = below
        low[active], high[active] = np.where(below, x[active], lo), np.where(below, hi, x[active])
        near = tolerance[active]
        return (np.abs(value) < near) | (high[active] - low[active] < near) | np.isnan(value)

    march(step, np.flatnonzero(np.isfinite(g_low + g_high)), most=80)
    return x, g


def turns_between(width, ends, slopes):
    """(...) bool: whether the cubic polynomial with the values `ends`, (low, high), and the `slopes` at the ends of an
    interval turns within the interval. Both slopes must have one sign. `width` is the length of the interval."""
    (low, high), mean = slopes, (ends[1] - ends[0]) / width
    # the slope of the polynomial is low + linear t + quadratic t², 0 <= t <= 1
    quadratic, linear = 3 * (low + high - 2 * mean), 2 * (3 * mean - 2 * low - high)
    t = -linear / (2 * quadratic)
    extreme = low + linear * t / 2
    return (t > 0) & (t < 1) & (np.sign(high) == np.sign(low)) & (np.sign(extreme) == -np.sign(low))


def _outwards(evaluate, start):
    """Both ends (2, B) of a bracket around the start, and the function there (2, B)."""
    index, sign = np.tile(np.arange(len(start)), 2), np.repeat([-1.0, 1.0], len(start))
    end, step = start[index] + 0.1 * sign, np.full(len(index), 0.1)
    g = evaluate(end, index)
    for _ in range(60):
        short = np.flatnonzero(sign * g < 0)
        if not len(short):
            break
        step[short] *= 2
        end[short] += sign[short] * step[short]
        g[short] = evaluate(end[short], index[short])
    return end.reshape(2, -1), g.reshape(2, -1)


def secant(evaluate, start, steps=12, reach=1.0):
    """Root x (B,) of a nearly straight function of each of B cases, to 1e-13 in x, by the secant method from `start`
    (B,). No step is longer than `reach`. A case that needs more than `steps` steps has NaN.

    evaluate : as of :func:`false_position`
    """
    size = len(start)
    out, every, x = np.full(size, np.nan), np.arange(size), np.array([start, start + 0.1])
    g = evaluate(x.ravel(), np.tile(every, 2)).reshape(2, size)

    def step(active):
        (before, now), (g_before, g_now) = x[:, active], g[:, active]
        with np.errstate(all="ignore"):
            by = np.clip(-g_now * (now - before) / (g_now - g_before), -reach, reach)
        done = np.abs(by) < 1e-13
        out[active[done]] = now[done]
        ended = done | ~np.isfinite(by)
        left = active[~ended]
        if len(left):
            following = (now + by)[~ended]
            x[:, left] = x[1, left], following
            g[:, left] = g[1, left], evaluate(following, left)
        return ended

    march(step, every, most=steps)
    return out
