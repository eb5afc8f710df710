"""The Dataset of a fit: inputs in SI with their intervals, validity, and words for its summary."""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from solver import Problem, Solution, Status, solve

from ...arrays.labelled import Labelled
from ...data.dataset import validity_of_rows
from ...in_words.fits import NAMES_OF_SHIFTS
from ...in_words.sentences import assumed
from ...in_words.stated_inputs import given
from ...inputs.checks import OWNER
from ...inputs.punch.micro_laws import results_of
from ...inputs.scene.scene import Scene
from ...inputs.vocabulary import NOT_RUN, ROWS
from ...rules.rule import RULES
from ...solving import unsolved
from ...work.cases import arrays_of
from .block import FitStatus
from .model import CurveModel
from .question import Question
from .residuals import PARTS

_WITHOUT_FIT = (FitStatus.INVALID_INPUT, FitStatus.NO_CONTACT)
#: At most so many curves have all places solved at once: a call costs more than some hundred contacts.
_FEW = 8
_HALVINGS = 4  # the depth at which the first assumption fails is right to 1/2**4 of the deepest
#: Bodies at least as stiff, in Pa, flow below a sharp tip, whatever they are made of: the mean pressure of the elastic
#: contact, E* cot(half_angle)/2, is 0.18 E* under a Berkovich tip, and their hardness is at most some 0.1 E*. Rubbers
#: and gels, which do not flow, are softer than 0.1 GPa.
HARD = 1e9
#: cot(half_angle)/2 of tips that count as sharp: hardness over E* is above this in few metals.
_BLUNT = 0.02
_POINTED = ("berkovich", "vickers", "cube_corner")
_TANGENT = 3.0  # a blunt cone is sharp where the contact is so many times as wide as its ball


class _Numbers(NamedTuple):
    """The fits of C curves in SI, NaN where a curve has none.

    value, low, high, spread : (C, k) of the unknowns
    covariance : (C, k, k); fit : (C, n) of y
    """

    value: np.ndarray
    low: np.ndarray
    high: np.ndarray
    spread: np.ndarray
    covariance: np.ndarray
    fit: np.ndarray


class FittedContacts(NamedTuple):
    """M contacts of a fit.

    scene : their inputs in SI; problem, solution : in its units
    validity : over "case"
    """

    scene: Scene
    problem: Problem
    solution: Solution
    validity: Labelled

    def take(self, some: slice) -> "FittedContacts":
        """Some of the contacts; their scene stays that of all, as far as it has one value."""
        flags = Labelled("case", self.validity.values[some], self.validity.attrs)
        R = self.scene.R[some] if np.ndim(self.scene.R) else self.scene.R
        return FittedContacts(replace(self.scene, R=R), self.problem.take(some), self.solution.take(some), flags)


def fit_dataset(
    question: Question, rows: dict, status: np.ndarray, X: np.ndarray, Y: np.ndarray, there: np.ndarray, plan: bool
) -> xr.Dataset:
    """The Dataset that `fit` returns; for a `plan` without values and residuals.

    rows : curve -> (numbers of `fit_block`, row of the curve in them)
    status : (curve,) of curves without a row
    X, Y, there : (curve, point), x and y, and whether there is a point
    """
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
    return fitted.merge(_validity(question, fitted, numbers.value, X, there))


def _in_si(question: Question, names: tuple, fits: dict, X: np.ndarray, there: np.ndarray) -> _Numbers:
    """The numbers of the unknowns `names` of curves with fits, curve -> (numbers of `fit_block`, row)."""
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
    """Variables that say how far the points agree with the fit (docs/fit.md, Points that do not agree).

    count : (curve,) of points
    """
    model, C, name = question.model, len(count), question.model.unknowns[0]
    words = {
        "effective_points": "number of independent points that say as much",
        "misfit_ratio": "rms of the residuals in contact over that before it",
        "misfit_larger": "whether the misfit in contact is surely larger than the noise before it",
        "change": f"change of ln {name} from the beginning of the contact to the deepest point",
        "changes": f"whether {name} surely changes with the depth",
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
        "long_name": f"{name} by parts of the depth, the other unknowns as fitted to all",
    }
    variables: dict[str, tuple] = {key: ("curve", array, {"long_name": words[key]}) for key, array in values.items()}
    return variables | {f"{name}_over_depth": (("curve", "part"), parts, about)}


