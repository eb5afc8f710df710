"""A part of the depth that is fitted alone."""

from typing import Any

import numpy as np

from ....inputs.definition import StudyError
from ....inputs.vocabulary import ROWS
from ....specimen.quantities import quantity
from ....terminal import shown


def region(depth: Any, x: str) -> tuple[float, float] | None:
    """The ends in SI of the option `depth` of a fit over x. Raises StudyError."""
    if depth is None:
        return None
    unit = ROWS[x].unit
    such = '("0 nm", "500 nm")' if unit == "m" else '("0 nN", "5 nN")'
    if not isinstance(depth, (tuple, list)) or len(depth) != 2:
        raise StudyError([f"depth = {shown(depth)}: must be (low, high), such as {such}"])
    try:
        low, high = (quantity("depth", end, unit).value if isinstance(end, str) else float(end) for end in depth)
    except (TypeError, ValueError) as error:
        raise StudyError([f"{error}" if "depth" in str(error) else f"depth = {shown(depth)}: {error}"]) from None
    if not (np.isfinite([low, high]).all() and low < high and high > 0):
        wanted = f"the low end must be below the high one, and that above 0, in {unit} or with units"
        raise StudyError([f"depth = ({depth[0]}, {depth[1]}): {wanted}"])
    return float(low), float(high)


def inside(x: np.ndarray, begin: dict[int, float], limits: tuple[float, float]) -> np.ndarray:
    """Which points (curves, n) count: those in contact within the limits, and those before the contact.

    begin : curve -> where its contact begins, if that is not at 0; of a curve that is not there, where there are
        others, all points count
    """
    low, high = limits
    depth = x - np.array([begin.get(curve, np.nan if begin else 0.0) for curve in range(len(x))])[:, None]
    out = (depth > high) | ((depth < low) & ((depth > 0) | (low < 0)))
    return ~out
