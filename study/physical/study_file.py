"""Study files, with units or without: `R = "5 mm"`, `h = ["2 um", "20 um"]`, `P = { start = "1 mN", ... }`."""

import hashlib
import json
from dataclasses import replace
from typing import Any

import numpy as np

from ..scene.quantities import Quantity, has_unit
from ..spec import definition
from ..spec.definition import Definition, StudyError
from ..spec.given import Draft
from ..spec.grid import axis_values, shown
from ..spec.identity import digest_of_array
from ..spec.vocabulary import NUMERICS, VOCABULARY
from .bodies import BODIES
from .names import SCENE, Known, dim_of, si, unit_of

NOTE = "(numbers and limits are dimensionless here: lengths in R, loads in E2* R², Nbar in 1/R², n = E1*/E2*)"


def read(path) -> Definition:
    """Definition of a study file. Raises StudyError with all that is wrong with it."""
    return from_tables(*definition.parsed(path))


def from_tables(tables: dict, name: str, text: str, where: str) -> Definition:
    """Definition of the parsed TOML tables; `where` begins every message."""
    with_unit = _with_unit(tables)
    if not with_unit:
        return definition.from_tables(tables, name, text, where)
    from .reading import read as read_scene  # takes xarray with it, which a study without units need not wait for

    draft, given = definition.begun(tables, where)
    definition.add_numerics(draft, given)
    parameters = _parameters(draft, given)
    if draft.errors:
        raise definition.refusal(where, draft.errors)
    try:
        scene = read_scene(parameters, tables.get("cases"), spreads=False)
        if scene.spreads:
            several = " and ".join(scene.spreads)
            raise StudyError([f"{several}: a study file takes no spreads (±); study.solve propagates them"])
    except StudyError as error:
        hint = f" ({with_unit} makes this a study with units)"
        raise definition.refusal(where, [f"{m}{hint * ('has no unit' in m)}" for m in error.messages]) from None
    made = complete(draft, scene, list(given["axes"]), (given, name, text, where))
    return replace(made, digest=_digest(made))


def complete(draft: Draft, scene: Any, axes: list[str], about: tuple, **options) -> Definition:
    """The definition of a scene, with a dimension for each of the `axes`, in their order.

    about, options : the other arguments of `study.spec.definition.complete`
    """
    draft.physical = True
    for dim, size in scene.sizes(axes).items():
        if dim == "case":
            draft.number_cases(size)
        draft.sizes[dim] = size
    for name, value in scene.parameters.items():
        draft.of_any_form(name, value)
    try:
        return replace(definition.complete(draft, *about, **options), scene=scene)
    except StudyError as error:
        raise StudyError([*error.messages, NOTE]) from None


def _with_unit(tables: dict) -> str:
    """The first parameter of a study file that only one with units has, as `NAME = VALUE`; "" if there is none."""
    rows = tables["cases"] if isinstance(tables.get("cases"), list) else []
    for table in (tables.get("model"), tables.get("axes"), *rows):
        for name, given in table.items() if isinstance(table, dict) else ():
            values = given.values() if isinstance(given, dict) else given if isinstance(given, list) else [given]
            if name in SCENE or name in BODIES or (name in VOCABULARY and any(map(has_unit, values))):
                return f"{name} = {shown(given)}"
    return ""


def _parameters(draft: Draft, given: dict) -> dict:
    """The parameters of [model] and [axes], with ranges as lists of SI values; messages go to the draft."""
    errors, model, axes = draft.errors, given["model"], given["axes"]
    if "sample" in given:
        errors.append("[sample] draws dimensionless numbers: a study with units takes [axes] or [[cases]]")
    rows = given.get("cases", [{}])
    if not isinstance(rows, list) or not rows or not all(isinstance(row, dict) for row in rows):
        errors.append("cases must be [[cases]] tables, at least one")
    for name, value in model.items():
        if name in NUMERICS:
            errors.append(f"[model] {name} belongs in [numerics]")
        elif name in axes:
            errors.append(f"{name} is given twice: in [model] and in [axes]")
        elif isinstance(value, (list, dict)):
            errors.append(f"[model] {name} has several values: these belong in [axes]")
    return {name: _axis(name, raw, errors) for name, raw in axes.items()} | model


def _axis(name: str, raw: Any, errors: list[str]) -> list | Known:
    """The values of an axis; of a range with units evenly spaced in SI."""
    if not isinstance(raw, dict) or not (name in SCENE or name in VOCABULARY) or unit_of(name) == "1":
        return axis_values(raw, name, errors)
    ends = {}
    for end in ("start", "stop"):
        try:
            ends[end] = si(name, raw[end], f"{name}: {end}").value if end in raw else None
        except ValueError as error:
            errors.append(str(error))
            return Known([], dim_of(name))
    return Known([Quantity(value) for value in axis_values(raw | ends, name, errors)], dim_of(name))


def _digest(made: Definition) -> str:
    """The digest of a study with units: of its dimensionless numbers, and of the SI values that they are made of."""
    scene = made.scene
    content = [made.digest, scene.labels, sorted(scene.names.items())]
    for name, value in sorted(scene.given.items()):
        content.append((name, getattr(value, "dims", ()), digest_of_array(np.asarray(value))))
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
