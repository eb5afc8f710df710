"""Batched solver of the contact of a rough sphere with a coated body (Goryacheva & Yakovenko 2024).

``solve(Problem.of(...), x)`` returns a `Solution`: arrays of cases in, arrays out. The equations, symbols, statuses and
limits are in docs/model.md. The package needs numpy, scipy, and threadpoolctl, which keeps BLAS on one thread.
"""

from . import closed_forms, fields
from .known import register
from .laws import Curve, Law
from .laws import disc_cell as micro
from .laws.power_law_fit import Fit, fit_power_law
from .parameters import Parameter
from .problem import Problem
from .sensitivity import Sensitivities, sensitivities
from .solution import Model, Solution
from .solve import solve
from .status import Status

#: It changes whenever the numbers may change, and is part of the digest of every study.
NUMERICS_VERSION = "25"

__all__ = [
    "NUMERICS_VERSION",
    "Curve",
    "Fit",
    "Law",
    "Model",
    "Parameter",
    "Problem",
    "Sensitivities",
    "Solution",
    "Status",
    "closed_forms",
    "fields",
    "fit_power_law",
    "micro",
    "register",
    "sensitivities",
    "solve",
]
