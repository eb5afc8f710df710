"""The starts of the searches for the unknowns of curves."""

from dataclasses import replace
from itertools import product

import numpy as np

from .curve import MeasuredCurves
from .least_squares import Data, filled, weighed
from .model import HERTZ, is_ratio
from .question import DECADE, Question

_STARTS = 6  # number of starts across the bounds of a second unknown input
#: Starts with adhesion: their number across the bounds of the work of adhesion and of another unknown input, and the
#: places where the contact may begin, as shares of the way from the point at half the load to the first point. Searches
#: begin from the _BEST starts, and from twice as many where more than two inputs are unknown. With three starts 3 of 36
#: paraboloids with free thickness converged far from the truth, with six none (`python tools/fit/sticking.py 210 h`).
_WORKS, _OTHERS, _WAYS, _BEST = 6, 5, (0.02, 0.06, 0.15, 0.3, 0.6, 1.0), 6
#: Most steps to the modulus with which a search begins, and how near, in its logarithm, ends them.
_STEPS, _CLOSE = 12, 1e-3
#: y = _HERTZ x^q E^e R^r for a rigid ball on a half-space.
_HERTZ = {("D", "P"): 4 / 3, ("P", "a"): 0.75 ** (1 / 3), ("a", "dP_dD"): 2.0}


def starts_of(
    question: Question, curve: MeasuredCurves, there: np.ndarray, y: np.ndarray, top: np.ndarray, least: np.ndarray
) -> tuple:
    """A list of unknowns (B, k) at which searches begin, and their bounds (B, k)."""
    model, names, B = question.model, curve.names, len(y)
    power = HERTZ[model.x, model.y][0]
    D0, P0, depth, load, half = _contact_points(question, curve, there, y, power[0])
    E = np.clip(load / (_HERTZ[model.x, model.y] * depth ** power[0] * model.scene.R ** power[2]), 1e-300, None) ** (
        1 / power[1]
    )
    nu = {"E1": "nu1", "E2": "nu2"}[model.modulus]
    hertz = np.log(E * (1 - float(model.scene.values.get(nu, 0.3)) ** 2))
    p, low, high = (np.zeros((B, len(names))) for _ in range(3))
    for i, name in enumerate(names):
        if name == "D0":  # within the range of the points, or at most that range before them
            p[:, i] = D0 / curve.wide
            low[:, i], high[:, i] = least / curve.wide - 1.0, least / curve.wide + 0.999
        elif name in ("P0", "tilt"):
            p[:, i] = P0 / top if name == "P0" else 0.0
            low[:, i], high[:, i] = p[:, i] - 1e3, p[:, i] + 1e3
        elif name in question.bounds:
            low[:, i], high[:, i] = model.coordinate(name, np.array(question.bounds[name]))
            p[:, i] = (low[:, i] + high[:, i]) / 2
            if name in question.priors:
                p[:, i] = np.clip(question.priors[name][0], low[:, i], high[:, i])
        elif name in question.priors:
            center, sd = question.priors[name]
            p[:, i], low[:, i], high[:, i] = center, center - 10 * sd, center + 10 * sd
            high[:, i] = np.minimum(high[:, i], 0.5) if is_ratio(name) else high[:, i]
        else:
            p[:, i], low[:, i], high[:, i] = hertz, hertz - 3 * DECADE, hertz + 3 * DECADE
    if model.sticks:
        return _of_sticking(question, curve, p, low, high, (least, half, D0 + depth, load)), low, high
    scanned = [i for i, name in enumerate(model.unknowns) if name in question.free and name != model.modulus][:1]
    places = [(j + 0.5) / _STARTS for j in range(_STARTS)] if scanned else [0.5]
    starts = []
    for place in places:
        start = p.copy()
        for i in scanned:
            start[:, i] = low[:, i] + place * (high[:, i] - low[:, i])
        starts.append(_with_modulus(question, curve, start, low, high, D0 + depth, load))
    return starts, low, high


