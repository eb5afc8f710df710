"""Films: the convolution at the edge against closed forms, against the full quadrature, and against Wiener and Hopf."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import gamma, jv
from solver_cases import JUDGED, MAIN, difference, layer_of

from solver import Problem, Status, solve
from solver.body import film, tables, wave_rule
from solver.body.wave_rule import CUT, FILM
from solver.kernels.closed_form import decaying_part
from solver.kernels.two_layers import SAMPLER
from solver.models.thin_layer_error import edge_shift
from solver.numerics.mesh import mesh_of, panel_mesh
from solver.rough.equation import evaluate
from solver.rough.newton import solve_on
from solver.rough.start import first_guess
from solver.scaling import as_cases, dimensionless

#: Rough contacts on films, by the whole quadrature in k: make_film_reference.py.
REFERENCE = np.genfromtxt(
    Path(__file__).parents[1] / "references" / "film_reference.csv", delimiter=",", names=True, dtype=None
)
MATERIALS = [(0.5, 0.3, False), (0.5, 0.3, True), (0.01, 0.45, True), (30.0, 0.2, True), (1e3, 0.3, False)]


def test_waves_integrate_cosines():
    """(1/π) ∫₀^∞ κ e^-κ cos(κτ) dκ/κ = 1/(π (1 + τ²)), from τ = 6e-8 to 128."""
    kappa, tau, matrix = film.waves()
    assert_allclose(matrix @ (kappa * np.exp(-kappa)), 1 / (np.pi * (1 + tau**2)), rtol=0, atol=1e-9)


@pytest.mark.parametrize("p", [1e-6, 1e-3, 1.0])
def test_transform_of_a_kernel_known_in_closed_form(p):
    """f = 1 - e^-pκ, which ends as 1: c = ln(1 + p²/τ²)/(2π) whatever the level that takes the end away."""
    kappa, tau, _ = film.waves()
    c = film.transform(-np.expm1(-p * kappa)[None], np.array([[-1.0]]), np.array([[p]]))[0]
    assert_allclose(c, np.log1p((p / tau) ** 2) / (2 * np.pi), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    "mesh", [mesh_of(5), mesh_of(24), mesh_of(96), panel_mesh(12, (0.0, 1e-4, 0.01, 0.5, 0.53125, 1.0))]
)
def test_transforms_at_all_k_of_films(mesh):
    """Sonine's integral: of s^p, 2^(p/2) Γ(1 + p/2) J_(1 + p/2)(k)/k^(1 + p/2)."""
    k = np.geomspace(1e-2, CUT, 2000)
    for p in (1, 3, min(mesh.order, 41) - 2):
        expected = 2 ** (p / 2) * gamma(1 + p / 2) * jv(1 + p / 2, k) / k ** (1 + p / 2)
        assert_allclose(tables.transform(mesh, k) @ mesh.s**p, expected, rtol=0, atol=1e-14)


def test_the_convolution_on_narrow_panels():
    """Of pressures that jump from panel to panel, for c = e^-τ: against a rule of many points on every panel."""
    mesh, cut = panel_mesh(4, (0.0, 0.01, 0.02, 0.03, 0.05, 0.1, 1.0)), 1000.0
    points = mesh.s[[0, 5, 11, 15]]
    _, tau, _ = film.waves()
    found = film.convolution(mesh, points, cut).of(np.exp(-tau)[None])[0]
    halves = 2.0 ** np.arange(-40, 0)  # towards every end, and every point
    fine = np.unique(np.concatenate([low + (high - low) * np.array([*halves, *(1 - halves)]) for low, high in
                                     pairwise(np.unique([*mesh.breaks, *points]))]))  # fmt: skip
    t, w = np.polynomial.legendre.leggauss(12)
    s = (fine[:-1, None] + np.diff(fine)[:, None] * (t + 1) / 2).ravel()
    w, x, at = (np.diff(fine)[:, None] * w / 2).ravel(), np.sqrt(1 - s**2), np.sqrt(1 - points**2)[:, None]
    kernel = np.exp(-cut * np.abs(x - at)) * (np.abs(x - at) * cut < film.REACH) * s / np.sqrt(x * at)
    assert_allclose(found, (w * kernel) @ mesh.basis(s), rtol=0, atol=1e-10 * np.abs(found).max())


def test_a_panel_whose_rule_lies_beyond_the_reach():
    """Its near end is within reach, no point of the rule is: nothing is felt of it, and all of the others."""
    mesh = panel_mesh(4, (0.0, 0.1, 0.2, 0.3, 0.35, 1.0))
    cut = 0.9999 * film.REACH / (1 - np.sqrt(1 - 0.3**2))
    found = film.convolution(mesh, np.zeros(1), cut).of(np.ones((1, len(film.waves()[1]))))[0, 0]
    assert np.all(found[12:] == 0) and np.all(found.reshape(5, 4)[:3].sum(axis=1) > 0)


