"""Where and how large stresses are at most, and at which load a body yields: docs/stresses.md."""
