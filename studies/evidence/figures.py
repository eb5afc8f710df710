"""What is measured of this program itself: work and precision, where the thin layer holds, random extreme cases."""

from . import extremes_map, picard_domain, tradeoff, tradeoff_view, validity_maps  # noqa: F401
