"""The inputs in which two study files differ, in words."""

import tomllib
from collections.abc import Iterator
from typing import Any

from ..files.examine import Condition
from ..inputs.definition import Definition
from ..terminal import shown

MOST = 3  # number of differences that are named; the others are counted
UNNAMED = ("title", "numerics.block")  # inputs on which no result depends
OPEN = ("model.", "axes.")  # sections that are left out of the names of their inputs


def owner_of(condition: Condition, definition: Definition) -> str:
    """The owner of results that another study of the same numerics has made, in words: "another definition (digest
    01234567, here 89abcdef; Ra: 0.004 there, 0.002 here)"."""
    digests = f"digest {condition.digest[:8]}, here {definition.digest[:8]}"
    return f"another definition ({'; '.join([digests, *differences(condition.text, definition.text)])})"


def differences(text: str, other: str) -> list[str]:
    """The inputs in which two study files differ: "Ra: 0.004 there, 0.002 here". [] if one is not a study file."""
    try:
        inputs, other_inputs = (dict(_inputs(tomllib.loads(source))) for source in (text, other))
    except (ValueError, RecursionError):
        return []
    names = [
        name
        for name in {**inputs, **other_inputs}
        if inputs.get(name) != other_inputs.get(name) and name not in UNNAMED
    ]
    lines = [f"{name}: {_value(inputs, name)} there, {_value(other_inputs, name)} here" for name in names[:MOST]]
    return lines + [f"and {len(names) - MOST} more"] * (len(names) > MOST)


def _inputs(table: dict[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    """Name and value of each input; "n.stop" of a range, "cases[1].P" of a case."""
    for key, value in table.items():
        name = f"{before}{key}"
        tables = value if isinstance(value, list) and all(isinstance(part, dict) for part in value) else []
        if isinstance(value, dict):
            yield from _inputs(value, "" if f"{name}." in OPEN else f"{name}.")
        elif tables:
            for number, part in enumerate(tables):
                yield from _inputs(part, f"{name}[{number}].")
        else:
            yield name, value


def _value(inputs: dict[str, Any], name: str) -> str:
    return shown(inputs[name]) if name in inputs else "none"
