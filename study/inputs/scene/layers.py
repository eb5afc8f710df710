"""Stacks of layers in calls and study files: a list of layers as one name for each number, and rows of these names.

The first layer, at the surface, has the names of a case with one layer, h, n or E1, nu1, bonding, layer; the others
have names like layers.2.h (:mod:`solver.layers`).
"""

import re
from collections.abc import Mapping
from typing import Any

from solver import layers

from ...terminal import shown
from ..vocabulary import FIRST_LAYER, OF_A_LAYER, name_in_stack, suggest

#: Parameters that a stack has in place of those of one layer.
_ONE_LAYER = ("h", "n", "nu1", "bonding", "E1", "layer")
#: A base -> what it is called when there are layers.
_BASES = {"auto": "stack", "thin_layer": "thin_stack"}
RIGID = "rigid_base"


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


def flattened(table: dict, errors: list[str], rows: Any = (), elsewhere: Any = ()) -> dict:
    """Parameters of a call, section or case with one name for each number of a layer, and the base of a stack.

    rows : cases beside the parameters, in which the base may stand
    elsewhere : names of parameters that stand in other sections, and so not in the list of layers
    """
    table = _dotted(table)
    if not any(map(_is_of_layers, (*table, *elsewhere))):
        return table
    errors += _twice(table)
    named = {name: value for name, value in table.items() if name.startswith("layers.")}
    others = {name: value for name, value in table.items() if name not in ("layers", RIGID, *named)}
    stack = {}
    if "layers" in table:
        beside = [name for name in _ONE_LAYER if name in others]
        errors += [f"{name} is given beside layers: each of the layers has its own" for name in beside[:1]]
        others = {name: value for name, value in others.items() if name not in beside}
        stack = _of_list(table["layers"], errors)
    named = {short(name): value for name, value in named.items()}
    stack = {name: value for name, value in stack.items() if name not in elsewhere} | named
    stack = _on_base(stack, table.get(RIGID, False), others | dict.fromkeys(elsewhere), errors)
    count = max(layers.numbers_of((*stack, *elsewhere)), 1)
    if count > layers.MOST:
        errors.append(f"layers: {count} layers: at most {layers.MOST} are allowed")
        return others
    return _with_base(others, errors, rows or []) | stack | {"sublayers": others.get("sublayers", 0)}


def in_call(parameters: dict, rows: list[dict], errors: list[str]) -> tuple[dict, list[dict]]:
    """The parameters of a call, and its cases, with one name for each number of a layer.

    Where `layers` holds for all cases, a number of a layer in a case stands in place of what the list says.
    """
    if not any(map(_is_of_layers, _dotted(parameters))):
        rows = [flattened(row, errors, [parameters] if "base" in parameters else ()) for row in rows]
        return parameters, rows
    again = [name for name in ("layers", RIGID, "sublayers") if name in parameters and any(name in row for row in rows)]
    if again:
        errors.append(f"{again[0]} is given twice: in [[cases]] and elsewhere")
        return {name: value for name, value in parameters.items() if not _is_of_layers(name)}, rows
    rows = [_dotted(row) for row in rows]
    for row in rows:
        errors += _twice(row)
    rows = _with_the_list([{short(name): value for name, value in row.items()} for row in rows], parameters)
    return flattened(parameters, errors, rows, {name for row in rows for name in row}), rows


def _with_the_list(rows: list, table: dict) -> list:
    """The cases; where some have a number of a layer the others have that of the list `layers` in the table."""
    numbers = _of_list(table["layers"], []) if "layers" in table else {}
    of_some = {name: numbers[name] for row in rows if isinstance(row, dict) for name in row if name in numbers}
    return [of_some | row if isinstance(row, dict) else row for row in rows]


def in_tables(tables: dict, errors: list[str]) -> tuple[dict, dict]:
    """The tables of a study file with one name for each number of a layer; and the numbers of [[layers]]."""
    parts = {section: tables.get(section) for section in ("model", "axes", "sample")}
    parts = {section: _dotted(table) for section, table in parts.items() if isinstance(table, dict)}
    rows = tables.get("cases", [])
    rows = [_dotted(row) if isinstance(row, dict) else row for row in rows] if isinstance(rows, list) else []
    names = [name for part in (*parts.values(), *(row for row in rows if isinstance(row, dict))) for name in part]
    if "layers" not in tables and not any(map(_is_of_layers, names)):
        return tables, {}
    beside = [name for name in _ONE_LAYER if name in names and "layers" in tables]
    errors += [f"{name} is given beside layers: each of the layers has its own" for name in beside[:1]]
    for part in (*parts.values(), *(row for row in rows if isinstance(row, dict))):
        errors += _twice(part)
    parts = {section: {short(name): value for name, value in part.items()} for section, part in parts.items()}
    rows = [{short(name): value for name, value in row.items()} if isinstance(row, dict) else row for row in rows]
    rows = _with_the_list(rows, tables)
    axes, sections = parts.get("axes", {}), [parts.get("axes", {}), parts.get("sample", {}), *rows]
    elsewhere = {name for part in sections if isinstance(part, dict) for name in part}
    bases = [{"base": 0}] * ("base" in elsewhere)
    source = parts["model"] | ({"layers": tables["layers"]} if "layers" in tables and not beside else {})
    flat = flattened(source, errors, bases, elsewhere)
    if isinstance(axes.get("base"), list):
        parts["axes"] = _with_base(axes, errors, [])
    model = {name: value for name, value in flat.items() if name in parts["model"] or name == "base"}
    stack = {name: value for name, value in flat.items() if name not in model}
    return tables | parts | {"model": model, "layers": None} | ({"cases": rows} if rows else {}), stack


