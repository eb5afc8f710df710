"""All figures by name: which studies each needs, who draws it, its size; `draw` writes the files of one."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from importlib.resources import as_file, files
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.figure import Figure

from .evidence.extremes_map import maps
from .evidence.picard_domain import domain
from .evidence.tradeoff_view import work_precision
from .evidence.validity_maps import given_load, given_radius
from .figures.coatings import master_curves
from .figures.sources import csv_text, open_studies, write_text
from .paper.curves import PAPERS_FIGURES, laws
from .paper.schemes import contact_scheme, spot_scheme

ONE_COLUMN, TWO_COLUMNS = 3.35, 6.9  # inches, widths of a journal page


@dataclass(frozen=True)
class Recipe:
    """`draw(axes, *datasets)` takes the datasets of the `studies` and returns the columns of numbers that it drew;
    several `panels` (rows, columns) make axes an array."""

    studies: tuple[str, ...]
    draw: Callable[..., dict[str, np.ndarray]]
    size: tuple[float, float] = (ONE_COLUMN, 2.6)
    panels: tuple[int, int] = (1, 1)


PAPERS_STUDIES = {
    "fig03": ("main_case",),
    "fig04": ("load_sweep", "main_case"),
    "fig05": ("load_sweep", "main_case"),
    "fig06": ("load_sweep", "main_case"),
    "fig07": ("main_case",),
    "fig08": ("load_sweep", "main_case"),
    "fig10": ("spot_density",),
}
RECIPES = {
    "fig01": Recipe(("main_case",), contact_scheme, (5.2, 2.9)),
    "fig02": Recipe(("main_case",), spot_scheme, (ONE_COLUMN, 2.3)),
    "fig09": Recipe(("table1",), laws, (TWO_COLUMNS, 2.7), (1, 2)),
    "validity": Recipe(("validity",), given_load, (TWO_COLUMNS, 7.4), (5, 5)),
    "validity_load": Recipe(("validity_load",), given_radius, (TWO_COLUMNS, 3.7), (2, 5)),
    "coatings": Recipe(("coatings",), master_curves, (TWO_COLUMNS, 7.0), (3, 2)),
    "extremes": Recipe(("extremes", "extremes_layered"), maps, (TWO_COLUMNS, 9.2), (5, 3)),
    "picard_domain": Recipe(("picard_domain",), domain, (TWO_COLUMNS, 4.6), (2, 3)),
    "tradeoff": Recipe(("tradeoff",), work_precision, (TWO_COLUMNS, 6.4), (2, 2)),
}
for _name, _draw in PAPERS_FIGURES.items():
    _size = (ONE_COLUMN, 3.2 if _name == "fig08" else 2.6)
    RECIPES[_name] = Recipe(PAPERS_STUDIES[_name], _draw, _size)
    RECIPES[f"{_name}_layered"] = Recipe(PAPERS_STUDIES[_name], partial(_draw, exact=True), _size)


def compose(name: str, results="results") -> tuple[Figure, dict[str, np.ndarray], str]:
    """A figure as it will be written, the columns of numbers that it shows, and the title that its files carry.

    Raises
    ------
    StudyError : there is no such figure, or a study it needs has no results
    """
    recipe, datasets = open_studies(name, RECIPES, results)
    digests = " ".join(dataset.attrs["study_digest"][:16] for dataset in datasets)
    with style():
        figure = Figure(figsize=recipe.size, layout="constrained")
        columns = recipe.draw(figure.subplots(*recipe.panels), *datasets)
    return figure, columns, f"{name}, studies {digests}"


@contextmanager
def style() -> Iterator[None]:
    """Draw, and write, in the style of all figures."""
    with as_file(files(__package__) / "figures" / "roughcoat.mplstyle") as sheet, matplotlib.style.context(sheet):
        yield


def draw(name: str, results="results", figures="figures") -> list[Path]:
    """Write a figure as figures/NAME.pdf and .png, and its numbers as .csv; returns the three paths.

    The same datasets give the same bytes: no file carries a date. Raises what `compose` raises.
    """
    return save(Path(figures) / name, *compose(name, results))


def save(stem: Path, figure: Figure, columns: dict[str, np.ndarray], title: str) -> list[Path]:
    """Write what `compose` gives as STEM.csv, .pdf and .png."""
    rows = zip(*(np.asarray(column).tolist() for column in columns.values()), strict=True)
    paths = [write_text(stem.with_suffix(".csv"), csv_text(columns, rows))]
    for suffix, dated in ((".pdf", {"CreationDate": None}), (".png", {})):
        paths.append(stem.with_suffix(suffix))
        with style():
            figure.savefig(paths[-1], metadata={"Title": title} | dated)
    return paths
