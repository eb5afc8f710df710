"""A contact in words: each quantity with its unit and its uncertainty, the solution, and the assumptions behind it."""

from .sentences import MODELS, NOT_VIOLATED, FarOutside, beside_rules, doubts, far_outside
from .text import MOST_CASES, SHOWN, Summary, summary

__all__ = [
    "MODELS",
    "MOST_CASES",
    "NOT_VIOLATED",
    "SHOWN",
    "FarOutside",
    "Summary",
    "beside_rules",
    "doubts",
    "far_outside",
    "summary",
]
