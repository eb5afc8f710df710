"""The question of a design, read and checked: the wanted result, and the input to determine with its bounds."""

import math
from typing import Any

from ..derivatives import QUANTITIES
from ..inputs.definition import Definition, StudyError, from_call, refuse_scans
from ..inputs.lexicon import lexicon_for
from ..inputs.scene.scene import si
from ..inputs.scene.stacks import short
from ..inputs.vocabulary import NUMERICS, ROWS, SCENE, VOCABULARY, finite, no_parameter, suggest
from ..specimen.foreign import plain
from ..specimen.quantities import has_unit
from ..terminal import shown
from .design_cases import Wanted

#: Possible targets: the results with derivatives, and the load at pull-off, which has no derivatives.
TARGETS = (*QUANTITIES, "P_off")
_EXAMPLE = 'such as {"p_max": "180 MPa"}'
_BOUNDS = 'such as by={"h": ("1 um", "1 mm")}'


def read_wanted(
    targets: Any, by: Any, parameters: dict, rows: list[dict], same_piece: Any, correlations: Any
) -> Wanted:
    """The design of a call. Raises StudyError for wrong arguments, before anything is computed."""
    target, value = _target(targets)
    written, bounds = _looked_for(by, (parameters, *rows))
    name = short(written)  # as in results: "h" for "layers.1.h"
    rest = {key: entry for key, entry in parameters.items() if entry is not None}
    twice = any({name, written} & {*table} for table in (rest, *rows))
    wrong = [f"{written} is both given and searched for (by): leave one of them out"] * twice
    wrong += [f"{target} is the target, and {target} is given: leave it out"] * any(target in t for t in (rest, *rows))
    wrong += [f"{target} is both the target and searched for (by)"] * (name == target)
    if wrong:
        raise StudyError(f"design: {text}" for text in wrong)
    ends = [_definition(rest | {written: bound}, rows, same_piece, correlations) for bound in bounds]
    low, high = (_number(definition, name) for definition in ends)
    written = f"by: {written} = ({shown(bounds[0])}, {shown(bounds[1])})"
    if not (math.isfinite(low) and math.isfinite(high)):
        raise StudyError([f"design: {written}: both bounds must be finite"])
    if low >= high:
        raise StudyError([f"design: {written}: the first bound must be below the second"])
    if ends[0].scene and name in {*ends[0].scene.spreads, *ends[1].scene.spreads}:
        raise StudyError([f"design: {written}: a bound has no ±"])
    return Wanted(ends[0], target, _level(target, value, ends[0]), name, low, high)


def _target(targets: Any) -> tuple[str, Any]:
    if not isinstance(targets, dict) or len(targets) != 1:
        many = f"{len(targets)} targets" if isinstance(targets, dict) else shown(targets)
        raise StudyError([f"design: {many}: give exactly one wanted result with its value, {_EXAMPLE}"])
    ((target, value),) = targets.items()
    if target not in TARGETS:
        raise StudyError([f"design: {shown(target)} is not a result that can be wanted{suggest(str(target), TARGETS)}"])
    return target, plain(value)


def _looked_for(by: Any, tables: tuple) -> tuple[str, tuple]:
    if not isinstance(by, dict) or len(by) != 1:
        raise StudyError([f"design: by = {shown(by)}: give exactly one input with two bounds, {_BOUNDS}"])
    ((name, bounds),) = by.items()
    shortened = short(name) if isinstance(name, str) else name
    lexicon = lexicon_for(tables, [shortened] if isinstance(name, str) else ())
    if not (shortened in SCENE or shortened in lexicon.parameters):
        raise StudyError([f"design: by: {no_parameter(name, [*lexicon.parameters, *SCENE])}"])
    parameter = lexicon.parameter(shortened) if shortened in lexicon.rows else None
    if name in NUMERICS or (parameter and (not parameter.interval or parameter.whole)):
        raise StudyError([f"design: by: {name} is not a number of the contact that can be searched for"])
    bounds = tuple(map(plain, bounds)) if isinstance(bounds, (tuple, list)) else bounds
    if not isinstance(bounds, tuple) or len(bounds) != 2 or any(isinstance(end, (tuple, list)) for end in bounds):
        raise StudyError([f"design: by: {name} = {shown(bounds)}: must be two bounds, {_BOUNDS}"])
    return name, bounds


def _definition(parameters: dict, rows: list[dict], same_piece: Any, correlations: Any) -> Definition:
    try:
        return refuse_scans(from_call(parameters, rows, same_piece, {}, correlations), "design")
    except StudyError as error:
        raise StudyError(text.replace("solve: ", "design: ", 1) for text in error.messages) from None


def _number(definition: Definition, name: str) -> float:
    """The value of a single input."""
    if definition.scene and name in definition.scene.values:
        return float(definition.scene.values[name])
    return float(definition.grid.values[name][1])


def _level(target: str, value: Any, definition: Definition) -> float:
    """The wanted value in SI, or dimensionless."""
    wanted, unit = f"design: {target} = {shown(value)}", ROWS[target].unit
    if definition.scene:
        try:
            quantity = si(target, value)
        except ValueError as error:
            raise StudyError([f"design: {error}"]) from None
        if quantity.spread:
            raise StudyError([f"{wanted}: a wanted value has no ±"])
        level = quantity.value
    elif isinstance(value, str) or has_unit(value):
        other = f", in {VOCABULARY[target].scale}" * (unit != "1")
        raise StudyError([f"{wanted}: no other input has a unit: give a number{other}"])
    elif not finite(value):
        raise StudyError([f"{wanted}: must be one finite number"])
    else:
        level = float(value)
    if target == "P_off":
        if not level < 0:
            raise StudyError([f"{wanted}: must be < 0, a pull"])
        if "w_adhesion" not in {*definition.grid.values, *(definition.scene.values if definition.scene else ())}:
            raise StudyError([f"{wanted}: without w_adhesion the surfaces do not adhere: give it, or look for it"])
        return level
    limits = "must be in (0, 1]" if target == "Ar_An" else "must be > 0"
    if not 0 < level <= (1 if target == "Ar_An" else math.inf):
        raise StudyError([f"{wanted}: {limits}"])
    return level
