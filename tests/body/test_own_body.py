"""A body of somebody else's, as docs/extending.md says: here the half-space by another name."""

from dataclasses import replace

import pytest
from numpy.testing import assert_allclose

from solver import Model, Problem, Status, solve
from solver.body import BODIES
from solver.body.half_space import half_space
from solver.known import PACKAGE
from solver.models import named
from solver.parameters import BASES, COMMON, LAYERED, NamedRows
from study.in_words import MODELS


@pytest.mark.parametrize("micro", ["disc_cell", "smooth"])
def test_a_body_of_ones_own(micro, monkeypatch):
    monkeypatch.setitem(BODIES, "mine", lambda problem: half_space(problem.m))
    monkeypatch.setitem(named._BY_NAME, "mine", Model.LAYERED)
    rows = {**COMMON, "base": COMMON["base"]._replace(choices=(*BASES, "mine"))}
    monkeypatch.setattr("solver.known.COMMON", NamedRows(rows))
    mine_too = replace(PACKAGE)
    given = {"micro": micro, "n": 1.0, "h": 0.02, "Nbar": 250_000.0, "Ra": 0.004, "rtol": 1e-9, "known": mine_too}
    mine, same = (solve(Problem.of(P=[1e-6, 1e-5], base=base, **given)) for base in ("mine", "half_space"))
    assert mine.status.tolist() == [Status.CONVERGED] * 2
    assert_allclose([mine.a, mine.D, mine.dP_dD], [same.a, same.D, same.dP_dD], rtol=1e-9, atol=0)
    assert mine.model_used.tolist() == [Model.SMOOTH_LAYERED if micro == "smooth" else Model.LAYERED] * 2


def test_every_body_is_in_all_lists():
    assert {*BODIES, "auto"} == {*BASES} == {*LAYERED[1], "half_space"}
    assert set(named._BY_NAME) == set(BODIES)
    assert {model.name.lower() for model in Model} - {"none"} <= set(MODELS)
