"""How curves and axes look: colours, points, logarithmic scales and their ticks."""

import numpy as np
from matplotlib import colormaps
from matplotlib.axis import Axis
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from .labels import written


def shades(count: int) -> list:
    """Colours from dark to light, told apart in grey as well; black for a single curve."""
    return [colormaps["viridis"](0.9 * i / (count - 1)) for i in range(count)] if count > 1 else ["black"]


def as_points(lines: list[Line2D], fill: str) -> None:
    """Points in place of curves, for cases that have nothing to do with each other. fill : "full" or "none" """
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
    """Ticks of a logarithmic axis at each decade, up to six; also at 3 times each if there are fewer than two.

    On few decades matplotlib writes one number, or writes those at 2, 3, 4 and 6 over each other. Of four decades in a
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
