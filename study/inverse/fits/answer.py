"""The Dataset of a fit: from the unknowns of each curve to inputs in SI with their intervals."""

import warnings
from typing import Any

import numpy as np
import xarray as xr

from solver import Status

from ...in_words.fits import NAMES_OF_SHIFTS
from ...inputs.scene.layers import moduli_of
from ...inputs.vocabulary import NOT_RUN, ROWS
from ...rules.rule import RULES
from ...solving import solve
from .asked import Asked
from .block import FitStatus
from .points.parts import PARTS
from .points.sharp import flows

#: At most so many curves have all places solved at once: a call costs more than some hundred contacts.
_FEW = 8
_HALVINGS = 4  # of the depth, to the place where the first assumption fails: it is right to 1/16


def answered(
    question: Asked, rows: dict, status: np.ndarray, X: np.ndarray, Y: np.ndarray, there: np.ndarray, plan: bool
) -> xr.Dataset:
    model, C = question.model, len(X)
    names = (*model.unknowns, *question.shifts)
    k, unit, by_name = len(names), ROWS[model.y].unit, model.scene.lexicon.all_rows
    value, low, high, spread = (np.full((C, k), np.nan) for _ in range(4))
    covariance, drawn = np.full((C, k, k), np.nan), np.full(X.shape, np.nan)
    status = status.astype(np.int8)
    for curve, (answer, i) in rows.items():
        status[curve] = answer["status"][i]
        if status[curve] in (FitStatus.INVALID_INPUT, FitStatus.NO_CONTACT):
            continue
        sizes = {"D0": answer["wide"][i], "P0": answer["top"][i], "tilt": answer["top"][i] / answer["wide"][i]}
        p, more = answer["p"][i], answer["propagated"][i]
        total = answer["covariance"][i] + more
        by = np.array([_slope(model, name, p[j], sizes) for j, name in enumerate(names)])
        for j, name in enumerate(names):
            ends = [_end(p[j], answer[end][i, j], answer["t"][i, j] * np.sqrt(more[j, j])) for end in ("low", "high")]
            value[curve, j], low[curve, j], high[curve, j] = (_value(model, name, v, sizes) for v in (p[j], *ends))
        covariance[curve] = total * by[:, None] * by[None, :]
        spread[curve] = np.sqrt(np.diag(covariance[curve]))
        drawn[curve, there[curve]] = answer["fit"][i][: there[curve].sum()]
    variables: dict[str, Any] = {}
    for j, name in enumerate(names):
        si = by_name[name].unit if name in by_name else {"D0": "m", "P0": unit, "tilt": "N/m"}[name]
        words = by_name[name].long_name if name in by_name else NAMES_OF_SHIFTS[name]
        if not plan:
            variables[name] = ("curve", value[:, j], {"units": si, "long_name": words})
        ends_of = (("low", low), ("high", high)) if question.intervals and not plan else ()
        variables |= {
            f"{name}_{end}": ("curve", array[:, j], {"units": si}) for end, array in (*ends_of, ("spread", spread))
        }
    coordinates: dict[str, Any] = {"cov_i": list(names), "cov_j": list(names)}
    variables["covariance"] = (("curve", "cov_i", "cov_j"), covariance)
    if not plan:
        about = {"units": unit}
        variables[f"{model.y}_fit"] = (("curve", "point"), drawn, about)
        variables["residual"] = (("curve", "point"), Y - drawn, about | {"long_name": f"{model.y} - fit"})
        variables |= _of_points(question, rows, status, there.sum(axis=1)) | _from_priors(question, names, value)
        coordinates["part"] = ("part", (np.arange(PARTS) + 0.5) / PARTS, {"long_name": "share of the depth"})
    meanings = {int(s): s.name.lower() for s in FitStatus} | ({NOT_RUN: "not_run"} if NOT_RUN in status else {})
    flags = {"flag_values": np.array([*meanings], np.int8), "flag_meanings": " ".join(meanings.values())}
    variables["fit_status"] = ("curve", status, flags)
    variables[model.x] = (("curve", "point"), X, {"units": ROWS[model.x].unit})
    if not plan:
        variables[model.y] = (("curve", "point"), Y, {"units": unit})
    fitted = xr.Dataset(
        variables, coordinates, {"level": question.level, "x": model.x, "y": model.y, "free": " ".join(question.free)}
    )
    return fitted.merge(_validity(question, fitted, value, X, there))


