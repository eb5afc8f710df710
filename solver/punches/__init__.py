"""The indenter's shape, one a file; the protocol is in :mod:`.punch`."""

from .paraboloid import PARABOLOID

__all__ = ["PARABOLOID"]
