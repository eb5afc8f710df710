"""`fit`: inputs of a contact from measured curves, with intervals."""

import os
import warnings
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from itertools import count
from typing import Any

import numpy as np
import xarray as xr

from ..inputs.definition import StudyError
from ..inputs.vocabulary import NOT_RUN, ROWS
from ..specimen.quantities import quantity
from ..terminal import shown
from ..work.cases import Failure, laws_of_users
from ..work.engine import computed_tasks
from ..work.progress import Progress, screen_of
from .curves import measured
from .fits.block import FitStatus
from .fits.fit_dataset import fit_dataset, words_of
from .fits.least_squares import AT_LEAST
from .fits.model import HERTZ, CurveModel
from .fits.question import Question, inside, read_question, region
from .fits.tables.branch import planned
from .fits.tasks import Task, fit_task, forget
from .no_pull import OF_ADHESION, joined, without, without_pull

#: Number of curves in a block, and the multiple to which the number of their points is padded: from 8 for curves of up
#: to 127 points to 64 for those of 512 and more, at most an eighth of the points.
_BLOCK, _PARTS = 64, (8, 64)
#: Largest number of fits in the search for the contact point of a part of the depth.
_ROUNDS = 5
_calls = count()
_ENDS = ((np.min, np.inf), (np.max, -np.inf))


def fit(
    curves: Any,
    *,
    free: list[str] | dict[str, Any],
    contact_point: bool = True,
    baseline: bool = True,
    tilt: bool = False,
    x: str = "D",
    y: str = "P",
    sigma: Any = None,
    loss: str = "linear",
    intervals: str | None = "profile",
    level: float = 0.95,
    depth: tuple | None = None,
    plan: bool = False,
    progress: bool | None = None,
    **parameters: Any,
) -> xr.Dataset:
    """Fit inputs of a contact to measured curves: y = F(x - D0) + P0 + tilt x, F the solved contact (docs/fit.md).

    Inputs without ± are exact. Those in `free` are fitted. So is an input with ± in the call ("1.5 ± 0.1 um"): the ±
    becomes a Gaussian prior of its logarithm. The spreads of R, of Poisson ratios and of named materials widen the
    intervals. At most three inputs are unknown.

    Parameters
    ----------
    curves : a source that `curves` takes
    free : names of inputs, or {name: (low, high)}. Without bounds a modulus lies between 1e-3 and 1e3 times the value
        by Hertz's formula for the deepest point, another input up to a decade from its value in the call
    contact_point, baseline, tilt : whether D0, P0, and a slope of the baseline are fitted, if x is the depth
    x, y : the abscissa and the fitted ordinate: "D", "P"; or "P", "a"; or "a", "dP_dD"
    sigma : standard deviation of a point of y: a number or an array in SI, or a text with its unit; None: from the
        residuals
    loss : "linear", least squares; "huber", under which outliers count less
    intervals : "profile" of the likelihood; "fisher", from the curvature at the minimum; None: no NAME_low, NAME_high.
        Under "huber" they come from the curvature
    level : of the intervals
    depth : (low, high) of x below the contact point, lengths with units or numbers in SI. Points in contact outside are
        left out; with a low end below 0, so are points further before the contact. None: all points count
    plan : whether to compute only the uncertainty of a future fit: from x in `curves`, with assumed values in the call
    progress : whether to show the progress; None: where the terminal or a notebook can
    parameters : of `study.solve` with units, except P, a and D

    Returns
    -------
    xarray.Dataset : over `curve`: NAME, NAME_low, NAME_high and NAME_spread of the unknown inputs and of D0, P0, tilt,
        in SI (the spread of an input is that of its logarithm, times the input); their `covariance` over (curve, cov_i,
        cov_j); the fit of y (P_fit, say) and `residual` = y - fit over (curve, point); `fit_status`; `validity` of the
        contact at the deepest point, and D_valid (or P_valid, a_valid), up to which no assumption is violated. A curve
        that cannot be fitted has a status and NaN. The attributes `given` and `assumed` state the inputs of the call

    Raises
    ------
    StudyError : a call that cannot be used, before a curve is read; a file or array without a curve

    Notes
    -----
    An interrupt ends the fit. Curves that were fitted before are returned; the others have the status 127, `not_run`.

    Examples
    --------
    >>> import study
    >>> bead = {"R": "5 um", "E2": "1 kPa", "nu2": 0.5, "base": "half_space", "micro": "smooth"}
    >>> contact = study.solve(**bead, D=[f"{depth} nm" for depth in range(10, 200, 10)], x=2, profiles=False)
    >>> measured = {"D": (contact.D.values, "m"), "P": (contact.P.values, "N")}
    >>> fitted = study.fit(measured, **bead | {"E2": None}, free=["E2"])
    >>> round(fitted.E2.item(), 2)
    1000.0
    """
    options = {"contact_point": contact_point, "baseline": baseline, "tilt": tilt, "sigma": sigma, "loss": loss}
    options |= {"intervals": intervals, "level": level, "plan": plan}
    parameters = {name: value for name, value in parameters.items() if value is not None}
    question = read_question(free, parameters, x, y, options)
    limits = region(depth, x)
    data = _columns(curves, question.model, plan)
    arrays, about = _arrays(data, question.model, sigma), (limits, screen_of(progress))
    fitted = _fitted(question, arrays, about, plan=plan)
    fitted = fitted.assign_coords({name: data[name] for name in data.coords})
    fitted = fitted.assign_attrs({"depth": list(limits)} if limits else {})
    other_free_inputs = {*question.free} - {*OF_ADHESION}
    if "w_adhesion" in question.bounds and "w_adhesion" not in question.priors and other_free_inputs and not plan:
        rest, bare = without(free, parameters)
        without_adhesion = read_question(rest, bare, x, y, options)
        fitted = _with_and_without(fitted, without_adhesion, arrays, about, question.bounds["w_adhesion"][0])
    return _as_called(fitted.assign_attrs(words_of(question, fitted)), question.called)


