"""The look of all figures."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import as_file, files
from io import BytesIO
from pathlib import Path

import matplotlib.style
from matplotlib import font_manager
from matplotlib.figure import Figure

FONT = "STIXGeneral"  # of all figures; it comes with matplotlib


@contextmanager
def style() -> Iterator[None]:
    """Draw, and write, in the style of all figures. What it does not set has the defaults of matplotlib, whatever the
    settings of the user are."""
    # A user keeps matplotlib's list of fonts from one installation to the next, so those that come with it may be
    # missing there, and every figure looks different.
    if FONT not in font_manager.fontManager.get_font_names():
        for file in Path(matplotlib.get_data_path(), "fonts/ttf").glob("STIX*.ttf"):
            font_manager.fontManager.addfont(file)
    with as_file(files(__package__) / "roughcoat.mplstyle") as sheet, matplotlib.style.context(["default", sheet]):
        yield


class StyledFigure(Figure):
    """A figure that takes the style of all figures each time it is drawn: matplotlib makes ticks only then.

    pyplot does not know it. A notebook shows it where it is the last value of a cell, or given to `display`.
    """

    def draw(self, renderer) -> None:
        with style():
            super().draw(renderer)

    def savefig(self, *arguments, **options) -> None:
        with style():
            super().savefig(*arguments, **options)

    def _repr_png_(self) -> bytes:
        """A notebook asks for this unless something, such as importing pyplot, has told it how to show figures."""
        stream = BytesIO()
        self.savefig(stream, format="png", dpi=self.dpi)
        return stream.getvalue()
