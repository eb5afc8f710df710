"""The loop of a bead on a gel, load over depth: it jumps into contact at one depth, and out of contact at another."""

import numpy as np
import xarray as xr

from study.figures.annotate import note_violations
from study.figures.labels import multiple
from study.figures.registry import TWO_COLUMNS, Columns, figure, joined

LOOKS = {
    "approach": {"color": "#0072B2", "linestyle": "-", "linewidth": 1.1},
    "retraction": {"color": "#D55E00", "linestyle": "--", "linewidth": 1.1},
}
"""Colours and dashes of all figures, told apart in grey."""
EDGE = 0.2  # margin of the drawing on the far side of the loop, over the range of depths


def paths(case: xr.Dataset) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Depths and loads of approach and retraction on one cantilever, in m and N.

    Without contact the load is 0. The base of the cantilever stands still in a jump, whose slope is therefore -k.
    """
    D, P, k = case["D"].values, case["P"].values, float(case["k_machine"])
    P_in, P_off, D_off = (float(case[name].isel(a=0)) for name in ("P_in", "P_off", "D_off"))
    a_in, a_off = (float(case[name].isel(a=0)) for name in ("a_in", "a_off"))
    margin = EDGE * (D.max() - D_off)
    after, before = case["a"].values > a_in, case["a"].values > a_off
    rest = np.array([D_off + P_off / k])  # depth at which the punch comes to rest
    start = min(D_off, float(rest[0])) - margin
    approach = np.concatenate([[start, 0.0, -P_in / k], D[after]]), np.concatenate([[0.0, 0.0, P_in], P[after]])
    leaving = np.concatenate([D[before][::-1], [D_off], rest, [start]])
    return {"approach": approach, "retraction": (leaving, np.concatenate([P[before][::-1], [P_off, 0.0, 0.0]]))}


@figure("bead_on_gel", "bead_on_gel", size=(TWO_COLUMNS, 2.8), panels=(1, 2))
def loop(panels, contacts: xr.Dataset) -> Columns:
    """Load on a bead over its depth in a gel that sticks. Grey: all contacts, also those that no cantilever holds. The
    bead jumps in where the surfaces meet, and comes off where the cantilever cannot hold it any more: (a) on a soft
    cantilever, (b) on a stiff one, which follows the curve farther. Dotted: -1.5 π w R, the pull-off load on a
    half-space. Above the panels stands which assumption of the model the contacts do not keep to: where the strain is
    not small, linear elasticity is roughly right at best.

    The area of a loop is the energy that it takes.
    """
    parts = []
    (metre, micro), (newton, nano) = (multiple(contacts[name]) for name in ("D", "P"))
    pull_off_half_space = -1.5 * np.pi * float(contacts["w_adhesion"] * contacts["R"])
    for axes, k in zip(panels, contacts["k_machine"].values.tolist(), strict=True):
        case = contacts.sel(k_machine=k)
        axes.plot(case["D"] / micro, case["P"] / nano, color="0.75", linewidth=3, linestyle="-", label="all contacts")
        for name, (D, P) in paths(case).items():
            axes.plot(D / micro, P / nano, label=name, **LOOKS[name])
            where = np.full(len(D), [*LOOKS].index(name))
            parts.append({"k (N/m)": np.full(len(D), k), "retraction": where, "D (m)": D, "P (N)": P})
        axes.axhline(pull_off_half_space / nano, color="k", linewidth=0.7, linestyle=(0, (1, 1.5)))
        axes.annotate(f"$k$ = {k:g} N/m", (0.97, 0.05), xycoords="axes fraction", ha="right", fontsize=8)
        axes.set(xlabel=f"$D$, {metre}", ylabel=f"$P$, {newton}")
        axes.set(xlim=(-1.8e-6 / micro, 1.2e-6 / micro), ylim=(1.2 * float(contacts["P"].min()) / nano, 20e-9 / nano))
        note_violations(axes, {"all contacts": case["validity"]})
    panels[0].legend(loc="upper left")
    return joined(parts)
