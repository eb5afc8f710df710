"""The bounds of "auto": with the error that a micro law states, and none where a model does not apply."""

from dataclasses import replace

import numpy as np
import pytest

from solver import Model, Problem, laws, solve
from solver.known import register
from solver.models.auto import bounds

pytestmark = pytest.mark.usefixtures("forgetful")

ERROR = 0.03
GIVEN = {"Nbar": 250_000.0, "Ra": 0.004, "n": 0.9, "asperities_on": "half_space"}


@pytest.fixture
def micro() -> dict[float, str]:
    """Error -> the name of a law of discs that states it."""
    disc, found = laws.LAWS["disc_cell"], {0.0: "exact_discs", ERROR: "rough_discs"}
    for error, name in found.items():
        register(replace(disc, name=name, version="1", error=error, on_body=None))
    return found


def test_every_bound_has_it(micro):
    """On layers so thin, and so thick, that each of the two cheap models is allowed."""
    given = GIVEN | {"P": 1e-5, "h": [1e-4, 1e-3, 10.0, 1e3], "base": "auto"}
    exact, rough = (bounds(Problem.of(**given, micro=name)) for name in micro.values())
    assert set(exact) == set(rough) > {Model.LAYER_ALONE, Model.THIN_LAYER}
    for model in exact:
        known = np.isfinite(exact[model])
        assert known.any() and (known == np.isfinite(rough[model])).all()
        np.testing.assert_allclose(rough[model][known] - exact[model][known], ERROR, rtol=1e-9)


@pytest.mark.parametrize("base", ["half_space", "thin_layer", "layered", "auto"])
@pytest.mark.parametrize("h", [1e-4, 0.02, 1e3])
def test_the_answer_has_it(micro, base, h):
    """`accuracy` is larger than it: so "auto" has the same choice."""
    if base == "thin_layer" and h > 0.1:
        return
    exact, rough = (
        solve(Problem.of(**GIVEN, P=1e-5, h=h, base=base, accuracy=0.2, micro=name)) for name in micro.values()
    )
    assert exact.status == rough.status == 0 and exact.model_used == rough.model_used
    np.testing.assert_allclose(rough.model_error - exact.model_error, ERROR, rtol=1e-6)


@pytest.mark.parametrize("micro", ["disc_cell", "smooth"])
def test_no_bound_where_the_thin_layer_does_not_apply(micro):
    """A bonded layer of nu1 = 1/2 has no springs: the exact layer is solved."""
    given = {"P": 1e-5, "h": 1e-3, "n": 0.5, "bonding": "bonded", "nu1": [0.5, 0.3], "base": "auto"}
    asperities = {} if micro == "smooth" else {"Nbar": 250_000.0, "Ra": 0.004}
    problem = Problem.of(**given, **asperities, micro=micro)
    thin = [bound for model, bound in bounds(problem).items() if model in (Model.THIN_LAYER, Model.SMOOTH_THIN_LAYER)]
    assert thin and all(bound[0] == np.inf and bound[1] < np.inf for bound in thin)
    found = solve(problem.but(accuracy=0.3))
    assert found.model_used[0] in (Model.LAYERED, Model.SMOOTH_LAYERED) and found.status[0] == 0
