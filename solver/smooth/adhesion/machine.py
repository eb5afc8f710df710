"""The holder of a punch: a load, a depth, or a machine of some stiffness."""

from typing import NamedTuple

import numpy as np

from ...numerics import batch


@batch.of_cases
class Holder(NamedTuple):
    """The holders of B punches: whether the load counts alone, k = 0, and else the compliance 1/k."""

    load: np.ndarray
    compliance: np.ndarray

    @classmethod
    def by(cls, k):
        """The stiffnesses k (B,), from 0 to infinite."""
        with np.errstate(divide="ignore"):
            return cls(k == 0, np.where(k == 0, 0.0, 1 / k))

    def of(self, P, D):
        """Q, or its slope, of P and D, or their slopes."""
        with np.errstate(invalid="ignore"):
            return np.where(self.load, P, D + self.compliance * P)


def machine(part):
    """Stiffness (B,) of the holders of the punches; by default 0 under a load and infinite under a depth."""
    usual = np.inf if part.control == "D" else 0.0
    return np.where(np.isnan(part.k_machine), usual, part.k_machine)
