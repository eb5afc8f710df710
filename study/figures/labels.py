"""What quantities are called on axes, in legends and in the line that states the parameters of a figure."""

import re
from collections.abc import Iterable

import numpy as np
import xarray as xr

from ..scene import quantities
from ..scene.quantities import READABLE, readable
from ..spec.vocabulary import VOCABULARY

SYMBOLS = {
    "P": "P", "a": "a", "D": "D", "h": "h", "n": "n", "m": "m", "nu1": r"\nu_1", "nu2": r"\nu_2", "Nbar": r"\bar N",
    "Ra": "R_a", "B": "B", "beta": r"\beta", "sigma": r"\sigma", "k": "k",
    "p0": "p(0)", "p_max": r"p_{\max}", "Ar_An": "A_r/A_n",
    "A0": "A[p(0)]", "dP_dD": "dP/dD", "lam0": r"\lambda(0)", "p": "p", "lam": r"\lambda", "An": "A_n",
    "An_ratio": r"A_n/(\pi a_0^2)", "p_mean": "P/A_n", "spots": r"\bar N A_n", "b0": "b(0)",
    "p_peak": r"p_{\mathrm{peak}}", "E_eff": r"E_{\mathrm{eff}}", "x": "r/a", "R": "R", "E1": "E_1", "E2": "E_2",
    "E_punch": r"E_{\mathrm{punch}}", "nu_punch": r"\nu_{\mathrm{punch}}",
}  # fmt: skip
"""Names -> symbols in mathtext; what has none is called by its name."""
OF_LAYERS, OF_ASPERITIES, OF_POWER_LAW = ("h", "n", "bonding"), ("Nbar", "Ra"), ("B", "beta")
STATED = ("R", "E_punch", "nu_punch", "E1", "nu1", "E2", "nu2", "P", "a", "D", "h", "n", "m", "bonding", "Nbar", "Ra",
          "B", "beta", "sigma", "cut")  # fmt: skip
"""Parameters that a figure states, in this order, where it has one value of them."""
UNITS = {"B": r"R_a/E_1^{*\beta}"}
"""Units of what has no scale in E2* and R."""


def symbol(name: str) -> str:
    """The symbol of a name: "$p_{\\max}$", or the name in words."""
    return f"${SYMBOLS[name]}$" if name in SYMBOLS else name.replace("_", " ")


def multiple(array: xr.DataArray) -> tuple[str, float]:
    """The unit in which physical numbers are read most easily, and its size in theirs; ("", 1) for pure numbers."""
    unit = array.attrs.get("units", "1")
    if unit not in READABLE or unit == "1":
        return "" if unit == "1" else unit, 1.0
    return quantities.multiple(np.nanmax(np.abs(array.values), initial=0.0), unit)


def axis_label(name: str, array: xr.DataArray) -> str:
    """The label of an axis: "$h/R$", "$P/(E_2^* R^2)$", "$\\bar N R^2$"; of physical numbers "$P$, mN"."""
    unit, _ = multiple(array)
    if unit:
        return f"{symbol(name)}, {unit}"
    if not array.attrs.get("scale") or name not in SYMBOLS:
        return symbol(name)
    return f"${over_scale(SYMBOLS[name], VOCABULARY[name].powers)}$"


def over_scale(text: str, powers: tuple[int, int]) -> str:
    """A symbol over its scale E2*^i R^j, in mathtext."""
    over, times = [], []
    for word, power in zip(("E_2^*", "R"), powers, strict=True):
        if power:
            (over if power > 0 else times).append(word + f"^{abs(power)}" * (abs(power) > 1))
    text = rf"({text})" if "/" in text and over else text
    text = "\\,".join([text, *times])
    below = "\\,".join(over)
    return text + (f"/({below})" if len(over) > 1 else f"/{below}" if over else "")


def value_text(name: str, array: xr.DataArray, value) -> str:
    """A value with its name: "$h/R$ = 0.02", "$h$ = 2 µm"; a text as it is."""
    if isinstance(value, str):
        return value.replace("_", " ") + " interface" * (name == "bonding")
    unit = array.attrs.get("units", "1")
    if unit in READABLE and unit != "1":
        return f"{symbol(name)} = {readable(float(value), unit)}"
    return f"{axis_label(name, array)} = {written(float(value))}"


def written(value: float) -> str:
    """A number for a legend: "0.02", "250000", "$2.704\\times10^{-5}$"."""
    if value == int(value) and abs(value) < 1e6:
        return str(int(value))
    mantissa, _, power = f"{value:.4g}".partition("e")
    return rf"${mantissa}\times10^{{{int(power)}}}$".replace(r"$1\times", "$") if power else mantissa


def stated(datasets: Iterable[xr.Dataset]) -> list[str]:
    """The parameters that have one value in all the datasets, each as `value_text`; those that no case uses are left
    out, and so are axes, which the figure shows."""
    datasets = list(datasets)
    words = {name: _values(datasets, name) for name in ("base", "micro", "bonding")}
    unused = set() if words["bonding"] == {"bonded"} or len(words["bonding"]) > 1 else {"nu1", "nu2"}
    unused |= set(OF_LAYERS) if words["base"] == {"half_space"} else set()
    unused |= set() if words["micro"] - {"smooth"} else set(OF_ASPERITIES)
    unused |= set() if "power_law" in words["micro"] else set(OF_POWER_LAW)
    unused |= {"n", "m"} if _values(datasets, "E2") else set()  # which follow from the moduli
    found = []
    for name in STATED:
        values = _values(datasets, name)
        if len(values) != 1 or name in unused or (name == "m" and values == {0.0}):
            continue
        (value,) = values
        array = next(dataset[name] for dataset in datasets if name in dataset)
        found.append(value_text(name, array, value) + (rf" ${UNITS[name]}$" if name in UNITS else ""))
    return found


def wrapped(texts: list[str], most: float) -> str:
    """Texts joined by commas, in lines of about so many characters; the marks of mathtext are not counted."""
    lines, length = [[]], 0
    for text in texts:
        shown = len(re.sub(r"\\(bar|mathrm|times|nu|beta)|[\\${}_^]", "", text)) + 2
        if lines[-1] and length + shown > most:
            lines.append([])
            length = 0
        lines[-1].append(text)
        length += shown
    return ",\n".join(", ".join(line) for line in lines)


def _values(datasets: list[xr.Dataset], name: str) -> set:
    """All values of a variable but NaN; numbers that are the same to 1e-9 are one."""
    arrays = [dataset[name].values.ravel() for dataset in datasets if name in dataset.coords]
    flat = [value for array in arrays for value in np.unique(array).tolist()]
    return {value if isinstance(value, str) else float(f"{value:.9g}") for value in flat if value == value}
