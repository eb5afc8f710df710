"""The question of a call of `fit`: the model, its unknown inputs with bounds and priors, and spreads of other
inputs."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from solver.parameters import ends

from ...inputs.definition import Definition, StudyError, from_call, refuse_scans
from ...inputs.lexicon import Lexicon, lexicon_for
from ...inputs.punch.shapes import ANGLES
from ...inputs.scene.stacks import short
from ...inputs.vocabulary import BODIES, CONTROLS, ROWS, scene_of, suggest
from ...specimen.quantities import has_unit, quantity
from ...terminal import shown
from .model import PAIRS, CurveModel, is_ratio

MOST = 3  # largest number of unknown inputs
ROUGHNESS = ("Nbar", "Ra", "sigma", "cut", "B", "beta")
#: Pairs of inputs that change a curve in the same way, so that only one of them can be determined.
_ALIKE = [*combinations(ROUGHNESS, 2), ("E1", "nu1"), ("E1", "R"), ("E1", "n")]
_ALIKE_WORDS = "a curve cannot tell them apart: give one of them a value"
_ABSCISSA = {"D": "1 nm", "P": "1 nN", "a": "1 nm"}
_OF_BODIES = {"layer": ("E1", "nu1"), "body": ("E2", "nu2"), "punch": ("E_punch", "nu_punch")}
_MODULUS = "1 MPa"  # stands for a modulus that is not known while the call is checked
DECADE = np.log(10.0)


@dataclass(frozen=True)
class Question:
    """A checked call.

    model : the curve, with its unknown inputs: free inputs, then those with a prior
    bounds : free input -> (low, high) in SI; bounds of other free inputs follow from each curve
    priors : input with ± in the call, even if it is free -> its coordinate in `CurveModel`, and the spread of that
    spreads : other input -> the spread of its coordinate
    shifts : unknowns after the inputs
    called : free input -> its name in the call, "layers.1.E1" for E1
    call : arguments of `study.solve`, with stand-ins for unknown inputs without a value, and for x
    """

    model: CurveModel
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


class _Unknowns(NamedTuple):
    """The unknown inputs of a call, by their names among the inputs of a contact: E1 for "layers.1.E1".

    called : free input -> its name in the call
    priors : fitted inputs with ± in the call, even if they are free
    bounds : free input with bounds in the call -> (low, high) in SI
    valued : free inputs that have a value in the call
    lexicon : of the call
    """

    free: tuple[str, ...]
    called: dict[str, str]
    priors: tuple[str, ...]
    bounds: dict[str, tuple[float, float]]
    valued: set[str]
    lexicon: Lexicon

    @property
    def every(self) -> tuple[str, ...]:
        """Free inputs, then those with a prior."""
        return (*self.free, *(name for name in self.priors if name not in self.free))


def read_question(free: Any, parameters: dict, x: str, y: str, options: dict) -> Question:
    """Check a call. Raises StudyError before any curve is read."""
    unknowns = _unknowns(free, parameters, x, y, options)
    call = _call(unknowns, parameters, x, options)
    definition = _definition(call, "fit")
    scene = definition.scene
    if scene is None:
        raise StudyError(["fit: curves have units, so that R and the moduli must have some too"])
    priors = tuple(name for name in unknowns.priors if name in scene.spreads)  # ± 0 is exact
    unknowns = unknowns._replace(priors=priors)
    model = _model(definition, unknowns, x, y)
    shifts = [
        name for name, wanted in (("D0", "contact_point"), ("P0", "baseline"), ("tilt", "tilt")) if options[wanted]
    ]
    return Question(
        model,
        unknowns.free,
        _all_bounds(model, unknowns),
        {name: _prior(model, name) for name in priors},
        {name: _log_spread(model, name) for name in model.moved},
        tuple(shifts if x == "D" else ()),
        options["loss"],
        options["intervals"],
        float(options["level"]),
        unknowns.called,
        call,
    )


def _unknowns(free: Any, parameters: dict, x: str, y: str, options: dict) -> _Unknowns:
    """The unknown inputs of a call. Raises StudyError with all errors in its names and options."""
    errors = _choices(x, y, options)
    names, texts = _listed(free, errors), dict(free) if isinstance(free, dict) else {}
    called = {short(name): name for name in names}
    names, texts = tuple(map(short, names)), {short(name): pair for name, pair in texts.items()}
    lexicon = lexicon_for([parameters], [name for name in (*names, *map(short, parameters)) if name not in ROWS])
    numbers = _numbers((*names, *parameters), lexicon)
    for name in names:
        if name not in numbers:
            near = suggest(name, numbers, ["such as E1, h or Ra"]).replace("; known: ", ", ")
            errors.append(f"free: {shown(called[name])} is not an input that can be fitted{near}")
    errors += [f"free: {name} is named twice" for name in dict.fromkeys(names) if names.count(name) > 1]
    errors += [f"fit: leave out {name}: curves have it" for name in CONTROLS if parameters.get(name) is not None]
    values = _in_layers(parameters) | {short(name): value for name, value in parameters.items()}
    written = {*map(short, parameters), *names} & {*values}  # ± of layers that are not free is taken over
    priors = tuple(name for name in values if name in written and _has_prior(name, values[name], name in names))
    valued = {name for name in names if values.get(name) is not None}
    unknowns = _Unknowns(names, called, priors, {}, valued, lexicon)
    errors += _too_many(unknowns, bool(errors))
    bounds: dict[str, tuple[float, float]] = {}
    for name in (name for name in texts if name in numbers):
        bounds |= _bounds(name, texts[name], errors, lexicon)
    if errors:
        raise StudyError(errors)
    return unknowns._replace(bounds=bounds)


def _too_many(unknowns: _Unknowns, wrong: bool) -> list[str]:
    """The reasons why a curve cannot determine these unknowns.

    wrong : whether there are other errors; then a lack of unknowns is not reported
    """
    every, errors = unknowns.every, []
    if "k_machine" in every:
        errors.append("free: k_machine: the points show where the punch comes off, not the stiffness of the machine")
    errors += [f"free: {a} and {b}: {_ALIKE_WORDS}" for a, b in _ALIKE if a in every and b in every]
    if not (unknowns.free or wrong or errors):
        errors.append('free: name at least one input, such as free=["E1"]')
    if len(every) > MOST:
        errors.append(
            f"fit: at most {MOST} inputs can be unknown, here are {', '.join(every)}: leave out a ±, or fix one"
        )
    return errors


def _call(unknowns: _Unknowns, parameters: dict, x: str, options: dict) -> dict[str, Any]:
    """The call of `study.solve`, with stand-ins for free inputs without a value, and for x.

    Raises StudyError for an input without a stand-in, and for a bound that the contact refuses.
    """
    bounds, called = unknowns.bounds, unknowns.called
    from_material = {name for body, rows in _OF_BODIES.items() if parameters.get(body) is not None for name in rows}
    open_ = [name for name in unknowns.free if name not in unknowns.valued and name not in from_material]
    stand_in = {name: _stand_in(name, bounds, unknowns.lexicon) for name in open_}
    lacking = [name for name, value in stand_in.items() if value is None]
    if lacking or (options["plan"] and open_):
        wanted = "give the value that is assumed" if options["plan"] else "give bounds, or a value to begin with"
        way = ', free={{"{0}": (low, high)}}, or {0}=...' if not options["plan"] else ", {0}=..."
        raise StudyError([f"free: {name} has no value: {wanted}{way.format(name)}" for name in lacking or open_])
    call = parameters | {called.get(name, name): value for name, value in stand_in.items()} | {x: _ABSCISSA[x]}
    ends_of = {name: pair for name, pair in bounds.items() if name not in from_material}
    _check_ends(call, ends_of, called, unknowns.lexicon)
    return call


def _model(definition: Definition, unknowns: _Unknowns, x: str, y: str) -> CurveModel:
    """The model of the curve. Raises StudyError if it has no curve y(x), or an unknown does not act in it."""
    scene, every = definition.scene, unknowns.every
    moved = tuple(name for name in scene.spreads if name not in every and name not in CONTROLS)
    model = CurveModel.of(definition, x, y, every, moved)
    if model.sticks and (x, y) != ("D", "P"):
        way = 'for contacts that adhere the load is fitted against the depth: x = "D", y = "P"'
        raise StudyError([f"x = {shown(x)}, y = {shown(y)}: {way}"])
    if model.sticks and scene.parameters.get("shape") == "flat":
        way = "its load is a straight line down to pull-off: w_adhesion follows from P_off by `design`"
        raise StudyError([f'fit: shape = "flat" with w_adhesion: {way}'])
    absent = [name for name in every if name not in scene.values and name not in scene.parameters]
    if model.sticks and scene.parameters.get("adhesion") != "maugis":
        absent += [name for name in every if name in ("sigma0", "z0")]
    if absent:
        raise StudyError([f"free: {name} has no effect on this contact" for name in absent])
    return model


def _all_bounds(model: CurveModel, unknowns: _Unknowns) -> dict[str, tuple[float, float]]:
    """Free input -> (low, high): the bounds in the call, or up to a decade from the value in the call. The modulus of
    the touched body, and an input with a prior, have only bounds in the call."""
    bounds = dict(unknowns.bounds)
    for name in unknowns.free:
        if name not in bounds and name != model.modulus and name not in unknowns.priors:
            value = model.value(name)
            bounds[name] = (0.0, 0.5) if is_ratio(name) else _within(name, value / 10, 10 * value, model.scene.lexicon)
            if name in ANGLES:
                bounds[name] = tuple(model.of_coordinate(name, model.coordinate(name, value) + [-DECADE, DECADE]))
    return bounds


def _in_layers(parameters: dict) -> dict[str, Any]:
    """Input -> its value in the list of layers of a call, for layers that are tables."""
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

    names : inputs of the call and free inputs, whose names show the layers
    """
    rows = {name for name in lexicon.parameters_of(names) if lexicon.parameter(name).interval}
    rows = {name for name in rows if not lexicon.parameter(name).whole}
    return (rows | set(scene_of(names))) - {*BODIES, *CONTROLS, "rtol", "accuracy", "k", "n", "m"}