def _fitted(question: Question, arrays: tuple, about: tuple, plan: bool = False, judged: bool = True) -> xr.Dataset:
    """The fits of curves, without the words for their summary.

    arrays : of :func:`_arrays`
    about : the part of the depth that counts, or None, and the screen for the progress
    judged : whether the assumptions of the model are looked at
    """
    (X, Y, S), (limits, screen) = arrays, about
    if plan:
        Y = _planned(question, X)
    counts = np.isfinite(X) & np.isfinite(Y)
    if limits:
        counts = _within(question, (X, Y, S), counts, limits)
    rows, status = _fits_of_curves(question, (X, Y, S), counts, screen)
    return fit_dataset(question, rows, status, (X, Y, counts), plan, judged)


def _within(question: Question, arrays: tuple, counts: np.ndarray, limits: tuple[float, float]) -> np.ndarray:
    """The points that count if only a part of the depth does.

    The depth is counted from the contact point of a fit of all points, then from that of a fit of the points that
    count, until these no longer change.
    """
    first, every = replace(question, intervals=None), counts
    for _ in range(_ROUNDS if "D0" in question.shifts else 1):
        begin = (
            _contact_points(question, _fits_of_curves(first, arrays, counts, None)[0])
            if "D0" in question.shifts
            else {}
        )
        before, counts = counts, every & inside(arrays[0], begin, limits)
        if np.array_equal(before, counts):
            break
    return counts


def _as_called(fitted: xr.Dataset, called: dict[str, str]) -> xr.Dataset:
    """The fits with the names in the call: layers.1.E1 for E1."""
    called = {name: text for name, text in called.items() if text != name and name in fitted["cov_i"].values}
    ends = ("", "_low", "_high", "_spread", "_over_depth", "_from_prior")
    names = {f"{name}{end}": f"{text}{end}" for name, text in called.items() for end in ends}
    lists = {axis: [called.get(str(name), str(name)) for name in fitted[axis].values] for axis in ("cov_i", "cov_j")}
    renamed = fitted.rename({name: text for name, text in names.items() if name in fitted})
    words = " ".join(called.get(name, name) for name in fitted.attrs["free"].split())
    return renamed.assign_coords(lists).assign_attrs(free=words) if called else fitted


