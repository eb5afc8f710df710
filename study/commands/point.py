"""The command `point`: one contact in the terminal, in words or as JSON."""

from __future__ import annotations

import io
import json
import math
import re
import sys
import warnings
from argparse import ArgumentTypeError
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import xarray_later as xr
from ..data.dataset import as_dataset, decode
from ..data.derived import QUANTITIES
from ..derivatives import spread_of_formula
from ..in_words import SHOWN, FarOutside, doubts, summary
from ..in_words.notes import OF_PULL_OFF
from ..in_words.sentences import assumed
from ..in_words.stated_inputs import all_inputs
from ..in_words.text import columns
from ..inputs.definition import StudyError
from ..inputs.lexicon import lexicon_in
from ..inputs.scene.scene import INFINITE
from ..solving import solve, solve_one
from ..terminal import answer, say
from .arguments import SWITCH, assignment

_DERIVED = ("p_ring", "r_ring", "p_peak", "D_body")  # members of QUANTITIES that are also in the JSON
_PICTURES = (".png", ".pdf", ".svg")  # endings of `--stresses`
#: The divider of a list: a comma and a blank, or a comma after a unit.
_LIST = re.compile(r",\s|(?<=[^\W\d_]),(?=[-+.\d])")
#: Numbers that all have a decimal point or an exponent, so that their commas cannot be decimal marks.
_NUMBERS = re.compile(r"[-+]?(?:\d*\.\d+|\d+(?:\.\d*)?e[-+]?\d+)(?:,[-+]?(?:\d*\.\d+|\d+(?:\.\d*)?e[-+]?\d+))+", re.I)
#: Arguments of the stresses of a contact -> what is said of them.
_OF_STRESSES = {
    "mu": "changes the stresses of a contact, not the contact: give it to rc.stresses, rc.extremes or rc.first_yield",
    "sigma_res": "adds to the stresses of a contact: give it to rc.stresses, rc.extremes or rc.first_yield",
}


def items(options) -> list[list[str]]:
    """All that was given describes one contact."""
    return [options.items]