def in_layers(messages: list[str], names: Any) -> list[str]:
    """Messages that name h of a stack as layers.1.h, as the other layers are named. `names` : of the inputs given."""
    if "sublayers" not in names:
        return messages
    fields = {name: field for field, name in FIRST_LAYER.items()}
    before = "^| and |: |follows from |given as |in place of "
    after = r"\[|: | = | is missing| is given twice| and | are both | follows |,|$"
    first = re.compile(f"({before})({'|'.join(fields)})(?={after})")
    return [first.sub(lambda match: f"{match[1]}layers.1.{fields[match[2]]}", message) for message in messages]


def axes_in(tables: dict) -> list[str]:
    """The names of [axes] in their order."""
    axes = tables.get("axes", {})
    return [short(name) for name in _dotted(axes)] if isinstance(axes, dict) else []


def _is_of_layers(name: Any) -> bool:
    return isinstance(name, str) and (name in ("layers", RIGID, "sublayers") or name.startswith("layers."))


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


def short(name: str) -> str:
    """The name that results have: "h" of "layers.1.h", all others as they are."""
    field = name.removeprefix("layers.1.") if isinstance(name, str) else name
    return name if field == name else name_in_stack(1, field)


def _twice(table: dict) -> list[str]:
    """Messages for numbers of the first layer that stand in a table under both of their names."""
    both = [(short(name), name) for name in table if isinstance(name, str) and short(name) != name]
    return [f"{name} is {short}, which is given too: leave out one" for short, name in both if short in table]


def _of_list(stack: Any, errors: list[str]) -> dict:
    """Name -> value of a list of layers."""
    if not isinstance(stack, (list, tuple)) or not stack or not all(isinstance(layer, Mapping) for layer in stack):
        form = '[{"h": "2 um", "material": "DLC a-C:H", "bonding": "bonded"}, ...], the layer at the surface first'
        errors.append(f"layers = {shown(stack)}: must be a list of layers, {form}")
        return {}
    if len(stack) > layers.MOST:
        errors.append(f"layers: {len(stack)} layers: at most {layers.MOST} are allowed")
        return {}
    flat = {}
    for number, layer in enumerate(stack, 1):
        try:
            fields = layers.fields_of(layer, number)
        except ValueError as error:
            errors.append(str(error) if str(error).startswith("layers") else f"layers.{number}: {error}")
            continue
        for field, value in fields.items():
            name = f"layers.{number}.{field}"
            if field not in OF_A_LAYER:
                errors.append(f"{name}: is not a key of a layer{suggest(str(field), OF_A_LAYER)}")
            elif isinstance(value, (list, tuple, range)):
                errors.append(f"{name} has several values: an axis stands beside layers, as {shown(name)}")
            else:
                flat[name_in_stack(number, field)] = value
    return flat


def _on_base(stack: dict, rigid: Any, others: dict, errors: list[str]) -> dict:
    """The stack with n = 0 where the base is rigid."""
    if rigid is not True:
        errors += [f"{RIGID} = {shown(rigid)}: must be true or false"] * (rigid is not False)
        return stack
    if "E2" in others or "body" in others:
        errors.append(f'{RIGID} is for studies without units: give E2 = "rigid"')
        return stack
    n = (others | stack).get("n", 1)
    if not isinstance(n, (int, float)) or n != 1:
        errors.append(f"layers.1.n = {shown(n)}: on a rigid base n is E_j*/E1*, and that of the first layer 1")
    return stack | {"n": 0.0}


def _with_base(others: dict, errors: list[str], rows: list[dict]) -> dict:
    if any("base" in row for row in rows):
        return others
    bases = others.get("base", "stack")
    several = bases if isinstance(bases, (list, tuple)) else [bases]
    if "layered" in [base for base in several if isinstance(base, str)]:
        errors.append('base = "layered" has one layer: of layers it is "stack"')
    words = [_BASES.get(base, base) if isinstance(base, str) else base for base in several]
    return others | {"base": words if isinstance(bases, (list, tuple)) else words[0]}
