"""A contact in words: each quantity with its unit and how sure it is, how it was solved, and what it rests on."""

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
