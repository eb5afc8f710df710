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


def shades(count: int) -> list:
    """Colours from dark to light, told apart in grey as well; black for a single curve."""
    return [colormaps["viridis"](0.9 * i / (count - 1)) for i in range(count)] if count > 1 else ["black"]


def as_points(lines: list[Line2D], fill: str) -> None:
    """Points in place of curves: of single cases, one has nothing to do with the next. fill : "full" or "none" """
    for line in lines:
        line.set(linestyle="none", marker="o", markersize=3, fillstyle=fill)


def spaced_by_factors(values: np.ndarray) -> bool:
    """Whether values grow by factors rather than by steps: their median is nearer to the geometric mean."""
    known = values[np.isfinite(values)] if values.dtype.kind in "fi" else np.zeros(1)
    if not len(known) or known.min() <= 0 or known.max() < 10 * known.min():
        return False
    middle = np.log(np.median(known))
    return abs(middle - np.log(known).mean()) < abs(middle - np.log(known.mean()))


def tick_decades(axis: Axis) -> None:
    """Ticks of a logarithmic axis at each decade, up to six; also at 3 times each if there are fewer than two.

    Of few decades matplotlib has one number, or writes those at 2, 3, 4 and 6 over each other; of four in a narrow
    panel it leaves out two, and all ticks between them.
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
