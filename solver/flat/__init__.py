"""Rough contacts of the flat punch, whose contact radius is its own: the depth closes the equation."""

from .solve import solve_flat

__all__ = ["solve_flat"]
