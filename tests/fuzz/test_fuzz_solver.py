"""A fixed sample of `make fuzz`, and that it sees what it is there to see."""

import fuzz_solver
import numpy as np
import pytest
from solver_cases import LOAD, MAIN

from solver import Problem, Status, solve

#: All laws and controls on the half-space and the thin layer, lattices, heights and tables on one of them in turn; the
#: exact layer takes seconds a case, and so do SLOW: histograms of many classes, and picard.
SLOW = (32, 61, 104)
QUICK = [n for n in range(fuzz_solver.ROUND) if n % 4 < 2 and (n // 4 % 9 < 4 or n % 4 == n // 4 % 2) and n not in SLOW]


def test_a_fixed_sample_has_nothing_silently_wrong():
    found, ended, _ = fuzz_solver.fuzz(QUICK, 0, share=45)
    assert not found, "\n".join(found)
    assert ended["CONVERGED"] >= 0.5 * sum(ended.values()) and ended["INVALID_INPUT"] == 0


@pytest.fixture(scope="module")
def good():
    return solve(Problem.of(P=np.full(2, LOAD), **MAIN, base="thin_layer"), fuzz_solver.X)


WRONG = [
    ("D", 0.1),
    ("dP_dD", 0.5),
    ("p_max", 0.1),
    ("P", 100.0),
    ("p", -1.0),
    ("lam", 10.0),
    ("error", 1e9),
    ("a", 3.0),
]


@pytest.mark.parametrize(("name", "factor"), WRONG)
def test_a_wrong_number_is_seen(good, name, factor):
    s = type(good)(**{key: value.copy() for key, value in vars(good).items()})
    bonded = np.zeros(2, dtype=bool)
    assert not fuzz_solver.wrong_numbers(s, 1e-6, bonded).any()
    getattr(s, name)[1] *= factor
    assert fuzz_solver.wrong_numbers(s, 1e-6, bonded).tolist() == [False, True]
    s.status[1] = Status.TOLERANCE_NOT_MET
    assert not fuzz_solver.wrong_numbers(s, 1e-6, bonded).any()


def test_another_contact_is_seen(good):
    """The load that belongs to the radius is another than the one given."""
    case = {"P": np.full(2, LOAD), "base": "thin_layer", "rtol": np.full(2, 1e-6)} | MAIN
    s = type(good)(**{key: value.copy() for key, value in vars(good).items()})
    s.a[1] *= 1.0001
    assert fuzz_solver.differs(s, case, "P").tolist() == [False, True]


def test_a_slow_case_and_a_violation_make_it_fail(monkeypatch, capsys):
    monkeypatch.setattr(fuzz_solver, "SLOWEST", -1.0)
    monkeypatch.setattr(fuzz_solver, "fuzz", lambda groups, *rest, fuzz=fuzz_solver.fuzz: fuzz([0], *rest))
    assert fuzz_solver.main(["--cases", "48"]) == 1
    assert capsys.readouterr().out.splitlines()[-1] in [f"{count} violations" for count in range(1, 91)]
    monkeypatch.setattr(fuzz_solver, "SLOWEST", 10.0)
    assert fuzz_solver.main(["--cases", "48"]) == 0


def test_a_violation_comes_with_its_table(monkeypatch):
    monkeypatch.setattr(fuzz_solver, "SLOWEST", -1.0)
    (rows,) = [n for n in QUICK if n < 36 and n // 4 == fuzz_solver.LAWS.index("rows")]
    found, _, _ = fuzz_solver.fuzz([rows], 0, singles=1, share=90)
    assert found and all("p,A,lam,p_max\n" in text for text in found)
