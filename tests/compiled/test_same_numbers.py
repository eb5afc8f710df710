"""The compiled core against its reference, the numpy path: the same meshes, statuses and steps, numbers to rounding."""

from functools import cache

import numpy as np
import pytest
from both_paths import SCALARS, X, by, contacts, of_the_sources  # noqa: F401
from numpy.testing import assert_allclose, assert_array_equal

from solver import Problem, Status
from solver.compiled import newton_in_c
from solver.compiled.library import available
from solver.rough import adaptive

pytestmark = pytest.mark.skipif(not available(), reason="no compiled core was built here")
#: Relative difference of the numbers. Rounding of a stiff plate is n times that of its base, so that its pressures move
#: by more (:func:`rounding`). numpy's own do so with the number of cases in a batch: of 12 smooth plates of n = 164 to
#: 987 by up to 6.5e-12, and by up to 2.1e-12 from those of the core.
SAME = 1e-12
#: Of error and profile_error, which are differences of two solutions: so much more than :func:`rounding`.
OF_ERRORS = 300.0
#: Of p over its largest at the radii, and of λ: between the nodes of a stiff film a pressure is so much less certain.
OF_PROFILES = 40.0


def rounding(problem: Problem) -> np.ndarray:
    """(B,): how far two paths may be apart by rounding."""
    return SAME + 1e-14 * np.where(problem.base == "layered", problem.n, 0.0)


@cache
def controlled(control: str, seed: int) -> tuple:
    """Contacts given by a quantity, and numpy's solution; by "a" and "D" only those that have one."""
    problem = contacts(200, seed)
    solution = by("numpy", problem)
    if control == "P":
        return problem, solution
    solved = np.flatnonzero(solution.status == Status.CONVERGED)
    problem = Problem(control, getattr(solution, control), problem.parameters, problem.known).take(solved)
    return problem, by("numpy", problem)


@pytest.fixture(params=available())
def variant(request) -> str:
    return request.param


@pytest.mark.parametrize("control", ["P", "a", "D"])
@pytest.mark.parametrize("seed", [1, 2])
def test_numbers_of_random_contacts(variant, control, seed):
    problem, numpy = controlled(control, seed)
    core = by(variant, problem)
    assert_same(problem, core, numpy)
    # a residual that is by chance at the limit of what is closed may be above it on one path, and below on the other
    assert np.mean(core.iterations != numpy.iterations) < 0.02


@pytest.mark.parametrize("nodes", [6, 12, 22, 32, 48, 64])
def test_numbers_on_a_mesh_that_is_asked_for(nodes):
    problem = contacts(60, 3, nodes=nodes, rtol=1e-7)
    core, numpy = by("", problem), by("numpy", problem)
    assert_same(problem, core, numpy)
    assert {Status.CONVERGED, Status.TOLERANCE_NOT_MET} & {*core.status.tolist()}


#: Few asperities on a thin layer that yields as springs.
SPRINGS = {"micro": "power_law", "B": 1e-8, "beta": 1.0, "Ra": 1e-7, "Nbar": 1e3, "n": 1.0, "m": 0.0}
SPRINGS |= {"base": "thin_layer", "bonding": "frictionless"}
#: What random contacts seldom have: springs that yield more than the body only in a ring which no mesh sees; layers
#: hardly thicker than films; stiff layers under long waves, where the kernel has a series, for it would lose digits.
SELDOM = {
    "rings of springs": SPRINGS | {"h": np.geomspace(1e-8, 1e-2, 40) * 0.05, "P": 1e-4, "rtol": 1e-3},
    "short waves": {"micro": "smooth", "base": "layered", "n": 0.003, "m": 0.0, "P": 1e-3, "h": 4e-4, "rtol": 0.1},
    "long waves": {"micro": "smooth", "base": "layered", "n": 1e3, "bonding": "bonded", "P": 1e-2, "h": 1e-2},
    "long waves without friction": {"micro": "disc_cell", "base": "layered", "n": 1e3, "bonding": "frictionless"},
}


