"""The commands that only read: pages, materials, and scans of rough surfaces."""

import pydoc
import sys
from argparse import ArgumentTypeError
from collections.abc import Callable
from typing import Any

from .. import pages
from ..inputs.definition import StudyError
from ..scan_laws import roughness
from ..specimen import materials
from ..specimen.quantities import has_unit, multiple, quantity
from ..specimen.scan import meant
from ..terminal import answer, program, shown
from . import signals
from .arguments import SWITCH, assignment

_DIGITS = 7  # of a number in the words for `point`, more than the precision of any scan


def items(options) -> list:
    """Pages or materials; without any, all are listed, which "" stands for. All words of `scan` are of one scan."""
    return [options.items] if options.command == "scan" else options.items or [""]


def docs(_, name: str) -> int:
    """Show a page, in a terminal by its pager; without a name the list of pages."""
    if not name:
        titles = pages.titles()
        width = max(map(len, titles), default=0)
        lines = (f"{page:{width}}  {title}" for page, title in titles.items())
        return answer(*lines, f"\nOpen one with `{program()} docs NAME`.")
    text = pages.page(name)
    if sys.stdout is not None and sys.stdout.isatty():
        signals.state.elsewhere = True  # Ctrl-C is the pager's
        pydoc.pager(text)
        signals.state.elsewhere = False
        return 0
    return answer(text.rstrip("\n"))


def materials_(_, name: str) -> int:
    """Say all that is known of a material; without a name the table of all."""
    if not name:
        return answer(materials.table(), f"\nStrengths and sources of one: `{program()} materials NAME`.")
    try:
        return answer(materials.in_words(materials.get(name)))
    except LookupError as error:
        raise StudyError([f"materials: {error.args[0]}"]) from None


def scan(options, texts: list[str]) -> int:
    """Measure the asperities of a scan: its numbers in sentences, and as `point` takes them; or write its own law."""
    path, *words = texts
    try:
        return _law(path, words, options.law) if options.law else _asperities(path, words)
    except OSError as error:
        raise StudyError([f"scan: {error.filename or path}: {error.strerror or error}"]) from None
    except StudyError:
        raise
    except (ValueError, ImportError) as error:
        raise StudyError([f"scan: {error}"]) from None


def _law(path: str, words: list[str], out: str) -> int:
    """Write the micro law of a scan, and say what it is."""
    arguments = _arguments(words, READING | PRESSING | BODY)
    reading, pressing, body = (
        {name: arguments[name] for name in kinds if name in arguments} for kinds in (READING, PRESSING, BODY)
    )
    of_scan = roughness.law(roughness.read(path, **reading), on=body or None, **pressing)
    of_scan.to_csv(out)
    inputs = " ".join(f'{name}="{value}"' for name, value in body.items())
    return answer(of_scan, f'\n{program()} point ... {inputs}{" " * bool(inputs)}micro="table:{out}"')


def _asperities(path: str, words: list[str]) -> int:
    arguments = _arguments(words, READING | MEASURING | {"heights": _text})
    heights = arguments.pop("heights", "normal")
    reading = {name: value for name, value in arguments.items() if name in READING}
    measuring = {name: value for name, value in arguments.items() if name in MEASURING}
    asperities = roughness.measure(roughness.read(path, **reading), **measuring)
    numbers = asperities.parameters(heights)
    if asperities.cutoff is not None:
        return answer(asperities)
    words = " ".join(f"{name}={_as_written(value)}" for name, value in numbers.items())
    return answer(asperities, f"\n{program()} point ... {words}")


def _as_written(value: float | str) -> str:
    """A value as people write it for `point`: a number of seven digits, at least 0.1 in the largest such unit."""
    if isinstance(value, float):
        return f"{value:.{_DIGITS}g}"
    number, _, unit = value.partition(" ")
    if not unit:
        return f'"{value}"'
    word, size = multiple(10 * float(number), unit)
    return f'"{float(number) / size:.{_DIGITS}g} {word.replace("²", "^2").replace("µ", "u")}"'


def _arguments(texts: list[str], kinds: "Kinds") -> dict[str, Any]:
    """The arguments of these `kinds` from texts NAME=VALUE. Raises StudyError with a message for each wrong text."""
    arguments, errors = {}, []
    for text in texts:
        try:
            name, _ = assignment(text)
            if name not in kinds:
                near = meant(name, kinds)
                says = f"did you mean {near}?" if near else f"it takes {', '.join(kinds)}"
                raise ValueError(f"`scan` does not take {shown(name)}; {says}")
            if name in arguments:
                raise ValueError(f"{name} is given twice")
            arguments[name] = kinds[name](name, text.partition("=")[2].strip())
        except (ArgumentTypeError, ValueError) as error:
            errors.append(f"scan: {error}")
    if errors:
        raise StudyError(errors)
    return arguments


def _text(_, text: str) -> str:
    return text


def _distance(name: str, text: str) -> float | str:
    if has_unit(text):
        return text
    try:
        return float(text)
    except ValueError:
        raise ValueError(f'{name} = {shown(text)}: must be a number, in `unit`, or a length such as "0.4 um"') from None


def _whole(name: str, text: str) -> int:
    if not text.isdecimal():
        raise ValueError(f"{name} = {shown(text)}: must be a whole number")
    return int(text)


def _deviations(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{name} = {shown(text)}: must be a number of robust deviations, such as 5") from None


def _columns(name: str, text: str) -> list[int]:
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise ValueError(f"{name} = {shown(text)}: must be columns, counted from 0, such as {name}=0,2") from None


def _switch(name: str, text: str) -> bool:
    if text.lower() not in SWITCH:
        raise ValueError(f"{name} = {shown(text)}: must be {name}=true or {name}=false")
    return SWITCH[text.lower()]


def _crop(_, text: str) -> list[float | str]:
    """Ends of the part to keep: numbers, or lengths with units. `read` reports errors in them."""
    return [_number_or_text(part.strip()) for part in text.split(",")]


def _number_or_text(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _cutoffs(name: str, text: str) -> float | list[float]:
    """One cutoff or several, m."""
    lengths = [quantity(name, part, "m").value for part in text.split(",")]
    return lengths if len(lengths) > 1 else lengths[0]


Kinds = dict[str, Callable[[str, str], Any]]
READING: Kinds = {
    "unit": _text,
    "height_unit": _text,
    "dx": _distance,
    "dy": _distance,
    "columns": _columns,
    "channel": _text,
    "crop": _crop,
    "missing": _text,
    "steep": _switch,
    "huge": _switch,
    "despike": _deviations,
}
"""Argument of `read` -> function of its name and a text that returns its value."""
MEASURING: Kinds = {"method": _text, "form": lambda _, text: _number_or_text(text), "rows": _text, "cutoff": _cutoffs}
"""The same for `measure`."""
PRESSING: Kinds = {
    "periodic": _text,
    "refine": _whole,
    "form": MEASURING["form"],
    "cutoff": lambda name, text: quantity(name, text, "m").value,
}
"""The same for `law`, with --law."""
BODY: Kinds = dict.fromkeys(
    ("h", "n", "E1", "nu1", "layer", "E2", "nu2", "body", "bonding", "m", "E_punch", "nu_punch", "punch"),
    lambda _, text: _number_or_text(text),
)
"""The body on which the law is computed, with --law: a half-space without any of them."""
