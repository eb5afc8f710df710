"""All figures and tables by name: the studies that each needs, whether it is up to date, and its files.

Files of figures beside studies are run when one of their figures is needed; a list of the names runs none
(`study.figures.figure_files`).
"""

import io
import os
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from .figures import record
from .figures.annotate import name_panels
from .figures.formats import as_latex, as_text, csv_text, write
from .figures.labels import stated, wrapped
from .figures.registry import FIGURES, TABLES, Columns, Drawing, code_of, entry, names, open_studies
from .figures.style import style
from .files.results_file import results_of
from .inputs.definition import StudyError

__all__ = ["FIGURES", "TABLES", "captions", "compose", "draw", "tabulate"]
Folder = str | os.PathLike
ENDINGS = {"figure": ("csv", "pdf", "png"), "table": ("txt", "csv", "tex"), "drawing": ("svg", "pdf", "png")}
CAPTIONS = "captions"  # counts as a figure: the file that holds all captions
NOT_THIN = (
    '"Layer not thin" above a figure: the largest of the errors of a, D, p(0), pmax and Ar/An of the thin-layer model '
    "is above 10 %. That of the quantity shown may be smaller; the figures on the exact layer show it."
)
LETTERED = 8  # at most so many panels get letters; more of them have headings of rows and columns instead
LETTERS = 21  # letters per inch in the line of parameters above a figure


def usual(kind: str) -> list[str]:
    """The names that "all" stands for: figures ("figure") or tables ("table") except those that need a long study."""
    listed = sorted(names(kind, long=False))
    return [*listed, CAPTIONS] if kind == "figure" else listed


def needed(kind: str, name: str) -> tuple[str, ...]:
    """The studies that a figure or table needs. Raises StudyError if there is none of this name."""
    return () if (kind, name) == ("figure", CAPTIONS) else entry(kind, name).studies


def what(kind: str, name: str) -> str:
    """The name of a figure or table in the record of a folder: "figure fig03", "table validity"."""
    return f"{kind} {stem(name)}"


def stem(name: str) -> str:
    """The name of the files of a figure or table: NAME for FOLDER/NAME."""
    return name.rpartition("/")[2]


def endings(kind: str, name: str) -> tuple[str, ...]:
    """Endings of the files of a figure or table."""
    return ENDINGS["drawing" if isinstance(entry(kind, name), Drawing) else kind]


def digest(kind: str, name: str, results) -> str:
    """The digest of all that decides the files of a figure or table: results, code, libraries."""
    recipe = entry(kind, name)
    paths = [path for study in recipe.studies if (path := results_of(Path(results), study)).exists()]
    copied = list(copies(recipe)) if isinstance(recipe, Drawing) else []
    return record.digest_of(what(kind, name), endings(kind, name), paths, [*code_of(kind, name), *copied])


def outdated(kind: str, name: str, results, folder) -> bool:
    """Whether a file of a figure or table is missing or has changed, or `renewed` made it with another digest."""
    if (kind, name) == ("figure", CAPTIONS):
        return True  # it depends on all results, so it is written each time
    files = [f"{stem(name)}.{ending}" for ending in endings(kind, name)]
    return not record.is_up_to_date(Path(folder), what(kind, name), digest(kind, name, results), files)


def renewed(kind: str, name: str, results="results", folder="figures") -> list[Path]:
    """Write a figure or table, like `draw` and `tabulate`, and enter it in the record of the folder."""
    if (kind, name) == ("figure", CAPTIONS):
        return draw(name, results, folder)
    digest_of_sources, paths = written(kind, name, results, folder)
    return noted(kind, name, folder, digest_of_sources, paths)


def written(kind: str, name: str, results: Folder, folder: Folder, bare: bool = False) -> tuple[str, list[Path]]:
    """Write a figure or table. Returns its `digest` and its files."""
    digest_of_sources = digest(kind, name, results)  # taken first: if results change meanwhile, the figure is outdated
    if bare:
        return digest_of_sources, draw(name, results, folder, bare=True)
    return digest_of_sources, (tabulate if kind == "table" else draw)(name, results, folder)


def noted(kind: str, name: str, folder: Folder, digest_of_sources: str, paths: list[Path]) -> list[Path]:
    """Enter a digest and files, as `written` returns them, in the record of the folder. Returns the files."""
    record.note(Path(folder), what(kind, name), digest_of_sources, paths)
    return paths


def compose(name: str, results: Folder = "results") -> tuple[Figure, Columns, str]:
    """A figure as `draw` writes it.

    Parameters
    ----------
    name : of the figure
    results : folder of the results

    Returns
    -------
    tuple : the figure, the columns of numbers that it shows, and the title that its files carry

    Raises
    ------
    StudyError : there is no such figure, a study it needs has no results, or its function does not return columns

    Examples
    --------
    >>> from study import figure
    >>> @figure("parabola")
    ... def parabola(axes):
    ...     "A parabola."
    ...     axes.plot([0, 1, 2], [0, 1, 4])
    ...     return {"x": [0, 1, 2], "y": [0, 1, 4]}
    >>> drawn, columns, title = compose("parabola")
    >>> columns["y"], title
    ([0, 1, 4], 'parabola')
    >>> _ = FIGURES.pop("parabola")
    """
    recipe = entry("figure", name)
    datasets = open_studies(name, recipe.studies, results)
    digests = [dataset.attrs["study_digest"][:16] for dataset in datasets]
    with style():
        figure = Figure(figsize=recipe.size, layout="constrained")
        panels = figure.subplots(*recipe.panels)
        columns = recipe.draw(panels, *datasets)
        shapes = [np.shape(column) for column in columns.values()] if isinstance(columns, dict) else [()]
        if any(len(shape) != 1 or shape != shapes[0] for shape in shapes):
            wrong = "the function must return its numbers: heading -> column, all of one length"
            raise StudyError([f"{name}: {wrong}"], code=1)
        if 1 < np.size(panels) <= LETTERED:
            name_panels(np.ravel(panels))
        if not figure.get_suptitle():
            figure.suptitle(wrapped(stated(datasets), LETTERS * recipe.size[0]), fontsize=7)
    return figure, columns, f"{stem(name)}, studies {' '.join(digests)}".removesuffix(", studies ")


