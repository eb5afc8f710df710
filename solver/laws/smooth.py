"""No asperities: A = 0, and the equation is linear in y = q, with p* = E."""

import numpy as np

from .law import Curve, Law

LAW = Law(
    name="smooth",
    scales=lambda E: (E, 0.0),
    curve=lambda y: Curve(y, np.zeros_like(y), np.ones_like(y), np.zeros_like(y)),
    area=lambda y, q: np.ones_like(y),
    peak=lambda y, q: q,
    edge=lambda: (1.0, 1.0),
    rough=False,
    from_pressure=lambda q: q,
)
