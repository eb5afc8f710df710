"""Points that an instrument did not measure: filled in, left out of the statistics, or refused."""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

#: Largest share of missing points that is filled in unasked. Interpolated points are too smooth: of random surfaces of
#: which 1 % were taken out, N̄ and Ra change by less than 2 % (tests/specimen/test_missing_points.py).
FILLED = 0.01
CHOICES = ("fill", "skip", "refuse")


def treated(z: np.ndarray, steps: tuple, missing: str, name: str) -> tuple[np.ndarray, tuple[str, ...]]:
    """The heights, in which NaN is a missing point, as `missing` says, and what was done with them in sentences.

    "fill": interpolated from their neighbours; "skip": NaN, which `measure` leaves out; "refuse": none may be missing.

    Raises ValueError: another `missing`, infinite heights, missing points that are refused or too many to be filled.
    """
    if missing not in CHOICES:
        raise ValueError(f'{name}: missing = {missing!r}; allowed are "fill", "skip" and "refuse"')
    infinite, absent = np.isinf(z), np.isnan(z)
    if infinite.any():
        raise ValueError(
            f"{name}: {infinite.sum()} of {z.size} heights are infinite, the first in {_place(infinite)}; "
            "a point that is missing must be NaN"
        )
    count, share = int(absent.sum()), float(absent.mean())
    if count == 0:
        return z, ()
    if count == z.size:
        raise ValueError(f"{name}: all {z.size} heights are not numbers (NaN)")
    said = (
        f"{count} of {z.size} heights are not numbers (NaN), the first in {_place(absent)}: {_percent(share)} missing"
    )
    out = 'missing="skip" takes the statistics of the points that are there, or crop the scan to a part without gaps'
    if missing == "refuse":
        raise ValueError(
            f'{name}: {said}, and missing="refuse" allows none; missing="fill" interpolates up to 1 %, {out}'
        )
    if missing == "fill" and share > FILLED:
        raise ValueError(f"{name}: {said}, and at most {FILLED:.0%} is interpolated; {out}")
    if missing == "fill":
        verb = "was" if count == 1 else "were"
        return filled(z, steps), (f"{count} of {z.size} heights ({_percent(share)}) {verb} missing, and interpolated",)
    return z, (
        f"{_percent(share)} of the heights are missing: the numbers are of the points that have all their neighbours",
    )


def filled(z: np.ndarray, steps: tuple) -> np.ndarray:
    """The heights with a membrane through the gaps: each missing point is the mean of its neighbours (Laplace).

    In a profile that is the straight line over the gap. At a border, where there is no neighbour, none counts.
    """
    absent = np.isnan(z)
    place = np.full(z.shape, -1)
    place[absent] = np.arange(absent.sum())
    rows, columns, weights, known = [], [], [], np.zeros(int(absent.sum()))
    for axis, step in enumerate(steps):
        for here, there in ((slice(1, None), slice(None, -1)), (slice(None, -1), slice(1, None))):
            here, there = ((slice(None),) * axis + (part,) for part in (here, there))
            pairs = absent[here]
            i, j, height = place[here][pairs], place[there][pairs], z[there][pairs]
            weight = np.full(i.size, float(step) ** -2)
            rows += [i, i[j >= 0]]
            columns += [i, j[j >= 0]]
            weights += [weight, -weight[j >= 0]]
            np.add.at(known, i[j < 0], weight[j < 0] * height[j < 0])
    entries = (np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns)))
    whole = z.copy()
    whole[absent] = spsolve(coo_matrix(entries, shape=(known.size,) * 2).tocsc(), known)
    return whole


def _place(where: np.ndarray) -> str:
    """The first place, counted from 1: "row 3, column 5"."""
    return ", ".join(f"{axis} {i + 1}" for axis, i in zip(("row", "column"), np.argwhere(where)[0], strict=False))


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %"
