"""Stresses at single points with their derivatives, for searches: docs/stress_fields.md, Waves."""
