"""The command `design`: the input that makes a wanted result, in the terminal, in words or as JSON."""

import json
import re
import sys
import warnings
from typing import Any

import xarray as xr

from ..data.dataset import decode
from ..in_words import FarOutside, summary
from ..inputs.definition import StudyError
from ..inputs.vocabulary import CONTROLS, NOT_RUN
from ..inverse.design import design as designed_by
from ..terminal import answer, say
from .point import as_numbers, described, number, number_or_text, parameters_of
from .signals import INTERRUPTED

_RANGE = re.compile(r"\s*\.\.\s*")
_RESULTS = ("p0", "p_max", "Ar_An", "dP_dD", "P_off")  # these are never inputs


def items(options) -> list[list[str]]:
    """All that was given describes one design."""
    return [options.items]


def design(options, texts: list[str]) -> int:
    """Find the input and say it. Exit code 1 if it has no value for some contact."""
    targets, by, parameters = question_of(parameters_of(texts))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the summary says it
        warnings.simplefilter("always", FarOutside)
        warnings.showwarning = lambda text, *_: say(f"beware: {text}", sys.stderr)
        try:
            designed = designed_by(targets, by, **parameters)
        except StudyError as error:
            raise StudyError(message.removeprefix("design: ") for message in error.messages) from None
    code = answer(_as_json(designed, *by) if options.json else summary(designed))
    if (designed["design_status"] == NOT_RUN).any():
        return INTERRUPTED
    return code or int(not designed["status"].isel(solution=0).isin([0]).all())


def question_of(parameters: dict[str, Any]) -> tuple[dict, dict, dict]:
    """The target, the wanted input, "LOW .. HIGH", and the other inputs. Raises StudyError.

    The target is p0, p_max, Ar_An, dP_dD or P_off; without these it is the first of P, a and D, if there are several.
    """
    ranges = {name: value for name, value in parameters.items() if isinstance(value, str) and ".." in value}
    if len(ranges) != 1:
        many = ", ".join(ranges) or "none"
        raise StudyError([f'exactly one input must have two bounds, such as h="1 um .. 1 mm"; here: {many}'])
    by = {name: tuple(map(number_or_text, _RANGE.split(value))) for name, value in ranges.items()}
    rest = {name: value for name, value in parameters.items() if name not in by}
    targets = {name: value for name, value in rest.items() if name in _RESULTS}
    controls = [name for name in rest if name in CONTROLS]
    if not targets and len(controls) > (not set(by) & {*CONTROLS}):
        targets = {controls[0]: rest[controls[0]]}
    return targets, by, {name: value for name, value in rest.items() if name not in targets}


def _as_json(designed: xr.Dataset, name: str) -> str:
    """The answer for a contact, with the numbers of each solution; for several contacts a list."""
    if not designed["design_status"].dims:
        return json.dumps(_of_contact(designed, name), indent=2, ensure_ascii=False)
    cases = designed.stack({"case": designed["design_status"].dims}, create_index=False)
    answers = [_of_contact(cases.isel(case=i), name) for i in range(cases.sizes["case"])]
    return json.dumps(answers, indent=2, ensure_ascii=False)


def _of_contact(designed: xr.Dataset, name: str) -> dict:
    solutions = []
    for i in range(designed.sizes["solution"]):
        contact = designed.isel(solution=i)
        if contact["status"] != NOT_RUN:
            ends = {end: number(contact[f"{name}_{end}"]) for end in ("low", "high")}
            entry = described(contact, name)
            solutions.append(as_numbers(contact) | {name: {**entry, **ends} if isinstance(entry, dict) else entry})
    status = decode(designed["design_status"]).item()
    return {"design_status": status, "message": str(designed["message"].values), "solutions": solutions}
