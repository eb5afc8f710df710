"""Stacks of layers in calls and study files: :mod:`solver.layers` gives each of their numbers one name.

The first layer, at the surface, has the names of a case with one layer, h, n or E1, nu1, bonding, layer; the others
have names like layers.2.h. Units and materials are read later, by name.
"""

import re
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from solver.layers import RIGID, LayerWords, base_of_layers, is_of_layers

from ...terminal import shown
from ..vocabulary import FIRST_LAYER, OF_A_LAYER, name_in_stack, suggest

#: The words of calls and study files, in which a layer may have a modulus or a material.
WORDS = LayerWords(
    keys=OF_A_LAYER,
    first=FIRST_LAYER,
    conflicts=("h", "n", "nu1", "bonding", "E1", "layer"),
    rigid=("E2", "body"),
    example='[{"h": "2 um", "material": "DLC a-C:H", "bonding": "bonded"}, ...], the layer at the surface first',
    shown=shown,
    hint=lambda key: suggest(key, OF_A_LAYER),
    arrays=False,
)
short = WORDS.short


def moduli_of(names: Any) -> list[tuple[str, str, str]]:
    """Young's modulus, Poisson ratio and ratio of moduli of each part of a layer whose modulus is among the names."""
    parts = []
    for name in names:
        if name.startswith("layers.") and name.rpartition(".")[2] in ("E1", "E1_bottom"):
            number, _, field = name.removeprefix("layers.").partition(".")
            end = field.removeprefix("E1")
            nu = name_in_stack(int(number), f"nu{end}")
            nu = nu if nu in names else name_in_stack(int(number), "nu")
            parts.append((name, nu, name_in_stack(int(number), f"n{end}")))
    return parts


def in_call(parameters: dict, rows: list[dict], errors: list[str]) -> tuple[dict, list[dict]]:
    """The parameters of a call, and its cases, with one name for each number of a layer.

    If `layers` holds for all cases, a number of a layer in a case replaces the number in the list.
    """
    parameters = _dotted(parameters)
    if not any(map(is_of_layers, parameters)):
        elsewhere = ["base"] if "base" in parameters else []
        return parameters, [_flat(row, errors, elsewhere) for row in rows]
    twice = [name for name in ("layers", RIGID, "sublayers") if name in parameters and any(name in row for row in rows)]
    if twice:
        errors.append(f"{twice[0]} is given twice: in [[cases]] and elsewhere")
        return {name: value for name, value in parameters.items() if not is_of_layers(name)}, rows
    rows = [_dotted(row) for row in rows]
    for row in rows:
        errors += WORDS.twice(row)
    listed = WORDS.list_of(parameters["layers"]) if "layers" in parameters else ({}, [])
    rows = _with_the_list(_short(rows), listed[0])
    return _flat(parameters, errors, {name for row in rows for name in row}, listed), rows


def in_tables(tables: dict, errors: list[str]) -> tuple[dict, dict]:
    """The tables of a study file with one name for each number of a layer; and the numbers of [[layers]]."""
    parts = {section: tables.get(section) for section in ("model", "axes", "sample")}
    parts = {section: _dotted(table) for section, table in parts.items() if isinstance(table, dict)}
    rows = tables.get("cases", [])
    rows = [_dotted(row) if isinstance(row, dict) else row for row in rows] if isinstance(rows, list) else []
    places = [*parts.values(), *(row for row in rows if isinstance(row, dict))]
    names = [name for part in places for name in part]
    if "layers" not in tables and not any(map(is_of_layers, names)):
        return tables, {}
    conflicts = WORDS.conflicts_among(names) if "layers" in tables else []
    errors += conflicts
    for part in places:
        errors += WORDS.twice(part)
    parts, rows = dict(zip(parts, _short(parts.values()), strict=True)), _short(rows)
    listed = WORDS.list_of(tables["layers"]) if "layers" in tables else None
    rows = _with_the_list(rows, listed[0] if listed else {})
    places = [parts.get("axes", {}), parts.get("sample", {}), *(row for row in rows if isinstance(row, dict))]
    source = parts["model"] | ({"layers": tables["layers"]} if "layers" in tables and not conflicts else {})
    flat = WORDS.flat(source, errors, {name for part in places for name in part}, listed)
    if isinstance(parts["axes"].get("base"), list):
        parts["axes"] = parts["axes"] | {"base": base_of_layers(parts["axes"]["base"], errors)}
    model = {name: value for name, value in flat.items() if name in parts["model"] or name == "base"}
    stack = {name: value for name, value in flat.items() if name not in model}
    return tables | parts | {"model": model, "layers": None} | ({"cases": rows} if rows else {}), stack


def _flat(table: dict, errors: list[str], elsewhere: Collection[str] = (), listed: tuple | None = None) -> dict:
    return WORDS.flat(_dotted(table), errors, elsewhere, listed)


def _short(tables: Iterable) -> list:
    """Tables of parameters with the names as in results; other values stay as they are."""
    return [{short(name): v for name, v in table.items()} if isinstance(table, dict) else table for table in tables]


def _with_the_list(rows: list, numbers: dict) -> list:
    """The cases. If some have a number of a layer, the others get it from `numbers`, those of the list `layers`."""
    of_some = {name: numbers[name] for row in rows if isinstance(row, dict) for name in row if name in numbers}
    return [of_some | row if isinstance(row, dict) else row for row in rows]


def in_layers(messages: list[str], names: Any) -> list[str]:
    """Messages that name h of a stack as layers.1.h, as the other layers are named. `names` : of the inputs given."""
    if "sublayers" not in names:
        return messages
    fields = {name: field for field, name in FIRST_LAYER.items()}
    before = "^| and |: |follows from |given as |in place of |or give "
    after = r"\[|: | = | is missing| is given twice| and | are both | follows |,|\)|$"
    first = re.compile(f"({before})({'|'.join(fields)})(?={after})")
    return [first.sub(lambda match: f"{match[1]}layers.1.{fields[match[2]]}", message) for message in messages]


def axes_in(tables: dict) -> list[str]:
    """The names of [axes] in their order."""
    axes = tables.get("axes", {})
    return [short(name) for name in _dotted(axes)] if isinstance(axes, dict) else []


def _dotted(table: dict) -> dict:
    """`layers.2.h` of TOML, a table of tables, as one name."""
    nested = table.get("layers")
    if not isinstance(nested, Mapping) or not nested:
        return table
    flat = {name: value for name, value in table.items() if name != "layers"}
    for number, fields in nested.items():
        for field, value in fields.items() if isinstance(fields, Mapping) else [("", fields)]:
            flat[f"layers.{number}.{field}".rstrip(".")] = value
    return flat