def _of_sticking(question, curve, p, low, high, about):
    """Starts with several works of adhesion, contact points and values of another unknown input."""
    model, names = question.model, curve.names
    first, half, deepest, load = about
    others = [i for i, name in enumerate(model.unknowns) if name not in (model.modulus, "w_adhesion")][:1]
    counts = {names.index("w_adhesion"): _WORKS} if "w_adhesion" in question.free else {}
    counts |= {i: _OTHERS for i in others if model.unknowns[i] in question.free}
    begins = [half - way * (half - first) for way in _WAYS] if "D0" in question.shifts else [0 * half]
    starts = []
    for begin, *places in product(begins, *(range(count) for count in counts.values())):
        start = p.copy()
        for (i, count), place in zip(counts.items(), places, strict=True):
            start[:, i] = low[:, i] + (place + 0.5) / count * (high[:, i] - low[:, i])
        if "D0" in question.shifts:
            start[:, names.index("D0")] = begin / curve.wide
        starts.append(start)
    size = len(starts)
    every = np.tile(np.arange(len(p)), size)
    deepest, load = np.tile(deepest, size), np.tile(load, size)
    started = _with_modulus(question, curve.take(every), np.concatenate(starts), low[every], high[every], deepest, load)
    return list(started.reshape(size, *p.shape))


def best_of(curve: MeasuredCurves, data: Data, starts: list) -> list:
    """The starts (B, k) whose curves are closest to the points."""
    most = _BEST if len(curve.table.model.unknowns) <= 2 else 2 * _BEST
    if len(starts) <= most:
        return starts
    every = np.tile(np.arange(len(data.y)), len(starts))
    part, p = curve.take(every), np.concatenate(starts)
    costs = weighed(data.take(every), p, part(p)[0])[1].reshape(len(starts), -1)
    order, rows = np.argsort(costs, axis=0, kind="stable"), np.arange(len(data.y))
    places = np.array(starts)
    return [places[order[i], rows] for i in range(most)]


def _with_modulus(question, curve, p, low, high, x, load):
    """The unknowns p with the modulus, if it is unknown, for which the curve passes through the deepest point.

    It follows by Newton's steps in logarithms.
    """
    model = question.model
    if model.modulus not in model.unknowns:
        return p
    i = model.unknowns.index(model.modulus)
    alone = replace(curve, x=x[:, None])
    wanted = np.log(np.maximum(load / curve.high, 1e-300))
    p = p.copy()
    p[:, i] = np.clip(p[:, i], low[:, i], high[:, i])
    left = np.arange(len(p))
    for _ in range(_STEPS):
        rows = filled(left)  # of a whole batch, so that the bits of a curve do not depend on its company
        F, by, _ = alone.take(rows).contact(p[rows])
        with np.errstate(divide="ignore", invalid="ignore"):
            step = (wanted[rows] - np.log(F[:, 0])) / np.maximum(np.abs(by[model.modulus][:, 0] / F[:, 0]), 0.03)
        if model.sticks:  # too soft a layer pulls
            step = np.where(F[:, 0] <= 0, 1.5, step)
        step *= np.sign(HERTZ[model.x, model.y][0][1])
        before = p[left, i]
        step = np.clip(np.nan_to_num(step), -2.0, 2.0)[: len(left)]
        p[left, i] = np.clip(before + step, low[left, i], high[left, i])
        left = left[np.abs(p[left, i] - before) > _CLOSE]
        if not len(left):
            break
    return p


def _contact_points(question: Question, curve: MeasuredCurves, there: np.ndarray, y: np.ndarray, q: float) -> tuple:
    """First values (B,) of D0 and P0, the depth and load of the deepest point above them, and x at half of that load.

    P0 is the mean of the first tenth of the points. D0 follows from the depths at 10 and 50 % of the load, as if the
    load rose with the power q of the depth.
    """
    B = len(y)
    D0, P0, deepest, load, half = (np.zeros(B) for _ in range(5))
    part = 0.2 ** (1 / q)
    for b in range(B):
        order = np.argsort(curve.x[b][there[b]], kind="stable")
        xs, ys = curve.x[b][there[b]][order], y[b][there[b]][order]
        tenth = max(1, len(xs) // 10)
        P0[b] = ys[:tenth].mean() if "P0" in question.shifts else 0.0
        high = np.sort(ys)[-max(1, len(ys) // 50) :].mean() - P0[b]
        x10, x50 = (xs[max(np.flatnonzero(ys - P0[b] < share * high), default=0)] for share in (0.1, 0.5))
        half[b] = min(x50, xs[-1] - 1e-3 * curve.wide[b])
        if "D0" in question.shifts:
            D0[b] = np.clip((x10 - part * x50) / (1 - part), xs[0], xs[-1] - 1e-3 * curve.wide[b])
        deepest[b], load[b] = xs[-1] - D0[b], max(high, 1e-300)
    return D0, P0, deepest, load, half
