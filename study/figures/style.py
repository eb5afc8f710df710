"""The look of all figures."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import as_file, files
from pathlib import Path

import matplotlib.style
from matplotlib import font_manager

FONT = "STIXGeneral"


@contextmanager
def style() -> Iterator[None]:
    """Draw, and write, in the style of all figures."""
    own_fonts()
    with as_file(files(__package__) / "roughcoat.mplstyle") as sheet, matplotlib.style.context(sheet):
        yield


def own_fonts() -> None:
    """Make the fonts known that come with matplotlib: its list, which a user keeps from one installation to the next,
    may lack them, and then every figure looks different."""
    if FONT in font_manager.fontManager.get_font_names():
        return
    for file in Path(matplotlib.get_data_path(), "fonts/ttf").glob("STIX*.ttf"):
        font_manager.fontManager.addfont(file)
