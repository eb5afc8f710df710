"""How a body yields to a wave of pressure, L(kh). One file has one kernel; the protocol is in :mod:`.kernel`."""
