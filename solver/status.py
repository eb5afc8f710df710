"""The status of the solution of a case; and whole numbers with names, for arrays."""

from enum import EnumType, IntEnum


class _Quiet(EnumType):
    """Metaclass without Python code in the look-up of attributes.

    numpy looks up attributes of a number that it compares, and swallows any exception, even the KeyboardInterrupt of a
    signal. Up to Python 3.11 EnumType runs Python code there, and signals are handled before Python code.
    """

    __getattr__ = type.__getattribute__


class Codes(IntEnum, metaclass=_Quiet):
    """An IntEnum whose members numpy reads without running Python code."""


class Status(Codes):
    """Status of one case; `meaning` explains it in a sentence. A case that fails has a status, and raises no
    exception.

    Examples
    --------
    >>> Status(10).name
    'OUTSIDE_LAW'
    >>> Status.OUTSIDE_LAW.meaning
    'the contact is outside the range of the micro law, or of the table of a tip; no numbers'
    """

    CONVERGED = 0, "the iteration closed and the estimated error is within rtol"
    ITERATION_LIMIT = 1, "the iteration did not close within its limit; the last numbers are kept"
    LIMIT_CYCLE = 2, "successive approximations cycle near the edge, the load has settled; last numbers kept"
    DIVERGED = 3, "the iteration diverged, or ended in a number that cannot be; no numbers"
    THIN_LAYER_NOT_APPLICABLE = 4, "the thin-layer equation does not apply (C <= 0 in Eq. (3)); no numbers"
    TOLERANCE_NOT_MET = 5, "the estimated error exceeds rtol at the finest mesh; the numbers are kept"
    INVALID_INPUT = 6, "a parameter is not finite, is out of bounds, or does not fit the others; no numbers"
    # 7 was a status of numerics version 2 and is not used again
    LIFT_OFF = 8, "the punch lifts off inside the contact, or the pressure is tensile there; no numbers"
    BUDGET_SPENT = 9, "the case has used up its share of work; the last numbers, if any, are kept"
    OUTSIDE_LAW = (
        10,
        "the contact is outside the range of the micro law, or of the table of a tip; no numbers",
    )
    PULLED_OFF = (
        11,
        "no state of the branch asked for has this load or depth; only pull-off and pull-in have numbers",
    )

    meaning: str

    def __new__(cls, value: int, meaning: str) -> "Status":
        """The member with a value, an int, and its meaning."""
        member = int.__new__(cls, value)
        member._value_, member.meaning = value, meaning
        return member


#: Statuses of cases whose equations have no solution in the model. They are no failures of the solver.
NO_SOLUTION = (Status.THIN_LAYER_NOT_APPLICABLE, Status.LIFT_OFF, Status.PULLED_OFF)
