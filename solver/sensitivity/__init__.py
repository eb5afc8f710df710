"""Derivatives of the answers by the inputs, from one Newton step of each solved contact for each moved input."""

from ..parameters import is_ratio
from .sensitivities import QUANTITIES, Sensitivities, sensitivities

__all__ = ["QUANTITIES", "Sensitivities", "is_ratio", "sensitivities"]
