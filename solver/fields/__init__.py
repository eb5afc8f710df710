"""Stresses and displacements in layer and body under a given pressure: docs/stresses.md."""

from .polynomial import of_pressure

__all__ = ["of_pressure"]
