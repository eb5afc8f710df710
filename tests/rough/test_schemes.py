"""A scheme of somebody else's: what docs/extending.md says, done as it stands there."""

import re

import pages
import pytest
from numpy.testing import assert_allclose
from solver_cases import MAIN

from solver import Problem, Status, schemes, solve

SECTION = pages.read("docs/extending.md").split("\n## A scheme\n")[1].split("\n## ")[0]
(CODE,) = re.findall(r"^```python\n(.*?)^```", SECTION, re.DOTALL | re.MULTILINE)


@pytest.fixture(autouse=True)
def one_mesh(forgetful):
    """The scheme of the page, for one test."""
    before = dict(schemes.SCHEMES)
    exec(CODE, {})
    yield
    schemes.SCHEMES.clear()
    schemes.SCHEMES.update(before)


@pytest.mark.parametrize("base", ["half_space", "thin_layer", "layered"])
def test_a_scheme_of_ones_own(base):
    """The numbers of Newton on as many nodes; one that is not as accurate as asked for says so."""
    case = MAIN | {"a": [0.02, 0.04], "base": base}
    own = solve(Problem.of(**case, scheme="one_mesh", rtol=[1e-6, 1e-14]))
    newton = solve(Problem.of(**case, nodes=32))
    assert own.status.tolist() == [Status.CONVERGED, Status.TOLERANCE_NOT_MET]
    assert_allclose(own.P, newton.P, rtol=1e-11, atol=0)
    assert own.error[1] > 1e-14


def test_a_scheme_does_not_take_the_name_of_another():
    """Results on disk that Newton's method has made would be taken for those of another scheme."""

    def newton(part, x):
        return schemes.picard(part, x)

    with pytest.raises(ValueError, match="scheme newton: solver.schemes has one of this name: take another name"):
        schemes.scheme(newton)
    assert schemes.SCHEMES["newton"] is schemes.newton
