"""Tables of numbers with the columns and units that a user chooses, perhaps beside the body without its layer."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from solver.bases import is_bare

from ..data.contacts import Contacts
from ..data.derived import QUANTITIES
from ..data.frames import frames
from ..inputs.definition import StudyError
from ..inputs.lexicon import lexicon_in
from ..inputs.vocabulary import CONTROLS, FIRST_LAYER, NUMERICS, scene_of, suggest
from ..specimen.quantities import READABLE, quantity
from ..terminal import shown
from .text import OF_ASPERITIES, SHOWN

COLUMNS = (*SHOWN, "status")
"""The columns by default."""
_BARE = "--beside bare"
DIGITS = 4  # of a number in a terminal
_OF_LAYERS = {*FIRST_LAYER.values(), "cn", "ct", "profile", "base", "asperities_on", "n_bottom", "nu_bottom"}
_OF_LAYERS |= {"sublayers"}


def selected(dataset: xr.Dataset, names: list[str] | tuple[str, ...] | None) -> xr.Dataset:
    """The results, inputs and derived quantities with these names, in this order, after the dimensions; None: all.

    Raises StudyError: a name is unknown.
    """
    if not names:
        return dataset
    choices = known_columns(dataset)
    if unknown := [name for name in names if name not in choices]:
        raise StudyError([f"--columns {shown(name)} is not a column{suggest(name, choices)}" for name in unknown])
    derived = {name: QUANTITIES[name](dataset) for name in names if name not in dataset.variables}
    whole = dataset.assign(derived).reset_coords()
    dims = list(dataset["status"].dims)
    order = [name for name in names if name not in dims]
    table = whole[[*order, *["status"] * ("status" not in order)]]
    return table.drop_vars([name for name in table.coords if name not in (*dims, "x")])


def known_columns(dataset: xr.Dataset) -> list[str]:
    """All names that a table can have as columns: inputs first, then results, spreads last."""
    names = [*map(str, dataset.coords), *map(str, dataset.data_vars), *QUANTITIES]
    return sorted(names, key=lambda name: name.endswith("_spread"))


def in_units(dataset: xr.Dataset, units: list[str] | None) -> xr.Dataset:
    """The dataset with each quantity in that of the units that is of its kind; all others stay as they are. A unit of a
    kind that no column has changes nothing, so that one list of units serves all tables.

    Raises StudyError: a word that is not a unit of any quantity, or no column has a unit.
    """
    wrong = []
    if units and not any(array.attrs.get("units", "1") != "1" for array in dataset.variables.values()):
        raise StudyError([f"--units {','.join(units)}: no column has a unit: leave it out"])
    for unit in units or ():
        changed = {}
        for name, array in dataset.variables.items():
            if factor := _size(unit, array.attrs.get("units", "1")):
                numbers = array.data / factor
                changed[name] = array.dims, numbers, array.attrs | {"units": unit}
        if not changed and not any(_size(unit, si) for si in READABLE):
            wrong.append(f"--units {shown(unit)} is not a unit of any quantity of a contact, such as um, N or MPa")
        dataset = dataset.assign(changed)
    if wrong:
        raise StudyError(wrong)
    return dataset


def _size(unit: str, si: str) -> float:
    """The size of a unit in the SI unit; 0 if it is of another kind."""
    if si == "1":
        return 0.0
    try:
        return quantity("", f"1 {unit}", si).value
    except ValueError:
        return 0.0


def without_layer(parameters: dict[str, Any]) -> dict[str, Any]:
    """The inputs of the same contact on the body without layers. Raises StudyError: there are no layers."""
    left = {name: value for name, value in parameters.items() if name not in _OF_LAYERS and name[:7] != "layers."}
    if is_bare(parameters.get("base", "layered")) or len(left) == len(parameters):
        raise StudyError([f"{_BARE}: there is no layer to leave out"])
    return left | {"base": "half_space"}


def inputs_without_layer(dataset: xr.Dataset) -> dict[str, Any]:
    """The inputs of `study.solve` for the contacts of results on the body without layers, as arrays over the same axes.

    Raises StudyError: there is no layer, or the dataset has lost an input.
    """
    Contacts.of(dataset, _BARE)  # refuses contacts that cannot be solved again, whose laws or tips are missing
    lexicon, coords = lexicon_in(dataset), [str(name) for name in dataset.coords]
    possible = dict.fromkeys((*CONTROLS, *scene_of(coords), *lexicon.parameters_of(coords)))
    names = [name for name in possible if name in coords and name not in _follow(dataset)]
    if is_bare(dataset["base"]).all():
        raise StudyError([f"{_BARE}: there is no layer to leave out"])
    inputs = without_layer({name: _as_input(dataset[name]) for name in names if name != "base"} | {"base": "layered"})
    settings = {name: dataset.attrs[name] for name in NUMERICS if name in dataset.attrs}
    return inputs | {name: value for name, value in settings.items() if value != lexicon.parameter(name).default}


def _follow(dataset: xr.Dataset) -> set[str]:
    """Inputs that follow from others in SI units: a ratio of moduli, the radius of two bodies, a mere scale."""
    scaled = dataset.attrs.get("scale", "R") != "R" or "R1" in dataset.coords or "R2" in dataset.coords
    return {*["m"] * ("E_punch" in dataset.coords), *["R"] * scaled}


def _as_input(array: xr.DataArray) -> Any:
    """A coordinate as an argument of `study.solve`: a single word as a text, numbers with their unit."""
    if not array.dims and array.dtype.kind in "UO":
        return str(array.values)
    attributes = {"units": array.attrs["units"]} if "units" in array.attrs else {}
    values = array.values.astype(str) if array.dtype.kind == "O" else array.values
    return xr.DataArray(
        values, {dim: array[dim].values for dim in array.dims if dim in array.coords}, array.dims, attrs=attributes
    )


def beside_bare(table: xr.Dataset, bare: xr.Dataset, names: list[str]) -> xr.Dataset:
    """The table with these results for the body without layers after its own, called NAME bare."""
    results = [name for name in names if name in bare.data_vars or name in QUANTITIES]  # an input of the layer is not
    results_of_bare = selected(bare, results)
    return table.assign({f"{name} bare": results_of_bare[name] for name in results})


def table_of(contacts: xr.Dataset, names: list[str] | None, units: list[str] | None, bare: xr.Dataset | None) -> str:
    """The lines of the table, a line for each contact.

    names : of the columns after those of the dimensions; None: the results of `summary`
    bare : the contacts on the body without layers, whose results follow, called NAME bare

    Raises StudyError: an unknown name or unit, or a profile, which does not fit into a line.
    """
    names = names or usual(contacts)
    table = selected(contacts, names)
    if profiles := [name for name in names if name in table and "x" in table[name].dims]:
        raise StudyError([f"--columns {profiles[0]} is a profile along x, which has no place in a line"])
    if bare is not None:
        table = beside_bare(table, bare, names)
    return _lines(rows_of(in_units(table, units), names)["contacts"])


def rows_of(table: xr.Dataset, names: list[str] | None) -> dict[str, Any]:
    """The frames of a table, without the status where only other columns are chosen."""
    return {
        kind: rows if not names or "status" in names else rows.drop(columns="status", errors="ignore")
        for kind, rows in frames(table).items()
    }


def usual(contacts: xr.Dataset) -> list[str]:
    """The columns of contacts by default."""
    smooth = np.isin(contacts["micro"], list(lexicon_in(contacts).smooth_laws())).all()
    return [name for name in COLUMNS if name in contacts and not (smooth and name in OF_ASPERITIES)]


def _lines(rows: Any) -> str:
    texts = [list(map(str, rows.columns)), *([_text(value) for value in row] for row in rows.itertuples(index=False))]
    widths = [max(map(len, cells)) for cells in zip(*texts, strict=True)]
    return "\n".join("  ".join(f"{t:{w}}" for t, w in zip(row, widths, strict=True)).rstrip() for row in texts)


def _text(value: Any) -> str:
    """A number with four digits, as people write it."""
    if not isinstance(value, (float, np.floating)):
        return str(value)
    return "-" if np.isnan(value) else f"{value:.{DIGITS}g}"