def _with_and_without(fitted: xr.Dataset, question: Question, arrays: tuple, about: tuple, low: float) -> xr.Dataset:
    """The fits; for curves without a pull, those of the `question` without adhesion.

    arrays, about : of :func:`_fitted`; low : the low bound of w_adhesion
    """
    flags = without_pull(fitted, _fitted(replace(question, intervals=None), arrays, about, judged=False), low)
    plain = _fitted(question, arrays, about) if flags[0].any() else fitted
    return joined(fitted, plain, *flags)


def _fits_of_curves(
    question: Question, arrays: tuple, counts: np.ndarray, screen: Any
) -> tuple[dict[int, tuple], np.ndarray]:
    """Fitted curve -> the fits of its block and its place in them; and the status of the other curves, -1 for fitted
    ones."""
    X, Y, _ = arrays
    unknowns = len(question.model.unknowns) + len(question.shifts)
    status = np.where(_usable(X, Y, counts, unknowns, "D0" in question.shifts), -1, FitStatus.INVALID_INPUT)
    rows: dict[int, tuple] = {}
    blocks = list(_blocks(counts, status < 0, _stiffness(X, Y, question) if X.size else np.zeros(len(X))))
    with Progress("fit", int((status < 0).sum()), screen, passing=True) as progress:
        try:
            for index, fits in _fits(question, blocks, arrays, counts):
                rows |= {int(curve): (fits, i) for i, curve in enumerate(index)}
                progress.update(len(index), 0)
        except KeyboardInterrupt:
            if not rows:
                raise
            warnings.warn(f"fit: interrupted after {len(rows)} of {len(X)} curves, which are kept", stacklevel=4)
    return rows, np.where((status < 0) & ~np.isin(np.arange(len(X)), list(rows)), NOT_RUN, status)


def _contact_points(question: Question, rows: dict[int, tuple]) -> dict[int, float]:
    """Curve -> its contact point in m, for curves that have one."""
    place = len(question.model.unknowns)
    lost = (FitStatus.INVALID_INPUT, FitStatus.NO_CONTACT)
    return {c: fits["p"][i, place] * fits["wide"][i] for c, (fits, i) in rows.items() if fits["status"][i] not in lost}


def _fits(question: Question, blocks: list, arrays: tuple, counts: np.ndarray) -> Iterator[tuple[np.ndarray, dict]]:
    """The curves of each block and their fits, by the processors that may be used."""
    call = f"{os.getpid()} {next(_calls)}"
    tasks = [
        Task(call, question, *(None if A is None else _packed(A, counts, filled, points) for A in arrays))
        for _, filled, points in blocks
    ]
    scene = question.model.scene
    of_users = laws_of_users(scene.lexicon.known, np.array([scene.parameters.get("micro", "disc_cell")]))
    try:
        with closing(computed_tasks(fit_task, tasks, can_leave=not of_users)) as results:
            for number, fits in results:
                # if a process was killed, or raised, the error is raised here
                yield blocks[number][0], fit_task(tasks[number]) if isinstance(fits, Failure) else fits
    finally:
        forget(call)


def _columns(source: Any, model: CurveModel, plan: bool) -> xr.Dataset:
    """The curves; for a plan only their x."""
    names = [model.x] if plan else [model.x, model.y]
    data = measured(source, len(names))
    lacking = [name for name in names if name not in data]
    if lacking:
        there = ", ".join(map(str, data.data_vars))
        asks = f"x = {model.x}, y = {model.y} are to be fitted"
        raise StudyError([f"curves: {lacking[0]} is not there, {there} is; {asks}"])
    return data[names]