def _has_prior(name: str, value: Any, free: bool) -> bool:
    """Whether a ± in the call is a prior.

    The ± of R, of Poisson ratios and of named materials widens the intervals instead, unless the input is `free`. The ±
    of k_machine changes no curve.
    """
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
    return refuse_scans(from_call(parameters, [], False, {"output": {"profiles": False}}, where=where), where)


def _check_ends(parameters: dict, bounds: dict, called: dict, lexicon: Lexicon) -> None:
    """Raise StudyError for a bound that the contact refuses.

    called : input -> its name in the call
    """
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


def _prior(model: CurveModel, name: str) -> tuple[float, float]:
    """The coordinate of an input and its spread."""
    value = model.value(name)
    return float(model.coordinate(name, value)), float(model.scene.spreads[name] / model.slope(name, value))


def _log_spread(model: CurveModel, name: str) -> float:
    spread = float(model.scene.spreads[name])
    return spread if is_ratio(name) else spread / model.value(name)


def region(depth: Any, x: str) -> tuple[float, float] | None:
    """The ends in SI of the option `depth` of a fit over x. Raises StudyError."""
    if depth is None:
        return None
    unit = ROWS[x].unit
    such = '("0 nm", "500 nm")' if unit == "m" else '("0 nN", "5 nN")'
    if not isinstance(depth, (tuple, list)) or len(depth) != 2:
        raise StudyError([f"depth = {shown(depth)}: must be (low, high), such as {such}"])
    try:
        low, high = (quantity("depth", end, unit).value if isinstance(end, str) else float(end) for end in depth)
    except (TypeError, ValueError) as error:
        raise StudyError([f"{error}" if "depth" in str(error) else f"depth = {shown(depth)}: {error}"]) from None
    if not (np.isfinite([low, high]).all() and low < high and high > 0):
        wanted = f"the low end must be below the high one, and that above 0, in {unit} or with units"
        raise StudyError([f"depth = ({depth[0]}, {depth[1]}): {wanted}"])
    return float(low), float(high)


def inside(x: np.ndarray, begin: dict[int, float], limits: tuple[float, float]) -> np.ndarray:
    """Whether points (curves, n) count: those in contact within the limits, and those before the contact.

    begin : curve -> beginning of its contact; {}: all begin at 0. All points of a missing curve count
    """
    low, high = limits
    depth = x - np.array([begin.get(curve, np.nan if begin else 0.0) for curve in range(len(x))])[:, None]
    out = (depth > high) | ((depth < low) & ((depth > 0) | (low < 0)))
    return ~out
