"""What a call of `fit` gives the contact, in words, for the summary of its answer."""

import warnings

import numpy as np
import xarray as xr

from ...in_words.inputs import given
from ...in_words.sentences import assumed
from ...solving import solve
from .question import Question


def said(question: Question, fitted: xr.Dataset) -> dict[str, str]:
    """Attributes of a Dataset of `fit`: `given`, the inputs that are not free; `assumed`, the defaults that stand for
    inputs which were not given, and may be far from them, if there are any."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        contact = solve(**question.call, x=2, profiles=False, progress=False)
    free = [name for name in question.free if name in fitted]  # of a plan none: these are its assumed values
    for name in free:  # what is assumed depends on how soft the layer is
        if np.isfinite(value := fitted[name].median().item()):
            contact[name] = contact[name].copy(data=value)
    words = {"given": "\n".join(given(contact, free))}
    doubts = [f"Assumed: {sentence}" for sentence in assumed(contact)]
    return words | ({"assumed": "\n".join(doubts)} if doubts else {})
