"""The convergence maps of the successive approximations: size of the cycle, lines of the linear theory, the figure."""

import numpy as np
import pytest
import xarray as xr
from conftest import opened
from drawn import frame, legend, lines, ticks
from drawn import mesh as drawn_mesh
from matplotlib.colors import to_hex
from numpy.testing import assert_allclose
from solver_cases import MAIN

from solver import Problem, Status, solve
from solver.numerics.mesh import mesh_of
from solver.rough import picard
from solver.scaling import as_cases, dimensionless
from study.studies.evidence.picard_domain import LARGEST, MAPS, SHARES, cycle_size, theory
from study.studies.paper.uniform import uniform_mesh

CASE = (
    {"a": 0.04} | {name: MAIN[name] for name in ("n", "Nbar", "Ra", "B")} | {"base": "thin_layer", "micro": "power_law"}
)


def approximations(k, count, nodes=32, **case):
    problem = Problem.of(**(CASE | {"beta": 0.5, "h": 0.02} | case), k=k, nodes=nodes)
    cases = as_cases(dimensionless(problem))
    return picard.approximate(cases, np.log(cases.value), mesh_of(nodes), problem.k, np.zeros(1), count).at


def part_of(h, beta: float, **changes) -> xr.Dataset:
    """One map of the study, for the largest k alone, with converged pressures."""
    case = CASE | {"beta": beta} | changes
    p0 = solve(Problem.of(**case, h=h, rtol=1e-9)).p0
    return xr.Dataset({"p0": (("k", "h"), p0[None])}, {"h": h} | case)


def test_the_largest_eigenvalue_is_that_of_the_operator():
    """Of any mesh that resolves a parabola."""
    for nodes in (16, 32, 64):
        # an eigenvalue to rounding
        assert_allclose(np.linalg.eigvals(mesh_of(nodes).K).real.max(), LARGEST, rtol=1e-10)
    # piecewise linear: an error of second order
    assert_allclose(np.linalg.eigvals(uniform_mesh(80).K).real.max(), LARGEST, rtol=1e-4)


def test_size_of_the_cycle_is_that_of_the_next_change():
    k = 2.0
    s = solve(Problem.of(**CASE, beta=0.5, h=0.02, scheme="picard", k=k, nodes=32, rtol=1e-9, max_iterations=4))
    one = (("k", "h"), np.array([[s.residual[0]]])), (("k", "h"), np.array([[s.p0[0]]]))
    part = xr.Dataset({"residual": one[0], "p0": one[1]}, {"h": [0.02], "k": [k], "a": 0.04, "n": 0.5})
    assert_allclose(cycle_size(part)[0, 0], approximations(k, 5).change[0], rtol=0.02)


def test_above_the_line_the_whole_contact_settles_and_below_it_swings():
    """Asperities hardly yield: only the half-space part decides."""
    h = np.array([0.002, 0.01])
    whole, *_ = theory(part_of(h, 0.5, B=1e-6))
    for thickness, edge in zip(h, whole, strict=True):
        above, below = (approximations((factor * edge - 1) / 2, 2000, h=thickness, B=1e-6) for factor in (1.1, 0.9))
        assert above.load_change[0] < 1e-6 < 1e-2 < below.load_change[0]


def test_lines_of_the_asperities_are_the_slope_of_their_law():
    h, beta = np.array([0.02]), 0.5
    _, *edges = theory(part_of(h, beta))
    p0 = solve(Problem.of(**CASE, beta=beta, h=0.02)).p0
    for share, edge in zip(SHARES, edges, strict=True):
        p = share * p0 * np.array([1 - 1e-6, 1 + 1e-6])
        A = CASE["B"] * CASE["Ra"] * (p / CASE["n"]) ** beta
        assert_allclose(edge, np.diff(A) / np.diff(p) / (2 * h), rtol=1e-6)