def point(options, texts: list[str]) -> int:
    """Solve the contact and say its numbers; of lists of values a table. Exit code 1 if one has no solution."""
    parameters, picture = parameters_of(texts), options.stresses
    if picture and not picture.lower().endswith(_PICTURES):
        raise StudyError([f"--stresses {picture}: must end with one of {', '.join(_PICTURES)}"])
    several = any(isinstance(value, list) for value in parameters.values())
    as_table = _is_table(options)
    if picture and several:
        raise StudyError([f"--stresses {picture}: the picture shows one contact, and the call has a list of values"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the summary has the sentences, though it may take long
        warnings.simplefilter("always", FarOutside)
        warnings.showwarning = lambda text, *_: say(f"beware: {text}", sys.stderr)
        try:
            # with the profile p, whose largest value may be in a ring
            contact = (
                solve(**parameters) if several else solve_one(f"--stresses {picture}" * bool(picture), **parameters)
            )
            bare = _bare(parameters) if options.beside else None
        except StudyError as error:
            raise StudyError(message.removeprefix("solve: ") for message in error.messages) from None
    if options.json or picture:
        contact = as_dataset(contact)
    if as_table:
        from ..in_words.chosen_columns import table_of  # it imports xarray and pandas

        contact = as_dataset(contact)
        text = table_of(contact, options.columns, options.units, bare)
    else:
        text = _as_json(contact) if options.json else columns(contact) if several else summary(contact)
    code = answer(text) or int((contact["status"] != 0).any())
    if (several or as_table) and not options.json:  # a table has no sentences
        for sentence in dict.fromkeys(text for case in _cases(contact) for text in assumed(case)):
            say(f"assumed: {sentence}", sys.stderr)
    return code or (_draw_stresses(contact, Path(picture)) if picture else 0)


def _is_table(options) -> bool:
    """Whether the answer is a table of numbers. Raises StudyError beside an option that does not go with a table."""
    options_of_tables = [name for name in ("columns", "units", "beside") if getattr(options, name)]
    if options_of_tables and (options.json or options.stresses):
        other = "--json" if options.json else "--stresses"
        raise StudyError([f"--{options_of_tables[0]} makes a table of numbers: leave out {other}"])
    return bool(options_of_tables)


def _bare(parameters: dict[str, Any]) -> xr.Dataset:
    """The same contacts on the body without its layers."""
    from ..in_words.chosen_columns import without_layer  # it imports xarray and pandas

    return solve(**without_layer(parameters))


def _draw_stresses(contact: xr.Dataset, path: Path) -> int:
    """Draw layer and body of the contact, and name the file on stderr. Returns the exit code."""
    from ..figures.formats import write
    from ..figures.stresses.picture import plot_stresses

    page = io.BytesIO()
    plot_stresses(contact).savefig(page, format=path.suffix[1:].lower())
    say(f"stresses: {write(path, page.getvalue())}", sys.stderr)
    return 0


def _as_json(contacts: xr.Dataset) -> str:
    """The numbers of a contact, or a list of those of several contacts, in the order of the words."""
    if not contacts["status"].dims:
        numbers: dict | list = as_numbers(contacts)
    else:
        numbers = [as_numbers(case) for case in _cases(contacts)]
    return json.dumps(numbers, indent=2, ensure_ascii=False)


def _cases(contacts: xr.Dataset) -> list[xr.Dataset]:
    if not contacts["status"].dims:
        return [contacts]
    cases = contacts.stack({"case": contacts["status"].dims}, create_index=False)
    return [cases.isel(case=i) for i in range(cases.sizes["case"])]


def parameters_of(texts: list[str]) -> dict[str, Any]:
    """Arguments of `study.solve` from texts NAME=VALUE. Raises StudyError with a message for each wrong text."""
    parameters, errors = {}, []
    for text in texts:
        try:
            name, value = assignment(text)
        except ArgumentTypeError as error:
            errors.append(f'{error}, such as R="5 mm"')
            continue
        errors += [f"{name} is given twice"] * (name in parameters)
        if name in _OF_STRESSES:
            errors.append(f"{name} {_OF_STRESSES[name]}")
        if name == "same_piece":
            errors += [f"{text}: must be same_piece=true or same_piece=false"] * (str(value).lower() not in SWITCH)
            value = SWITCH.get(str(value).lower())
        elif name in solve.__kwdefaults__:
            errors.append(f"{name} does not apply to one contact: leave it out")
        parameters[name] = listed(value)
    if errors:
        raise StudyError(errors)
    return parameters


def listed(value: float | str | bool) -> float | str | bool | list[str | float]:
    """The values of a list: "1 N, 2 N" and "1N,2N" have two. A comma between digits may be a decimal mark, "1,5 N"."""
    if not isinstance(value, str):
        return value
    parts = value.split(",") if _NUMBERS.fullmatch(value) else _LIST.split(value)
    return [number_or_text(part.strip()) for part in parts] if len(parts) > 1 else value


def number_or_text(text: str) -> float | str:
    """The number in a text, or the text if it is not a number."""
    try:
        return float(text)
    except ValueError:
        return text


def as_numbers(contact: xr.Dataset) -> dict:
    """Inputs and results of one case for JSON: value, unit, and spread where inputs have spreads; flags by name."""
    contact = contact.assign({name: QUANTITIES[name](contact) for name in _DERIVED} | _spreads_of_derived(contact))
    inputs = all_inputs(contact.variables, lexicon_in(contact))
    shown = {
        name: described(contact, name)
        for name in dict.fromkeys((*inputs, *SHOWN, *OF_PULL_OFF, *_DERIVED))
        if name in contact
    }
    yields = "plastic_share" in contact and np.isfinite(contact["plastic_share"])
    shown |= {"plastic_share": described(contact, "plastic_share")} if yields else {}
    felt = "p_spot" in contact and np.isfinite(contact["p_spot"])
    shown |= {name: described(contact, name) for name in ("p_spot", "r_spot") if felt}
    shown |= {"stable": bool(contact["stable"])} if "stable" in contact and contact["status"] == 0 else {}
    shown |= {name: number(contact[name]) for name in ("error", "model_error")}
    flags = [name for name in ("status", "model_used", "asperities_used") if name in contact]
    shown |= {name: decode(contact[name]).item() for name in flags}
    shown["validity"] = decode(contact["validity"]).item().split()
    return shown | {"beware": doubts(contact)}


def _spreads_of_derived(contact: xr.Dataset) -> dict[str, xr.DataArray]:
    """NAME_spread of derived quantities, if results have spreads; NaN where it does not follow from these.

    To first order a largest pressure does not change with its place. A largest pressure in the centre stays there.
    """
    if "p_spread" not in contact:
        return {}
    place = int(np.argmax(contact["p"].values))
    spreads = {"p_ring": contact["p_spread"][place].drop_vars("x"), "p_peak": contact["p_max_spread"]}
    spreads["D_body"] = contact.get("D_spread")
    formulas = {"r_ring": _ring if place else lambda _: math.nan}
    formulas |= {name: QUANTITIES[name] for name in ["p_peak"] * bool(place) + ["D_body"] * bool(contact.get("m", 0.0))}
    spreads |= {name: xr.DataArray(spread_of_formula(contact, formula)) for name, formula in formulas.items()}
    return {f"{name}_spread": spread for name, spread in spreads.items() if spread is not None}


def _ring(dataset: xr.Dataset) -> float:
    """The radius of the ring of one contact: the top of the parabola through the three points at the largest pressure.

    It moves continuously with the inputs; the point of `r_ring` does not.
    """
    p, x = dataset["p"].values, dataset["x"].values
    place = min(max(int(np.argmax(p)), 1), len(p) - 2)
    bend, slope, _ = np.polyfit(x[place - 1 : place + 2] - x[place], p[place - 1 : place + 2], 2)
    return float(dataset["a"]) * (x[place] - slope / (2 * bend))


def described(contact: xr.Dataset, name: str) -> dict | str:
    """Value, unit and spread of a variable; a text as it is, and "rigid" or "flat" in place of an infinite number."""
    array = contact[name]
    if array.dtype.kind in "UO":
        return str(array.values)
    if name in INFINITE and math.isinf(array):
        return INFINITE[name][0]
    unit = array.attrs.get("scale") or array.attrs.get("units", "1")
    spread = {"spread": number(contact[f"{name}_spread"])} if f"{name}_spread" in contact else {}
    return {"value": number(array), "unit": unit} | spread


def number(array: xr.DataArray) -> float | str | None:
    """A finite number, "inf" or "-inf" for an infinite one, None for NaN, since JSON has only finite numbers."""
    value = float(array)
    return None if math.isnan(value) else value if math.isfinite(value) else str(value)
