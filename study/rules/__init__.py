"""The table of rules: what a contact may violate, and what is doubted of it (docs/extending.md, A rule)."""

from . import assumptions, strength, slope_and_adhesion, doubts  # noqa: F401, I001 - they fill the table, in this order
