"""Largest stresses and loads of first yield of what a test asks for alone: the rest takes most of the time."""

from functools import partial

import pytest
import xarray as xr

import study
from solver.yields.contact import of_contacts
from study import fields
from study.yields import first_yield as searching


def largest(contact: xr.Dataset, *names: str, mu: float = 0.0) -> xr.Dataset:
    """`study.extremes` with these names alone."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(fields, "EXTREMES", {name: fields.EXTREMES[name] for name in names})
        patched.setattr(fields, "extremes_of", partial(of_contacts, names=names))
        return study.extremes(contact, mu)


def first_yield(*bodies: str, **given) -> xr.Dataset:
    """`study.first_yield` with the loads of these bodies alone: "layer", "body", "asperities", "punch"."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(searching, "BODIES", {body: searching.BODIES[body] for body in bodies})
        return study.first_yield(**given)
