"""The look of all figures."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import as_file, files
from pathlib import Path

import matplotlib.style
from matplotlib import font_manager

FONT = "STIXGeneral"  # of all figures; it comes with matplotlib


@contextmanager
def style() -> Iterator[None]:
    """Draw, and write, in the style of all figures."""
    add_fonts()
    with as_file(files(__package__) / "roughcoat.mplstyle") as sheet, matplotlib.style.context(sheet):
        yield


def add_fonts() -> None:
    """Add the fonts that come with matplotlib to its list.

    A user keeps the list from one installation to the next, so they may be missing, and every figure looks different.
    """
    if FONT in font_manager.fontManager.get_font_names():
        return
    for file in Path(matplotlib.get_data_path(), "fonts/ttf").glob("STIX*.ttf"):
        font_manager.fontManager.addfont(file)