def draw(name: str, results: Folder = "results", folder: Folder = "figures", bare: bool = False) -> list[Path]:
    """Write a figure as FOLDER/NAME.csv, its numbers, .pdf and .png.

    A drawing is copied as .svg, .pdf and .png; "captions" is FOLDER/captions.md. The same datasets give the same bytes:
    no file carries a date.

    Parameters
    ----------
    name : of the figure
    results, folder : folders of the results, and of the files that are written
    bare : whether to leave out the parameters above the figure; captions.md has them

    Returns
    -------
    list of pathlib.Path : the files

    Raises
    ------
    StudyError : as for `compose`

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     print([path.name for path in draw("fig01", folder=folder)])
    ['fig01.svg', 'fig01.pdf', 'fig01.png']
    """
    if name == CAPTIONS:
        return [write(Path(folder) / "captions.md", captions(results))]
    recipe = entry("figure", name)
    if isinstance(recipe, Drawing):  # the .svg is the original, to be edited by hand
        return [write(Path(folder) / f"{stem(name)}{path.suffix}", path.read_bytes()) for path in copies(recipe)]
    figure, columns, title = compose(name, results)
    return save(Path(folder) / stem(name), without_parameters(figure) if bare else figure, columns, title)


def without_parameters(figure: Figure) -> Figure:
    """The figure without the line of parameters above it."""
    figure.suptitle("").set_in_layout(False)
    return figure


def copies(drawing: Drawing) -> list[Path]:
    """The files of a drawing."""
    return [drawing.stem().with_suffix(f".{ending}") for ending in ENDINGS["drawing"]]


def captions(results: Folder = "results") -> str:
    """A paragraph for each figure whose studies have results: its caption, and the parameters of its studies.

    Parameters
    ----------
    results : folder of the results

    Returns
    -------
    str : in Markdown

    Examples
    --------
    >>> print(captions(results="of_an_example").partition(" ")[2][:8])
    Captions
    """
    lines = ["# Captions", "", "Lengths are in R, pressures in E2*, loads in E2* R² unless an axis says otherwise.", ""]
    lines += [NOT_THIN, ""]
    recipes = {name: entry("figure", name) for name in sorted(names("figure"))}
    for name, recipe in sorted(recipes.items(), key=lambda item: not isinstance(item[1], Drawing)):  # drawings first
        if all((Path(results) / f"{study}.nc").exists() for study in recipe.studies):
            shared = ", ".join(stated(open_studies(name, recipe.studies, results)))
            lines.append(f"**{name}.** {recipe.caption}{f' Parameters: {shared}.' if shared else ''}\n")
    return "\n".join(lines)


def save(stem: Path, figure: Figure, columns: Columns, title: str) -> list[Path]:
    """Write a figure that `compose` returned as STEM.csv, .pdf and .png."""
    rows = zip(*(np.asarray(column).tolist() for column in columns.values()), strict=True)
    contents: dict[str, str | bytes] = {"csv": csv_text(columns, rows)}
    for ending, metadata in (("png", {}), ("pdf", {"CreationDate": None})):
        page = io.BytesIO()
        with style():
            figure.savefig(page, format=ending, metadata={"Title": title} | metadata)
            figure.set_layout_engine(
                None
            )  # the second file keeps the layout of the first: it takes long to find for many axes
        contents[ending] = page.getvalue()
    return [write(stem.with_suffix(f".{ending}"), contents[ending]) for ending in ENDINGS["figure"]]


def tabulate(name: str, results: Folder = "results", folder: Folder = "tables") -> list[Path]:
    """Write a table as FOLDER/NAME.txt, .csv and .tex.

    Parameters
    ----------
    name : of the table
    results, folder : folders of the results, and of the files that are written

    Returns
    -------
    list of pathlib.Path : the three files

    Raises
    ------
    StudyError : there is no such table, a study it needs has no results, or its function returns other rows

    Examples
    --------
    >>> import tempfile
    >>> from study import table
    >>> @table("squares", columns="x | d; square | d")
    ... def squares():
    ...     "The first squares."
    ...     return [(1, 1), (2, 4)]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     files = tabulate("squares", folder=folder)
    ...     print(files[1].read_text().splitlines())
    ['x,square', '1,1', '2,4']
    >>> _ = TABLES.pop("squares")
    """
    table = entry("table", name)
    rows = table.rows(*open_studies(name, table.studies, results))
    if not isinstance(rows, list) or any(len(row) != len(table.columns) for row in rows):
        wrong = f"the function must return a list of tuples of {len(table.columns)} cells, one a row"
        raise StudyError([f"{name}: {wrong}"], code=1)
    text_csv = csv_text([column.text for column in table.columns], rows)
    try:
        texts = {"txt": as_text(table, rows), "csv": text_csv, "tex": as_latex(table, rows)}
    except StudyError as error:  # a column without a format
        raise StudyError([f"{name}: {text}" for text in error.messages], code=1) from None
    return [write(Path(folder) / f"{stem(name)}.{suffix}", text) for suffix, text in texts.items()]
