"""The problem that was solved for each case: with a named base, in the units in which its equation is written."""

from typing import NamedTuple

import numpy as np

from ..bases import is_chosen
from ..kernels.two_layers import layer_modulus
from ..laws.disc_cell import SMOOTH
from ..numerics import batch
from ..problem import Problem
from ..scaling import dimensionless, with_a_stiff_base, with_rigid_punch
from ..solution import Model

_THIN = (Model.THIN_LAYER, Model.SMOOTH_THIN_LAYER)
_EXACT = (Model.LAYERED, Model.SMOOTH_LAYERED)
_SMOOTH = (Model.SMOOTH_LAYER_ALONE, Model.SMOOTH_THIN_LAYER)


@batch.of_cases
class SolvedCases(NamedTuple):
    """Cases with the base on which they were solved.

    named : Problem with the name of that base
    written : the same problem in its own units R = E2* = 1; under a rigid punch if that makes the same contact
    E2 : (B,), the modulus that is 1 in `written`
    added : (B,) bool, whether a smooth punch was solved, and the asperities were added afterwards
    """

    named: Problem
    written: Problem
    E2: np.ndarray
    added: np.ndarray


def solved_cases(scaled, used):
    """:class:`SolvedCases` of a problem in units R = E2* = 1; used : (B,), the :class:`~solver.solution.Model` of each
    case. Cases of the base "auto" keep the model that was chosen."""
    auto, thin, exact = is_chosen(scaled.base), np.isin(used, _THIN), np.isin(used, _EXACT)
    alone, added = auto & ~thin & ~exact, auto & np.isin(used, _SMOOTH) & scaled.rough()
    of_model = np.select([thin, exact], ["thin_layer", "layered"], "half_space")
    named = scaled.but(
        base=np.where(auto, of_model, scaled.base),
        micro=np.where(added, SMOOTH.name, scaled.micro),
        E2=np.where(alone, layer_modulus(scaled.n), 1.0),
        nu2=np.where(alone, scaled.nu1, scaled.nu2),
        scheme="newton",
        model_check="closed_form",
    )
    moved = with_a_stiff_base(with_rigid_punch(named))
    return SolvedCases(named, dimensionless(moved), moved.E2, added)
