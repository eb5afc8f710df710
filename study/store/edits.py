"""In which inputs two study files differ, as a message says it."""

import tomllib
from collections.abc import Iterator
from typing import Any

from ..files.examine import Condition
from ..inputs.definition import Definition
from ..terminal import shown

MOST = 3  # differences that are named; the others are counted
UNNAMED = ("title", "numerics.block")  # no result depends on them
OPEN = ("model.", "axes.")  # sections whose inputs are known by their names alone


def owner_of(condition: Condition, definition: Definition) -> str:
    """Whose results a file has that are not those of a study of these numerics: "another definition (digest 01234567,
    here 89abcdef; Ra: 0.004 there, 0.002 here)"."""
    digests = f"digest {condition.digest[:8]}, here {definition.digest[:8]}"
    return f"another definition ({'; '.join([digests, *differences(condition.text, definition.text)])})"


def differences(text: str, other: str) -> list[str]:
    """The inputs in which two study files differ: "Ra: 0.004 there, 0.002 here". [] if one is no study file."""
    try:
        there, here = (dict(_inputs(tomllib.loads(source))) for source in (text, other))
    except (ValueError, RecursionError):
        return []
    names = [name for name in {**there, **here} if there.get(name) != here.get(name) and name not in UNNAMED]
    lines = [f"{name}: {_value(there, name)} there, {_value(here, name)} here" for name in names[:MOST]]
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
