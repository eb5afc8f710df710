"""How the solution of a case ended."""

from enum import IntEnum


class Status(IntEnum):
    """Status of one case; `meaning` says it in a sentence. A case that fails is a flagged value, never an exception."""

    CONVERGED = 0
    ITERATION_LIMIT = 1
    LIMIT_CYCLE = 2
    DIVERGED = 3
    THIN_LAYER_NOT_APPLICABLE = 4
    TOLERANCE_NOT_MET = 5
    INVALID_INPUT = 6  # 7 was a status of numerics version 2 and is not used again
    LIFT_OFF = 8
    BUDGET_SPENT = 9
    OUTSIDE_LAW = 10

    @property
    def meaning(self):
        """One sentence for a person."""
        return _MEANINGS[self]


_MEANINGS = {
    Status.CONVERGED: "the iteration closed and the estimated error is within rtol",
    Status.ITERATION_LIMIT: "the iteration did not close within its limit; the last numbers are kept",
    Status.LIMIT_CYCLE: "successive approximations cycle near the edge, the load has settled; last numbers kept",
    Status.DIVERGED: "the iteration diverged, or ended in a number that cannot be; no numbers",
    Status.THIN_LAYER_NOT_APPLICABLE: "the thin-layer equation does not apply (C <= 0 in Eq. (3)); no numbers",
    Status.TOLERANCE_NOT_MET: "the estimated error exceeds rtol at the finest mesh; the numbers are kept",
    Status.LIFT_OFF: "the punch lifts off inside the contact, or the pressure is tensile there; no numbers",
    Status.BUDGET_SPENT: "the work that one case may take is spent; last numbers, if any, kept",
    Status.OUTSIDE_LAW: "the nominal pressures are not in the range that the micro law knows; no numbers",
    Status.INVALID_INPUT: "a parameter is not finite or out of bounds, or a smooth case asks for picard; no numbers",
}
