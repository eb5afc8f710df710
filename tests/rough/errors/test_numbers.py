"""The numbers of the paper's main case, and how the error falls with the number of nodes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import BASES, LOAD, ROUGH, difference, one

from solver import Problem, solve

pytestmark = pytest.mark.usefixtures("each_path")


def half_of_last_digit(text):
    """Half a unit of the last printed digit."""
    mantissa, _, exponent = text.partition("e")
    return 0.5 * 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def assert_printed(values, texts):
    """Each value rounds to its text."""
    for value, text in zip(np.ravel(values), texts, strict=True):
        assert_allclose(value, float(text), rtol=0, atol=half_of_last_digit(text) * (1 + 1e-9), err_msg=text)


def test_layered_power_law():
    s = one(a=0.04, micro="power_law", rtol=1e-10)
    assert_printed([s.P, s.p0, s.Ar_An, s.p_max], ["2.70408e-5", "0.010448", "0.18478", "0.05271"])
    assert_printed([s.D, s.A0], ["1.04362e-3", "5.782e-5"])


def test_homogeneous_power_law():
    s = one(P=LOAD, micro="power_law", base="half_space", rtol=1e-10)
    assert_printed([s.a**2 / 0.04**2, s.Ar_An, s.p_max], ["0.56612", "0.17145", "0.09693"])


def test_smooth():
    depths = [one(P=LOAD, micro="smooth", base=base).D for base in ("thin_layer", "half_space")]
    assert_printed(depths, ["1.00510e-3", "7.43681e-4"])


@pytest.mark.parametrize("base", BASES)
def test_exact_law_is_near_its_fit(base):
    """The fit of the paper is within 8 % of the exact A[p]: so are the answers, within what A contributes to them."""
    exact, fitted = (one(P=LOAD, micro=micro, base=base, rtol=1e-10) for micro in ("disc_cell", "power_law"))
    assert 1e-4 < difference(exact, fitted)[0] < 0.08
    assert_allclose(exact.a, fitted.a, rtol=5e-3, atol=0)


@pytest.mark.parametrize("micro", ROUGH)
@pytest.mark.parametrize("base", BASES)
def test_spectral_rate(base, micro):
    """The errors of a and Ar/An fall by 30 for every four nodes from 8 to 24, as far as 1e-12."""
    sizes = [8, 12, 16, 20, 24]
    reference = one(P=LOAD, micro=micro, base=base, nodes=96)
    for name in ("a", "Ar_An"):
        found = [getattr(one(P=LOAD, micro=micro, base=base, nodes=n, rtol=0.5), name)[0] for n in sizes]
        error = np.abs(np.array(found) / getattr(reference, name)[0] - 1)
        slope = np.polyfit(sizes, np.log(np.maximum(error, 1e-13)), 1)[0]
        assert slope < -np.log(10) / 4, (name, error)  # at least a digit for every four nodes, on average
        assert np.all(np.diff(np.log(np.maximum(error, 1e-12))) < np.log(2)), (name, error)  # and never back
        assert error[0] < 1e-5
        assert error[-1] < 1e-11


@pytest.mark.parametrize("micro", ROUGH)
@pytest.mark.parametrize("base", BASES)
def test_nodes_that_are_promised(base, micro):
    reference = one(P=LOAD, micro=micro, base=base, nodes=96)
    for nodes, error in ((16, 1e-7), (24, 1e-9)):
        found = one(P=LOAD, micro=micro, base=base, nodes=nodes, rtol=1e-4)
        assert found.nodes[0] == nodes
        assert_allclose(found.a, reference.a, rtol=error, atol=0)


@pytest.mark.parametrize("micro", ROUGH)
@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("control", ["P", "a", "D"])
def test_residual(base, micro, control):
    """The iteration closes quadratically: the last residual is far below its tolerance in most cases."""
    given = {"P": LOAD, "a": 0.04, "D": 1e-3}[control]
    s = one(**{control: given}, micro=micro, base=base, rtol=1e-9)
    assert s.status[0] == 0
    assert s.residual[0] <= 1e-12
    assert 1 <= s.iterations[0] <= 15
    assert getattr(s, control)[0] == given  # the controlled quantity exactly as given


@pytest.mark.parametrize("micro", [*ROUGH, "smooth"])
def test_tolerance_chooses_the_nodes(micro):
    rtol = np.array([1e-2, 1e-4, 1e-6, 1e-8, 1e-10])
    s = one(P=np.full(5, LOAD), micro=micro, rtol=rtol)
    reference = one(P=LOAD, micro=micro, nodes=96)
    assert np.all(np.diff(s.nodes) >= 0)
    assert s.nodes[0] < s.nodes[-1]
    assert np.all(s.error <= rtol)
    assert np.all(difference(s, reference) <= rtol)


def test_unreachable_tolerance_is_said():
    s = solve(Problem.of(P=LOAD, h=0.02, n=0.5, Nbar=250000, Ra=0.004, base="thin_layer", rtol=1e-15))
    assert s.status[0] == 5
    assert s.error[0] > 1e-15
    assert s.nodes[0] >= 32  # on more nodes the rounding of their sums is more, and no error can be less
    assert_allclose(s.a, one(P=LOAD, nodes=64, micro="disc_cell").a, rtol=1e-13, atol=0)


def test_profiles_of_no_radius_or_of_the_edge_alone():
    case = {"P": LOAD, "h": 0.02, "n": 0.5, "Nbar": 250000, "Ra": 0.004, "base": [*BASES, "layered"]}
    whole, none, edge = (solve(Problem.of(**case), x) for x in ([0.0, 1.0], [], [1.0, 1.0]))
    assert none.p.shape == (3, 0) and (none.D == whole.D).all() and (edge.D == whole.D).all()
    assert edge.p.shape == (3, 2) and (edge.p == 0).all() and (edge.lam == 0).all()
