"""The command `fit`: inputs of a contact from a measured curve, in the terminal, in words or as JSON."""

import io
import json
import re
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..data.dataset import decode
from ..figures.formats import write
from ..figures.plots import plot
from ..in_words import summary
from ..inputs.definition import StudyError
from ..inputs.vocabulary import ROWS, absent, suggest
from ..inverse.curves import curves
from ..inverse.fit import fit as fitted_by
from ..terminal import answer, say
from .arguments import SWITCH
from .point import parameters_of

_RANGE = re.compile(r"\s*\.\.\s*")
_SWITCHES = ("contact_point", "baseline", "tilt")
_OPTIONS = (*_SWITCHES, "x", "y", "sigma", "loss", "intervals", "level", "depth", "free")
_READING = ("part", "curve", "spring_constant", "sensitivity", "area")  # of `study.curves`
_PYTHON = ("plan", "progress")  # options of `study.fit` that a terminal does not have


def items(options) -> list[list[str]]:
    """All that was given describes one fit."""
    return [options.items]


def fit(options, texts: list[str]) -> int:
    """Fit and say it. Exit code 1 if a curve has no fit that can be used."""
    path, *words = texts
    if not Path(path).exists():  # said first, since inputs that are missing too are of no use without it
        first = f"the file of the curve comes first, then the inputs: fit curve.csv {path} ..."
        raise StudyError([f"{path}: {first if '=' in path else 'there is no such file'}"])
    reading = _reading([word for word in words if _name(word) in _READING])
    free, settings, parameters = question_of([word for word in words if _name(word) not in _READING])
    picture = options.plot
    if picture and not picture.lower().endswith((".png", ".pdf", ".svg")):
        raise StudyError([f"--plot {picture}: must end with one of .png, .pdf, .svg"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the summary says it
        try:
            fitted = fitted_by(curves(path, **reading) if reading else path, free=free, **settings, **parameters)
        except StudyError as error:
            raise StudyError(message.removeprefix("fit: ") for message in error.messages) from None
    code = answer(as_json(fitted) if options.json else summary(fitted))
    if picture:
        page = io.BytesIO()
        plot(fitted).savefig(page, format=Path(picture).suffix[1:].lower())
        say(f"figure: {write(Path(picture), page.getvalue()).as_posix()}", sys.stderr)
    usable = fitted["fit_status"].isin([0, 1, 3, 4])
    return code or int(not usable.all())


def _name(word: str) -> str:
    return word.partition("=")[0].strip()


def _reading(words: list[str]) -> dict[str, Any]:
    """The options of `study.curves`. Raises StudyError for an option that is given twice."""
    names = [_name(word) for word in words]
    if errors := [f"{name} is given twice" for name in _READING if names.count(name) > 1]:
        raise StudyError(errors)
    reading: dict[str, Any] = {_name(word): word.partition("=")[2].strip() for word in words}
    if re.fullmatch(r"-?\d{1,9}", reading.get("curve", "")):
        reading["curve"] = int(reading["curve"])
    if "area" in reading:
        reading["area"] = _coefficients(reading["area"])
    return reading


def _coefficients(text: str) -> list[float]:
    """C0, C1 ... of the area function of a tip, in nm."""
    try:
        return [float(number) for number in text.strip("[]() ").split(",")]
    except ValueError:
        raise StudyError([f"area={text}: must be numbers C0, C1 ... in nm, such as area=24.5,800"]) from None


def question_of(words: list[str]) -> tuple[Any, dict, dict]:
    """Free inputs, options of the fit, other inputs. An input "LOW .. HIGH" is free within these bounds.

    Raises StudyError with a message for each wrong word.
    """
    texts = {word.partition("=")[0].strip(): word.partition("=")[2].strip() for word in words}
    settings: dict[str, Any] = {name: text for name, text in texts.items() if name in _OPTIONS}
    errors = [message for name in dict.fromkeys(texts) if (message := _no_option(name))]
    if errors:
        raise StudyError(errors)
    parameters = parameters_of([word for word in words if word.partition("=")[0].strip() not in _OPTIONS])
    bounds = {name: tuple(_RANGE.split(v)) for name, v in parameters.items() if isinstance(v, str) and ".." in v}
    free: dict[str, Any] = {name.strip(): None for name in settings.pop("free", "").split(",") if name.strip()}
    free |= bounds
    names = [word.partition("=")[0].strip() for word in words]
    errors = [f"{name} is given twice" for name in _OPTIONS if names.count(name) > 1]
    errors += [] if free else ['name the inputs to fit, such as free=E1, or E1="1 kPa .. 1 MPa"']
    for name in _SWITCHES:
        if name in settings:
            value = SWITCH.get(settings[name].lower())
            errors += [f"{name}={settings[name]}: must be true or false"] * (value is None)
            settings[name] = value
    if "level" in settings:
        try:
            settings["level"] = float(settings["level"])
        except ValueError:
            errors.append(f"level={settings['level']}: must be a number, such as 0.95")
    if "depth" in settings:
        settings["depth"] = tuple(_RANGE.split(settings["depth"]))
    if settings.get("intervals") == "none":
        settings["intervals"] = None
    if errors:
        raise StudyError(errors)
    return free, settings, {name: value for name, value in parameters.items() if name not in bounds}


def _no_option(name: str) -> str:
    """The error for a name that is similar to an option; "" for other names."""
    if name in _PYTHON:
        return f"{name} is an option of study.fit in Python alone (docs/fit.md): leave it out"
    near = "" if name in (*_OPTIONS, *ROWS) or absent(name) else suggest(name, (*_OPTIONS, *_READING))
    return f'"{name}" is neither an option nor an input{near}' if "did you mean" in near else ""


def as_json(fitted: xr.Dataset) -> str:
    """The numbers of each curve in a list, or of a single curve without a list."""
    curves = [_of_curve(fitted.isel(curve=i)) for i in range(fitted.sizes["curve"])]
    return json.dumps(curves[0] if len(curves) == 1 else curves, indent=2, ensure_ascii=False)


def _of_curve(curve: xr.Dataset) -> dict:
    numbers: dict[str, Any] = {"curve": curve["curve"].item()} if "curve" in curve.coords else {}
    for name in map(str, curve["cov_i"].values):
        ends = {"value": name, "low": f"{name}_low", "high": f"{name}_high", "spread": f"{name}_spread"}
        numbers[name] = {key: _number(curve[variable]) for key, variable in ends.items() if variable in curve}
        numbers[name]["unit"] = curve[f"{name}_spread"].attrs["units"]
    flags = str(decode(curve["validity"]).item()).split() if int(curve["validity"]) else []
    return {"fit_status": str(decode(curve["fit_status"]).item()), **numbers, "validity": flags}


def _number(array: xr.DataArray) -> float | None:
    return float(array) if np.isfinite(array) else None
