"""The work of one case is limited, by what is done and not by time: where it ends, and what is said then.

The limits are lowered here, so that cases which take little work reach them.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import LOAD, MAIN, layer_of

from solver import Problem, Status, solve
from solver.body.half_space import half_space
from solver.rough import adaptive, newton, panels, picard
from solver.rough.newton import newton_steps
from study.inputs.reading import from_tables

pytestmark = pytest.mark.usefixtures("numpy_path")

X = np.linspace(0.0, 1.0, 5)
#: Relaxed so much that it takes some 500 approximations; and hardly, on springs that carry nearly all: some 20.
PAPERS = MAIN | {"base": "thin_layer", "micro": "power_law", "scheme": "picard"}
SLOW, QUICK = {"k": 20.0, "h": 0.02}, {"k": 1.0, "h": 3.0}
#: The asperities saturate: a corner that one polynomial does not resolve to 1e-9; and the main case.
CORNER = {"a": [0.1, 0.04], "h": [1e-4, 0.02], "n": [1e-2, 0.5], "Ra": [0.02, 0.004], "Nbar": [1.5e4, 250000.0]}


@pytest.mark.parametrize(("control", "value"), [("a", 0.04), ("P", LOAD)])
def test_approximations(monkeypatch, control, value):
    """At one radius and in all; the neighbour, which settles in time, has its numbers."""
    both = {name: [SLOW[name], QUICK[name]] for name in SLOW}
    free, quick = (solve(Problem.of(**PAPERS | {control: value} | case), X) for case in (both, QUICK))
    monkeypatch.setattr(picard, "APPROXIMATIONS", 300 if control == "P" else 100)
    s = solve(Problem.of(**PAPERS | {control: value, "max_iterations": 100_000} | both), X)
    assert s.status[0] == Status.BUDGET_SPENT and free.status[0] != Status.BUDGET_SPENT
    assert 100 <= s.iterations[0] <= 900 and np.isfinite(s.P[0])
    assert quick.status[0] == s.status[1] == Status.CONVERGED
    assert_allclose(s.a[1], quick.a[0], rtol=1e-9)  # the last approximation moves it by less than 1e-6/10
    few = solve(Problem.of(**PAPERS | {"a": 0.04, "max_iterations": 20} | SLOW), X)
    assert few.status[0] == Status.ITERATION_LIMIT  # the limit of the user is none of ours


def test_newton_steps(monkeypatch):
    """A limit of the user's beyond ours, on a case that takes more."""
    case = MAIN | {"P": [LOAD, 1e3 * LOAD], "base": "thin_layer", "rtol": 1e-9}
    for module in (adaptive, newton):
        monkeypatch.setattr(module, "newton_steps", lambda nodes: np.minimum(2, nodes))
    s = solve(Problem.of(**case, max_iterations=100_000), X)
    assert s.status.tolist() == [Status.BUDGET_SPENT] * 2 and np.isfinite(s.a).all()
    s = solve(Problem.of(**case, max_iterations=1), X)
    assert s.status.tolist() == [Status.ITERATION_LIMIT] * 2


def test_a_search_for_the_radius_ends(monkeypatch):
    """Newton on the load fails on purpose: then each radius is solved by itself, until the steps are spent."""
    case = Problem.of(P=LOAD, **MAIN, base="thin_layer", nodes=16)
    steps = []

    def failing(start, *arguments):
        found = plain(start, *arguments)
        steps.append(int(found.count.sum()))
        return found._replace(closed=found.closed & (start.cases.control == "a"))

    plain = newton.iterate
    monkeypatch.setattr(newton, "iterate", failing)
    solve(case, X)
    many = sum(steps)
    steps.clear()
    monkeypatch.setattr(newton, "newton_steps", lambda nodes: 10)
    solve(case, X)
    assert 10 <= sum(steps) < many / 2


#: On 48 nodes its error is half of that on 32, and 800 times rtol.
STUCK = {"a": 0.34, "h": 1.577e-6, "n": 1.3324e-4, "Nbar": 136520.0, "Ra": 1.62486e-4, "base": "thin_layer"}


