"""What a matplotlib figure shows, as data: the lines, fills, maps, texts, legends and scales of its axes."""

from dataclasses import dataclass

import numpy as np
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_hex
from matplotlib.contour import ContourSet


@dataclass(frozen=True)
class Look:
    """By which a reader knows an artist in the legend; `dashes` in units of the width."""

    colour: str
    dashes: tuple
    marker: str
    face: str


@dataclass(frozen=True, eq=False)
class Line:
    """`label` is "" for a line that has no entry in the legend."""

    label: str
    x: np.ndarray
    y: np.ndarray
    look: Look


WORDS = {  # of the legend, by the masks of `validity`
    1: "layer not thin",
    2: "fewer than 100 spots",
    4: r"spots not small, $b > 0.1\,h$",
    8: r"layer not soft, $n \geq 1$",
    16: r"spots merge, $\lambda(0) > 0.4$",
    32: r"$a > 0.2\,R$ or layer strained",
    64: r"spots steep, $b > 0.5\,R_a$",
    128: r"asperities far apart, pitch $> 2\,h$",
    256: r"wide in a cup, $a > 0.2\,\min(|R_1|, |R_2|)$",
    512: "a body would yield",
    1024: "asperities would yield",
    16384: "spots lift off",
    2048: r"slope $f'(a) > 0.4$",
    4096: "not JKR",
    8192: "tension inside",
}


def look(line) -> Look:
    marker = str(line.get_marker())
    face = to_hex(line.get_markerfacecolor()) if marker != "None" else ""
    _, dashes = line._unscaled_dash_pattern
    drawn = () if line.get_linestyle() == "None" else tuple(dashes or ("solid",))
    return Look(to_hex(line.get_color()), drawn, marker, face)


def lines(axes) -> list[Line]:
    """Lines with points, in the order in which they were drawn."""
    return [
        Line(
            "" if line.get_label().startswith("_") else line.get_label(), *map(np.asarray, line.get_data()), look(line)
        )
        for line in axes.lines
        if len(line.get_xdata())
    ]


def legend(legend) -> dict[str, object]:
    """Text -> look of a line, or colour of a patch; in the order of the legend."""
    texts = [text.get_text() for text in legend.get_texts()]
    handles = [
        look(handle) if hasattr(handle, "get_marker") else to_hex(handle.get_facecolor())
        for handle in legend.legend_handles
    ]
    assert len(set(texts)) == len(texts)
    return dict(zip(texts, handles, strict=True))


def bands(axes) -> list[tuple[float, float, str]]:
    """Shaded intervals of the abscissa: start, stop, colour."""
    found = []
    for patch in axes.patches:
        box = patch.get_path().get_extents(patch.get_patch_transform())
        found.append((box.x0, box.x1, to_hex(patch.get_facecolor())))
    return found


def texts(axes) -> dict[str, tuple]:
    """Text -> the point it belongs to; arrows, which have no text, are left out."""
    found = [(text.get_text(), getattr(text, "xy", text.get_position())) for text in axes.texts if text.get_text()]
    assert len(dict(found)) == len(found)
    return dict(found)


def arrows(axes) -> list[tuple]:
    """(tail, head) of each arrow."""
    return [(text.xyann, text.xy) for text in axes.texts if getattr(text, "arrowprops", None)]


def fills(axes) -> list[tuple[np.ndarray, str]]:
    """Corners (n, 2) and colour of each filled area, in the order in which they were drawn."""
    return [
        (path.vertices, to_hex(area.get_facecolor()[0]))
        for area in axes.collections
        if not isinstance(area, QuadMesh | ContourSet)
        for path in area.get_paths()
    ]


def mesh(axes) -> QuadMesh:
    """The one map of cells."""
    (found,) = [collection for collection in axes.collections if isinstance(collection, QuadMesh)]
    return found


def contours(axes) -> list[ContourSet]:
    """Bands and lines of equal values."""
    return [collection for collection in axes.collections if isinstance(collection, ContourSet)]


def same_contours(found: ContourSet, expected: ContourSet) -> bool:
    """Whether two sets of contours have the same levels, and between them the same lines to 1e-9 (of log axes, too)."""
    if found.filled != expected.filled or not np.array_equal(found.levels, expected.levels):
        return False
    paths = [[path.vertices for path in contour.get_paths()] for contour in (found, expected)]
    return all(a.shape == b.shape and np.allclose(a, b, rtol=1e-9, atol=0) for a, b in zip(*paths, strict=True))


def frame(axes) -> tuple:
    """Label and scale of the abscissa and of the ordinate, title."""
    return axes.get_xlabel(), axes.get_xscale(), axes.get_ylabel(), axes.get_yscale(), axes.get_title()


def ticks(axes) -> tuple[list[str], list[str]]:
    """Texts at the ticks of both axes."""
    return tuple([text.get_text() for text in labels] for labels in (axes.get_xticklabels(), axes.get_yticklabels()))