def test_pressures_below_the_line_cycle_and_those_above_do_not():
    """k = 0: A'(p) = C at p = 5e-5 E2*; one decade below all nodes swing, one above none."""
    problem = Problem.of(**CASE, beta=0.5, h=0.02, rtol=1e-9)
    mesh = mesh_of(64)
    solution = solve(problem, mesh.x).p[0]
    critical = (0.5 * CASE["B"] * CASE["Ra"] / CASE["n"] ** 0.5 / 0.04) ** 2
    first, second = (approximations(0.0, count, nodes=64).q[0] * CASE["n"] for count in (1000, 1001))
    swing = np.abs(first - second)
    assert (swing[solution < 0.1 * critical] > 0.5 * solution[solution < 0.1 * critical]).all()
    assert (swing[solution > 10 * critical] < 1e-2 * solution[solution > 10 * critical]).all()


def test_the_study_holds_cycles_and_answers(results):
    found = opened(results / "picard_domain.nc")
    status = found["status"].values
    assert set(np.unique(status)) <= {
        Status.CONVERGED,
        Status.ITERATION_LIMIT,
        Status.LIMIT_CYCLE,
        Status.TOLERANCE_NOT_MET,
    }
    assert (status == Status.LIMIT_CYCLE).any()
    for beta, nodes in MAPS:
        size = cycle_size(found.sel(beta=beta, nodes=nodes).transpose("k", "h", ...))
        assert size[-1, -1] < 1e-3 < size[0, 0], "large k and C against small ones"


@pytest.mark.parametrize("k", [0.0, 1.0, 5.0])
def test_the_cycle_shrinks_with_k_as_the_map_says(k):
    assert approximations(2 * k + 1, 2000).change[0] < approximations(k, 2000).change[0]


MAPPED = {  # title -> β, nodes, in the order of the panels
    r"$\beta = 0.5$, 16 nodes": (0.5, 16),
    r"$\beta = 0.5$, 32 nodes": (0.5, 32),
    r"$\beta = 0.5$, 64 nodes": (0.5, 64),
    r"$\beta = 0.4$, 32 nodes": (0.4, 32),
    r"$\beta = 2/3$, 32 nodes": (0.6667, 32),
}
WORDS = ("small errors of the whole contact die above this line", "all of the pressure swings")
SLOPES = (r"$A'(p) = (1 + 2k)\,C$ at $p = 10^{-2}\,p(0)$", r"$A'(p) = (1 + 2k)\,C$ at $p = 10^{-4}\,p(0)$")


def sizes(found, beta: float, nodes: int) -> np.ndarray:
    """Largest |p̂ - p|/p(0) over (k, h): C |p̂ - p| is the residual times a²/2, with C = h/n."""
    part = found.sel(beta=beta, nodes=nodes).transpose("k", "h", ...)
    with np.errstate(divide="ignore"):
        return part.residual.values * 0.04**2 / 2 / (part.h.values / 0.5) / part.p0.values


def test_maps_show_the_size_of_the_cycle(drawing, results):
    figure, columns, _ = drawing("picard_domain")
    found = opened(results / "picard_domain.nc")
    C, k = 2 * found.h.values, found.k.values
    parts = []
    for axes, (title, (beta, nodes)) in zip(figure.axes, MAPPED.items(), strict=False):
        size = sizes(found, beta, nodes)
        image = drawn_mesh(axes)
        drawn = image.get_array().reshape(size.shape)
        np.testing.assert_array_equal(np.ma.getmaskarray(drawn), (size >= 0.1) | ~np.isfinite(size))
        known = ~np.ma.getmaskarray(drawn)
        assert known.any()
        assert_allclose(drawn[known], np.maximum(size[known], 1e-8), rtol=1e-12)  # as drawn
        assert_allclose(image.norm.boundaries, 10.0 ** np.arange(-8, 0), rtol=1e-12)  # powers of ten
        corners = image.get_coordinates()
        assert all((corners[0, i, 0] < C[i] < corners[0, i + 1, 0]) for i in range(len(C)))
        assert all((corners[i, 0, 1] < 1 + 2 * k[i] < corners[i + 1, 0, 1]) for i in range(len(k)))
        assert to_hex(axes.get_facecolor()) == legend(figure.legends[0])[WORDS[1]]
        ylabel = "$1 + 2k$" if title in (r"$\beta = 0.5$, 16 nodes", r"$\beta = 0.4$, 32 nodes") else ""
        assert frame(axes) == (r"$C\,E_2^*/R$", "log", ylabel, "log", title)
        assert axes.get_xlim() == (C[0], C[-1]) and axes.get_ylim() == (1, 1 + 2 * k[-1])
        assert ticks(axes) == (["0.01", "0.1"], ["1", "10", "100"])
        same = np.full(size.shape, beta), np.full(size.shape, nodes), *np.meshgrid(C, k)
        parts.append([values[np.isfinite(size)] for values in (*same, size, status_of(found, beta, nodes))])
    expected = [np.concatenate(column) for column in zip(*parts, strict=True)]
    assert list(columns) == ["beta", "nodes", "C", "k", "cycle/p(0)", "status"]
    for values, column in zip(expected, columns.values(), strict=True):
        assert_allclose(column, values, rtol=1e-12)  # as drawn, written with all digits


