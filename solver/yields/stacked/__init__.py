"""Where and how large stresses are at most in stacks of layers: docs/stresses.md, Extremes."""
