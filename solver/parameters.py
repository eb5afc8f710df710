"""What describes a case beside its control: the one table of defaults, of choices, and of who needs what."""

from typing import NamedTuple

from .base import BONDINGS
from .micro import MICROS

BASES = ("half_space", "thin_layer", "layered", "auto")
SCHEMES = ("newton", "picard")
#: How the model error of a thin layer asked for by name is estimated: free of cost, or by one step of the exact layer.
MODEL_CHECKS = ("closed_form", "first_order")


class Parameter(NamedTuple):
    """One parameter of a case.

    default : its value where it is not given; None: it has none, and must be given if a case needs it.
    choices : the words allowed, of a text; of a number ().
    whole : a number without fraction.
    needed_by : name of another parameter, and those of its choices that need this one, which has no default then.
    """

    default: float | int | str | None = None
    choices: tuple[str, ...] = ()
    whole: bool = False
    needed_by: tuple[str, tuple[str, ...]] = ("", ())


#: The cases that have a layer, asperities, a fitted law of them.
LAYERED = ("base", ("thin_layer", "layered", "auto"))
ROUGH = ("micro", ("disc_cell", "power_law"))
FITTED = ("micro", ("power_law",))

#: In the order of the fields of :class:`~solver.problem.Problem`, where units and bounds are said.
PARAMETERS = {
    "h": Parameter(needed_by=LAYERED),
    "n": Parameter(needed_by=LAYERED),
    "nu1": Parameter(0.3),
    "nu2": Parameter(0.3),
    "bonding": Parameter("frictionless", BONDINGS),
    "Nbar": Parameter(needed_by=ROUGH),
    "Ra": Parameter(needed_by=ROUGH),
    "base": Parameter("layered", BASES),
    "accuracy": Parameter(1e-2),
    "model_check": Parameter("closed_form", MODEL_CHECKS),
    "micro": Parameter("disc_cell", MICROS),
    "B": Parameter(needed_by=FITTED),
    "beta": Parameter(needed_by=FITTED),
    "scheme": Parameter("newton", SCHEMES),
    "k": Parameter(1.0),
    "rtol": Parameter(1e-6),
    "nodes": Parameter(0, whole=True),
    "max_iterations": Parameter(0, whole=True),
    "R": Parameter(1.0),
    "E2": Parameter(1.0),
}
