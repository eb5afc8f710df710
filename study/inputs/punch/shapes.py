"""Shapes of the punch in calls and study files: their names, angles in degrees, tables, and what each of them needs."""

from functools import partial
from typing import Any

import numpy as np

from solver import shapes
from solver.bases import on_springs
from solver.shapes import table

from ...specimen.quantities import has_unit, quantity
from ...terminal import shown
from ..grid import Grid, along
from ..lexicon import Lexicon

#: Inputs besides the shape that are words: capitals, blanks and hyphens in them do not matter.
WORDS = ("tip", "adhesion", "branch")
#: How the words of tables of the user's own begin.
PREFIX = table.PREFIX
#: Angles of the punch: numbers of degrees.
ANGLES = ("half_angle",)
#: The shapes with a flat end, beyond which a contact reaches.
WITH_A_FLAT = ("frustum", "rounded_flat")
#: Lengths: the first of them that is given is the unit of length for a shape without a radius.
LENGTHS = ("flat_radius", "tip_radius", "h")
#: That unit if none of them is given.
MICROMETRE = "1 um"


def as_written(values: list) -> list:
    """The values, with words spelled as in the solver: "jkr" for "JKR", "cube_corner" for "Cube corner"."""
    return [_plain(value) if isinstance(value, str) else value for value in values]


def _plain(word: str) -> str:
    """A word in small letters with "_" for gaps; the path of a table as it is."""
    if word.lower().startswith(PREFIX):
        return PREFIX + word[len(PREFIX) :]
    return word.strip().lower().replace(" ", "_").replace("-", "_")


def in_degrees(name: str, values: Any) -> Any:
    """The values of an angle as numbers of degrees: 70.3 for "70.3 deg", a Quantity for "70.3 ± 0.5 deg".

    values : a list, a range or a DataArray

    Raises ValueError for a text or an array with another unit.
    """
    if isinstance(values, dict):
        return {key: _degrees(name, value) if key in ("start", "stop") else value for key, value in values.items()}
    if isinstance(values, list):
        return [_degrees(name, value) for value in values]
    unit = getattr(values, "attrs", {}).get("units", "1")
    if unit in ("1", "", "dimensionless"):
        return values
    return values.copy(data=values.values * quantity(name, f"1 {unit}", "degree").value).drop_attrs(deep=False)


def _degrees(name: str, value: Any) -> Any:
    if not has_unit(value):
        return value
    if isinstance(value, str) and not any(sign.isalpha() or sign == "°" for sign in value):  # "70.3 ± 0.5"
        value = f"{value} deg"
    angle = quantity(name, value, "degree")
    return angle if angle.spread else angle.value


def _of_shapes(name: str, lexicon: Lexicon) -> bool:
    return name in lexicon.rows and lexicon.rows[name].role == "shape"


def radius_needed(words: Any) -> bool:
    """Whether some case has a shape with a radius."""
    return bool(np.isin(words, shapes.ROUND).any())


def in_metres(words: Any, lexicon: Lexicon) -> Any:
    """Whether a shape is a table with units of length in its header; one bool, or an array, like the `words`."""
    tables = {word: table.rows_of(kind) for word, kind in lexicon.known.shapes.items()}
    there = [word for word, rows in tables.items() if rows and rows.metres]
    return words.isin(there) if hasattr(words, "isin") else np.isin(words, there) if np.ndim(words) else words in there


def mistakes(grid: Grid, sections: Any, physical: bool) -> list[str]:
    """Messages about shapes: numbers that no case uses, a radius for a flat punch, a contact that is too wide."""
    messages, values = _without_use(grid, sections), partial(along, grid)
    if "shape" not in grid.values:
        return messages
    words = values("shape")
    if ((words != shapes.PARABOLOID) & on_springs(values("base"))).any():
        messages.append('base = "thin_layer" is for shape = "paraboloid": take "layered", or "auto"')
    if np.any(in_metres(words, grid.lexicon)) and not physical:
        example = 'R = "1 um", E2 = "1 MPa"'
        messages.append(f"shape: the table has units in its header: give the other inputs with units too ({example})")
    return messages + (_of_the_radius(grid, words, values("a")) if "a" in grid.values else [])


def _of_the_radius(grid: Grid, words: np.ndarray, a: np.ndarray) -> list[str]:
    """Messages for contact radii that are impossible with the shapes `words`."""
    messages = []
    if (words == "flat").any():
        messages.append('a is given with shape = "flat": its contact radius is flat_radius; give P or D')
    if (wrong := (words == "sphere") & (a >= 1)).any():
        most = np.broadcast_to(a, grid.shape)[np.broadcast_to(wrong, grid.shape)].max()
        message = 'with shape = "sphere": the radius of the contact must be below that of the ball'
        messages.append(f"a = {most:g} R {message}")
    flat = along(grid, "flat_radius")
    if (wrong := np.isin(words, WITH_A_FLAT) & (a <= flat)).any():
        first = tuple(np.argwhere(np.broadcast_to(wrong, grid.shape))[0])
        radii = [np.broadcast_to(array, grid.shape)[first] for array in (a, flat)]
        shape = shown(str(np.broadcast_to(words, grid.shape)[first]))
        message = "the radius of the contact must be above that of the flat end"
        messages.append(f"a = {radii[0]:g} R with shape = {shape}, flat_radius = {radii[1]:g} R: {message}")
    return messages


def _without_use(grid: Grid, sections: Any) -> list[str]:
    """Messages for numbers of shapes that are given though no case has a shape with them."""
    messages = []
    for name in sections:
        if name != "shape" and _of_shapes(name, grid.lexicon):
            owners = grid.lexicon.parameter(name).needed_by[1]
            users = " or ".join(shown(word) for word in owners)
            if "shape" not in grid.values or not np.any(grid.lexicon.cases_with(name, partial(along, grid))):
                messages.append(f"{name} is given, and no case has a shape with it: shape = {users}")
    return messages
