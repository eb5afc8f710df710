"""Pull-off of a ball from a layer on a rigid base, over the half-space of Johnson, Kendall and Roberts (1971)."""

import numpy as np
import xarray as xr

from study.figures.registry import pick, table

SHOWN_AT = (0.1, 0.3, 1.0, 2.0, 4.0)  # a/h at pull-off for which the table has the loads
THIN = {"frictionless": 2.0, "bonded, ν = 0.3": 2.0, "bonded, ν = 0.45": 2.0, "bonded, ν = 0.5": 3.0}
"""Case -> -P_off/(π w R) for layers much thinner than the contact is wide: 2 if the layer acts like local springs, 3 if
it is squeezed out."""


def over_half_space(contacts: xr.Dataset, label: str) -> tuple[np.ndarray, np.ndarray]:
    """a/h at pull-off in ascending order, and P_off over its value on a half-space, -1.5 π w R."""
    case = pick(contacts, label=label).sortby("h", ascending=False)
    on_half_space = -1.5 * np.pi * float(case["w_adhesion"])
    return case["a_off"].values / case["h"].values, case["P_off"].values / on_half_space


@table(
    "literature_pull_off",
    "literature_pull_off",
    columns="layer" + "".join(f"; a/h = {x:g} | +.1% | $a/h = {x:g}$" for x in SHOWN_AT) + "; limit | +.0%",
)
def pull_offs(contacts: xr.Dataset) -> list[tuple]:
    """By how much the work of adhesion of a pull-off load is wrong that Johnson, Kendall and Roberts' half-space makes
    of it: a layer on a rigid base under a dead load, over a/h at pull-off."""
    from scipy.interpolate import CubicSpline

    rows = []
    for label, limit in THIN.items():
        x, ratio = over_half_space(contacts, label)
        rows.append((label, *(CubicSpline(np.log(x), ratio)(np.log(SHOWN_AT)) - 1), limit / 1.5 - 1))
    return rows
