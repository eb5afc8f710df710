"""The Dataset of a fit: inputs in SI with their intervals, validity, and words for its summary."""

import warnings
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from solver import Status

from ...in_words.fits import NAMES_OF_SHIFTS
from ...in_words.sentences import assumed
from ...in_words.stated_inputs import given
from ...inputs.scene.stacks import moduli_of
from ...inputs.vocabulary import NOT_RUN, ROWS
from ...rules.rule import RULES
from ...solving import solve, unsolved
from .block import FitStatus
from .model import CurveModel
from .question import Question
from .residuals import PARTS

_WITHOUT_FIT = (FitStatus.INVALID_INPUT, FitStatus.NO_CONTACT)
#: For at most so many curves all depths are solved at once: a call costs more than some hundred contacts.
_FEW = 8
_HALVINGS = 4  # the depth at which the first assumption fails is found to 1/2**4 of the deepest
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
    question: Question, rows: dict, status: np.ndarray, X: np.ndarray, Y: np.ndarray, there: np.ndarray, plan: bool
) -> xr.Dataset:
    """The Dataset that `fit` returns; for a `plan` without values and residuals.

    rows : curve -> (numbers of `fit_block`, the curve's row in them)
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


def _validity(
    question: Question, fitted: xr.Dataset, value: np.ndarray, X: np.ndarray, there: np.ndarray
) -> xr.Dataset:
    """Variables over `curve`: the assumptions of the model that the deepest contact of a fit violates, and the x up to
    which no contact violates any."""
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
        contacts = _contacts(question, value[good], depths) if every is None else every.isel(curve=last)
        flags[good], about = contacts["validity"].values, contacts["validity"].attrs
        outside[good] = contacts["status"].values == Status.OUTSIDE_LAW
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
        "flows": ("curve", plastic, {"long_name": "whether a sharp tip makes the body flow: E is not a modulus"}),
        f"{model.x}_valid": ("curve", valid, {"units": ROWS[model.x].unit}),
    }
    if outside.any():
        about = {"long_name": "whether the deepest contact is outside the law of its asperities"}
        variables["outside_law"] = "curve", outside, about
    return xr.Dataset(variables)


def _hold(contacts: xr.Dataset) -> np.ndarray:
    """(M,) bool: contacts that violate no assumption, and are in the range of the law of their asperities."""
    return (contacts["validity"].values == 0) & (contacts["status"].values != Status.OUTSIDE_LAW)


def _at_all_parts(question: Question, value: np.ndarray, x: np.ndarray) -> xr.Dataset:
    """Contacts over `curve` at 1, 2 ... 2**_HALVINGS parts of the depths x (M,), one depth after the other."""
    parts = np.arange(1, 2**_HALVINGS + 1)
    every = np.repeat(value, len(parts), axis=0), (x[:, None] * parts / 2**_HALVINGS).ravel()
    return _contacts(question, *every)


def _contacts(question: Question, value: np.ndarray, x: np.ndarray) -> xr.Dataset:
    """Contacts of the unknown inputs `value` (M, k) at x (M,), over `curve`."""
    model, scene = question.model, question.model.scene
    values = model.within({name: value[:, i] for i, name in enumerate(model.unknowns)})
    by_name = scene.lexicon.all_rows
    columns: dict[str, tuple] = {name: (values[name], by_name[name].unit) for name in model.unknowns}
    others = [name for name in scene.values if name not in columns and name != model.x]
    columns |= {name: (float(scene.values[name]), by_name[name].unit) for name in others}
    columns[model.x] = (x, ROWS[model.x].unit)
    arrays = {
        name: xr.DataArray(v, dims=("curve",) if np.ndim(v) else (), attrs={"units": unit})
        for name, (v, unit) in columns.items()
    }
    arrays |= {"E2": "rigid"} if np.isinf(np.asarray(columns.get("E2", (0.0,))[0])).all() else {}
    # inputs without units; ratios follow from moduli
    others = {*scene.parameters} - {
        *arrays,
        "n",
        "m",
        "P",
        "a",
        "D",
        *(ratio for _, _, ratio in moduli_of(scene.values)),
    }
    arrays |= {name: scene.parameters[name] for name in others if by_name[name].unit == "1"}
    arrays["micro"] = scene.lexicon.law_or_name(arrays.get("micro", "disc_cell"))
    if "R1" in arrays:
        del arrays["R"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return solve(**arrays, x=2, profiles=False, progress=False)


def flows(model: CurveModel, modulus: np.ndarray, contacts: xr.Dataset) -> np.ndarray:
    """Whether each contact (M,) of a fit has a sharp tip, and a body that flows below it.

    modulus : (M,) in Pa, of the touched body
    contacts : the contacts at the deepest points, of `solve`
    """
    numbers = model.scene.parameters
    shape = numbers.get("shape", "paraboloid")
    if (model.x, model.y) != ("D", "P") or shape not in (*_POINTED, "cone", "blunt_cone"):
        return np.zeros(len(modulus), bool)
    hard = modulus >= HARD
    if shape in _POINTED:
        return hard
    angle = contacts["half_angle"].values if "half_angle" in contacts else numbers["half_angle"]
    slope = 1 / np.tan(np.radians(np.asarray(angle, float)))
    if shape == "blunt_cone":
        hard &= contacts["a"].values > _TANGENT * model.scene.values["tip_radius"] * slope
    return hard & (slope / 2 > _BLUNT)


def words_of(question: Question, fitted: xr.Dataset) -> dict[str, str]:
    """Attributes of a Dataset of `fit`: `given`, the inputs that are not free; and `assumed`, the defaults of inputs
    that were not given, which may be far from the true values, if there are any."""
    contact = unsolved("fit", question.call)
    free = [name for name in question.free if name in fitted]  # none of a plan: these are its assumed values
    for name in free:  # the assumptions depend on how soft the layer is
        if np.isfinite(value := fitted[name].median().item()):
            contact[name] = contact[name].copy(data=value)
    words = {"given": "\n".join(given(contact, free))}
    doubts = [f"Assumed: {sentence}" for sentence in assumed(contact)]
    return words | ({"assumed": "\n".join(doubts)} if doubts else {})
