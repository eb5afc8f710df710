"""Study files, with units or without: `R = "5 mm"`, `h = ["2 um", "20 um"]`, `P = { start = "1 mN", ... }`.

Inputs may have spreads ("200 ± 10 GPa", materials by name). Then each case is solved several times: as given, and with
each such input moved up and down, along the dimension MOVED. The results have `NAME_spread` in place of this dimension.
"""

import hashlib
import json
from dataclasses import replace
from typing import Any

import numpy as np

from ..specimen.quantities import Quantity, has_unit, quantity
from ..terminal import shown
from . import definition
from .definition import Definition, StudyError
from .given import Draft
from .grid import axis_values
from .identity import digest_of_array
from .laws import is_parameter
from .sample import LIMITS, divisor, draw
from .scene.bodies import BODIES, with_materials
from .scene.names import NEEDS_NAMES, CaseValues, QuantityList, dim_of, si
from .vocabulary import NUMERICS, PARAMETERS, ROWS, SCENE, VOCABULARY, Parameter, no_parameter, si_unit

ANY_NUMBER = Parameter(interval="(-inf, inf)")
"""Bounds of a range of SI numbers in [sample]: what is drawn is checked later, as all numbers with units are."""
ANY_VALUE = 0.3
"""Stands for an axis with a mistake. Every parameter that is a number may have it, so no second message follows."""
FLOAT32_REMEDY = 'say dtype = "float64", or spreads = false'


def read(path) -> Definition:
    """Definition of a study file. Raises StudyError with all that is wrong with it."""
    return from_tables(*definition.parsed(path))


def from_tables(tables: dict, name: str, text: str, where: str) -> Definition:
    """Definition of the parsed TOML tables; `where` begins every message."""
    model = tables.get("model")
    model = model if isinstance(model, dict) else {}
    same_piece = model.get("same_piece", False)
    if not _has_units(tables):
        if "same_piece" in model:
            raise definition.refusal(where, [f"[model] same_piece: {NEEDS_NAMES}"])
        return definition.from_tables(tables, name, text, where)
    from .scene.reading import (
        read as read_scene,  # here: it imports xarray, for which a study without units need not wait
    )

    draft, given = definition.new_draft(tables, where)
    before = len(draft.errors)
    parameters = _parameters(draft, given)
    if draft.errors and "sample" in given:  # what it draws would be missing
        raise definition.refusal(where, draft.errors)
    spreads, errors, scene = given["output"].get("spreads", True), draft.errors, None
    try:
        right = len(errors) == before
        scene = read_scene(parameters, tables.get("cases"), spreads is True, right, same_piece is True)
    except StudyError as error:
        errors += error.messages
    if not isinstance(same_piece, bool):
        errors.append(f"[model] same_piece = {shown(same_piece)}: must be true or false")
    if not isinstance(spreads, bool):
        errors.append(f"[output] spreads = {shown(spreads)}: must be true or false")
    if scene and scene.spreads and given["output"].get("dtype") == "float32":
        problem = f"has too few digits for the spreads of {' and '.join(scene.spreads)}"
        errors.append(f'[output] dtype = "float32" {problem}: {FLOAT32_REMEDY}')
    if errors:  # what is read later only, words and other sections, is checked too: all mistakes are named at once
        for key, value in parameters.items():
            if key in VOCABULARY and VOCABULARY[key].own.choices:
                draft.checked(key, value if isinstance(value, list) else [value])
        definition.settings(given, errors)
        raise definition.refusal(where, errors)
    made = complete(draft, scene, list(given["axes"]), (given, name, text, where))
    return replace(made, digest=_digest(made))


def complete(draft: Draft, scene: Any, axes: list[str], about: tuple, **options) -> Definition:
    """The definition of a study of a scene. Its dimensions are `case`, the `axes` in their order, and MOVED.

    about, options : the other arguments of `study.inputs.definition.complete`
    """
    draft.physical = True
    draft.sizes |= scene.sizes(axes)
    for name, value in scene.parameters.items():
        draft.of_any_form(name, value)
    if "case" in draft.sizes and "case" not in draft.labels:  # DataArrays may bring numbers of their own
        draft.number_cases(draft.sizes["case"])
    return replace(definition.complete(draft, *about, **options), scene=scene)


def _has_units(tables: dict) -> bool:
    """Whether a parameter has a unit, or only a study with units has it."""
    rows = tables["cases"] if isinstance(tables.get("cases"), list) else []
    for table in (tables.get("model"), tables.get("axes"), tables.get("sample"), *rows):
        for name, given in table.items() if isinstance(table, dict) else ():
            values = given.values() if isinstance(given, dict) else given if isinstance(given, list) else [given]
            if name in SCENE or name in BODIES or (name in VOCABULARY and any(map(has_unit, values))):
                return True
    return False


