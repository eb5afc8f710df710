"""Micro laws: what the asperities add to the displacement, one file each."""
