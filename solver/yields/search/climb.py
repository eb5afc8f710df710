"""The largest values of functions of the stresses near points, many at a time: quadratic models of the stresses are
trusted in boxes, which shrink where a model proves wrong and follow its largest value where it proves right."""

import numpy as np

from ...compiled.highest import highest_in_c

#: A model is evaluated on a grid of _POINTS points in each direction, then on at most _ROUNDS stencils about the best
#: point, until a stencil is as narrow as _LEAST of the box.
_POINTS, _LEAST, _ROUNDS = 9, 3e-6, 20
#: A model is right if its error is at most _RIGHT of the gain it promised; then the box keeps its width. Otherwise the
#: width is multiplied by _SHRINK.
_RIGHT, _SHRINK = 0.1, 0.25
#: A search ends when its model promises a gain below _SAME (value + scale), when its box is smaller than _SMALLEST, or
#: after _MOST steps. All are far below the documented accuracy, 1e-6 (tests/yields/test_largest_stresses.py).
_SAME, _SMALLEST, _MOST = 1e-13, 1e-8, 30
#: Half the width of a box is at most _STEPS times the length of the last step.
_STEPS = 4.0


def climb(jets, value, numbers, start, half, low, high, scale):
    """The largest values (T,) of T tasks and their places (T, 2), each near its start.

    jets : ``jets(index, u, v)`` returns stresses with derivatives (6, 4, t), at one point (u, v) for each task `index`
    value : ``value(index, stresses)`` returns the values (t, m) of stresses (4, t, m)
    numbers : (T,), of the function of each task, an index of :data:`~solver.compiled.highest.FUNCTIONS`
    start, half : (T, 2), the first points (u, v), and half the widths of the first boxes
    low, high : (T, 2), bounds of the region
    scale : (T,), the magnitude of the stresses
    """
    centre, half = np.clip(start, low, high), np.where(low == high, 0.0, half)
    widest, best, place = high - low, np.full(len(start), -np.inf), centre.copy()
    models = np.zeros((6, 4, len(start)))
    trial, promised = centre.copy(), np.full(len(start), np.inf)
    active = np.arange(len(start))
    for _ in range(_MOST):
        stresses = jets(active, *trial[active].T)
        reached = value(active, stresses[0][..., None])[:, 0]
        better = reached > best[active]
        if np.isfinite(best[active]).any():
            wrong = np.abs(reached - promised[active]) > _RIGHT * np.abs(promised[active] - best[active])
            step = np.abs(trial[active] - centre[active])
            half[active] = _resized(half[active], widest[active], step, wrong, better)
        some = active[better]
        best[some], centre[some], models[..., some] = reached[better], trial[some], stresses[..., better]
        ends = np.maximum(centre - half, low)[active], np.minimum(centre + half, high)[active]
        boxes = models[..., active], centre[active], *ends
        trial[active], promised[active] = highest_in_c(numbers[active], *boxes) or _highest(active, value, *boxes)
        gain = promised[active] - best[active]
        done = ~(gain > _SAME * (np.abs(best) + scale)[active]) | np.all(half[active] < _SMALLEST, axis=1)
        place[active] = np.where((gain >= 0)[:, None], trial[active], centre[active])
        active = active[~done]
        if not len(active):
            break
    return best, place


def _resized(half, widest, step, wrong, better):
    """Half the widths (T, 2) of the next boxes.

    half, widest : (T, 2), half the widths of the last boxes, and their upper bounds
    step : (T, 2), lengths of the last steps
    wrong, better : (T,), whether the model was wrong, and whether the step reached a larger value
    """
    far = (step >= 0.99 * half) & (half > 0) & (better & ~wrong)[:, None]
    half = half * np.where(wrong, _SHRINK, 1.0)[:, None]
    half = np.where(far, np.minimum(2 * half, widest), half)
    long = np.maximum(_STEPS * np.maximum(step, step.max(axis=1, keepdims=True) * 1e-3), _SMALLEST)
    return np.where(better[:, None], np.minimum(half, long), half)


def _highest(active, value, models, centre, low, high):
    """Places (T, 2) and values (T,) of the largest values that models have in boxes: the best point of a grid, then the
    best of stencils about it and of the top of the parabola through each stencil."""

    def values_at(index, u, v):
        du, dv = u - centre[index, :1], v - centre[index, 1:]
        f, by_u, by_v, uu, uv, vv = models[:, :, index, None]
        return value(active[index], f + du * (by_u + uu * du / 2) + dv * (by_v + uv * du + vv * dv / 2))

    flat, index, width = bool(np.all(low[:, 1] == high[:, 1])), np.arange(len(centre)), (high - low) / 2
    u, v = _around((low + high) / 2, width, np.linspace(-1, 1, _POINTS), flat)
    at, best = _best_of(u, v, values_at(index, u, v))
    share = np.full(len(centre), 2 / (_POINTS - 1))
    for _ in range(_ROUNDS):
        ends, steps = (low[index], high[index]), width[index] * share[index, None]
        middle = np.clip(at[index], ends[0] + steps, ends[1] - steps)
        u, v = _around(middle, steps, np.array([-1.0, 0.0, 1.0]), flat)
        values = values_at(index, u, v)
        around, of_around = _best_of(u, v, values)
        top = np.clip(middle + steps * _top(values), *ends)
        of_top = values_at(index, top[:, :1], top[:, 1:])[:, 0]
        smooth = (of_top >= of_around) & (of_top >= best[index])
        for places, reached in ((around, of_around), (top, of_top)):
            higher = reached > best[index]
            best[index[higher]], at[index[higher]] = reached[higher], places[higher]
        share[index] *= np.where(smooth, 1 / 16, 1 / 2)
        index = index[share[index] > _LEAST]
        if not len(index):
            break
    return at, best


def _around(middle, width, steps, flat):
    """Points u, v (T, m) of grids about `middle` (T, 2); each grid is one line along u if `flat`."""
    across, down = (axis.ravel() for axis in np.meshgrid(steps, 0 * steps[:1] if flat else steps))
    return middle[:, :1] + width[:, :1] * across, middle[:, 1:] + width[:, 1:] * down


def _best_of(u, v, values):
    rows, chosen = np.arange(len(u)), np.argmax(values, axis=1)
    return np.stack([u[rows, chosen], v[rows, chosen]], axis=1), values[rows, chosen]


@np.errstate(divide="ignore", invalid="ignore")  # where there is no parabola
def _top(values):
    """Places of the tops of the parabolas through 3 or 3 x 3 values (T, 3 or 9), in steps (T, 2) from the middle, each
    cut off at 1; 0 where a parabola has no top. A box that is a line has one row of values, which stands for all."""
    f = values.reshape(len(values), -1, 3)
    row = f.shape[1] // 2
    left, here, right = np.moveaxis(f[:, row], 1, 0)
    u, uu = (right - left) / 2, right - 2 * here + left
    v, vv, uv = f[:, -1, 1] - f[:, 0, 1], f[:, -1, 1] - 2 * here + f[:, 0, 1], f[:, -1, 2] - f[:, 0, 2]
    v, uv = v / 2, (uv - f[:, -1, 0] + f[:, 0, 0]) / 4
    determinant = uu * vv - uv * uv
    step = np.stack([uv * v - vv * u, uv * u - uu * v], axis=1) / determinant[:, None]
    step[~((determinant > 0) & (uu < 0))] = 0.0
    line = (v == 0) & (vv == 0) & (uu < 0)
    step[line, 0] = (-u / uu)[line]
    return np.clip(np.nan_to_num(step), -1, 1)