def _from_priors(question: Question, names: tuple, value: np.ndarray) -> dict[str, tuple]:
    """How far each input with a prior is from it, in standard deviations."""
    variables = {}
    for name, (center, sd) in question.priors.items():
        about = {"long_name": f"{name} less its prior, in standard deviations of that"}
        off = (question.model.coordinate(name, value[:, names.index(name)]) - center) / sd
        variables[f"{name}_from_prior"] = ("curve", off, about)
    return variables


def _slope(model, name: str, p: float, sizes: dict) -> float:
    """d(value in SI)/d(unknown)."""
    return sizes[name] if name in sizes else float(model.slope(name, model.of_coordinate(name, p)))


def _value(model, name: str, p: float, sizes: dict) -> float:
    return float(p * sizes[name]) if name in sizes else float(model.of_coordinate(name, p))


def _end(p: float, end: float, more: float) -> float:
    """The end of an interval with what other inputs add to it."""
    return p + np.sign(end - p) * np.hypot(end - p, more)


def _validity(
    question: Question, fitted: xr.Dataset, value: np.ndarray, X: np.ndarray, there: np.ndarray
) -> xr.Dataset:
    """Variables over `curve`: which assumptions of the model the deepest contact of a fit violates, and the x up to
    which it violates none."""
    model = question.model
    deepest = np.where(there, X, -np.inf).max(axis=1, initial=-np.inf)
    D0 = fitted["D0"].values if "D0" in fitted else np.zeros(len(X))
    good = np.isfinite(value).all(axis=1) & (deepest > D0)
    flags, valid, about = np.zeros(len(X), np.int64), np.where(good, deepest, np.nan), {}
    plastic, outside = np.zeros((2, len(X)), bool)
    if good.any():
        few, depths = good.sum() <= _FEW, (deepest - D0)[good]
        every = _at_all_parts(question, value[good], depths) if few else None
        last = slice(2**_HALVINGS - 1, None, 2**_HALVINGS)
        contacts = _contacts(question, value[good], depths) if every is None else every.take(last)
        flags[good], about = contacts.validity.values, contacts.validity.attrs
        outside[good] = contacts.solution.status == Status.OUTSIDE_LAW
        touched = value[good, model.unknowns.index(model.modulus)] if model.modulus in model.unknowns else None
        touched = np.full(good.sum(), model.value(model.modulus)) if touched is None else touched
        plastic[good] = flows(model, touched, contacts)
        broken = np.flatnonzero((flags != 0) | outside)
        holds, fails = np.zeros(len(broken), int), np.full(len(broken), 2**_HALVINGS)  # in parts of the depth
        at_once = None
        if every is not None:
            at_once = _hold(every).reshape(len(depths), -1)[np.isin(np.flatnonzero(good), broken)]
        elif 0 < len(broken) <= _FEW:
            at_once = _hold(_at_all_parts(question, value[broken], (deepest - D0)[broken])).reshape(len(broken), -1)
        for _ in range(_HALVINGS if len(broken) else 0):
            part = (holds + fails) // 2
            x = part / 2**_HALVINGS * (deepest - D0)[broken]
            if at_once is None:
                good_there = _hold(_contacts(question, value[broken], x))
            else:
                good_there = at_once[np.arange(len(broken)), part - 1]
            holds, fails = np.where(good_there, part, holds), np.where(good_there, fails, part)
        x = holds / 2**_HALVINGS * (deepest - D0)[broken]
        valid[broken] = np.where(holds > 0, D0[broken] + x, -np.inf)
    flags, valid = np.where(plastic, flags | RULES["body_yields"].mask, flags), np.where(plastic, -np.inf, valid)
    variables = {
        "validity": ("curve", flags, about),
        "flows": ("curve", plastic, {"long_name": "whether a sharp tip makes the body flow: E is no modulus"}),
        f"{model.x}_valid": ("curve", valid, {"units": ROWS[model.x].unit}),
    }
    if outside.any():
        about = {"long_name": "whether the deepest contact is outside of the law of its asperities"}
        variables["outside_law"] = "curve", outside, about
    return xr.Dataset(variables)


