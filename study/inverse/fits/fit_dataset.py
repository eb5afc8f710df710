"""The Dataset of a fit: inputs in SI with their intervals, validity, and words for its summary."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from solver import Problem, Solution, Status, solve
from solver.solve import solve_at_radii

from ...arrays.labelled import Labelled
from ...data.dataset import validity_of_rows
from ...in_words.fits import NAMES_OF_SHIFTS
from ...in_words.sentences import assumed
from ...in_words.stated_inputs import input_lines
from ...inputs.checks import OWNER
from ...inputs.punch.micro_laws import results_of
from ...inputs.scene.scene import Scene, with_unit
from ...inputs.vocabulary import NOT_RUN, ROWS
from ...rules.rule import RULES
from ...solving import unsolved
from ...work.cases import arrays_of
from .block import JUDGED, FitStatus
from .model import CurveModel
from .question import Question
from .residuals import PARTS

_WITHOUT_FIT = (FitStatus.INVALID_INPUT, FitStatus.NO_CONTACT)
#: For at most so many curves all depths are solved at once: a call costs more than some hundred contacts.
_FEW = 8
#: Bodies of at least this modulus, in Pa, flow below a sharp tip, whatever their material: the mean pressure of the
#: elastic contact, E* cot(half_angle)/2, is 0.18 E* under a Berkovich tip, but their hardness is at most some 0.1 E*.
#: Rubbers and gels, which do not flow, are softer than 0.1 GPa.
HARD = 1e9
#: Tips count as sharp if cot(half_angle)/2 is larger: few metals have a larger hardness over E*.
_BLUNT = 0.02
_POINTED = ("berkovich", "vickers", "cube_corner")
_TANGENT = 3.0  # a blunt cone is sharp if the contact is so many times as wide as its ball


class _Numbers(NamedTuple):
    """The fits of C curves in SI; NaN for a curve without one.

    value, low, high, spread : (C, k) of the unknowns
    covariance : (C, k, k); fit : (C, n) of y
    """

    value: np.ndarray
    low: np.ndarray
    high: np.ndarray
    spread: np.ndarray
    covariance: np.ndarray
    fit: np.ndarray


def fit_dataset(
    question: Question, rows: dict, status: np.ndarray, points: tuple, plan: bool, judged: bool = True
) -> xr.Dataset:
    """The Dataset that `fit` returns; for a `plan` without values and residuals.

    rows : curve -> (numbers of `fit_block`, the curve's row in them)
    status : (curve,) of curves without a row
    points : x, y, and whether there is a point, (curve, point) each
    judged : whether the assumptions of the model are looked at
    """
    X, Y, there = points
    model, names = question.model, (*question.model.unknowns, *question.shifts)
    status = status.astype(np.int8)
    for curve, (block, i) in rows.items():
        status[curve] = block["status"][i]
    fits = {curve: row for curve, row in rows.items() if status[curve] not in _WITHOUT_FIT}
    numbers = _in_si(question, names, fits, X, there)
    variables = _of_unknowns(question, names, numbers, plan)
    coordinates: dict[str, Any] = {"cov_i": list(names), "cov_j": list(names)}
    variables["covariance"] = (("curve", "cov_i", "cov_j"), numbers.covariance)
    about = {"units": ROWS[model.y].unit}
    if not plan:
        variables[f"{model.y}_fit"] = (("curve", "point"), numbers.fit, about)
        variables["residual"] = (("curve", "point"), Y - numbers.fit, about | {"long_name": f"{model.y} - fit"})
        variables |= _of_points(question, fits, there.sum(axis=1)) | _from_priors(question, names, numbers.value)
        coordinates["part"] = ("part", (np.arange(PARTS) + 0.5) / PARTS, {"long_name": "share of the depth"})
    meanings = {int(s): s.name.lower() for s in FitStatus} | ({NOT_RUN: "not_run"} if NOT_RUN in status else {})
    flags = {"flag_values": np.array([*meanings], np.int8), "flag_meanings": " ".join(meanings.values())}
    variables["fit_status"] = ("curve", status, flags)
    variables[model.x] = (("curve", "point"), X, {"units": ROWS[model.x].unit})
    if not plan:
        variables[model.y] = (("curve", "point"), Y, about)
    attributes = {"level": question.level, "x": model.x, "y": model.y, "free": " ".join(question.free)}
    fitted = xr.Dataset(variables, coordinates, attributes)
    if not judged:
        return fitted
    return fitted.merge(_validity(question, fitted, numbers.value, X, there, _radii(fits, len(X))))


def _in_si(question: Question, names: tuple, fits: dict, X: np.ndarray, there: np.ndarray) -> _Numbers:
    """The numbers of the unknowns `names`. fits : curve -> (numbers of `fit_block`, its row in them)"""
    model, C, k = question.model, len(X), len(names)
    numbers = _Numbers(
        *(np.full((C, k), np.nan) for _ in range(4)), np.full((C, k, k), np.nan), np.full(X.shape, np.nan)
    )
    for curve, (block, i) in fits.items():
        sizes = {"D0": block["wide"][i], "P0": block["top"][i], "tilt": block["top"][i] / block["wide"][i]}
        p, more = block["p"][i], block["propagated"][i]
        by = np.array([_slope(model, name, p[j], sizes) for j, name in enumerate(names)])
        for j, name in enumerate(names):
            ends = [_end(p[j], block[end][i, j], block["t"][i, j] * np.sqrt(more[j, j])) for end in ("low", "high")]
            for array, v in zip(numbers[:3], (p[j], *ends), strict=True):
                array[curve, j] = _value(model, name, v, sizes)
        numbers.covariance[curve] = (block["covariance"][i] + more) * by[:, None] * by[None, :]
        numbers.spread[curve] = np.sqrt(np.diag(numbers.covariance[curve]))
        numbers.fit[curve, there[curve]] = block["fit"][i][: there[curve].sum()]
    return numbers


def _of_unknowns(question: Question, names: tuple, numbers: _Numbers, plan: bool) -> dict[str, Any]:
    """The variables of the unknowns: values, ends of intervals, spreads; for a `plan` spreads alone."""
    variables: dict[str, Any] = {}
    rows = question.model.scene.lexicon.all_rows
    of_shifts = {"D0": "m", "P0": ROWS[question.model.y].unit, "tilt": "N/m"}
    for j, name in enumerate(names):
        si = rows[name].unit if name in rows else of_shifts[name]
        words = rows[name].long_name if name in rows else NAMES_OF_SHIFTS[name]
        if not plan:
            variables[name] = ("curve", numbers.value[:, j], {"units": si, "long_name": words})
        ends = ("low", "high") if question.intervals and not plan else ()
        for end in (*ends, "spread"):
            variables[f"{name}_{end}"] = ("curve", getattr(numbers, end)[:, j], {"units": si})
    return variables


def _of_points(question: Question, fits: dict, count: np.ndarray) -> dict[str, tuple]:
    """Variables that tell how well the points agree with the fit (docs/fit.md, Points that do not agree).

    count : (curve,) of points
    """
    model, C, name = question.model, len(count), question.model.unknowns[0]
    words = {
        "effective_points": "number of independent points that carry as much information",
        "misfit_ratio": "rms of the residuals in contact over that before it",
        "misfit_larger": "whether the misfit in contact is significantly larger than the noise before it",
        "change": f"change of ln {name} from the beginning of the contact to the deepest point",
        "changes": f"whether {name} changes significantly with the depth",
    }
    keys = {"misfit_ratio": "ratio", "misfit_larger": "larger", "change": "change", "changes": "changes"}
    values = {key: np.full(C, np.nan) for key in words}
    values |= {key: np.zeros(C, bool) for key in ("misfit_larger", "changes")}
    parts = np.full((C, PARTS), np.nan)
    for curve, (block, i) in fits.items():
        values["effective_points"][curve] = count[curve] / block["factors"][i][: len(model.unknowns)].max()
        for key, short in keys.items():
            values[key][curve] = block[short][i]
        parts[curve] = model.of_coordinate(name, block["parts"][i])
    about = {
        "units": model.scene.lexicon.all_rows[name].unit,
        "long_name": f"{name} in parts of the depth, with the other unknowns as fitted to all of it",
    }
    variables: dict[str, tuple] = {key: ("curve", array, {"long_name": words[key]}) for key, array in values.items()}
    return variables | {f"{name}_over_depth": (("curve", "part"), parts, about)}


def _from_priors(question: Question, names: tuple, value: np.ndarray) -> dict[str, tuple]:
    """The distance of each input from its prior, in standard deviations."""
    variables = {}
    for name, (center, sd) in question.priors.items():
        about = {"long_name": f"{name} less its prior, in standard deviations of the prior"}
        off = (question.model.coordinate(name, value[:, names.index(name)]) - center) / sd
        variables[f"{name}_from_prior"] = ("curve", off, about)
    return variables


def _slope(model, name: str, p: float, sizes: dict) -> float:
    """d(value in SI)/d(unknown)."""
    return sizes[name] if name in sizes else float(model.slope(name, model.of_coordinate(name, p)))


def _value(model, name: str, p: float, sizes: dict) -> float:
    return float(p * sizes[name]) if name in sizes else float(model.of_coordinate(name, p))


def _end(p: float, end: float, more: float) -> float:
    """The end of an interval, with the contribution `more` of other inputs."""
    return p + np.sign(end - p) * np.hypot(end - p, more)


def _radii(fits: dict, count: int) -> np.ndarray:
    """The radii (curve, JUDGED) of the contacts that are judged, NaN where they are not known."""
    radii = np.full((count, JUDGED), np.nan)
    for curve, (block, i) in fits.items():
        radii[curve] = block["radii"][i]
    return radii


def _validity(
    question: Question, fitted: xr.Dataset, value: np.ndarray, X: np.ndarray, there: np.ndarray, radii: np.ndarray
) -> xr.Dataset:
    """Variables over `curve`: the assumptions of the model that the deepest contact of a fit violates, and the x up to
    which no contact violates any."""
    model = question.model
    deepest = np.where(there, X, -np.inf).max(axis=1, initial=-np.inf)
    D0 = fitted["D0"].values if "D0" in fitted else np.zeros(len(X))
    good = np.isfinite(value).all(axis=1) & (deepest > D0)
    flags, valid, about = np.zeros(len(X), np.int64), np.where(good, deepest, np.nan), {}
    plastic, outside = np.zeros((2, len(X)), bool)

    def judged(curves: np.ndarray, part: np.ndarray) -> _Judged:
        """The contacts of some of the curves at a part of the depth, 1 to JUDGED, each."""
        x = part / JUDGED * (deepest - D0)[curves]
        return _judged(question, value[curves], x, radii[curves, part - 1])

    if good.any():
        index = np.flatnonzero(good)
        contacts = judged(index, np.full(len(index), JUDGED))
        flags[good], about = contacts.validity.values, contacts.validity.attrs
        outside[good] = contacts.outside
        touched = value[good, model.unknowns.index(model.modulus)] if model.modulus in model.unknowns else None
        touched = np.full(good.sum(), model.value(model.modulus)) if touched is None else touched
        plastic[good] = flows(model, touched, contacts)
        broken = np.flatnonzero((flags != 0) | outside)
        valid[broken] = _valid_to(judged, broken, D0, deepest)
    flags, valid = np.where(plastic, flags | RULES["body_yields"].mask, flags), np.where(plastic, -np.inf, valid)
    variables = {
        "validity": ("curve", flags, about),
        "flows": ("curve", plastic, {"long_name": "whether a sharp tip makes the body flow: E is not a modulus"}),
        f"{model.x}_valid": ("curve", valid, {"units": ROWS[model.x].unit}),
    }
    if outside.any():
        about = {"long_name": "whether the deepest contact is outside the law of its asperities"}
        variables["outside_law"] = "curve", outside, about
    return xr.Dataset(variables)


def _valid_to(judged: Any, broken: np.ndarray, D0: np.ndarray, deepest: np.ndarray) -> np.ndarray:
    """The x up to which no assumption is violated, of the curves `broken` (M,), whose deepest contact violates some;
    -inf where there is none. By bisection of the parts of the depth; of few curves all parts are solved at once."""
    holds, fails = np.zeros(len(broken), int), np.full(len(broken), JUDGED)
    at_once = None
    if 0 < len(broken) <= _FEW:
        every = judged(np.repeat(broken, JUDGED), np.tile(np.arange(1, JUDGED + 1), len(broken)))
        at_once = every.hold.reshape(len(broken), -1)
    while len(broken) and (fails - holds > 1).any():
        part = (holds + fails) // 2
        good = judged(broken, part).hold if at_once is None else at_once[np.arange(len(broken)), part - 1]
        holds, fails = np.where(good, part, holds), np.where(good, fails, part)
    x = holds / JUDGED * (deepest - D0)[broken]
    return np.where(holds > 0, D0[broken] + x, -np.inf)


class _Judged(NamedTuple):
    """Contacts (M,): which assumptions they violate, whether they are outside of the law of their asperities, their
    radii in m, and their parameters."""

    validity: Labelled
    outside: np.ndarray
    a: np.ndarray
    parameters: dict[str, np.ndarray]

    @property
    def hold(self) -> np.ndarray:
        """(M,) bool: they violate no assumption, and are in the range of the law of their asperities."""
        return (self.validity.values == 0) & ~self.outside


def _judged(question: Question, value: np.ndarray, x: np.ndarray, radii: np.ndarray) -> _Judged:
    """The contacts of the unknown inputs `value` (M, k) at x (M,); where they stick, by their `radii` (M,) in m, if
    these are known."""
    model = question.model
    scene = model.scene_of(model.within({name: value[:, i] for i, name in enumerate(model.unknowns)}))

    def problem(control: str, at: np.ndarray) -> Problem:
        numbers = with_unit(at, tuple(-power for power in ROWS[control].powers), scene.unit, scene.R)
        return scene.lexicon.problem(scene.parameters, **{control: numbers})

    by_x, at_radius = problem(model.x, x), np.isfinite(radii)
    pieces = [(np.flatnonzero(~at_radius), solve(by_x.take(~at_radius)))] if not at_radius.all() else []
    if at_radius.any():
        contacts = solve_at_radii(problem("a", radii).take(at_radius), np.array([0.0, 1.0]))
        pieces.append((np.flatnonzero(at_radius), contacts))
    solution = Solution.join(len(x), 2, pieces)
    results = results_of(by_x.known.laws, by_x.micro, felt=bool(by_x.feels_layer().any()))
    of_two = {name: scene.values[name] / scene.R + 0 * x for name in ("R1", "R2") if name in scene.values}
    numbers = _stated(by_x, scene) | of_two | arrays_of(solution, results, ())
    validity, outside = validity_of_rows(numbers, by_x.known), solution.status == Status.OUTSIDE_LAW
    return _Judged(validity, outside, solution.a * scene.R, by_x.parameters)


def _stated(problem: Problem, scene: Scene) -> dict[str, np.ndarray]:
    """The parameters of a problem that results of the scene have: none without a value, and none of a shape or of
    adhesion where the scene has no shape, or no work of adhesion."""
    rows, stated = scene.lexicon.rows, {}
    for name, column in problem.parameters.items():
        owner = OWNER.get(rows[name].role) if name in rows else None
        is_stated = owner is None or owner in scene.parameters
        if is_stated and not (column.dtype.kind == "f" and np.isnan(column).all()):
            stated[name] = column
    return stated


def flows(model: CurveModel, modulus: np.ndarray, contacts: _Judged) -> np.ndarray:
    """Whether each contact (M,) of a fit has a sharp tip, and a body that flows below it.

    modulus : (M,) in Pa, of the touched body
    contacts : the contacts at the deepest points
    """
    shape = model.scene.parameters.get("shape", "paraboloid")
    if (model.x, model.y) != ("D", "P") or shape not in (*_POINTED, "cone", "blunt_cone"):
        return np.zeros(len(modulus), bool)
    hard = modulus >= HARD
    if shape in _POINTED:
        return hard
    angle = contacts.parameters["half_angle"]
    slope = 1 / np.tan(np.radians(np.asarray(angle, float)))
    if shape == "blunt_cone":
        hard &= contacts.a > _TANGENT * model.scene.values["tip_radius"] * slope
    return hard & (slope / 2 > _BLUNT)


def words_of(question: Question, fitted: xr.Dataset) -> dict[str, str]:
    """Attributes of a Dataset of `fit`: `given`, the inputs that are not free; and `assumed`, the defaults of inputs
    that were not given, which may be far from the true values, if there are any."""
    contact = unsolved("fit", question.call)
    free = [name for name in question.free if name in fitted]  # none of a plan: these are its assumed values
    for name in free:  # the assumptions depend on how soft the layer is
        values = fitted[name].values[np.isfinite(fitted[name].values)]
        if len(values):
            contact[name] = contact[name].copy(data=np.median(values))
    words = {"given": "\n".join(input_lines(contact, free))}
    doubts = [f"Assumed: {sentence}" for sentence in assumed(contact)]
    return words | ({"assumed": "\n".join(doubts)} if doubts else {})