def _of_points(question: Asked, rows: dict, status: np.ndarray, count: np.ndarray) -> dict[str, tuple]:
    """Variables that say how far the points agree with the fit (docs/fit.md, Points that do not agree).

    count : (curve,) of points
    """
    model, C, name = question.model, len(status), question.model.unknowns[0]
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
    for curve, (answer, i) in rows.items():
        if status[curve] in (FitStatus.INVALID_INPUT, FitStatus.NO_CONTACT):
            continue
        values["effective_points"][curve] = count[curve] / answer["factors"][i][: len(model.unknowns)].max()
        for key, short in keys.items():
            values[key][curve] = answer[short][i]
        parts[curve] = model.of_coordinate(name, answer["parts"][i])
    about = {
        "units": model.scene.lexicon.all_rows[name].unit,
        "long_name": f"{name} by parts of the depth, the other unknowns as fitted to all",
    }
    variables: dict[str, tuple] = {key: ("curve", array, {"long_name": words[key]}) for key, array in values.items()}
    return variables | {f"{name}_over_depth": (("curve", "part"), parts, about)}


def _from_priors(question: Asked, names: tuple, value: np.ndarray) -> dict[str, tuple]:
    """Of each input with a prior, how far it is from that."""
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


def _validity(question: Asked, fitted: xr.Dataset, value: np.ndarray, X: np.ndarray, there: np.ndarray) -> xr.Dataset:
    """What the deepest contact of each fitted curve violates of the assumptions of the model, and up to which x none
    is."""
    model = question.model
    deepest = np.where(there, X, -np.inf).max(axis=1, initial=-np.inf)
    D0 = fitted["D0"].values if "D0" in fitted else np.zeros(len(X))
    good = np.isfinite(value).all(axis=1) & (deepest > D0)
    flags, valid, about = np.zeros(len(X), np.int64), np.where(good, deepest, np.nan), {}
    plastic, outside = np.zeros((2, len(X)), bool)
    if good.any():
        contacts = _contacts(question, value[good], (deepest - D0)[good])
        flags[good], about = contacts["validity"].values, contacts["validity"].attrs
        outside[good] = contacts["status"].values == Status.OUTSIDE_LAW
        touched = value[good, model.unknowns.index(model.modulus)] if model.modulus in model.unknowns else None
        touched = np.full(good.sum(), model.value(model.modulus)) if touched is None else touched
        plastic[good] = flows(model, touched, contacts)
        broken = np.flatnonzero((flags != 0) | outside)
        holds, fails = np.zeros(len(broken), int), np.full(len(broken), 2**_HALVINGS)  # in parts of the depth
        at_once = _all_parts(question, value[broken], (deepest - D0)[broken]) if 0 < len(broken) <= _FEW else None
        for _ in range(_HALVINGS if len(broken) else 0):
            part = (holds + fails) // 2
            x = part / 2**_HALVINGS * (deepest - D0)[broken]
            if at_once is None:
                good_there = _hold(_contacts(question, value[broken], x))
            else:
                good_there = at_once[np.arange(len(broken)), part]
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


def _hold(contacts: xr.Dataset) -> np.ndarray:
    """(M,) bool: contacts that violate no assumption, and are in the range of the law of their asperities."""
    return (contacts["validity"].values == 0) & (contacts["status"].values != Status.OUTSIDE_LAW)


def _all_parts(question: Asked, value: np.ndarray, x: np.ndarray) -> np.ndarray:
    """(M, 1 + parts) bool: no assumption is violated at a part of the depths x (M,)."""
    parts = np.arange(1, 2**_HALVINGS)
    every = np.repeat(value, len(parts), axis=0), (x[:, None] * parts / 2**_HALVINGS).ravel()
    good = _hold(_contacts(question, *every))
    return np.pad(good.reshape(len(x), -1), ((0, 0), (1, 0)))


def _contacts(question: Asked, value: np.ndarray, x: np.ndarray) -> xr.Dataset:
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
    # those without units; ratios follow from moduli
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
