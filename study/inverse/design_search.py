"""The search of a design: solutions, their contacts, spreads and ends, and the status."""

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, TextIO

import numpy as np
import xarray as xr

from ..data.dataset import not_run, parts
from ..data.si import dataset_of
from ..data.spreads import spreads_of
from ..derivatives import QUANTITIES
from ..inputs.grid import along
from ..inputs.vocabulary import NOT_RUN
from ..terminal import counted
from ..work.progress import Progress
from .design_cases import Wanted, solve_into
from .design_curves import EDGE, Curves, crossings, ends, scanned

STATUSES = ("found", "several", "none_below", "none_above", "at_edge", "unsolved")
"""Meanings of `design_status` 0, 1, ...; NOT_RUN is "not_run"."""
#: Number of cases that are searched at a time, and of contacts that are solved with their derivatives. More at a time
#: would not be faster.
CHUNK, BLOCK = 100, 1000

Piece = tuple[np.ndarray, Curves, np.ndarray]
"""A chunk of cases: their numbers, curves, and solutions t (k, n)."""


class Change(NamedTuple):
    """Changes of the wanted result, over the cases and their solutions.

    spread : standard deviation of the result; NaN for a result without derivatives
    by_input : |d ln result/d ln input|
    shares : input with a spread -> its share of the variance; {} where inputs are correlated
    """

    spread: np.ndarray
    by_input: np.ndarray
    shares: dict[str, np.ndarray]


@dataclass(frozen=True)
class Outcome:
    """The solutions of the cases.

    t, low, high : (B, n) solutions, and the t below and above at which the result is a spread off
    status : (B,)
    reach : (B, 4), least result and its t, largest result and its t; NaN for cases that were not searched
    """

    t: np.ndarray
    low: np.ndarray
    high: np.ndarray
    status: np.ndarray
    reach: np.ndarray
    change: Change


def _each(name: str, chunks: list, work: Callable, stream: TextIO | None, begun: float | None = None) -> None:
    """Do the work of each chunk, with a line of progress. An interrupt after the first ends it in good order."""
    total, done = sum(map(len, chunks)), 0
    begun = time.monotonic() if begun is None else begun
    try:
        with Progress(name, total, stream, begun=begun, passing=True) as shown:
            for chunk in chunks:
                work(chunk)
                done += len(chunk)
                shown.update(len(chunk), 0)
    except KeyboardInterrupt:
        if not done:
            raise
        warnings.warn(f"{name}: interrupted after {done} of {total}, which are kept", stacklevel=4)


def searched(want: Wanted, stream: TextIO | None, begun: float) -> list[Piece]:
    """The pieces of all cases, or of those up to an interrupt."""
    pieces: list[Piece] = []

    def search(rows: np.ndarray) -> None:
        curves = scanned(want.results, rows, want.t_of(want.low), want.t_of(want.high))
        level = np.full(len(rows), want.level)
        pieces.append((rows, curves, crossings(want.results, curves, rows, level, _rtol(want))))

    chunks = np.array_split(np.arange(want.size), -(-want.size // CHUNK))
    _each(f"searching {counted(want.size, 'design')}", chunks, search, stream, begun)
    return pieces


def _rtol(want: Wanted) -> float:
    return float(along(want.definition.grid, "rtol").min())


def solutions(want: Wanted, pieces: list[Piece]) -> np.ndarray:
    """The solutions t (B, n) of all cases, padded with NaN; n is at least 1."""
    t = np.full((want.size, max(t_of_piece.shape[1] for _, _, t_of_piece in pieces)), np.nan)
    for rows, _, t_of_piece in pieces:
        t[rows, : t_of_piece.shape[1]] = t_of_piece
    return t


def solved(want: Wanted, t: np.ndarray, stream: TextIO | None = None) -> tuple[xr.Dataset, Change]:
    """The contacts at t (B, n), with NaN where t is NaN, and the changes of the wanted result."""
    definition = want.at(t)
    arrays, index = not_run(definition, t.size), np.flatnonzero(np.isfinite(t))
    blocks = np.array_split(index, -(-len(index) // BLOCK)) if len(index) else []
    _each(f"solving {counted(len(index), 'contact')}", blocks, lambda i: solve_into(arrays, definition, i), stream)
    results = parts(definition, arrays, "study.design")
    contacts, scene = dataset_of(definition, results.settings_as_attributes()), definition.scene
    if want.target not in QUANTITIES:
        unknown = np.full(t.shape, np.nan)
        return contacts, Change(unknown, unknown, {})
    if not results.by_input:
        still = np.where(np.isfinite(t), 0.0, np.nan)
        return contacts, Change(still, still, {})

    def alone(name: str, size: Any) -> np.ndarray:
        """The dimensionless spread of the result that follows from a single input."""
        only = replace(definition, scene=replace(scene, spreads={name: size}, correlations={}))
        return spreads_of(only, results)[want.target].reshape(t.shape)

    variances = {} if scene.correlations else {name: alone(name, size) ** 2 for name, size in scene.spreads.items()}
    with np.errstate(invalid="ignore", divide="ignore"):
        shares = {name: variance / sum(variances.values()) for name, variance in variances.items()}
        by_input = alone(want.name, scene.values[want.name]) / results.variables[want.target].values.reshape(t.shape)
    return contacts, Change(contacts[f"{want.target}_spread"].values.reshape(t.shape), by_input, shares)


def answered(want: Wanted, pieces: list[Piece], t: np.ndarray, change: Change, stream: TextIO | None) -> Outcome:
    """The answer, with the ends of each solution, its status and the range that is reached."""
    low, high = np.where(change.spread == 0, t, np.nan), np.where(change.spread == 0, t, np.nan)
    status, reach = np.full(want.size, NOT_RUN, np.int8), np.full((want.size, 4), np.nan)
    curves_of = {int(rows[0]): curves for rows, curves, _ in pieces}
    for rows, curves, _ in pieces:
        reach[rows] = np.stack(curves.reach(), axis=1)
        status[rows] = _status(want, t[rows], reach[rows])

    def search(rows: np.ndarray) -> None:
        about = curves_of[int(rows[0])], rows, t[rows], want.level, change.spread[rows], _rtol(want)
        low[rows], high[rows] = ends(want.results, *about)

    if np.any(change.spread > 0):
        _each(f"the ± of {counted(want.size, 'design')}", [rows for rows, _, _ in pieces], search, stream)
    return Outcome(t, low, high, status, reach, change)


def _status(want: Wanted, t: np.ndarray, reach: np.ndarray) -> np.ndarray:
    """(k,) int8: the index of the status in STATUSES."""
    count = np.isfinite(t).sum(axis=1)
    bounds = np.array([want.t_of(want.low), want.t_of(want.high)])
    at_edge = (np.abs(t[..., None] - bounds) <= EDGE * want.width).any(axis=(1, 2))
    none = np.where(reach[:, 0] > want.level, 2, np.where(reach[:, 2] < want.level, 3, 5))
    none = np.where(np.isfinite(reach[:, 0]), none, 5)
    return np.where(at_edge, 4, np.where(count > 1, 1, np.where(count == 1, 0, none))).astype(np.int8)
