"""All figures and tables by name: what each needs, whether it is up to date, and the files that it is written to."""

import io
from importlib import import_module
from importlib.resources import files
from pathlib import Path
from pkgutil import iter_modules

import numpy as np
from matplotlib.figure import Figure

from . import evidence, figures, literature, paper
from .figures import record
from .figures.formats import as_latex, as_text, csv_text, write
from .figures.labels import stated, wrapped
from .figures.registry import FIGURES, TABLES, Columns, entry, open_studies
from .figures.style import style
from .spec.definition import StudyError

SCHEMES = {
    "fig01": "The contact: a sphere of radius R with asperities, pressed by P on a coated half-space.",
    "fig02": "One asperity of radius Ra and its cell; the contact spot has the radius b.",
}
"""Figures 1 and 2 of the paper, with their captions. They show no results, and are kept as drawings."""
for _room in (figures, paper, literature, evidence):
    for _module in iter_modules(_room.__path__, f"{_room.__name__}."):
        import_module(_module.name)  # its decorators register figures and tables


FIGURE, SCHEME, TABLE = ("csv", "pdf", "png"), ("svg", "pdf", "png"), ("txt", "csv", "tex")
"""Endings of the files of a figure, a scheme and a table."""
CAPTIONS = "captions"  # name among the figures of the file that holds all captions
LETTERS = 21  # letters on an inch of the line above a figure that states its parameters
LONG = ("extremes", "extremes_layered", "picard_domain", "tradeoff")
"""Studies that take minutes to compute: `make figures` goes without them."""


def usual(known: dict) -> list[str]:
    """What "all" stands for: the FIGURES with the schemes, or the TABLES, that need none of the LONG studies."""
    names = [name for name, entry in known.items() if not set(entry.studies) & set(LONG)]
    return [*sorted([*names, *SCHEMES]), CAPTIONS] if known is FIGURES else sorted(names)


def needed(name: str, known: dict) -> tuple[str, ...]:
    """The studies that a figure or table needs. Raises StudyError if there is none of this name."""
    return () if name in (*SCHEMES, CAPTIONS) and known is FIGURES else entry(name, known).studies


def what(name: str, known: dict) -> str:
    """How the record of a folder calls it: "figure fig03", "table validity"."""
    return f"{'table' if known is TABLES else 'figure'} {name}"


def endings(name: str, known: dict) -> tuple[str, ...]:
    """Endings of the files of a figure or table."""
    if name == CAPTIONS and known is FIGURES:
        return ("md",)
    return TABLE if known is TABLES else SCHEME if name in SCHEMES else FIGURE


def digest(name: str, known: dict, results) -> str:
    """The digest of all that the files of a figure or table follow from: results, code, libraries."""
    paths = [Path(results) / f"{study}.nc" for study in needed(name, known)]
    return record.digest_of(what(name, known), endings(name, known), [path for path in paths if path.exists()])


def outdated(name: str, known: dict, results, folder) -> bool:
    """Whether a file of a figure or table is missing, has changed, or was not made by `renewed` of the same digest."""
    if name == CAPTIONS and known is FIGURES:
        return True  # it depends on all results, so it is written each time
    names = [f"{name}.{ending}" for ending in endings(name, known)]
    return not record.is_up_to_date(Path(folder), what(name, known), digest(name, known, results), names)


def renewed(known: dict, name: str, results="results", folder="figures") -> list[Path]:
    """Write a figure or table, as `draw` and `tabulate` do, and put it into the record of the folder."""
    of = digest(name, known, results)  # before: results that change meanwhile make it outdated
    paths = (tabulate if known is TABLES else draw)(name, results, folder)
    record.note(Path(folder), what(name, known), of, paths)
    return paths


