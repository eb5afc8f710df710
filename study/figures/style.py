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
    # A user keeps matplotlib's list of fonts from one installation to the next, so those that come with it may be
    # missing there, and every figure looks different.
    if FONT not in font_manager.fontManager.get_font_names():
        for file in Path(matplotlib.get_data_path(), "fonts/ttf").glob("STIX*.ttf"):
            font_manager.fontManager.addfont(file)
    with as_file(files(__package__) / "roughcoat.mplstyle") as sheet, matplotlib.style.context(sheet):
        yield
