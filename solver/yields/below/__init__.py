"""Stresses below asperities that feel the coated body (docs/stresses.md, Below a spot)."""