def compose(name: str, results="results") -> tuple[Figure, Columns, str]:
    """A figure as it will be written, the columns of numbers that it shows, and the title that its files carry.

    Raises StudyError when there is no such figure, a study it needs has no results, or its function does not return
    columns.
    """
    recipe, datasets = entry(name, FIGURES), open_studies(name, FIGURES, results)
    digests = [dataset.attrs["study_digest"][:16] for dataset in datasets]
    with style():
        figure = Figure(figsize=recipe.size, layout="constrained")
        columns = recipe.draw(figure.subplots(*recipe.panels), *datasets)
        shapes = [np.shape(column) for column in columns.values()] if isinstance(columns, dict) else [()]
        if any(len(shape) != 1 or shape != shapes[0] for shape in shapes):
            wrong = "the function must return its numbers: heading -> column, all of one length"
            raise StudyError([f"{name}: {wrong}"], code=1)
        if not figure.get_suptitle():
            figure.suptitle(wrapped(stated(datasets), LETTERS * recipe.size[0]), fontsize=7)
    return figure, columns, f"{name}, studies {' '.join(digests)}".removesuffix(", studies ")


def draw(name: str, results="results", folder="figures") -> list[Path]:
    """Write a figure as FOLDER/NAME.csv, its numbers, .pdf and .png; returns the three paths.

    A scheme is copied as .svg, .pdf and .png; "captions" is FOLDER/captions.md. The same datasets give the same bytes:
    no file carries a date. Raises what `compose` raises.
    """
    if name in SCHEMES:  # it stands in the package as it is: the .svg is the original, to be edited by hand
        paths = [Path(folder) / f"{name}.{kind}" for kind in SCHEME]
        return [write(path, (files(paper) / "schemes" / path.name).read_bytes()) for path in paths]
    if name == CAPTIONS:
        return [write(Path(folder) / "captions.md", captions(results))]
    return save(Path(folder) / name, *compose(name, results))


def captions(results="results") -> str:
    """A paragraph for each figure whose studies have results: what it shows, and the parameters of its studies."""
    lines = ["# Captions", "", "Lengths are in R, pressures in E2*, loads in E2* R² unless an axis says otherwise.", ""]
    lines += [f"**{name}.** {text}\n" for name, text in SCHEMES.items()]
    for name, recipe in sorted(FIGURES.items()):
        if all((Path(results) / f"{study}.nc").exists() for study in recipe.studies):
            given = ", ".join(stated(open_studies(name, FIGURES, results)))
            lines.append(f"**{name}.** {recipe.caption}{f' Parameters: {given}.' if given else ''}\n")
    return "\n".join(lines)


def save(stem: Path, figure: Figure, columns: Columns, title: str) -> list[Path]:
    """Write what `compose` gives as STEM.csv, .pdf and .png."""
    rows = zip(*(np.asarray(column).tolist() for column in columns.values()), strict=True)
    contents = {"csv": csv_text(columns, rows)}
    for ending, dated in (("png", {}), ("pdf", {"CreationDate": None})):
        page = io.BytesIO()
        with style():
            figure.savefig(page, format=ending, metadata={"Title": title} | dated)
            figure.set_layout_engine(None)  # the second keeps the layout, which takes long to find for many axes
        contents[ending] = page.getvalue()
    return [write(stem.with_suffix(f".{ending}"), contents[ending]) for ending in FIGURE]


def tabulate(name: str, results="results", folder="tables") -> list[Path]:
    """Write a table as FOLDER/NAME.txt, .csv and .tex; returns the three paths. Raises as `compose` does."""
    table, datasets = entry(name, TABLES), open_studies(name, TABLES, results)
    rows = table.rows(*datasets)
    if not isinstance(rows, list) or any(len(row) != len(table.columns) for row in rows):
        wrong = f"the function must return a list of tuples of {len(table.columns)} cells, one a row"
        raise StudyError([f"{name}: {wrong}"], code=1)
    text_csv = csv_text([column.text for column in table.columns], rows)
    texts = {"txt": as_text(table, rows), "csv": text_csv, "tex": as_latex(table, rows)}
    return [write(Path(folder) / f"{name}.{suffix}", text) for suffix, text in texts.items()]