def _hold(contacts: FittedContacts) -> np.ndarray:
    """(M,) bool: contacts that violate no assumption, and are in the range of the law of their asperities."""
    return (contacts.validity.values == 0) & (contacts.solution.status != Status.OUTSIDE_LAW)


def _at_all_parts(question: Question, value: np.ndarray, x: np.ndarray) -> FittedContacts:
    """Contacts at 1, 2 ... 2**_HALVINGS parts of the depths x (M,), one depth after the other."""
    parts = np.arange(1, 2**_HALVINGS + 1)
    every = np.repeat(value, len(parts), axis=0), (x[:, None] * parts / 2**_HALVINGS).ravel()
    return _contacts(question, *every)


def _contacts(question: Question, value: np.ndarray, x: np.ndarray) -> FittedContacts:
    """Contacts of the unknown inputs `value` (M, k) at x (M,)."""
    model = question.model
    values = model.within({name: value[:, i] for i, name in enumerate(model.unknowns)})
    scene, problem = model.contacts_at(values, x)
    solution = solve(problem)
    sticks, felt = bool((problem.w_adhesion > 0).any()), bool(problem.feels_layer().any())
    results = results_of(problem.known.laws, problem.micro, sticks, felt)
    numbers = _stated(problem, scene) | arrays_of(solution, results, ())
    numbers |= {name: np.broadcast_to(radius.values, len(x)) for name, radius in scene.radii().items()}
    return FittedContacts(scene, problem, solution, validity_of_rows(numbers, problem.known))


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


def flows(model: CurveModel, modulus: np.ndarray, contacts: FittedContacts) -> np.ndarray:
    """Which contacts (M,) of a fit are those of a sharp tip in a body that flows below it.

    modulus : (M,) in Pa, of the touched body
    contacts : the contacts at the deepest points
    """
    shape = model.scene.parameters.get("shape", "paraboloid")
    if (model.x, model.y) != ("D", "P") or shape not in (*_POINTED, "cone", "blunt_cone"):
        return np.zeros(len(modulus), bool)
    hard = modulus >= HARD
    if shape in _POINTED:
        return hard
    slope = 1 / np.tan(np.radians(contacts.problem.half_angle))
    if shape == "blunt_cone":
        hard &= contacts.solution.a * contacts.scene.R > _TANGENT * model.scene.values["tip_radius"] * slope
    return hard & (slope / 2 > _BLUNT)


def words_of(question: Question, fitted: xr.Dataset) -> dict[str, str]:
    """Attributes of a Dataset of `fit`: `given`, the inputs that are not free; `assumed`, the defaults that stand for
    inputs which were not given, and may be far from them, if there are any."""
    contact = unsolved("fit", question.call)
    free = [name for name in question.free if name in fitted]  # none of a plan: these are its assumed values
    for name in free:  # the assumptions depend on how soft the layer is
        if np.isfinite(value := fitted[name].median().item()):
            contact[name] = contact[name].copy(data=value)
    words = {"given": "\n".join(given(contact, free))}
    doubts = [f"Assumed: {sentence}" for sentence in assumed(contact)]
    return words | ({"assumed": "\n".join(doubts)} if doubts else {})
