"""What holds of every law of this package: no pressure, full contact, and that no law has the numbers of another."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import study
from solver import Problem, laws
from solver.laws import Curve, Law, heights
from solver.numerics.caches import Cache

ROUGH = [law for law in laws.BUILT_IN if law.rough]
GIVEN = {"Nbar": 250_000.0, "Ra": 0.004, "B": 0.1, "beta": 0.53, "sigma": 1e-5, "cut": 3.0}
GIVEN |= {"hardness": 0.02, "yield_strength": np.nan, "nu": 0.3}


def at(law, p, **other):
    return law.at(p, 1.0, **{name: (GIVEN | other)[name] for name in law.arguments})


@pytest.mark.parametrize("law", ROUGH, ids=[law.name for law in ROUGH])
@pytest.mark.parametrize("sigma", [0.0, 1e-8, 1e-5, 1e-2])
def test_nothing_at_no_pressure(law, sigma):
    """Zeros, not 0/0; beside pressures, and alone. NaN stays NaN."""
    for found, p in ((at(law, np.array([0.0, 1e-4, np.nan]), sigma=sigma), 3), (at(law, 0.0, sigma=sigma), 1)):
        values = np.array([np.ravel(one) for one in found])
        assert values.shape == (3, p)
        assert_array_equal(values[:, 0], 0.0)
        assert (values[:, 1:2] > 0).all() and np.isnan(values[:, 2:]).all()


@pytest.mark.parametrize("law", ROUGH, ids=[law.name for law in ROUGH])
@pytest.mark.parametrize("sigma", [0.0, 1e-5, 1e-3, 1e-2])
def test_contact_is_never_more_than_full(law, sigma):
    """λ rises to 1 and no further, however large p is, and the mean pressure on the spots is no more than the
    largest."""
    p = np.geomspace(1e-9, 1e6, 600)
    found = at(law, p, sigma=sigma)
    assert (np.diff(found.lam) >= -1e-9).all() and (found.lam <= 1).all() and found.lam[-1] > 0.01
    assert (found.p_max >= p).all(), "of the real pressure, which is the nominal one in full contact"


def _cones(y):
    """g ~ q, as of cones, written as a quotient that is 0/0 at y = 0."""
    q = np.asarray(y, dtype=float) ** 2
    return Curve(q, q * q / q, 2 * y, 2 * q / y)


def test_a_law_of_ones_own_without_pressure():
    """Its functions are asked for y > 0 alone: 0/0 at y = 0 is no number of the law."""
    law = Law("quotient", lambda E: (E, 1.0), _cones, lambda y, q: q / (1 + q), lambda y, q: 1 + q, lambda: (1.0, 1.0))
    found = law.at(np.array([0.0, 0.25, np.nan]), 1.0)
    assert_allclose(found.A, [0.0, 0.25, np.nan], rtol=1e-13)
    assert_allclose(found.lam, [0.0, 0.2, np.nan], rtol=1e-13)


def test_two_laws_of_one_name_in_one_call_are_refused():
    """Else every case would have the last of them. A copy is the same law, and so is a law that is given twice."""
    first, second = (replace(laws.LAWS[name], name="mine", version="1") for name in ("disc_cell", "hex_lattice"))
    case = {"P": 1e-5, "h": 0.02, "n": 0.5, "Nbar": 250_000.0, "Ra": 0.004}
    message = 'two micro laws of one call are called "mine": give each a name of its own'
    with pytest.raises(ValueError, match=f"^{message}$"):
        Problem.of(**case, micro=[first, second])
    cases = [{"micro": law} for law in (first, second)]
    with pytest.raises(study.StudyError, match=f"^solve: micro: {message}$"):
        study.solve(**case, cases=cases)
    del case["h"]
    same = study.solve(**case, cases=[{"micro": first, "h": 0.02}, {"micro": replace(first), "h": 0.03}])
    alone = study.solve(**case, h=0.02, micro=first)
    assert_allclose(same.a[0], alone.a, rtol=1e-12)  # in other company sums have another order


def test_distributions_of_the_same_heights_have_tables_of_their_own(monkeypatch):
    """Normal and uniform ones, with and without the field of the others, of two cuts, in whichever order they come."""
    normal = heights.law("free_normal", heights.NORMAL, field=0.0, version="1")
    even = heights.law("free_even", heights.EVEN, field=0.0, version="1")
    known = [(heights.LAW, 3.0), (normal, 3.0), (heights.LAW, 3.5), (heights.UNIFORM_LAW, None), (even, None)]
    p = np.geomspace(1e-6, 1e-2, 7)

    def together(order):
        monkeypatch.setattr(heights, "_cache", Cache(6e7))
        return {i: at(known[i][0], p, cut=known[i][1]).lam for i in order}

    first, last = together(range(5)), together(reversed(range(5)))
    alone = {i: together([i])[i] for i in range(5)}
    for i in range(5):
        assert_allclose(first[i], alone[i], rtol=1e-13)
        assert_allclose(last[i], alone[i], rtol=1e-13)
        for j in range(i):
            assert (np.abs(alone[i] / alone[j] - 1) > 1e-3).any(), "they are different distributions"
