"""Stresses and displacements in layer and body under a known pressure: docs/stresses.md."""

from .polynomial import of_pressure

__all__ = ["of_pressure"]
