"""Master curves of coated contacts: effective modulus, largest pressure and real contact area against a/h."""

from itertools import product

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D

from study import derived
from study.figures.labels import stated, written
from study.figures.registry import TWO_COLUMNS, Columns, figure, joined

from . import adhesion, scan_law, strength, substrate  # noqa: F401

COLOURS = {
    1e-3: "#08306b", 1e-2: "#2878b8", 0.1: "#7fb5d8", 1.0: "0.2", 10.0: "#f4a36c", 100.0: "#dd5f21", 1e3: "#8c2d04"
}  # fmt: skip
"""n -> colour, from soft (blue) to hard (red)."""
PALE = 0.4  # opacity of curves outside validity
DASHES = (0, (2.5, 1.5))  # of the smooth punch
RANGE = (0.05, 20.0)  # of a/h


@figure("coatings", "coatings", size=(TWO_COLUMNS, 7.2), panels=(3, 2))
def master_curves(panels, contacts: xr.Dataset) -> Columns:
    """Coatings from soft (blue) to hard (red) under loads from 1e-14 to 1e-3 E2* R², film-dominated contacts to the
    left, substrate-dominated ones to the right; frictionless and bonded. E_eff is (dP/dD)/(2a); the largest real
    pressure is over that under the same load without a coating. Curves of the rough punch begin where there are 100
    spots and end at the largest load; pale: another assumption of the model does not hold (spots merge, or the strain
    is not small).

    Rows: E_eff/E1*, largest real pressure over that of the uncoated body at the same load, Ar/An; columns: the two
    interfaces. E_eff of the smooth punch is dashed.
    """
    peak = derived.peak_pressure(contacts)
    bare = peak.sel(n=1.0, bonding="bonded", drop=True)  # with n = 1 and equal ν the layer has no effect
    quantities = {
        "E_eff/E1*": derived.effective_modulus(contacts) / contacts["n"],
        "p_peak/p_peak uncoated": peak / bare,
        "Ar/An": contacts["Ar_An"],
    }
    a_h = contacts["a"] / contacts["h"]
    parts = []
    for column, bonding in zip(panels.T, contacts["bonding"].values, strict=True):
        for n, micro in product(contacts["n"].values.tolist(), ("disc_cell", "smooth")):
            where, rough = {"bonding": bonding, "n": n, "micro": micro}, micro != "smooth"
            flags = contacts["validity"].sel(where).values
            shown, valid = flags & 2 == 0, flags == 0
            fixed = {"bonded": float(bonding == "bonded"), "rough": float(rough), "n": n}
            part = {name: np.full(shown.sum(), value) for name, value in fixed.items()}
            part |= {"P/(E2* R^2)": contacts["P"].values[shown], "a/h": a_h.sel(where).values[shown]}
            part |= {name: quantity.sel(where).values[shown] for name, quantity in quantities.items()}
            parts.append(part)
            look, width = {"linestyle": "-" if rough else DASHES, "color": COLOURS[n]}, 1.3 if rough else 0.8
            for axes, name in zip(column, quantities, strict=True):
                if rough or name == "E_eff/E1*":
                    x, y = part["a/h"], part[name]
                    axes.plot(x, y, alpha=PALE, linewidth=0.7 * width, **look)
                    axes.plot(x, np.where(valid[shown], y, np.nan), linewidth=width, **look)
        column[0].set_title(bonding)
    decorate(panels, contacts)
    return joined(parts)


def decorate(panels, contacts: xr.Dataset) -> None:
    """Scales, labels, legend."""
    labels = (r"$E_{\mathrm{eff}}/E_1^*$", "largest real pressure\nover that of the uncoated body", "$A_r/A_n$")
    for row, label in zip(panels, labels, strict=True):
        for axes in row:
            axes.set(xscale="log", xlim=RANGE, yscale="linear" if label.startswith("$A") else "log")
            axes.set_xticks([0.1, 1, 10], ["0.1", "1", "10"])
        row[0].set_ylabel(label)
        low, high = zip(*(axes.get_ylim() for axes in row), strict=True)
        for axes in row:
            axes.set_ylim(min(low), max(high))
    for axes in panels[-1]:
        axes.set_xlabel("$a/h$")
    handles = [Line2D([], [], color=COLOURS[n], linewidth=1.3, label=f"$n = {power(n)}$") for n in contacts["n"].values]
    handles.append(Line2D([], [], color="0.2", linewidth=0.8, linestyle=DASHES, label="smooth punch"))
    handles.append(Line2D([], [], color="0.2", linewidth=0.9, alpha=PALE, label="outside validity"))
    P = rf"$P/(E_2^* R^2)$ from {written(float(contacts['P'][0]))} to {written(float(contacts['P'][-1]))}"
    panels[0, 0].figure.suptitle(", ".join([*stated([contacts]), P]), fontsize=7)
    panels[0, 0].figure.legend(handles=handles, loc="outside lower center", ncols=4)


def power(n: float) -> str:
    """A power of ten for mathtext."""
    return f"{n:g}" if 0.1 <= n <= 10 else f"10^{{{round(np.log10(n))}}}"
