"""Pages of the site that are made of the code: public names, command line, parameters, statuses, validity, files."""

import argparse
import inspect
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import roughcoat
import solver
from study.__main__ import parser
from study.inputs.lexicon import PACKAGE
from study.inputs.vocabulary import VOCABULARY, allowed
from study.rules.rule import ASSUMPTIONS, RULES

STUDY = '[model]\nbase = "half_space"\nmicro = "smooth"\n[axes]\nP = [1e-6, 1e-5]\n'


def write(folder: Path) -> None:
    """Write all pages into a folder; one that is as it was keeps its time, so that Sphinx does not read it again."""
    pages = {
        "command_line.md": command_line(),
        "parameters.md": parameters(),
        "statuses.md": statuses(),
        "validity.md": validity(),
        "file_format.md": file_format(),
        **dict(names()),
    }
    folder.mkdir(exist_ok=True)
    for path in folder.iterdir():
        if path.name not in pages:
            path.unlink()
    for name, text in pages.items():
        path = folder / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def pages_linked(text: str) -> str:
    """Text of a docstring in which docs/fit.md is a link to that page."""
    return re.sub(r"(?<![`\w/])docs/(\w+)\.md", r":doc:`/\1`", text)


def links_inside(text: str, page: str) -> str:
    """A page of docs/ without links out of docs/: README becomes the start, other files become their names.

    A link whose words are the name of a page, [fit.md](fit.md), has the title of that page, or of the section, as its
    words.
    """
    if page == "index":  # it includes README.md, which stands one folder up
        return text
    text = re.sub(r"\[(\w+\.md)\]\((\1(?:#[^)]*)?)\)", r"[](\2)", text)
    text = re.sub(r"\]\(\.\./README\.md(#[^)]*)?\)", r"](index.md)", text)
    return re.sub(r"\[([^\]]*)\]\(\.\./([^)]*)\)", r"\1 (`\2`)", text)


def table(heads: list[str], rows: list[list[str]]) -> str:
    """A table in Markdown."""
    lines = [heads, ["---"] * len(heads), *rows]
    return (
        "\n".join(f"| {' | '.join(str(cell).replace('|', chr(92) + '|') for cell in line)} |" for line in lines) + "\n"
    )


def names() -> Iterator[tuple[str, str]]:
    """A page for each public name, and one that lists them: name of the file, text."""
    listed = []
    for package in (roughcoat, solver):
        rows = []
        for name in package.__all__:
            full = f"{package.__name__}.{name}"
            rows.append(f"   * - :doc:`{name} <{full}>`\n     - {_first_line(getattr(package, name))}")
            yield f"{full}.rst", _page(full, getattr(package, name))
        listed.append(_under(package.__name__, "-") + ".. list-table::\n\n" + "\n".join(rows) + "\n")
    tree = "\n.. toctree::\n   :hidden:\n   :glob:\n\n   roughcoat.*\n   solver.*\n"
    yield "names.rst", _under("Public names", "=") + "\n".join(listed) + tree


def _page(full: str, thing: Any) -> str:
    title = _under(full, "=")
    if isinstance(thing, ModuleType):
        parts = [f".. automodule:: {thing.__name__}\n"]
        parts += [_member(full, name, getattr(thing, name)) for name in _public(thing)]
        return title + "\n".join(parts)
    package, name = full.rsplit(".", 1)
    return title + _member(package, name, thing)


def _member(place: str, name: str, thing: Any) -> str:
    if inspect.isclass(thing):
        return f".. autoclass:: {place}.{name}\n   :members:\n"
    if callable(thing):
        return f".. autofunction:: {place}.{name}\n"
    return f".. py:data:: {place}.{name}\n\n   {_first_line(thing)}\n"


def _public(module: ModuleType) -> list[str]:
    """The names that a module says are public; without such a list its functions and classes."""
    if hasattr(module, "__all__"):
        return [*module.__all__]
    found = {name: thing for name, thing in vars(module).items() if not name.startswith("_") and callable(thing)}
    return [name for name, thing in found.items() if thing.__module__ == module.__name__]


