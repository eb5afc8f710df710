"""How the pressure ends at the edge of the contact, one edge a file; the protocol is in :mod:`.edge`."""

from .free import FREE

__all__ = ["FREE"]