@pytest.fixture
def meshes(monkeypatch):
    """Nodes and panels of each mesh on which Newton's method was run."""
    found, plain = [], adaptive.solve_on

    def watched(start, *arguments, **options):
        found.append((start.mesh.n, len(start.mesh.breaks) - 1))
        return plain(start, *arguments, **options)

    for module in (adaptive, panels):
        monkeypatch.setattr(module, "solve_on", watched)
    return found


def test_panels(monkeypatch, meshes):
    """The corner ends on its first panels, with last numbers; the main case beside it needs none."""
    case = Problem.of(**CORNER, base="thin_layer", rtol=1e-9)
    free, all_panels = solve(case, X), {panels for _, panels in meshes}
    meshes.clear()
    monkeypatch.setattr(adaptive, "BUDGET", 8000)
    s = solve(case, X)
    assert free.status.tolist() == [Status.CONVERGED] * 2 and len(all_panels) > 2
    assert s.status.tolist() == [Status.BUDGET_SPENT, Status.CONVERGED]
    assert {panels for _, panels in meshes} == {1, 5}
    assert s.error[0] > 1e-9 and np.isfinite(s.p).all() and s.a[1] == free.a[1]


def test_a_case_that_finer_meshes_do_not_help_goes_to_panels(meshes):
    """In company as alone: with the main case, which needs none."""
    s = solve(Problem.of(**STUCK), X)
    assert max(n for n, panels in meshes if panels == 1) == 48
    assert (s.status[0], s.nodes[0] > 96) == (Status.CONVERGED, True)
    both = {name: np.array([value, MAIN.get(name, value)]) for name, value in STUCK.items() if name != "base"}
    assert solve(Problem.of(**both, base="thin_layer"), X).D[0] == s.D[0]


def test_the_steps_of_all_meshes_are_of_the_budget(monkeypatch, meshes):
    """A case that has spent it on its first mesh ends there, with last numbers; one that converges there is right."""
    monkeypatch.setattr(adaptive, "BUDGET", 1)
    s = solve(Problem.of(**CORNER, base="thin_layer", rtol=[1e-9, 1e-2]), X)
    assert s.status.tolist() == [Status.BUDGET_SPENT, Status.CONVERGED]
    assert len(meshes) == len(set(s.nodes.tolist())) and np.isfinite(s.p).all() and s.error[0] > 1e-9


def test_a_case_without_budget_is_not_said_to_lift_off(monkeypatch):
    """That takes panels: meshes that are too coarse show tension that is not there."""
    plate = Problem.of(a=0.04, h=0.012, n=1e5, micro="smooth", base="layered")
    assert solve(plate, X).status[0] == Status.LIFT_OFF
    monkeypatch.setattr(adaptive, "BUDGET", 1)
    assert solve(plate, X).status[0] == Status.BUDGET_SPENT


@pytest.mark.parametrize("given", [{"a": 0.1}, {"P": 1e-3}])
def test_a_search_for_the_radius_takes_what_is_left_of_the_budget(monkeypatch, given):
    """Newton fails on purpose wherever there are panels, so that the radius is searched for."""
    plain, work = newton.iterate, {False: [], True: []}  # on panels, or not

    def failing(start, *arguments):
        found, panels = plain(start, *arguments), len(start.mesh.breaks) > 2
        work[panels].append(found.count[0] * start.cases.body.work(np.ones(1), start.mesh.n)[1][0])
        return found._replace(closed=found.closed & (not panels))

    monkeypatch.setattr(newton, "iterate", failing)
    case, totals = {name: value[0] for name, value in CORNER.items() if name != "a"} | given, []
    for budget in (1e6, 6000):
        work |= {False: [], True: []}
        monkeypatch.setattr(adaptive, "BUDGET", budget)
        assert solve(Problem.of(**case, base="thin_layer", rtol=1e-9), X).status[0] != Status.CONVERGED
        totals.append(sum(work[True]))
    left = 6000 - sum(work[False]) - 60**2  # 60**2: work of the first panels, on 60 nodes
    assert totals[0] > 6000 and 0 < totals[1] <= left + 150  # of the last step, which may spend a little more


