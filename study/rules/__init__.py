"""The table of rules: assumptions that a contact may violate, and doubts about it (docs/extending.md, A rule)."""

from . import assumptions, strength, slope_and_adhesion, doubts  # noqa: F401, I001 - they fill the table, in this order
