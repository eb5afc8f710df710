"""The holder of a punch: a load, a depth, or a machine of some stiffness."""

from typing import NamedTuple

import numpy as np

from ...numerics import batch


@batch.of_cases
class Holder(NamedTuple):
    """The holders of B punches: whether each prescribes the `load`, k = 0; otherwise its `compliance` 1/k."""

    load: np.ndarray
    compliance: np.ndarray

    @classmethod
    def by(cls, k):
        """Holders of the stiffnesses k (B,), from 0 to infinity."""
        with np.errstate(divide="ignore"):
            return cls(k == 0, np.where(k == 0, 0.0, 1 / k))

    def of(self, P, D):
        """Q from P and D, or the slope of Q from their slopes."""
        with np.errstate(invalid="ignore"):
            return np.where(self.load, P, D + self.compliance * P)


def machine(part):
    """Stiffness (B,) of the holders of the punches; by default infinite for a given depth and 0 otherwise."""
    usual = np.inf if part.control == "D" else 0.0
    return np.where(np.isnan(part.k_machine), usual, part.k_machine)