@pytest.mark.parametrize(("n", "h"), [(8.6e5, 5.6e-5), (1e5, 5e-6)])
def test_a_stiff_film_rings_at_the_edge_and_does_not_lift_off(n, h):
    """The pressure of a film of 5 to 56 millionths of the radius, on meshes that share no panel there: 2e-3 of p(0).

    They differ by 0.92e-3 under OPENBLAS_CORETYPE=Haswell and by 1.04e-3 under Nehalem: rounding counts n times."""
    case = {"a": 1.0, "R": 20.0, "h": h, "n": n, "base": "layered", "micro": "smooth"}
    cases = as_cases(dimensionless(Problem.of(**case)))
    s = np.sqrt(2 * h * np.geomspace(0.1, 20, 40))
    pressures = []
    for width in (0.8, 0.65):
        ends = np.arange(0, 0.999 * s[-1] + width * np.sqrt(h), width * np.sqrt(h))
        mesh = panel_mesh(12, (*ends, *np.geomspace(ends[-1], 1.0, 9)[1:]))
        with np.errstate(divide="ignore"):
            found = solve_on(evaluate(cases, first_guess(cases, mesh), mesh), 60)
        assert found.closed[0]
        pressures.append(mesh.basis(s) @ found.at.state.y[0] / found.at.state.y[0, -1])
    assert np.all(pressures[0] > 0)
    assert pressures[0].max() > 4 * pressures[0][-1]
    assert_allclose(*pressures, rtol=0, atol=2e-3)


@pytest.mark.parametrize(("n", "nu", "bonded"), MATERIALS)
def test_the_convolution_replaces_the_rest_of_the_quadrature(n, nu, bonded):
    """At h/a = 2^-8.5, with the half-space and all k to the end of the kernel: 1e-8 of the displacement."""
    eta, mesh = 2.0**-8.5, mesh_of(16)
    layer = layer_of(h=eta, n=n, nu1=nu, bonded=bonded)
    found = layer.at(np.ones(1), mesh)
    assert found.parts[0].octave[0] == FILM
    k, weight = wave_rule.quadrature(FILM, found.parts[0].stiffness)
    W = weight * decaying_part(k * eta, n, nu, 0.3, np.array(bonded))[0]
    table = tables.table(mesh, SAMPLER, FILM, found.parts[0].stiffness, True)
    whole = (table.J[:, :-1] * W[:, None]).T @ table.phi
    assert np.abs(decaying_part(np.array([CUT * eta]), n, nu, 0.3, np.array([bonded]))[0][0]) < 1e-5  # all of L - 1
    K = found.K[0]
    for q in (mesh.s, mesh.s**3):
        found = K @ q
        expected = mesh.K @ q + np.pi / 2 * whole @ q
        assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize("row", REFERENCE)
@pytest.mark.parametrize("rtol", [1e-6, 1e-8])
def test_the_error_of_rough_films_covers_their_convolution(row, rtol):
    """At 1e-8 it is what is left of the error, up to 1.6e-8, and no finer mesh takes it away."""
    given = {name: row[name] for name in ("micro", "bonding", "h", "n", "nu1", "nu2", "Nbar", "Ra")}
    given["asperities_on"] = "half_space"  # as in the reference
    found = solve(Problem.of(a=0.04, B=0.3, beta=0.5, base="layered", rtol=rtol, **given))
    truth = max(abs(getattr(found, name)[0] / row[name] - 1) for name in ("P", "D", "p0", "p_max", "Ar_An"))
    assert truth < found.error[0]
    assert found.status[0] == (Status.CONVERGED if rtol == 1e-6 else Status.TOLERANCE_NOT_MET)


@pytest.mark.parametrize(("n", "nu", "bonded"), MATERIALS[:3])
def test_a_film_shifts_the_edge_as_wiener_and_hopf_say(n, nu, bonded):
    """Under one load a_thin - a → κ h for h << a: another formulation of the edge, in closed form."""
    h = np.array([3e-6, 1e-5])
    case = {"P": 1e-3, "h": h, "n": n, "nu1": nu, "bonding": "bonded" if bonded else "frictionless", "micro": "smooth"}
    thin, film_ = (solve(Problem.of(**case, base=base, rtol=1e-9)) for base in ("thin_layer", "layered"))
    assert np.all(film_.a * 2.0**FILM > h)
    kappa = edge_shift(n, nu, 0.3, bonded)
    assert_allclose((thin.a - film_.a) / h, kappa, rtol=0.02, atol=2e-3)


@pytest.mark.parametrize("law", ["smooth", "disc_cell", "power_law"])
@pytest.mark.parametrize("bonding", ["frictionless", "bonded"])
def test_no_cliff_where_films_begin(law, bonding):
    """The two sides of h/a = 2^-8 differ by the thickness alone."""
    h = 0.04 * 2.0**-8 * (1 + np.array([-2e-9, 2e-9]))
    s = solve(Problem.of(**(MAIN | {"h": h}), a=0.04, base="layered", micro=law, bonding=bonding, rtol=1e-9))
    assert np.all(np.isfinite(s.P))
    for name in JUDGED:
        low, high = getattr(s, name)
        assert abs(high / low - 1) < 1e-7


def test_films_of_any_thinness():
    """From h/a = 2^-8 to 1e-9: converged, and ever nearer to the thin layer."""
    h = 0.04 * np.array([1e-3, 1e-4, 1e-5, 1e-7, 1e-9])
    case = MAIN | {"h": h, "a": 0.04, "micro": "disc_cell", "asperities_on": "half_space"}  # as thin layers have them
    thin, found = (solve(Problem.of(**case, base=base)) for base in ("thin_layer", "layered"))
    assert np.all(found.status == Status.CONVERGED)
    gap = difference(thin, found)
    assert np.all(gap < 2 * h / 0.04 + 2e-6)
