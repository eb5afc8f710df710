"""The look of all figures: font, sizes, colours, points, logarithmic scales and their ticks."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import as_file, files
from io import BytesIO
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib import colormaps, font_manager
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from .labels import written

FONT = "STIXGeneral"  # of all figures; it comes with matplotlib


@contextmanager
def style() -> Iterator[None]:
    """Draw and write in the style of all figures. Other settings have the defaults of matplotlib, whatever the settings
    of the user are."""
    # The user's list of fonts survives a new installation of matplotlib, so fonts that come with matplotlib may be
    # missing in it, and every figure would look different.
    if FONT not in font_manager.fontManager.get_font_names():
        for file in Path(matplotlib.get_data_path(), "fonts/ttf").glob("STIX*.ttf"):
            font_manager.fontManager.addfont(file)
    with as_file(files(__package__) / "roughcoat.mplstyle") as sheet, matplotlib.style.context(["default", sheet]):
        yield


class StyledFigure(Figure):
    """A figure that applies the style of all figures each time it is drawn, since matplotlib makes ticks only then.

    pyplot does not know it. A notebook shows it as the last value of a cell, or by `display`.
    """

    def draw(self, renderer) -> None:
        with style():
            super().draw(renderer)

    def savefig(self, *arguments, **options) -> None:
        with style():
            super().savefig(*arguments, **options)

    def _repr_png_(self) -> bytes:
        """The picture for a notebook, unless something, such as importing pyplot, has told it how to show figures."""
        stream = BytesIO()
        self.savefig(stream, format="png", dpi=self.dpi)
        return stream.getvalue()


def shades(count: int) -> list:
    """Colours from dark to light, which differ in grey as well; black for a single curve."""
    return [colormaps["viridis"](0.9 * i / (count - 1)) for i in range(count)] if count > 1 else ["black"]


def as_points(lines: list[Line2D], fill: str) -> None:
    """Draw points in place of curves, for single cases that have nothing to do with each other.

    fill : "full" or "none"
    """
    for line in lines:
        line.set(linestyle="none", marker="o", markersize=3, fillstyle=fill)


def spaced_by_factors(values: np.ndarray) -> bool:
    """Whether values grow by factors rather than by steps: their median is nearer to the geometric mean."""
    finite = values[np.isfinite(values)] if values.dtype.kind in "fi" else np.zeros(1)
    if not len(finite) or finite.min() <= 0 or finite.max() < 10 * finite.min():
        return False
    middle = np.log(np.median(finite))
    return abs(middle - np.log(finite).mean()) < abs(middle - np.log(finite.mean()))


def tick_decades(axis: Axis) -> None:
    """Put ticks at each decade of a logarithmic axis, up to six, and also at 3 times each on fewer than two decades.

    On few decades matplotlib writes a single number, or those at 2, 3, 4 and 6 over each other. On four decades in a
    narrow panel it leaves out two, and all ticks between them.
    """
    if axis.get_scale() != "log":
        return
    low, high = axis.get_view_interval()
    few = high < 100 * low
    axis.set_major_locator(LogLocator(subs=(1, 3) if few else (1,), numticks=6))
    axis.set_minor_locator(LogLocator(subs=range(2, 10), numticks=6))
    if few:
        axis.set_major_formatter(lambda value, _: written(value))
        axis.set_minor_formatter(NullFormatter())
