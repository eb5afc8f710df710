"""Batched solver of the two-scale model of a rough punch on a coated body (Goryacheva & Yakovenko 2024): numpy and
scipy only."""

import numpy as np

from . import closed_forms, micro
from .fit import Fit, fit_power_law
from .problem import Model, Problem, Solution
from .solve import solve
from .status import Status

#: Changes whenever the numbers may change: part of the digest of every study.
NUMERICS_VERSION = "6"

# Once it has freed as much in one piece, glibc's malloc keeps freed arrays below that size for the next ones; else it
# gives them back to the system and gets them again, page by page. Untouched, these 32 MB cost nothing.
np.empty(4_000_000)

__all__ = [
    "NUMERICS_VERSION",
    "Fit",
    "Model",
    "Problem",
    "Solution",
    "Status",
    "closed_forms",
    "fit_power_law",
    "micro",
    "solve",
]
