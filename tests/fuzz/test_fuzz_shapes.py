"""A fixed sample of random shapes and of what sticks, and that wrong numbers are seen."""

from collections import Counter

import fuzz_shapes
import numpy as np
import pytest

from solver import Problem, Status, solve

#: Of quick groups: smooth, JKR, DMT and rough ones of several shapes.
QUICK = (2, 5, 6, 9, 10, 12, 15)


def test_a_fixed_sample_has_nothing_silently_wrong():
    ended = Counter()
    assert [text for number in QUICK for text in fuzz_shapes.violations(1, number, ended)] == []
    assert ended["CONVERGED"] > 10


CASE = {"shape": "sphere", "base": "half_space", "micro": "smooth", "rtol": np.full(2, 1e-6)}
STICKS = {"w_adhesion": np.full(2, 1e-6)}


@pytest.mark.parametrize(
    ("name", "factor", "more"),
    [("D", 0.1, {}), ("P", -1.0, {}), ("p", np.nan, {}), ("error", 1e12, {}), ("P_off", np.nan, STICKS)],
)
def test_a_wrong_number_is_seen(name, factor, more):
    case = CASE | more
    s = solve(Problem.of(**case, P=np.full(2, 1e-4)), fuzz_shapes.X)
    assert s.status.tolist() == [Status.CONVERGED] * 2 and not fuzz_shapes.wrong_numbers(s, case).any()
    assert not fuzz_shapes.differs(s, case | {"P": np.full(2, 1e-4)}, "P").any()
    s = type(s)(**{key: value.copy() for key, value in vars(s).items()})
    getattr(s, name)[1] *= factor
    assert fuzz_shapes.wrong_numbers(s, case).tolist() == [False, True]


def test_another_contact_is_seen():
    case = CASE | {"P": np.full(2, 1e-4)}
    s = solve(Problem.of(**case), fuzz_shapes.X)
    s = type(s)(**{key: value.copy() for key, value in vars(s).items()})
    s.a[1] *= 1.0001
    assert fuzz_shapes.differs(s, case, "P").tolist() == [False, True]


def test_wrong_stresses_are_seen():
    """The surface bears the pressure: here under a flat end, whose largest stress is in a ring next to the edge."""
    case = {"shape": "rounded_flat", "flat_radius": 0.1, "edge_radius": 0.1, "base": "half_space", "micro": "smooth"}
    problem = Problem.of(**case, a=[0.101, 0.12])
    s = solve(problem, fuzz_shapes.X)
    assert not fuzz_shapes.stressed(s, problem).any()
    s = type(s)(**{key: value.copy() for key, value in vars(s).items()})
    s.p[1] *= 1.01
    assert fuzz_shapes.stressed(s, problem).tolist() == [False, True]


def test_a_table_is_convex():
    word = fuzz_shapes.table(np.random.default_rng(0), 0, 0)
    assert solve(Problem.of(shape=word, P=1e-4, base="half_space", micro="smooth")).status == Status.CONVERGED
