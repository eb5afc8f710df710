"""The public function `design`: the value of one input that makes a wanted result, with its ±."""

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TextIO

import numpy as np
import xarray as xr

from ..carried import with_coordinates
from ..data.dataset import Parts, parts
from ..data.si import dataset_of
from ..data.spreads import spreads_of
from ..in_words import doubts, falling
from ..inputs.definition import Definition, StudyError
from ..inputs.grid import along
from ..inputs.vocabulary import NOT_RUN, ROWS
from ..specimen.foreign import plain
from ..terminal import counted
from ..work.progress import Progress
from ..work.screen import screen_of
from .design_asked import wanted
from .design_cases import Wanted, solved
from .design_curves import EDGE, Curves, crossings, scanned
from .design_messages import messages

STATUSES = ("found", "several", "none_below", "none_above", "at_edge", "unsolved")
"""Meanings of `design_status` 0, 1, ...; NOT_RUN is "not_run"."""
CHUNK = 100  # contacts that are searched at a time: 2,400 cases of the first scan


def design(
    targets: dict[str, Any],
    by: dict[str, tuple],
    *,
    progress: bool | None = None,
    cases: list[dict] | None = None,
    same_piece: bool = False,
    correlations: dict[tuple[str, str], float] | None = None,
    **parameters: Any,
) -> xr.Dataset:
    """The value of one input at which a result is as wanted: docs/design.md.

    Every solution within the bounds is found: the result is scanned over the input, its turns are looked for, and each
    crossing of the wanted value is a solution.

    Parameters
    ----------
    targets : one wanted result and its value, {"p_max": "180 MPa"}: a, P, D, p0, p_max, Ar_An or dP_dD
    by : one input that is a number, and two bounds, {"h": ("1 um", "1 mm")}; also P, a or D, which controls then
    progress : whether a call of more than two seconds says how far it is; None: in a notebook or on a terminal
    cases, same_piece, correlations, parameters : as of `study.solve`, without the target and the input of `by`

    Returns
    -------
    xarray.Dataset : contacts as of `study.solve` over the dimensions of the parameters and `solution`, with NaN and
        the status "not_run" where there are fewer solutions. The input, say `h`, is a coordinate over the same
        dimensions; `h_spread` its standard deviation, to first order, of the spreads of the other inputs; `h_low`,
        `h_high` where the result is one standard deviation off, NaN if it is nowhere on that side. Without spreads
        `h_spread` is 0. Over the dimensions of the parameters: `design_status` (found; several; none_below, none_above:
        the target is below, or above, all that is reached; at_edge: a solution within 1e-6 of a bound, in ln; unsolved:
        where it would be, contacts have no solution) and `message`, what was found in words

    Raises
    ------
    StudyError : input that cannot be used

    Notes
    -----
    An interrupt ends the search; what was searched until then is returned, the rest is "not_run".

    Examples
    --------
    >>> import study
    >>> layer = {"n": 0.5, "bonding": "bonded", "micro": "smooth"}
    >>> designed = study.design({"p0": 0.01}, by={"h": (1e-3, 0.1)}, P=1e-5, **layer)
    >>> round(designed.h.item(), 5), study.decode(designed.design_status).item()
    (0.00989, 'found')
    """
    begun, stream = time.monotonic(), screen_of(plain(progress))
    if cases is not None and not (isinstance(cases, list) and cases and all(isinstance(row, dict) for row in cases)):
        raise StudyError(["design: cases must be a list of dictionaries, at least one"])
    want = wanted(targets, by, parameters, cases or [], same_piece, correlations)
    pieces = _searched(want, stream, begun)
    width = max(t.shape[1] for _, _, t in pieces)
    t = np.full((want.size, width), np.nan)
    for rows, _, found in pieces:
        t[rows, : found.shape[1]] = found
    definition = want.at(t)
    made = parts(definition, solved(definition, np.isfinite(t).ravel()), "study.design")
    contacts = dataset_of(definition, made.settings_apart())
    answer = _with_ends(want, pieces, _spread(want, definition, made, contacts, t), stream)
    designed = contacts.assign(_variables(want, answer, contacts))
    designed, left_out = with_coordinates(designed, parameters)
    beyond = doubts(designed) if definition.scene else falling(designed)
    for text in [*left_out, *["\n".join(["a contact found is beyond what the model describes:", *beyond])] * bool(beyond)]:
        warnings.warn(text, stacklevel=2)
    return designed


