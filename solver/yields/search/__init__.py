"""The way up from a start to the largest stress near it: docs/stresses.md, Extremes."""
