"""A contact in words: each quantity with its unit and how sure it is, how it was solved, and what it rests on."""

from .early import FarOutside, far_outside
from .notes.unloading import falling
from .sentences import MODELS, NOT_VIOLATED, doubts
from .text import MOST_CASES, SHOWN, Summary, summary

__all__ = [
    "MODELS",
    "MOST_CASES",
    "NOT_VIOLATED",
    "SHOWN",
    "FarOutside",
    "Summary",
    "doubts",
    "falling",
    "far_outside",
    "summary",
]
