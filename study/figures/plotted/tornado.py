"""The change of one result by each input: bars, the longest above."""

from collections.abc import Callable

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ...derivatives import QUANTITIES, relative_spreads, sensitivities
from ...inputs.definition import StudyError
from ..labels import stated, symbol, wrapped
from ..registry import Columns

ORDINATE = "input"
"""The y of `study.plot` for these bars."""
#: Relative change of an input without a spread, and change of a Poisson ratio.
_STEP = 0.01


def tornado(contact: xr.Dataset, name: str, new: Callable[..., Figure]) -> tuple[Figure, Columns]:
    """The relative change of a result of one contact with each input, in %.

    new : makes an empty figure

    Each input is larger and smaller by one standard deviation where inputs have spreads, otherwise by 1 %, and a
    Poisson ratio by 0.01.

    Raises StudyError for several contacts, a contact that has not converged, and a result without sensitivities.
    """
    if name not in QUANTITIES:
        raise StudyError([f"y = {ORDINATE}: x must be one of {', '.join(QUANTITIES)}, not {name}"])
    if sizes := ", ".join(f"{dim} ({size})" for dim, size in contact["status"].sizes.items() if size > 1):
        raise StudyError([f"y = {ORDINATE} is of one contact: choose one of {sizes}, by P=VALUE, or --where"])
    contact = contact.squeeze(contact["status"].dims)
    by_input = sensitivities(contact)[f"{name}_sensitivity"].to_series().to_dict()
    parts = {key: by_input[key] * part for key, part in relative_spreads(contact, by_input).items()}
    about = "one standard deviation" if parts else "1 % (a Poisson ratio by 0.01)"
    parts = parts or {key: by * _STEP for key, by in by_input.items()}
    parts = dict(sorted(((key, 100 * part) for key, part in parts.items() if part), key=lambda item: abs(item[1])))
    if not parts or not np.isfinite([*parts.values()]).all():
        raise StudyError([f"nothing to draw: no input changes {name} of this contact, or it has not converged"])
    figure = new(figsize=(3.6, 0.9 + 0.24 * len(parts)), layout="constrained")
    axes, names, widths = figure.subplots(), [symbol(key) for key in parts], np.array([*parts.values()])
    axes.barh(names, widths, color="0.25", label=f"input larger by {about}")
    axes.barh(names, -widths, color="0.75", label="smaller by as much")
    axes.axvline(0.0, color="0.0", linewidth=0.6)
    axes.set_xlabel(f"change of {symbol(name)} [%]")
    figure.suptitle(wrapped(stated([contact]), 21 * figure.get_figwidth()), fontsize=7)
    figure.legend(loc="outside lower center", fontsize=7)
    return figure, {"input": np.array([*parts]), f"change of {name} [%]": widths}