@pytest.mark.parametrize("name", SELDOM)
def test_numbers_of_what_is_seldom(name):
    problem = contacts(40, 12, **SELDOM[name])
    assert_same(problem, by("", problem), by("numpy", problem))


def assert_same(problem, core, numpy):
    for name in ("status", "nodes", "model_used"):
        assert_array_equal(getattr(core, name), getattr(numpy, name), name)
    allowed = rounding(problem)
    for name in SCALARS:
        values, expected = getattr(core, name), getattr(numpy, name)
        assert_array_equal(np.isnan(values), np.isnan(expected), name)
        apart = np.abs(values - expected) > allowed * np.abs(expected)
        assert not apart.any(), (name, np.flatnonzero(apart))
    largest = np.fmax(numpy.p0, numpy.p.max(axis=1, initial=0.0))
    for name, of in (("p", largest), ("lam", np.ones(len(largest)))):
        apart = np.abs(getattr(core, name) - getattr(numpy, name)) > (OF_PROFILES * allowed * of)[:, None]
        assert not apart.any(), (name, np.flatnonzero(apart.any(axis=1)))
    for name in ("error", "profile_error"):
        apart = np.abs(getattr(core, name) - getattr(numpy, name)) > OF_ERRORS * allowed
        assert not apart.any(), (name, np.flatnonzero(apart))


def test_what_the_core_does_not_take_is_numpys_to_the_last_bit():
    """Films, very stiff layers, numbers of nodes that are not on the ladder, limits of the steps, small exponents."""
    film = {"P": 1e-5, "h": 1e-5, "n": 0.5, "micro": "smooth"}
    rough = {"P": 1e-5, "h": 0.02, "n": 0.5, "Nbar": 250000.0, "Ra": 0.004}
    others = {
        "film": film,
        "stiff": rough | {"n": 5e3},
        "nodes": rough | {"nodes": 25},
        "steps": rough | {"max_iterations": 2},
        "exponent": rough | {"micro": "power_law", "B": 0.1, "beta": 0.05},
        "heights": rough | {"micro": "normal_heights", "sigma": 1e-5},
    }
    for name, case in others.items():
        problem = Problem.of(**case)
        core, numpy = by("", problem), by("numpy", problem)
        for field, values in vars(numpy).items():
            assert getattr(core, field).tobytes() == values.tobytes(), (name, field)


def test_a_case_is_handed_back_among_others(monkeypatch):
    """And only that one goes to numpy."""
    problem = contacts(40, 4, base="layered", micro="disc_cell", n=0.5, m=0.0, h=0.02, rtol=1e-6)
    problem = problem.but(h=np.where(np.arange(40) == 7, 1e-5, problem.h))
    sizes, plain = [], adaptive.solve_newton

    def counted(cases, *arguments):
        sizes.append(len(cases.value))
        return plain(cases, *arguments)

    monkeypatch.setattr(adaptive, "solve_newton", counted)
    core = by("", problem)
    assert sizes == [1]
    assert_same(problem, core, by("numpy", problem))


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_what_goes_wrong_with_a_table_is_raised(monkeypatch, error):
    """Ctrl-C too, which would be lost in a callback of C."""

    def failing(*key):
        raise error("a table")

    monkeypatch.setattr(newton_in_c, "table_for", failing)
    with pytest.raises(error, match="a table"):
        by("", contacts(5, 5, base="layered"))


def test_no_cases_and_no_radii():
    problem = contacts(6, 6)
    assert len(by("", problem.take([]), X).a) == 0
    none, some = by("", problem, np.array([])), by("", problem)
    assert none.p.shape == (6, 0) and none.a.tobytes() == some.a.tobytes()
    edge = by("", problem, np.array([1.0, 0.0, 1.0]))
    assert (edge.p[:, [0, 2]] == 0).all()
    assert_allclose(edge.p[:, 1], some.p[:, 0], rtol=1e-12)  # the steps between the nodes end by the radii together
