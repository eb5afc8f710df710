"""A case has the same bits in any company: alone, among few and among many, in whichever lane."""

import numpy as np
import pytest
from both_paths import by, contacts, of_the_sources  # noqa: F401

from solver.compiled import newton_in_c
from solver.compiled.library import available
from solver.compiled.structures import mesh_for

VARIANTS = available()
pytestmark = pytest.mark.skipif(not VARIANTS, reason="no compiled core was built here")


@pytest.mark.parametrize("variant", VARIANTS)
def test_the_same_bits_in_any_company(variant):
    """But of those that the core hands back, whose bits depend on the number of cases that numpy gets."""
    problem = contacts(400, 7, h=np.geomspace(0.05, 3.0, 400))
    whole, random = by(variant, problem), np.random.default_rng(0)
    handed = handed_back(variant, problem)
    assert handed.mean() < 0.2  # a sixth have the way of their own
    for size in (1, 1, 2, 3, 5, 9, 60):
        index = random.permutation(np.flatnonzero(~handed))[:size]
        part = by(variant, problem.take(index))
        for name, values in vars(part).items():
            assert values.tobytes() == getattr(whole, name)[index].tobytes(), (size, name)


def handed_back(variant, problem) -> np.ndarray:
    """(B,) bool: the smooth cases on thin layers and half-spaces, which have a way of their own, and those that the
    core does not finish."""
    with pytest.MonkeyPatch.context() as patched:

        def left(cases, rtol, nodes, limit, x):
            return newton_in_c.Solution.of(len(rtol), len(x), status=9)

        patched.setattr(newton_in_c.adaptive, "solve_newton", left)
        alone = (problem.micro == "smooth") & (problem.base != "layered")
        return alone | (by(variant, problem).status == 9)


def test_the_same_bits_in_blocks_of_a_large_batch(monkeypatch):
    problem = contacts(100, 8, base="layered", micro="disc_cell", h=0.05)
    whole = by("", problem)
    monkeypatch.setattr(newton_in_c, "_CHUNK", 17)
    assert by("", problem).P.tobytes() == whole.P.tobytes()
    assert by("", problem).p.tobytes() == whole.p.tobytes()


def test_meshes_are_made_for_cases_alone(monkeypatch):
    """The first contact of a program would wait for all of the ladder."""
    asked = []
    monkeypatch.setattr(newton_in_c, "mesh_for", lambda n, s: asked.append(n) or mesh_for(n, s))
    coarse = by(VARIANTS[0], contacts(5, 11, base="layered", h=0.1, n=0.5, micro="disc_cell", rtol=1e-3))
    assert coarse.nodes.max() < 22 and len(asked) >= 2 and max(asked) == coarse.nodes.max()
