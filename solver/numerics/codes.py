"""Whole numbers with names, which arrays hold."""

from enum import EnumType, IntEnum


class _Quiet(EnumType):
    """numpy looks for attributes of a number that it compares, and forgets what is raised meanwhile, also the
    KeyboardInterrupt of a signal. Up to Python 3.11 EnumType would run Python code there, before which signals are
    heard."""

    __getattr__ = type.__getattribute__


class Codes(IntEnum, metaclass=_Quiet):
    """An IntEnum whose members numpy reads without running Python code."""