def test_the_second_panels_go_on_from_the_first(monkeypatch, meshes):
    """The error of the first is raised on purpose: no mesh is made twice."""
    plain, judged = adaptive.answer, []

    def raised(iterated, *arguments, **options):
        found = plain(iterated, *arguments, **options)
        if len(iterated.at.mesh.breaks) > 2:
            judged.append(iterated.at.mesh.n)
            found.solution.error[:] = 1e-8 if len(judged) == 1 else found.solution.error
        return found

    monkeypatch.setattr(adaptive, "answer", raised)
    s = solve(Problem.of(**CORNER, base="thin_layer", rtol=[1e-9, 1e-6]), X)
    made = [grid for grid in meshes if grid[1] > 1]
    assert s.status[0] == Status.CONVERGED and len(judged) == 2 and made == sorted(set(made))


def test_work_is_more_where_more_is_computed():
    a = np.ones(1)
    film, thick = (layer_of(h=h, n=1e3, bonded=False).work(a, 96) for h in (1e-6, 0.1))
    springs = half_space(np.zeros(1)).work(a, 96)
    for of_film, of_layer, of_springs in zip(film, thick, springs, strict=True):
        assert of_film[0] > of_layer[0] > of_springs[0] > 0


def test_a_tolerance_that_no_mesh_meets_takes_no_panels(meshes):
    """The operator of a soft film is not as good as rtol: that is said on the first mesh that is as good as it, also
    at the edge that the film moves."""
    film = {"n": 1.41e-5, "nu1": 0.091, "nu2": -0.15, "bonding": "bonded"}
    s = solve(Problem.of(P=132.0, h=1.97e-9, **film, micro="smooth", rtol=1e-10), X)
    layer = layer_of(h=1.97e-9, **{name: film[name] for name in ("n", "nu1", "nu2")})
    assert s.status[0] == Status.TOLERANCE_NOT_MET and all(panels == 1 for _, panels in meshes)
    assert_allclose(s.error, layer.error(s.a, s.nodes), rtol=1e-9)
    assert np.isfinite(s.p).all() and np.isfinite(s.lam).all()


def test_a_finer_mesh_has_fewer_steps_but_never_fewer_than_newton_takes():
    assert newton_steps(np.array([6, 96])).tolist() == [1000, 1000]
    assert 60 < newton_steps(256) < 200 and newton_steps(384) == 62 and newton_steps(10_000) == 60


#: What a study holds, and the cases of a block.
BLOCKS = [
    ({}, 8000),
    ({"base": "half_space", "rtol": 1e-12}, 8000),
    ({"rtol": 1e-10}, 100),
    ({"n": 2e3}, 100),
    ({"n": 2e3, "base": "thin_layer"}, 8000),
    ({"n": 2e3, "base": "auto"}, 100),
    ({"scheme": "picard"}, 100),
    ({"scheme": "picard", "base": "thin_layer"}, 1000),
    ({"nodes": 128, "base": "half_space"}, 1000),
    ({"n": 2e3, "block": 7}, 7),
]


@pytest.mark.parametrize(("given", "size"), BLOCKS)
def test_blocks_of_slow_cases_are_small(given, size):
    """One slow value of an axis is enough; what a study says itself holds."""
    numerics = {name: given[name] for name in ("rtol", "scheme", "nodes", "block") if name in given}
    model = {"h": 0.02, "Nbar": 250000, "Ra": 0.004} | {"base": given.get("base", "layered")}
    axes = {"P": [1e-5, 2e-5], "n": [0.5, given.get("n", 0.6)]}
    made = from_tables({"model": model, "axes": axes, "numerics": numerics}, "s", "", "s.toml")
    assert made.block == size


def test_a_film_that_begins_as_a_thin_layer():
    """Its first panels are those of the thin layer; without them it spends its budget (a case of extremes_layered)."""
    film = {"h": 1.94e-7, "n": 1.55e-5, "nu1": 0.0688, "nu2": 0.369, "bonding": "bonded", "base": "layered"}
    s = solve(Problem.of(P=3.44e-6, **film, Nbar=3240.0, Ra=0.0068, asperities_on="half_space"))
    assert s.status[0] == Status.CONVERGED