def _first_line(thing: Any) -> str:
    if isinstance(thing, str):
        return f"``{thing!r}``"
    if isinstance(thing, dict | list | tuple):
        return f"A {type(thing).__name__} of {len(thing)} entries."
    first = (inspect.getdoc(thing) or "").split("\n\n")[0].replace("\n", " ")
    return pages_linked(re.sub(r"`([^`]*)`", r"``\1``", first))


def _under(title: str, line: str) -> str:
    return f"{title}\n{line * len(title)}\n\n"


def command_line() -> str:
    """Each command with its options, as `--help` says them."""
    top = parser()
    top.prog = "roughcoat"
    (commands,) = (action for action in top._actions if isinstance(action, argparse._SubParsersAction))
    parts = ["# Command line\n\n`roughcoat COMMAND`, or `python -m roughcoat COMMAND`, which is the same.\n"]
    for name, command in commands.choices.items():
        command.prog = f"roughcoat {name}"
        command.formatter_class = lambda prog: argparse.HelpFormatter(prog, width=100)
        parts.append(f"## {name}\n\n```text\n{command.format_help().rstrip()}\n```\n")
    return "\n".join(parts)


def parameters() -> str:
    """Each row of the vocabulary: parameters with bounds and default, then results."""
    heads = ["name", "symbol", "what it is", "SI unit", "unit without R and E", "allowed", "default", "equation"]
    parts = ["# Parameters and results\n"]
    for role in dict.fromkeys(entry.role for entry in VOCABULARY.values()):
        rows = []
        for name, entry in VOCABULARY.items():
            if entry.role == role:
                parameter = PACKAGE.parameter(name)
                bounds = allowed(parameter) if parameter.interval or parameter.choices else ""
                default = (
                    ""
                    if parameter.default in (None, "") or parameter.default != parameter.default
                    else f"`{parameter.default}`"
                )
                rows.append([f"`{name}`", entry.symbol, entry.long_name, entry.unit, entry.scale, bounds, default])
                rows[-1].append(entry.equation)
        parts.append(f"## {role}\n\n" + table(heads, rows))
    return "\n".join(parts)


def statuses() -> str:
    """How a computation may end."""
    rows = [[int(status), f"`{status.name.lower()}`", status.meaning] for status in solver.Status]
    return "# Statuses\n\n`status` of each case. Other cases go on.\n\n" + table(["value", "name", "meaning"], rows)


def validity() -> str:
    """The assumptions that are checked."""
    rows = [[mask, f"`{name}`", _in_markdown(RULES[name].sentence)] for mask, name in sorted(ASSUMPTIONS.items())]
    head = "# Validity\n\n`validity` of each case is the sum of the masks of what it violates; 0: nothing.\n\n"
    return head + table(["mask", "name", "what is said of such a case"], rows)


def _in_markdown(sentence: str) -> str:
    return sentence.replace("*", "\\*").replace("$", "\\$").replace("_", "\\_")


def file_format() -> str:
    """Dimensions, variables and attributes of a results file, of one that is computed here."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "small.toml"
        path.write_text(STUDY, encoding="utf-8")
        study = roughcoat.load(path, Path(folder) / "results")
        study.run(workers=1)
        with study.open() as dataset:
            found = dataset.load()
    variables = [
        [f"`{name}`", ", ".join(map(str, array.dims)) or "none", array.dtype, array.attrs.get("long_name", "")]
        for name, array in {**found.coords, **found.data_vars}.items()
    ]
    attributes = [[f"`{name}`", type(value).__name__] for name, value in found.attrs.items()]
    kinds = {name: "flag_values" if "flag_values" in array.attrs else "" for name, array in found.data_vars.items()}
    flags = ", ".join(f"`{name}`" for name, kind in kinds.items() if kind or "flag_masks" in found[name].attrs)
    return f"""# File format

`roughcoat run NAME` writes `results/NAME.nc`, netCDF-4. `xarray.open_dataset` and every other reader of netCDF-4 opens
it. The dimensions are the axes of the study, and x = r/a of the profiles. Units are SI where the study has physical
values; otherwise the attribute `scale` says in what a number is measured, such as `E2* R^2`. {flags} are flags after
the conventions CF: `flag_values` or `flag_masks`, and `flag_meanings`.

These are the variables of the smallest study, two smooth contacts on a half-space:

{table(["variable", "dimensions", "type", "what it is"], variables)}
and the attributes of the file:

{table(["attribute", "type"], attributes)}"""