@dataclass(frozen=True)
class Answer:
    """What was found, over the cases and their solutions.

    t : (B, n) solutions; spread : of the result there; by_input : |d ln result/d ln input|; shares : input with a
        spread -> part of the variance; low, high : t where the result is a spread off
    status : (B,); reach : least result, its t, largest result, its t, (B,) each; NaN of cases that were not searched
    """

    t: np.ndarray
    spread: np.ndarray
    by_input: np.ndarray
    shares: dict[str, np.ndarray]
    low: np.ndarray
    high: np.ndarray
    status: np.ndarray
    reach: np.ndarray


def _each(name: str, chunks: list, work: Callable, stream: TextIO | None, begun: float) -> None:
    """Do the work of each chunk of cases, with a line of progress. An interrupt after the first ends it in peace."""
    total, done = sum(map(len, chunks)), 0
    try:
        with Progress(name, total, stream, begun=begun, passing=True) as shown:
            for rows in chunks:
                work(rows)
                done += len(rows)
                shown.update(len(rows), 0)
    except KeyboardInterrupt:
        if not done:
            raise
        warnings.warn(f"{name}: interrupted after {done} of {total}; these are kept", stacklevel=4)


def _searched(want: Wanted, stream: TextIO | None, begun: float) -> list[tuple[np.ndarray, Curves, np.ndarray]]:
    """Of each chunk of cases their numbers, curves and solutions."""
    pieces, rtol = [], float(along(want.definition.grid, "rtol").min())
    low, high = want.t_of(want.low), want.t_of(want.high)

    def search(rows: np.ndarray) -> None:
        curves = scanned(want.results, rows, low, high)
        level = np.full(len(rows), want.level)
        pieces.append((rows, curves, crossings(want.results, curves, rows, level, rtol)))

    chunks = np.array_split(np.arange(want.size), -(-want.size // CHUNK))
    _each(f"searching {counted(want.size, 'design')}", chunks, search, stream, begun)
    return pieces


def _spread(want: Wanted, definition: Definition, made: Parts, contacts: xr.Dataset, t: np.ndarray) -> Answer:
    """The answer with the spreads of the result, before the ends are looked for."""
    zero, shares, scene = np.where(np.isfinite(t), 0.0, np.nan), {}, definition.scene
    spread, by_input = zero, zero

    def alone(name: str, size: Any) -> np.ndarray:
        """The spread of the result that an input makes alone."""
        only = replace(definition, scene=replace(scene, spreads={name: size}, correlations={}))
        return spreads_of(only, made)[want.target].reshape(t.shape)

    if made.by_input:
        spread = contacts[f"{want.target}_spread"].values.reshape(t.shape)
        values = made.variables[want.target].values.reshape(t.shape)
        by_input = alone(want.name, scene.values[want.name]) / values
        if not scene.correlations:
            parts_of = {name: alone(name, size) ** 2 for name, size in scene.spreads.items()}
            total = sum(parts_of.values())
            with np.errstate(invalid="ignore"):
                shares = {name: part / total for name, part in parts_of.items()}
    unknown = np.full((want.size, 4), np.nan)
    return Answer(t, spread, by_input, shares, t, t, np.full(want.size, NOT_RUN, np.int8), unknown)


def _with_ends(want: Wanted, pieces: list, answer: Answer, stream: TextIO | None) -> Answer:
    """The answer with the ends of each solution, its status and what is reached."""
    low, high = (np.where(answer.spread == 0, answer.t, np.nan) for _ in range(2))
    status, reach, rtol = answer.status.copy(), answer.reach.copy(), float(along(want.definition.grid, "rtol").min())
    for rows, curves, _ in pieces:
        reach[rows] = np.stack(curves.reach(), axis=1)
        status[rows] = _status(want, answer.t[rows], reach[rows])
    curves_of = {int(rows[0]): curves for rows, curves, _ in pieces}

    def search(rows: np.ndarray) -> None:
        here, curves = answer.t[rows], curves_of[int(rows[0])]
        place, number = np.nonzero(np.isfinite(here) & (answer.spread[rows] > 0))
        if not len(place):
            return
        mine, at, spread = curves.at(place), here[place, number], answer.spread[rows[place], number]
        others = crossings, want.results, mine, rows[place]
        up, down = (others[0](*others[1:], want.level + sign * spread, rtol) for sign in (1, -1))
        rising = _rises(mine, at, want.level)[:, None]
        before = np.where(number > 0, here[place, number - 1], -np.inf)
        behind = np.where(number + 1 < here.shape[1], here[place, np.minimum(number + 1, here.shape[1] - 1)], np.inf)
        for ends, levels, side in ((low, (down, up), -1), (high, (up, down), 1)):
            width = max(up.shape[1], down.shape[1])
            padded = [np.pad(t, ((0, 0), (0, width - t.shape[1])), constant_values=np.nan) for t in levels]
            places = np.where(rising, *padded)
            limit = np.where(np.isnan(behind), np.inf, behind) if side > 0 else before
            there = (side * places > side * at[:, None]) & (side * places <= side * limit[:, None])
            nearest = np.where(there, side * places, np.inf).min(axis=1) * side
            ends[rows[place], number] = np.where(np.isfinite(nearest), nearest, np.nan)

    if np.any(answer.spread > 0):
        name = f"the ± of {counted(want.size, 'design')}"
        _each(name, [rows for rows, _, _ in pieces], search, stream, time.monotonic())
    return replace(answer, low=low, high=high, status=status, reach=reach)


def _rises(curves: Curves, at: np.ndarray, level: float) -> np.ndarray:
    """(k,) bool: whether the result rises with the input at a solution."""
    numbers = np.arange(len(at))
    right = np.sum(curves.t <= at[:, None], axis=1)
    left = np.sum(curves.t < at[:, None], axis=1) - 1
    behind = curves.y[numbers, np.minimum(right, curves.y.shape[1] - 1)]
    return np.where(np.isfinite(behind) & (right > left), behind > level, curves.y[numbers, left] < level)


def _status(want: Wanted, t: np.ndarray, reach: np.ndarray) -> np.ndarray:
    count = np.isfinite(t).sum(axis=1)
    bounds = np.array([want.t_of(want.low), want.t_of(want.high)])
    at_edge = (np.abs(t[..., None] - bounds) <= EDGE * want.width).any(axis=(1, 2))
    none = np.where(reach[:, 0] > want.level, 2, np.where(reach[:, 2] < want.level, 3, 5))
    none = np.where(np.isfinite(reach[:, 0]), none, 5)
    return np.where(at_edge, 4, np.where(count > 1, 1, np.where(count == 1, 0, none))).astype(np.int8)


def _variables(want: Wanted, answer: Answer, contacts: xr.Dataset) -> dict[str, xr.Variable]:
    """What a design has beside its contacts."""
    name, dims = want.name, contacts["status"].dims
    unit = ROWS[name].unit if want.definition.scene else ""
    about = {"units": unit} if unit not in ("", "1") else {}
    about |= {key: contacts[name].attrs[key] for key in ("scale",) if key in contacts[name].attrs}
    x = want.x_of(answer.t)
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(answer.spread == 0, 0.0, answer.spread / want.level / answer.by_input)
    numbers = {
        f"{name}_spread": (np.abs(x) * relative, f"standard deviation of {name}, from the spreads of other inputs"),
        f"{name}_low": (want.x_of(answer.low), f"{name} below, where {want.target} is one standard deviation off"),
        f"{name}_high": (want.x_of(answer.high), f"{name} above, where {want.target} is one standard deviation off"),
    }
    shape = contacts["status"].shape
    variables = {
        key: xr.Variable(dims, values.reshape(shape), {"long_name": words} | about)
        for key, (values, words) in numbers.items()
    }
    flags = {
        "long_name": f"whether {want.target} is as wanted for some {name} within its bounds",
        "flag_values": np.array([*range(len(STATUSES)), NOT_RUN], dtype=np.int8),
        "flag_meanings": " ".join((*STATUSES, "not_run")),
    }
    texts = np.array(messages(want, answer, contacts.assign(variables)), dtype=object).reshape(shape[:-1])
    variables["design_status"] = xr.Variable(dims[:-1], answer.status.reshape(shape[:-1]), flags)
    variables["message"] = xr.Variable(dims[:-1], texts.astype(str), {"long_name": "what was found"})
    return variables
