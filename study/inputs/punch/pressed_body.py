"""The coated body that a scan presses on, of the parameters of a contact."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from solver.bases import is_bare, named
from solver.body import BODIES
from solver.parameters import LAYER
from solver.scaling import dimensionless

from ..lexicon import Lexicon


@dataclass(frozen=True)
class PressedBody:
    """What a scan presses on.

    Attributes
    ----------
    kernel : function of k (W,) in 1/m that gives (L + m)/(1 + m); None: 1
    m : E1*/E_punch*; the modulus that is felt is E1*/(1 + m)
    inputs : parameter -> number or word, lengths in m: what tells it from other bodies; None of a half-space
    E1 : modulus E1* of what lies at the surface, Pa; None: it is not known
    """

    kernel: Callable | None = None
    m: float = 0.0
    inputs: dict[str, Any] | None = None
    E1: float | None = None


def told_by(table: Mapping[str, np.ndarray], metre: np.ndarray, lexicon: Lexicon) -> dict[str, np.ndarray]:
    """What tells bodies apart, of the parameters of contacts (k,): numbers and words, lengths in m.

    metre : (k,), 1 m in the lengths of the parameters
    """
    told = {}
    for name in (name for name in table if _tells(name)):
        values = table[name]
        if values.dtype.kind == "f" and np.isnan(values).all():
            continue
        told[name] = values / metre if lexicon.rows[name].powers == (0, 1) else values
    return told


def body_in(case: Mapping[str, Any], metre: float, lexicon: Lexicon) -> PressedBody:
    """The body of the parameters of one contact. Raises ValueError for a base that has no kernel.

    case : parameter of the solver -> its value; metre : 1 m in its lengths
    """
    if is_bare(case["base"]):
        return PressedBody()
    base = named(case["base"]).item()
    problem = dimensionless(lexicon.problem(case, micro="smooth", scheme="newton", base=base))
    solid = BODIES[base](problem)
    if solid.kernel is None:
        raise ValueError(f'base = "{base}" has no kernel: take "layered" or "stack"')
    h, m = float(solid.h[0]) / metre, float(solid.m[0])
    table = {name: np.array([value]) for name, value in case.items()}
    told = {name: values.item() for name, values in told_by(table, np.array([metre]), lexicon).items()}
    return PressedBody(lambda k: (solid.kernel.whole((k * h)[None])[0] + m) / (1 + m), m, told)


def _tells(name: str) -> bool:
    """Whether a parameter says what a body is."""
    of_layers = name.startswith("layers.") and name.rpartition(".")[2] in LAYER
    return of_layers or name in ("h", "n", "m", "nu1", "nu2", "bonding")
