"""What a call of `fit` asks: the model, its unknown inputs with bounds and priors, and whose spreads it takes over."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from solver.parameters import ends

from ...inputs.definition import Definition, StudyError
from ...inputs.lexicon import Lexicon, lexicon_for
from ...inputs.punch.shapes import ANGLES
from ...inputs.reading import from_call
from ...inputs.scene.layers import short
from ...inputs.vocabulary import BODIES, CONTROLS, ROWS, scene_of, suggest
from ...specimen.quantities import has_unit, quantity
from ...terminal import shown
from .model import PAIRS, Model, is_ratio

MOST = 3  # unknown inputs
ROUGHNESS = ("Nbar", "Ra", "sigma", "cut", "B", "beta")
#: Pairs of inputs that change a curve alike, so that only one of them can be told.
_ALIKE = [*combinations(ROUGHNESS, 2), ("E1", "nu1"), ("E1", "R"), ("E1", "n")]
_ALIKE_WORDS = "a curve cannot tell them apart: give one of them a value"
_ABSCISSA = {"D": "1 nm", "P": "1 nN", "a": "1 nm"}
_OF_BODIES = {"layer": ("E1", "nu1"), "body": ("E2", "nu2"), "punch": ("E_punch", "nu_punch")}
_MODULUS = "1 MPa"  # stands for a modulus that is not known while the call is checked
DECADE = np.log(10.0)


@dataclass(frozen=True)
class Asked:
    """A checked call.

    model : the curve, with its unknown inputs: free ones, then those with a prior
    bounds : free input -> (low, high) in SI; other free inputs have bounds that follow from each curve
    priors : input with ± in the call, free ones too -> (coordinate, its spread), as the unknowns of `Model`
    spreads : other input -> its spread in its coordinate
    shifts : unknowns after the inputs
    called : free input -> its name in the call, "layers.1.E1" of E1
    call : arguments of `study.solve`: stand-ins for unknown inputs without a value, and for x
    """

    model: Model
    free: tuple[str, ...]
    bounds: dict[str, tuple[float, float]]
    priors: dict[str, tuple[float, float]]
    spreads: dict[str, float]
    shifts: tuple[str, ...]
    loss: str
    intervals: str | None
    level: float
    called: dict[str, str]
    call: dict[str, Any]


def asked(free: Any, parameters: dict, x: str, y: str, options: dict) -> Asked:
    """Check a call. Raises StudyError before any curve is read."""
    errors = _choices(x, y, options)
    names, texts = _listed(free, errors), dict(free) if isinstance(free, dict) else {}
    called = {short(name): name for name in names}  # "layers.1.E1" is E1 among the inputs of a contact
    names, texts = tuple(map(short, names)), {short(name): pair for name, pair in texts.items()}
    lexicon = lexicon_for([parameters], [name for name in (*names, *map(short, parameters)) if name not in ROWS])
    numbers = _numbers((*names, *parameters), lexicon)
    for name in names:
        if name not in numbers:
            near = suggest(name, numbers, ["such as E1, h or Ra"]).replace("; known: ", ", ")
            errors.append(f"free: {shown(called[name])} is no input that can be fitted{near}")
    errors += [f"free: {name} stands twice" for name in dict.fromkeys(names) if names.count(name) > 1]
    errors += [f"fit: leave out {name}: curves have it" for name in CONTROLS if parameters.get(name) is not None]
    values = _in_layers(parameters) | {short(name): value for name, value in parameters.items()}
    written = {*map(short, parameters), *names} & {*values}  # ± of layers that are not free is taken over
    priors = tuple(name for name in values if name in written and _has_prior(name, values[name], name in names))
    unknowns = (*names, *(name for name in priors if name not in names))
    if "k_machine" in unknowns:
        errors.append(
            "free: k_machine: where a punch comes off is read from the points, so they do not say what held it"
        )
    errors += [f"free: {a} and {b}: {_ALIKE_WORDS}" for a, b in _ALIKE if a in unknowns and b in unknowns]
    if not names and not errors:
        errors.append('free: name at least one input, such as free=["E1"]')
    if len(unknowns) > MOST:
        errors.append(
            f"fit: at most {MOST} inputs can be unknown, here are {', '.join(unknowns)}: leave out a ±, or fix one"
        )
    bounds: dict[str, tuple[float, float]] = {}
    for name in (name for name in texts if name in numbers):
        bounds |= _bounds(name, texts[name], errors, lexicon)
    if errors:
        raise StudyError(errors)
    from_material = {name for body, rows in _OF_BODIES.items() if parameters.get(body) is not None for name in rows}
    open_ = [name for name in names if values.get(name) is None and name not in from_material]
    stand_in = {name: _stand_in(name, bounds, lexicon) for name in open_}
    lacking = [name for name, value in stand_in.items() if value is None]
    if lacking or (options["plan"] and open_):
        wanted = "give the value that is assumed" if options["plan"] else "give bounds, or a value to begin with"
        way = ', free={{"{0}": (low, high)}}, or {0}=...' if not options["plan"] else ", {0}=..."
        raise StudyError([f"free: {name} has no value: {wanted}{way.format(name)}" for name in lacking or open_])
    call = parameters | {called.get(name, name): value for name, value in stand_in.items()} | {x: _ABSCISSA[x]}
    _check_ends(call, {name: pair for name, pair in bounds.items() if name not in from_material}, called, lexicon)
    definition = _definition(call, "fit")
    scene = definition.scene
    if scene is None:
        raise StudyError(["fit: curves have units, so that R and the moduli must have some too"])
    priors = tuple(name for name in priors if name in scene.spreads)  # ± 0 is exact
    unknowns = (*names, *(name for name in priors if name not in names))
    moved = tuple(name for name in scene.spreads if name not in unknowns and name not in CONTROLS)
    model = Model.of(definition, x, y, unknowns, moved)
    if model.sticks and (x, y) != ("D", "P"):
        way = 'of what sticks the load over the depth is fitted: x = "D", y = "P"'
        raise StudyError([f"x = {shown(x)}, y = {shown(y)}: {way}"])
    if model.sticks and scene.parameters.get("shape") == "flat":
        way = "its load is a straight line down to pull-off: w_adhesion follows from P_off by `design`"
        raise StudyError([f'fit: shape = "flat" with w_adhesion: {way}'])
    absent = [name for name in unknowns if name not in scene.values and name not in scene.parameters]
    if model.sticks and scene.parameters.get("adhesion") != "maugis":
        absent += [name for name in unknowns if name in ("sigma0", "z0")]
    if absent:
        raise StudyError([f"free: {name} does not act in this contact" for name in absent])
    for name in names:
        if name not in bounds and name != model.modulus and name not in priors:
            value = model.value(name)
            bounds[name] = (0.0, 0.5) if is_ratio(name) else _within(name, value / 10, 10 * value, scene.lexicon)
            if name in ANGLES:
                bounds[name] = tuple(model.of_coordinate(name, model.coordinate(name, value) + [-DECADE, DECADE]))
    spread = {name: _log_spread(model, name) for name in moved}
    spread |= {name: float(model.scene.spreads[name] / model.slope(name, model.value(name))) for name in priors}
    prior = {name: (float(model.coordinate(name, model.value(name))), spread[name]) for name in priors}
    spread = {name: value for name, value in spread.items() if name not in priors}
    shifts = [
        name for name, wanted in (("D0", "contact_point"), ("P0", "baseline"), ("tilt", "tilt")) if options[wanted]
    ]
    shifts = shifts if x == "D" else []
    about = (options["loss"], options["intervals"], float(options["level"]))
    return Asked(model, names, bounds, prior, spread, tuple(shifts), *about, called, call)


def _in_layers(parameters: dict) -> dict[str, Any]:
    """Input -> its value in the list of layers of a call, of layers that are tables."""
    listed = parameters.get("layers")
    tables = enumerate(listed, 1) if isinstance(listed, (list, tuple)) else ()
    rows = {f"layers.{i}": layer for i, layer in tables if isinstance(layer, dict)}
    return {short(f"{layer}.{field}"): value for layer, row in rows.items() for field, value in row.items()}


def _choices(x: str, y: str, options: dict) -> list[str]:
    errors = []
    if (x, y) not in PAIRS:
        listed = "; or ".join(f'x="{a}", y="{b}"' for a, b in PAIRS)
        errors.append(f"x = {shown(x)}, y = {shown(y)}: must be {listed}")
    if options["loss"] not in ("linear", "huber"):
        errors.append(f'loss = {shown(options["loss"])}: must be "linear" or "huber"')
    if options["intervals"] not in ("profile", "fisher", None):
        errors.append(f'intervals = {shown(options["intervals"])}: must be "profile", "fisher" or None')
    level = options["level"]
    if isinstance(level, bool) or not isinstance(level, (int, float)) or not 0 < level < 1:
        errors.append(f"level = {shown(level)}: must be between 0 and 1, such as 0.95")
    for name in ("contact_point", "baseline", "tilt", "plan"):
        if not isinstance(options[name], bool):
            errors.append(f"{name} = {shown(options[name])}: must be True or False")
    if options["plan"] is True and options["sigma"] is None:
        errors.append("plan: give sigma, the standard deviation of a point")
    return errors


def _listed(free: Any, errors: list[str]) -> tuple[str, ...]:
    several = isinstance(free, (list, tuple, dict, set, np.ndarray))
    names = tuple(free) if several else (free,)
    if not all(isinstance(name, str) for name in names):
        errors.append(f'free = {shown(free)}: must be names of inputs, such as ["E1"], or {{"E1": ("1 kPa", "1 MPa")}}')
        return ()
    return names


def _numbers(names: Iterable[str], lexicon: Lexicon) -> set[str]:
    """Inputs that may be fitted: numbers of the contact, not settings of the solver.

    names : of the inputs that are given or free, which say what layers there are
    """
    rows = {name for name in lexicon.parameters_of(names) if lexicon.parameter(name).interval}
    rows = {name for name in rows if not lexicon.parameter(name).whole}
    return (rows | set(scene_of(names))) - {*BODIES, *CONTROLS, "rtol", "accuracy", "k", "n", "m"}


def _has_prior(name: str, value: Any, free: bool) -> bool:
    """Whether ± stands in the call: of R, Poisson ratios and names of materials it is taken over, not fitted, unless
    they are `free`; that of k_machine changes no curve."""
    if name == "k_machine" or name in BODIES or name in CONTROLS or (not free and (name == "R" or is_ratio(name))):
        return False
    spread = getattr(value, "std_dev", None) or getattr(getattr(value, "magnitude", None), "std_dev", None)
    written = isinstance(value, str) and any(sign in value for sign in ("±", "+/-", "+-"))
    return bool(spread) or (written and (free or has_unit(value)))


def _bounds(name: str, pair: Any, errors: list[str], lexicon: Lexicon) -> dict[str, tuple[float, float]]:
    unit = lexicon.all_rows[name].unit
    if pair is None:
        return {}
    if not isinstance(pair, (tuple, list)) or len(pair) != 2:
        errors.append(f"free: {name} = {shown(pair)}: must be (low, high)")
        return {}
    try:
        units = ("degree" if name in ANGLES and has_unit(end) else unit for end in pair)
        low, high = (quantity(f"free: {name}", end, of).value for end, of in zip(pair, units, strict=True))
    except ValueError as error:
        errors.append(str(error))
        return {}
    if not low < high or (low <= 0 and not is_ratio(name)):
        wanted = "below the high one" if is_ratio(name) else "above 0 and below the high one"
        errors.append(f"free: {name} = ({pair[0]}, {pair[1]}): the low bound must be {wanted}")
    return {name: (low, high)}


def _definition(parameters: dict, where: str) -> Definition:
    try:
        return from_call(parameters, [], False, {"output": {"profiles": False}})
    except StudyError as error:
        raise StudyError(message.replace("solve: ", f"{where}: ", 1) for message in error.messages) from None


def _check_ends(parameters: dict, bounds: dict, called: dict, lexicon: Lexicon) -> None:
    """Whether the contact takes the bounds. Raises StudyError if not. `called` : input -> its name in the call."""
    for name, pair in bounds.items():
        unit = lexicon.all_rows[name].unit
        for end in pair:
            _definition(parameters | {called[name]: end if unit == "1" else f"{end!r} {unit}"}, "free")


def _within(name: str, low: float, high: float, lexicon: Lexicon) -> tuple[float, float]:
    """Bounds within the interval of an input without unit."""
    if lexicon.all_rows[name].unit != "1":
        return low, high
    least, most, *_ = ends(lexicon.parameter(name).interval)
    return max(low, least), min(high, most)


def _stand_in(name: str, bounds: dict, lexicon: Lexicon) -> str | float | None:
    """A value for a free input without one, while the call is checked."""
    if name in bounds:
        low, high = bounds[name]
        middle = (low + high) / 2 if is_ratio(name) else math.sqrt(low * high)
        unit = lexicon.all_rows[name].unit
        return middle if unit == "1" else f"{middle!r} {unit}"
    return _MODULUS if name in ("E1", "E2") else 0.3 if is_ratio(name) else None


def _log_spread(model: Model, name: str) -> float:
    spread = float(model.scene.spreads[name])
    return spread if is_ratio(name) else spread / model.value(name)
