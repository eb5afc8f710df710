"""Measurements of this program: work and precision, validity of the thin layer, random extreme cases."""

from . import extremes_map, picard_domain, tradeoff, tradeoff_view, validity_maps  # noqa: F401
