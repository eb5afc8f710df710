"""The panels of the picture of one contact: sections through layer and body, and stresses along a line."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.contour import QuadContourSet
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from ...in_words.stated_inputs import is_rigid
from ...specimen import quantities
from ..labels import multiple
from .regions import Region, Stresses

NAMES = {"layer": "mises1", "body": "mises2"}  # the extremes that the sections mark
#: One colour for one stress: name -> symbol without friction, symbol with it, colour, dashes.
_CURVES = {
    "p": ("$p$", "$p$", "black", (0, (1, 1.2))),
    "sz": (r"$\sigma_z$", r"$\sigma_z$", "black", "-"),
    "sr": (r"$\sigma_r$", r"$\sigma_x$", "#0072B2", "-"),
    "st": (r"$\sigma_\theta$", r"$\sigma_y$", "#009E73", "-"),
    "trz": (r"$\tau_{rz}$", r"$\tau_{xz}$", "#D55E00", "-"),
}
_RINGS = {
    "surface": {"s1_surface": "sr"},
    "interface": {"sr_interface1": "sr_above", "tau_interface": "trz_above"},
}  # line -> extreme -> the curve on which it lies
_BELOW = (0, (4, 1.5))  # dashes of the stresses in the body at the interface


class Units(NamedTuple):
    """The units in which lengths and stresses are shown.

    a : contact radius, in the unit `long`
    long : name of the unit of lengths; "" for lengths in units of a
    strong, one : name and size of the unit of stresses
    sliding : whether the plane y = 0 is shown
    """

    a: float
    long: str
    strong: str
    strong_size: float
    sliding: bool

    @classmethod
    def of(cls, contact: xr.Dataset, largest: float, sliding: bool) -> "Units":
        """The units in which the radius of the contact and a stress are easiest to read."""
        largest = float(f"{largest:.6g}")  # otherwise 1 GPa may be 1000 MPa
        if "units" not in contact["a"].attrs:
            power = int(np.floor(np.log10(largest)))
            modulus = "E_1^*" if is_rigid(contact, "base") else "E_2^*"
            unit = rf"10^{{{power}}}\,{modulus}" if power else modulus
            return cls(1.0, "", unit, 10.0**power, sliding)
        long, length = multiple(contact["a"])
        strong, strong_size = quantities.multiple(largest, "Pa")
        return cls(float(contact["a"]) / length, long, strong, strong_size, sliding)

    def length(self, name: str) -> str:
        """The label of an axis: "$r$, µm" or "$r/a$"."""
        return f"${name}$, {self.long}" if self.long else f"${name}/a$"

    def stress(self, name: str) -> str:
        """The label of a stress: "stress, GPa" or "stress$/(10^{-3} E_2^*)$"."""
        return f"{name}, {self.strong}" if self.long else f"{name}$\\,/\\,({self.strong})$"

    def text(self, stress: float) -> str:
        """A stress with its unit: "1.51 GPa" or "$1.55\\times10^{-3} E_2^*$"."""
        number = f"{stress / self.strong_size:.3g}"
        times = r"\times" if self.strong.startswith("10") else r"\,"
        return f"{number} {self.strong}" if self.long else f"${number}{times}{self.strong}$"


def section(axes, region: Region, top: float, colours: str, units: Units) -> QuadContourSet:
    """Von Mises' stress of a region, in steps of colour from 0 to `top`."""
    r, z = region.r * units.a, region.z * units.a
    levels = MaxNLocator(10).tick_values(0, top / units.strong_size)
    filled = axes.contourf(r, z, region.mises / units.strong_size, levels[levels > -1e-12], cmap=colours)
    axes.contour(r, z, region.mises / units.strong_size, levels[1:], colors="white", linewidths=0.3)
    axes.set(xlim=(r[0], r[-1]), ylim=(z[-1], z[0]), ylabel=units.length("z"))
    return filled


def outline(axes, region: Region, Y: float, units: Units) -> None:
    """Draw a red line around the part that exceeds the yield strength."""
    axes.contour(region.r * units.a, region.z * units.a, region.mises, [Y], colors="#CC0000", linewidths=1.2)


def mark(axes, largest: xr.Dataset, name: str, units: Units) -> None:
    """Draw a cross where a stress is largest."""
    r, z = (float(largest[f"{name}_{axis}"]) * units.a for axis in "rz")
    edge = [withStroke(linewidth=3, foreground="white")]
    axes.plot(r, z, "x", color="black", markersize=6, markeredgewidth=1.2, clip_on=False, zorder=5, path_effects=edge)


def along(axes, name: str, values: dict[str, np.ndarray], shown: Stresses, units: Units) -> None:
    """Draw stresses along the surface or the interface; rings mark the largest tension and shear."""
    for key, stress in values.items():
        kind, _, side = key.partition("_")
        *symbols, colour, dashes = _CURVES[kind]
        where = {"sr_above": ", layer", "sr_below": ", body"}.get(key, "")
        look = {"color": colour, "linestyle": _BELOW if side == "below" else dashes}
        axes.plot(shown.r * units.a, stress / units.strong_size, label=symbols[units.sliding] + where, **look)
    for extreme, key in {extreme: key for extreme, key in _RINGS[name].items() if extreme in shown.largest}.items():
        r, value = float(shown.largest[f"{extreme}_r"]), float(shown.largest[extreme])
        sign = np.sign(np.interp(r, shown.r, values[key])) if extreme == "tau_interface" else 1.0
        colour = _CURVES[key.partition("_")[0]][2]
        if value > 0:
            axes.plot(r * units.a, sign * value / units.strong_size, "o", color=colour, markersize=4, fillstyle="none")
    axes.axhline(0, color="0.7", linewidth=0.6, zorder=0)
    axes.set(xlim=(shown.r[0] * units.a, shown.r[-1] * units.a), ylabel=units.stress("stress"))
    axes.set_title(name, loc="left")
    place = {"loc": "lower right", "bbox_to_anchor": (1, 1), "borderaxespad": 0.2, "ncols": len(values)}
    legend = axes.legend(fontsize=7, handlelength=1.6, columnspacing=0.8, handletextpad=0.4, **place)
    legend.set_in_layout(False)  # otherwise a wide legend makes the panel narrow
