"""Derivatives of the answers by the inputs, from one more linear system for each solution."""

from .changes import is_ratio
from .sensitivities import QUANTITIES, Sensitivities, sensitivities

__all__ = ["QUANTITIES", "Sensitivities", "is_ratio", "sensitivities"]
