"""Adhesion in calls and study files: which inputs go together, and what is refused."""

from functools import partial
from typing import Any

import numpy as np

from solver.bases import on_springs
from solver.parameters import one_of

from ...specimen.quantities import readable
from ...terminal import shown
from ..grid import Grid, along
from ..vocabulary import names

OF_ADHESION = names("adhesion")
#: Each summit of the asperities pulls with at most 1.5 π w Ra: their adhesion counts as negligible if that makes less
#: than this share of the mean pressure.
_NEGLIGIBLE = 0.01


def adhesive(grid: Grid) -> np.ndarray:
    """bool, along the dimensions of the grid: the cases that may stick."""
    return along(grid, "w_adhesion") > 0


def mistakes(grid: Grid, sections: Any) -> list[str]:
    """Messages about inputs of adhesion that do not go together."""
    if "w_adhesion" not in sections:
        present = [name for name in OF_ADHESION if name in sections]
        return [
            f"{name} is given without w_adhesion, the work of adhesion: the surfaces do not adhere" for name in present
        ]
    values, sticks = partial(along, grid), adhesive(grid)
    messages = []
    for name in ("P", "D"):
        if name in grid.values and not sticks.any() and (values(name) <= 0).any():
            messages.append(f"{name} must be > 0 where w_adhesion is 0")
    maugis, dmt = sticks & (values("adhesion") == "maugis"), sticks & (values("adhesion") == "dmt")
    present = {name: ~np.isnan(values(name)) for name in ("sigma0", "z0")}
    both = (maugis & present["sigma0"] & present["z0"]).any()
    none = (maugis & ~present["sigma0"] & ~present["z0"]).any()
    if both or none:
        number = "not both" if both else "one of them is missing"
        messages.append(f'adhesion = "maugis" needs exactly one of sigma0 and z0 (sigma0 = w/(0.97 z0)): {number}')
    extra = [name for name, there in present.items() if (dmt & there).any()]
    messages += [f'{name} is given with adhesion = "dmt", which does not use it' for name in extra]
    if (dmt & (values("shape") != "paraboloid")).any():
        messages.append(f'adhesion = "dmt" is for shape = "paraboloid", not {_first(values("shape"), "paraboloid")}')
    if (sticks & on_springs(values("base"))).any():
        messages.append('base = "thin_layer" has no adhesion: w_adhesion > 0 needs base = "layered", or "auto"')
    if (maugis & (values("shape") == "flat")).any():
        messages.append('adhesion = "maugis" is not for shape = "flat", whose edge is fixed: take "jkr"')
    return messages


def _first(words: np.ndarray, but: str) -> str:
    return shown(next(word for word in words.ravel().tolist() if word != but))


def rough_and_sticking(grid: Grid, unit: Any) -> list[str]:
    """The message for adhesion of a rough punch, with an estimate of the pull of the asperities.

    unit : of pressures, in Pa, a number; None without units
    """
    rough = ~one_of(along(grid, "micro"), grid.lexicon.smooth_laws())
    if not (adhesive(grid) & rough).any():
        return []
    message = (
        'w_adhesion > 0 needs micro = "smooth" among the inputs: the model has no adhesion of asperities. Give '
        "the effective work of adhesion of the smooth shape, which roughness lowers"
    )
    pull = 1.5 * np.pi * along(grid, "w_adhesion") * along(grid, "Ra") * along(grid, "Nbar")
    pull = np.broadcast_to(pull, grid.shape)[np.broadcast_to(rough, grid.shape)]
    largest = float(np.nanmax(pull, initial=0.0))
    if largest > 0:
        in_units = [f"{value:.3g} E2*" if unit is None else readable(value * unit, "Pa") for value in
                    (largest, largest / _NEGLIGIBLE)]  # fmt: skip
        message += (
            f". These asperities pull with at most 1.5 pi w Ra Nbar = {in_units[0]}: where the mean pressure is above "
            f"{in_units[1]} that is negligible, and w_adhesion may be left out"
        )
    return [message]
