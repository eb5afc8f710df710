"""The largest values of functions of the stresses near points, many at a time, by quadratic models of the stresses in
boxes that shrink or move by how far the models are right."""

import numpy as np

#: Points of a model in each direction; then stencils about the best of them until they are this part of the box wide.
_POINTS, _LEAST, _ROUNDS = 9, 3e-6, 20
#: A model is right where it misses less than this part of what it promised: the box stays; else it is a quarter as
#: wide.
_RIGHT, _SHRINK = 0.1, 0.25
#: Done when a model promises less than _SAME of the value and of the scale, far below the 1e-6 that is promised; or the
#: box is smaller than _SMALLEST; after _MOST steps at the latest (tests/yields/test_largest_stresses.py).
_SAME, _SMALLEST, _MOST = 1e-13, 1e-8, 30
#: A box is at most so many times as wide as the last step was long.
_STEPS = 4.0


def climb(jets, value, start, half, low, high, scale):
    """Largest values (T,) and their places (T, 2), each near its start.

    jets : ``jets(index, u, v)``, stresses with derivatives (6, 4, t) at one point (t,) for each of the tasks `index`
    value : ``value(index, stresses)`` of (4, t, m), (t, m)
    start, half : (T, 2), the first points (u, v), and half the widths of the boxes in which the models are trusted
    low, high : (T, 2), bounds of the region
    scale : (T,), a number of the size of the stresses
    """
    centre, half = np.clip(start, low, high), np.where(low == high, 0.0, half)
    widest, best, place = high - low, np.full(len(start), -np.inf), centre.copy()
    models = np.zeros((6, 4, len(start)))
    trial, promised = centre.copy(), np.full(len(start), np.inf)
    active = np.arange(len(start))
    for _ in range(_MOST):
        made = jets(active, *trial[active].T)
        reached = value(active, made[0][..., None])[:, 0]
        better = reached > best[active]
        if np.isfinite(best[active]).any():
            wrong = np.abs(reached - promised[active]) > _RIGHT * np.abs(promised[active] - best[active])
            step = np.abs(trial[active] - centre[active])
            half[active] = _resized(half[active], widest[active], step, wrong, better)
        some = active[better]
        best[some], centre[some], models[..., some] = reached[better], trial[some], made[..., better]
        ends = np.maximum(centre - half, low)[active], np.minimum(centre + half, high)[active]
        trial[active], promised[active] = _highest(active, value, models[..., active], centre[active], *ends)
        gain = promised[active] - best[active]
        done = ~(gain > _SAME * (np.abs(best) + scale)[active]) | np.all(half[active] < _SMALLEST, axis=1)
        place[active] = np.where((gain >= 0)[:, None], trial[active], centre[active])
        active = active[~done]
        if not len(active):
            break
    return best, place


def _resized(half, widest, step, wrong, better):
    """Halves of the widths (T, 2) of boxes after steps (T, 2), of models that were `wrong` or not (T,)."""
    far = (step >= 0.99 * half) & (half > 0) & (better & ~wrong)[:, None]
    half = half * np.where(wrong, _SHRINK, 1.0)[:, None]
    half = np.where(far, np.minimum(2 * half, widest), half)
    long = np.maximum(_STEPS * np.maximum(step, step.max(axis=1, keepdims=True) * 1e-3), _SMALLEST)
    return np.where(better[:, None], np.minimum(half, long), half)


def _highest(active, value, models, centre, low, high):
    """Places (T, 2) and values (T,) at which the functions of models are largest in boxes: the best of a grid, then of
    stencils about it and of the top of the parabola through each."""

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
    """Points u, v (T, m) of grids about `middle` (T, 2); one line if all are flat."""
    across, down = (axis.ravel() for axis in np.meshgrid(steps, 0 * steps[:1] if flat else steps))
    return middle[:, :1] + width[:, :1] * across, middle[:, 1:] + width[:, 1:] * down


def _best_of(u, v, values):
    rows, chosen = np.arange(len(u)), np.argmax(values, axis=1)
    return np.stack([u[rows, chosen], v[rows, chosen]], axis=1), values[rows, chosen]


@np.errstate(divide="ignore", invalid="ignore")  # where there is no parabola
def _top(values):
    """Where the parabola through 3 or 3 x 3 values (T, 3 or 9) has its top, in steps (T, 2) from the middle, at most 1;
    the middle where it has none. Of boxes that are lines all rows are the same."""
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