def _parameters(draft: Draft, given: dict) -> dict:
    """The parameters of [model], [axes] and [sample], ranges as lists of their values; messages go to the draft."""
    errors, axes = draft.errors, given["axes"]
    model = {name: value for name, value in given["model"].items() if name != "same_piece"}  # which is no parameter
    sample = _sampled(given["sample"], draft) if "sample" in given else {}
    if sample and "cases" in given:
        errors.append("[sample] and [[cases]] both make the dimension case: only one of them is allowed")
    errors += [f"{name} is given twice: in [sample] and elsewhere" for name in sample if name in model or name in axes]
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
    return sample | {name: _axis(name, raw, errors) for name, raw in axes.items()} | model


def _axis(name: str, raw: Any, errors: list[str]) -> list | QuantityList:
    """The values of an axis. A range with units becomes SI values."""
    numeric = name in ROWS and not ROWS[name].own.choices
    with_unit = isinstance(raw, dict) and numeric and ROWS[name].unit != "1"
    before = len(errors)
    raw = _in_si(raw, name, ROWS[name].unit, errors) if with_unit else raw
    values = axis_values(raw, name, errors) if len(errors) == before else []
    if not values:  # what else is wrong is looked for, without a second message about this
        word = "PTFE" if name in BODIES else []  # any material
        return QuantityList([Quantity(ANY_VALUE)], dim_of(name)) if numeric else word
    return QuantityList([Quantity(value) for value in values], dim_of(name)) if with_unit else values


def _in_si(raw: dict, key: str, unit: str, errors: list[str]) -> dict:
    """A range with its ends as numbers in the SI `unit`; messages and {} for ends that it cannot have."""
    try:
        read = {end: quantity(f"{key}: {end}", raw[end], unit) for end in ("start", "stop") if end in raw}
    except ValueError as error:
        errors.append(str(error))
        return {}
    unsure = [end for end, one in read.items() if one.spread]
    errors += [f"{key}: {end} = {shown(raw[end])}: a range has no spread, a list of values may" for end in unsure]
    ends = {end: one.value for end, one in read.items()}
    wrong = [end for end, value in ends.items() if raw.get("spacing") == "log" and value <= 0]
    errors += [f"{key}: {end} = {shown(raw[end])}: must be > 0 for spacing log" for end in wrong]
    return {} if wrong or unsure else raw | ends


def _sampled(table: Any, draft: Draft) -> dict[str, CaseValues | QuantityList]:
    """What [sample] draws, over the dimension `case`: SI numbers from ranges, entries of lists as they stand there."""
    drawn, errors = table if isinstance(table, dict) else {}, draft.errors
    before, known, in_si = len(errors), {}, dict(drawn)
    for name, raw in drawn.items():
        if isinstance(raw, list):
            _check_list(name, raw, draft)
        if name in BODIES:
            known[name] = Parameter(choices=("a material",))
        elif name in SCENE or is_parameter(name):
            known[name] = VOCABULARY[name].own if ROWS[name].unit == "1" and name in VOCABULARY else ANY_NUMBER
            if isinstance(raw, dict):
                in_si[name] = _in_si(raw, f"[sample] {name}", _unit_of_range(name, raw), errors)
        elif name not in LIMITS:
            errors.append(no_parameter(name, [*PARAMETERS, *SCENE, *BODIES], "[sample] "))
    if len(errors) > before:
        return {}
    return {
        name: QuantityList(list(map(Quantity, values)), "case") if isinstance(drawn[name], dict) else CaseValues(values)
        for name, values in draw(in_si if drawn else table, known, errors).items()
    }


def _check_list(name: str, raw: list, draft: Draft) -> None:
    """Messages for values of a list of [sample], of which some may not be drawn."""
    if name in BODIES:
        with_materials({name: CaseValues(raw)}, draft.errors)
    elif name in SCENE or (is_parameter(name) and not VOCABULARY[name].own.choices):
        for i, one in enumerate(raw):
            try:
                si(name, one, f"{name}[{i}]")
            except ValueError as error:
                draft.errors.append(str(error))
    elif is_parameter(name):
        draft.checked(name, raw)


def _unit_of_range(name: str, raw: dict) -> str:
    """The SI unit of the ends of a range of [sample]: with over = "Ra^2" that of the product with Ra²."""
    i, j = ROWS[name].powers
    other, power = divisor(raw)
    if other in ROWS:
        i, j = (own + power * more for own, more in zip((i, j), ROWS[other].powers, strict=True))
    return si_unit((i, j))


def _digest(made: Definition) -> str:
    """The digest of a study with units: of its dimensionless numbers, and of the SI values from which they follow."""
    scene = made.scene
    content = [made.digest, scene.labels, sorted(scene.names.items())]
    for name, value in sorted(scene.given.items()):
        content.append((name, getattr(value, "dims", ()), digest_of_array(np.asarray(value))))
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
