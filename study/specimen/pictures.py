"""A text with a small picture, for notebooks: HTML that loads nothing and fits light and dark pages."""

from html import escape
from typing import Any

import numpy as np

from .quantities import readable

_WIDTH, _HEIGHT, _POINTS = 260, 90, 200


def with_picture(text: str, picture: str = "") -> str:
    """A text with its line breaks, and a picture below it."""
    return f'<pre style="white-space:pre-wrap">{escape(text)}</pre>{picture}'


def curve(x: np.ndarray, y: np.ndarray, across: str, up: str) -> str:
    """A curve as SVG, with words for both axes; "" where there are no numbers. Of many points, means are drawn."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    finite = np.isfinite(x) & np.isfinite(y)
    if finite.sum() < 2:
        return ""
    parts = np.array_split(np.flatnonzero(finite), min(_POINTS, int(finite.sum())))
    x, y = (np.array([values[part].mean() for part in parts]) for values in (x, y))
    low, high = min(y.min(), 0.0) if y.min() >= 0 else y.min(), y.max()
    across_x = _WIDTH * (x - x[0]) / max(x[-1] - x[0], np.finfo(float).tiny)
    down = _HEIGHT * (high - y) / max(high - low, np.finfo(float).tiny)
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across_x, down, strict=True))
    words = escape(f"{up} over {across}")
    return (
        f'<svg role="img" aria-label="{words}" width="{_WIDTH + 8}" height="{_HEIGHT + 26}" '
        f'viewBox="-4 -4 {_WIDTH + 8} {_HEIGHT + 26}"><g fill="none" stroke="currentColor">'
        f'<path d="M0,0V{_HEIGHT}H{_WIDTH}" stroke-opacity="0.4"/><polyline points="{points}" stroke-width="1.5"/></g>'
        f'<text x="0" y="{_HEIGHT + 16}" font-size="11" fill="currentColor">{words}</text></svg>'
    )


def of_heights(scan: Any) -> str:
    """The text of a `Scan` and a picture of its heights, for a map those of its middle row."""
    profile = scan.z.ndim == 1
    row, step = (scan.z, scan.steps[0]) if profile else (scan.z[len(scan.z) // 2], scan.steps[1])
    size = " x ".join(readable(float(f"{length:.3g}"), "m") for length in scan.sizes)
    text = "\n".join([f"{scan.name}: {' x '.join(map(str, scan.z.shape))} heights, {size}", *scan.notes])
    words = "height z" if profile else "height z of the middle row"
    return with_picture(text, curve(np.arange(len(row)) * step, row - np.nanmin(row), "x", words))


def of_contact(dataset: Any) -> str:
    """HTML of an xarray.Dataset: that of xarray, below a picture of p(r) if it is a single contact with a profile."""
    is_contact = "model_used" in dataset and "p" in dataset and "x" in dataset.coords
    drawn = is_contact and dataset["p"].dims == dataset["x"].dims == ("x",)
    picture = curve(dataset["x"].values, dataset["p"].values, "r/a", "nominal pressure p") if drawn else ""
    return picture + dataset._repr_html_()


def show_in(shell: Any) -> None:
    """Let a notebook (a shell of IPython) show datasets by `of_contact`, unless it has another way to show them.

    The class is given by its name, so xarray need not be imported.
    """
    formatter = shell.display_formatter.formatters["text/html"]
    if "xarray.core.dataset.Dataset" not in formatter:
        formatter.for_type_by_name("xarray.core.dataset", "Dataset", of_contact)
