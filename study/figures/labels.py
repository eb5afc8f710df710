"""Labels of quantities on axes, in legends, and in the line with the parameters of a figure."""

import re
from collections.abc import Iterable

import numpy as np
import xarray as xr

from ..in_words.stated_inputs import all_inputs, is_rigid, used_inputs
from ..inputs.lexicon import Lexicon, default, lexicon_in
from ..inputs.vocabulary import over_scale
from ..specimen import quantities
from ..specimen.quantities import READABLE, readable

TIMES = r"\,"  # between two factors, in mathtext
GREEK = {"α": r"\alpha ", "β": r"\beta ", "λ": r"\lambda ", "ν": r"\nu ", "π": r"\pi ", "σ": r"\sigma ", "²": "^2"}
UNITS = {"B": r"R_a/E_1^{*\beta}"}  # units of parameters whose scale is not a product of powers of E2* and R


def symbol(name: str, lexicon: Lexicon | None = None) -> str:
    """The symbol of a name: "$p_{\\max}$", or the name in words.

    lexicon : as in `plain_symbol`
    """
    plain = plain_symbol(name, lexicon)
    return f"${mathtext(plain)}$" if plain else name.replace("_", " ")


def plain_symbol(name: str, lexicon: Lexicon | None = None) -> str:
    """The symbol of a name in the vocabulary or of an input of a physical scene, as plain text; "" if it has none.

    lexicon : of the results that have the name; by default that of the program
    """
    rows = (lexicon or default()).all_rows
    return rows[name].symbol if name in rows else ""


def mathtext(plain: str) -> str:
    """A symbol for matplotlib: "pmax" has an index, p_max, as E1, Ra and hl2 have; "N̄" a bar."""

    def with_index(match: re.Match) -> str:
        letter, index = match.groups()
        word = r"\max" if index == "max" else rf"\mathrm{{{index}}}"
        return f"{letter}_{index}" if len(index) == 1 else f"{letter}_{{{word}}}"

    indexed = re.sub(r"([^\W\d_])_?([a-z]+\d*|\d)", with_index, plain)
    barred = re.sub("(.)\u0304", r"\\bar \1", indexed)
    return re.sub(r" (?![A-Za-z])", "", "".join(GREEK.get(letter, letter) for letter in barred))


def multiple(array: xr.DataArray) -> tuple[str, float]:
    """The unit in which physical numbers are easiest to read, and its size in their unit; ("", 1) for pure numbers."""
    unit = array.attrs.get("units", "1")
    if unit not in READABLE or unit == "1":
        return "" if unit == "1" else unit, 1.0
    return quantities.multiple(np.nanmax(np.abs(array.values), initial=0.0), unit)


def axis_label(name: str, array: xr.DataArray) -> str:
    """The label of an axis: "$h/R$", "$P/(E_2^* R^2)$", "$\\bar N R^2$"; for physical numbers "$P$, mN"."""
    unit, _ = multiple(array)
    lexicon = lexicon_in(array.coords)
    if unit:
        return f"{symbol(name, lexicon)}, {unit}"
    scale = array.attrs.get("scale")
    if not scale or not plain_symbol(name, lexicon):
        return symbol(name, lexicon)
    units = ("E_1^*" if "E1*" in scale else "E_2^*", "R")  # E1* is the unit on a rigid base
    return f"${over_scale(mathtext(plain_symbol(name, lexicon)), lexicon.rows[name].powers, units, TIMES)}$"


def with_units(columns: dict, dataset: xr.Dataset) -> dict:
    """Columns of numbers of a dataset, with the unit of physical numbers in their names: "P", or "P [N]"."""
    units = {name: dataset[name].attrs.get("units", "1") for name in columns if name in dataset}
    return {name if units.get(name, "1") == "1" else f"{name} [{units[name]}]": v for name, v in columns.items()}


def value_text(name: str, array: xr.DataArray, value) -> str:
    """A value with its name: "$h/R$ = 0.02", "$h$ = 2 µm"; a text as it is."""
    if isinstance(value, str):
        return value.replace("_", " ") + " interface" * (name == "bonding")
    unit = array.attrs.get("units", "1")
    if unit in READABLE and unit != "1":
        text = readable(float(value), unit)  # "5e+05 1/mm²"
        text = re.sub(r"(\d)e([+-]\d+)", lambda match: rf"{match[1]}$\times10^{{{int(match[2])}}}$", text)
        return f"{symbol(name, lexicon_in(array.coords))} = {text}"
    if unit != "1":  # from study.readable
        return f"{symbol(name, lexicon_in(array.coords))} = {written(float(value))} {unit}"
    return f"{axis_label(name, array)} = {written(float(value))}"


def written(value: float) -> str:
    """A number for a legend: "0.02", "250000", "$2.704\\times10^{-5}$"."""
    if value == int(value) and abs(value) < 1e6:
        return str(int(value))
    mantissa, _, power = f"{value:.4g}".partition("e")
    return rf"${mantissa}\times10^{{{int(power)}}}$".replace(r"$1\times", "$") if power else mantissa


def name_of(dataset: xr.Dataset, dim: str, i: int) -> str:
    """The name of index i of a dimension, for a title: its value, or the label of the case."""
    name = "label" if dim == "case" and "label" in dataset else dim
    if name not in dataset.coords:
        return f"{dim} {i}"
    value = dataset[name].values[i]
    if name == "case":
        return f"case {value}"
    return value_text(name, dataset[name], value if isinstance(value, str) else float(value))


def legend_texts(dataset: xr.Dataset, hue: str) -> tuple[str, list[str]]:
    """Title of the legend, and the name of each curve in it."""
    name = "label" if hue == "case" and "label" in dataset else hue
    if name not in dataset.coords or dataset[name].dtype.kind not in "fi" or name == "case":
        return "", [name_of(dataset, hue, i) for i in range(dataset.sizes[hue])]
    size = multiple(dataset[name])[1]
    return axis_label(name, dataset[name]), [written(float(f"{value / size:.4g}")) for value in dataset[name].values]


def stated(datasets: Iterable[xr.Dataset]) -> list[str]:
    """The texts above a figure: `value_text` of each input that has one value in all the datasets.

    Inputs that no case uses are left out. So are axes, which the figure shows, and names of models and materials,
    except the shape of the punch. A rigid base, which has no modulus, is stated in words.
    """
    datasets = list(datasets)
    contacts = [dataset for dataset in datasets if "base" in dataset.coords]
    texts = ["rigid base"] * (bool(contacts) and all(is_rigid(dataset, "base") for dataset in contacts))
    of_some = {name for dataset in datasets for name in used_inputs(dataset)}
    in_order = [name for dataset in datasets for name in all_inputs(of_some, lexicon_in(dataset))]
    for name in dict.fromkeys(in_order):
        values = _values(datasets, name)
        if name in of_some and len(values) == 1:
            (value,) = values
            if name in ("bonding", "shape") or not isinstance(value, str):
                array = next(dataset[name] for dataset in datasets if name in dataset)
                more = rf" ${UNITS[name]}$" if name in UNITS else " punch" * (name == "shape")
                texts.append(value_text(name, array, value) + more)
    return texts


def wrapped(texts: list[str], most: float) -> str:
    """Texts joined by commas, in lines of about `most` characters; those that mathtext does not print do not count."""
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
    """All values of a variable except NaN; numbers that agree to 1e-9 are one value."""
    arrays = [dataset[name].values.ravel() for dataset in datasets if name in dataset.coords]
    flat = [value for array in arrays for value in np.unique(array).tolist()]
    return {value if isinstance(value, str) else float(f"{value:.9g}") for value in flat if value == value}