def _arrays(data: xr.Dataset, model: CurveModel, sigma: Any) -> tuple:
    """x, y and the standard deviations of y over (curve, point); for a plan y is NaN."""
    X = data[model.x].values
    Y = data[model.y].values if model.y in data else np.full(X.shape, np.nan)
    if sigma is None:
        return X, Y, None
    unit = ROWS[model.y].unit
    try:
        values = quantity("sigma", sigma, unit).value if isinstance(sigma, str) else np.asarray(sigma, float)
    except (TypeError, ValueError) as error:
        raise StudyError([str(error)]) from None
    try:
        S = np.broadcast_to(values, X.shape).copy()
    except ValueError:
        raise StudyError([f"sigma has the shape {np.shape(values)}: must be one number, or as y, {X.shape}"]) from None
    if isinstance(sigma, (bool, np.bool_)) or not np.all(np.isfinite(S[there := np.isfinite(X)]) & (S[there] > 0)):
        raise StudyError([f"sigma = {shown(sigma)}: must be above 0, in {unit} or with a unit"])
    return X, Y, S


def _planned(question: Question, X: np.ndarray) -> np.ndarray:
    """The curve of the assumed values."""
    model = question.model
    values = {name: np.full(1, model.value(name)) for name in model.unknowns}
    if model.sticks:
        return planned(model, {name: value[:, None] for name, value in values.items()}, X)
    with np.errstate(all="ignore"):
        flat = np.where(X > 0, X, np.nan).ravel()
        y = np.zeros(flat.shape)
        good = np.isfinite(flat)
        y[good] = model.solved({name: np.full(good.sum(), v[0]) for name, v in values.items()}, flat[good])
    return np.where(np.isfinite(X), y.reshape(X.shape), np.nan)


def _usable(X: np.ndarray, Y: np.ndarray, counts: np.ndarray, unknowns: int, anywhere: bool) -> np.ndarray:
    """Whether curves can be fitted: they have more points than unknowns, several x and several y.

    anywhere : whether the contact point is fitted; otherwise the contact begins at 0, and some x must be above it
    """
    enough = counts.sum(axis=1) > unknowns
    ends = [[limit(np.where(counts, A, out), axis=1, initial=out) for limit, out in _ENDS] for A in (X, Y)]
    spread = [high - low > 0 for low, high in ends]
    return enough & spread[0] & spread[1] & ((ends[0][1] > 0) | anywhere)


def _stiffness(X: np.ndarray, Y: np.ndarray, question: Question) -> np.ndarray:
    """A rough modulus of each curve, in any unit. Curves with similar moduli share the tiles of a table."""
    q, e, _ = HERTZ[question.model.x, question.model.y][0]
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")  # for curves without points
        return (np.nanmax(Y, axis=1) - np.nanmin(Y, axis=1)) ** (1 / e) / np.nanmax(np.abs(X), axis=1) ** (q / e)


def _blocks(counts: np.ndarray, usable: np.ndarray, stiffness: np.ndarray) -> Iterator[tuple]:
    """For each block its curves, the same padded to a multiple of AT_LEAST with the last one, and the number of points.

    Similar curves come together, since they share tiles.
    """
    points = np.maximum(counts.sum(axis=1), 1)
    part = np.clip(2.0 ** (np.floor(np.log2(points)) - 3), *_PARTS).astype(int)
    size = -(-points // part) * part
    for points in np.unique(size[usable]):
        same = np.flatnonzero((size == points) & usable)
        same = same[np.argsort(stiffness[same], kind="stable")]
        for begin in range(0, len(same), _BLOCK):
            index = same[begin : begin + _BLOCK]
            yield index, np.concatenate([index, np.repeat(index[-1:], -len(index) % AT_LEAST)]), points


def _packed(A: np.ndarray, counts: np.ndarray, index: np.ndarray, points: int) -> np.ndarray:
    """The points of some curves, without the gaps between them, padded with NaN."""
    packed = np.full((len(index), points), np.nan)
    for row, curve in zip(packed, index, strict=True):
        values = A[curve][counts[curve]]
        row[: len(values)] = values
    return packed
