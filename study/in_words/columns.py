"""Several contacts as a table for a terminal: a line for each, with units and ±."""

from __future__ import annotations

import re

import numpy as np

from ..arrays import xarray_later as xr
from ..data.dataset import decode
from ..inputs.lexicon import lexicon_in
from .numbers import given_text, result_text
from .strength import closest
from .text import MOST_CASES, OF_ASPERITIES, SHOWN


def columns(contacts: xr.Dataset) -> str:
    """A line for each contact of a grid: what differs, the results that `summary` has, status, where strengths are
    known what is closest to its limit with its share of that, and validity.

    contacts : of `study.solve`, over one dimension or more; above 20 the last lines are counted, not written
    """
    dims = list(contacts["status"].dims)
    cases = contacts.stack({"case": dims}, create_index=False)
    shown = [cases.isel(case=i) for i in range(min(cases.sizes["case"], MOST_CASES))]
    laws = lexicon_in(contacts).smooth_laws()
    smooth = all(case["micro"].values in laws for case in shown)
    names = [name for name in SHOWN if name not in dims and not (smooth and name in OF_ASPERITIES)]
    rows = [[*dims, *names, "status", "strength", "validity"], *(_row(case, dims, names) for case in shown)]
    left = [-1] * (not any(row[-1] for row in rows[1:])) + [-2] * all(row[-2] == "-" for row in rows[1:])
    rows = [[cell for place, cell in enumerate(row, -len(row)) if place not in left] for row in rows]
    widths = [max(map(len, cells)) for cells in zip(*rows, strict=True)]
    lines = ["  ".join(f"{cell:{w}}" for cell, w in zip(row, widths, strict=True)).rstrip() for row in rows]
    more = cases.sizes["case"] - len(shown)
    return "\n".join([*lines, *[f"... and {more} more contacts"] * bool(more)])


def _row(case: xr.Dataset, dims: list, names: list[str]) -> list[str]:
    """The cells of one contact. A result that is not known stands as "-"."""
    inputs = [re.sub(rf"^{re.escape(dim)} (= |of )?", "", given_text(case, dim)) for dim in dims]
    results = ["-" if np.isnan(case[name]) else result_text(case, name) for name in names]
    flags = [str(decode(case[name]).values) for name in ("status", "validity")]
    return [*inputs, *results, flags[0], closest(case), flags[1]]