def status_of(found, beta: float, nodes: int) -> np.ndarray:
    return found.status.sel(beta=beta, nodes=nodes).transpose("k", "h").values


def test_lines_of_the_maps_are_those_of_the_theory(drawing, results):
    figure, _, _ = drawing("picard_domain")
    h = opened(results / "picard_domain.nc").h.values
    entries = legend(figure.legends[0])
    assert list(entries) == [WORDS[0], WORDS[1], *SLOPES]
    for axes, (beta, _) in zip(figure.axes, MAPPED.values(), strict=False):
        for line, values, words in zip(lines(axes), theory(part_of(h, beta)), (WORDS[0], *SLOPES), strict=True):
            assert_allclose(line.x, 2 * h, rtol=1e-14)  # one product
            assert_allclose(line.y, values, rtol=1e-6)  # p(0) of the study ends at 1e-6
            assert line.look == entries[words]
    assert len({line.look.dashes for line in lines(figure.axes[0])}) == 3
    bar = figure.axes[6]
    assert bar.get_ylabel() == r"largest $|\hat p - p|\,/\,p(0)$ after 2000 approximations"
    assert_allclose(bar.get_yticks(), [1e-8, 1e-6, 1e-4, 1e-2], rtol=1e-12)  # powers of ten


def test_two_iterates_are_drawn_about_the_solution(drawing):
    figure, _, _ = drawing("picard_domain")
    axes, mesh = figure.axes[5], mesh_of(64)
    first, second, solution = lines(axes)
    shown = mesh.x > 0.97
    for line, count in ((first, 1000), (second, 1001)):
        assert line.label == f"iterate {count}"
        assert_allclose(line.x, mesh.x[shown], rtol=1e-9)  # ten digits in the file
        iterate = CASE["n"] * approximations(0.0, count, nodes=64).q[0]
        assert_allclose(line.y, 1e3 * iterate[shown], rtol=1e-7, atol=1e-9)  # cycles amplify rounding
    exact = solve(Problem.of(**CASE, beta=0.5, h=0.02, rtol=1e-9, nodes=64), mesh.x[shown])
    assert solution.label == "solution" and solution.x[0] > 0.9999 and solution.x[-1] < 0.985
    assert_allclose(solution.y, 1e3 * exact.p[0], rtol=1e-8, atol=1e-12)
    assert list(legend(axes.get_legend())) == ["iterate 1000", "iterate 1001", "solution"]
    assert frame(axes)[0::2] == ("$r/a$", r"$10^3\,p/E_2^*$", r"$k = 0$, $\beta = 0.5$, 64 nodes, $C = 0.04$")
    inside = np.interp(0.985, solution.x[::-1], solution.y[::-1])
    assert axes.get_xlim() == (0.985, 1.0005) and axes.get_ylim() == (0, pytest.approx(1.15 * inside, rel=1e-3))
