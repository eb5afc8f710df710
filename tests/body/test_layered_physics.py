"""The exact layered base as physics and as a batch: no cliff, the three controls, stiffness, energy, neighbours."""

import numpy as np
import pytest
from layered_independent import answers, fredholm, rough
from numpy.testing import assert_allclose
from solver_cases import MAIN, difference, one, random_cases

from solver import Problem, Status, solve
from solver.laws import disc_cell as micro

pytestmark = pytest.mark.usefixtures("each_path")

LAW = pytest.mark.parametrize("law", ["smooth", "disc_cell", "power_law"])
#: Material of a layer: n, nu1, nu2, bonding.
SOFT = {"n": 0.5, "nu1": 0.3, "nu2": 0.3, "bonding": "frictionless"}
HARD = {"n": 10.0, "nu1": 0.5, "nu2": 0.3, "bonding": "bonded"}
RUBBER = {"n": 1e-3, "nu1": 0.5, "nu2": 0.3, "bonding": "bonded"}
RANGES = {"P": (1e-7, 1e-3), "Ra": (5e-4, 1e-2), "NR": (0.1, 10), "n": (1e-3, 1e3), "h": (1e-3, 0.1)}
ALL = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD")
_t, _w = np.polynomial.legendre.leggauss(60)
PHI = np.pi / 4 * (_t + 1)
X, WEIGHT = np.sin(PHI), np.pi / 4 * _w * np.cos(PHI)


def layered_cases(size, seed):
    """As ``random_cases``, with Poisson ratios and layers from a thousandth to a thousand times as stiff."""
    nu1, nu2 = np.random.default_rng(seed + 1).uniform(0, 0.5, (2, size))
    return random_cases(size, seed, RANGES) | {"nu1": nu1, "nu2": nu2, "base": "layered"}


# ---- no cliff

#: Six points 1e-3 of a logarithm apart: the fourth difference of a smooth function is below 1e-10, of a jump its size.
CLUSTER = 1e-3 * (np.arange(6) - 2.5)
WATCHED = ("P", "D", "p0", "dP_dD")


def jumps(s, shape):
    """Largest fourth difference of the logarithms in each cluster, (clusters,)."""
    assert np.all(s.status == Status.CONVERGED)
    logs = np.log([np.reshape(getattr(s, name), shape) for name in WATCHED])
    return np.abs(np.diff(logs, 4, axis=-1)).max(axis=(0, 2))


@pytest.mark.parametrize(
    ("material", "law", "thinnest"), [(SOFT, "disc_cell", -9), (RUBBER, "smooth", -9), (HARD, "power_law", -6)]
)
def test_no_cliff_in_thickness(material, law, thinnest):
    """h/a from 2e-3 to 5e2 at a given radius, on one mesh: smooth at every octave, where the quadrature in k changes.

    Very thin, the operator is a difference of large terms: rounding over h/a is what is left.
    """
    eta = 2.0 ** np.arange(thinnest, 10)[:, None] * np.exp(CLUSTER)
    s = one(a=0.04, h=0.04 * eta.ravel(), base="layered", micro=law, rtol=0.9, nodes=12, **material)
    assert np.all(jumps(s, eta.shape) < 5e-11 + 1e-11 / eta[:, 0])


@pytest.mark.parametrize("bonding", ["frictionless", "bonded"])
@pytest.mark.parametrize(("eta", "stiffest"), [(0.15, 13), (3.0, 20)])
def test_no_cliff_in_stiffness(bonding, eta, stiffest):
    """n from 1e-4 at a given radius: clusters at the powers of two and where n^(1/3) is one over 3.5, so wherever the
    quadrature changes with n.

    Where a thin layer is stiffer still, the punch would lift off in the middle.
    """
    switches = np.concatenate([2.0 ** np.arange(-13, stiffest), (2.0 ** np.arange(2, stiffest // 3 + 2) / 3.5) ** 3])
    n = switches[:, None] * np.exp(CLUSTER)
    case = {"n": n.ravel(), "nu1": 0.3, "nu2": 0.2, "bonding": bonding, "base": "layered", "micro": "disc_cell"}
    s = one(a=0.04, h=0.04 * eta, rtol=0.9, nodes=24, **case)
    assert np.all(jumps(s, n.shape) < 5e-10)


@pytest.mark.parametrize("bonding", ["frictionless", "bonded"])
def test_smooth_over_decades(bonding):
    """P, D, p(0) at rtol = 1e-9 along h/a over five decades: second differences that change little."""
    eta = np.geomspace(1e-2, 1e3, 201)
    s = one(a=0.04, h=0.04 * eta, base="layered", micro="power_law", rtol=1e-9, **(SOFT | {"bonding": bonding}))
    assert np.all(s.status == Status.CONVERGED)
    for name in ("P", "D", "p0"):
        bend = np.diff(np.log(getattr(s, name)), 2)
        assert np.abs(np.diff(bend)).max() < 0.2 * np.abs(bend).max()
        assert np.abs(np.diff(bend, 2)).max() < 0.04 * np.abs(bend).max()


# ---- controls, stiffness, energy


@LAW
def test_controls_agree(law):
    """The same contact from its load, its radius and its depth, to 1e-11."""
    case = layered_cases(120, 11) | {"micro": law, "rtol": 0.5, "nodes": 24}
    case["h"] = np.maximum(case["h"], 5e-3)
    by_load = solve(Problem.of(**case))
    assert np.all(by_load.status == Status.CONVERGED)
    del case["P"]
    for control in ("a", "D"):
        found = solve(Problem.of(**case, **{control: getattr(by_load, control)}))
        assert np.all(found.status == Status.CONVERGED)
        assert difference(found, by_load, ALL).max() < 1e-11


@LAW
@pytest.mark.parametrize("material", [SOFT, HARD, RUBBER], ids=["soft", "hard", "rubber"])
def test_stiffness(law, material):
    """dP/dD against a fourth-order difference of loads at given depths."""
    D = np.array([2e-4, 1e-3])
    keep = material | {"base": "layered", "micro": law, "rtol": 1e-11, "nodes": 48}

    def load(step):
        return one(D=D * (1 + step), **keep).P

    slope = (8 * (load(1e-3) - load(-1e-3)) - (load(2e-3) - load(-2e-3))) / (12e-3 * D)
    assert_allclose(one(D=D, **keep).dP_dD, slope, rtol=1e-8, atol=0)


def energy(s, law, n):
    """Half of p times what the base yields, and p A - ∫ A dp on the asperities."""
    a, p, D = s.a[0], s.p[0], s.D[0]
    A = work = 0 * p
    if law == "power_law":
        A = MAIN["B"] * MAIN["Ra"] * (p / n) ** MAIN["beta"]
        work = p * A * MAIN["beta"] / (1 + MAIN["beta"])
    elif law == "disc_cell":  # ∫ q dg over y from 0
        p_star, A_star = micro.scales(n, MAIN["Nbar"], MAIN["Ra"])
        y, v = micro.spot_from_pressure(p / p_star), (_t + 1) / 2
        A, curve = micro.displacement(p, n, MAIN["Nbar"], MAIN["Ra"]), micro.spot_curve(y[:, None] * v)
        work = p_star * A_star * ((curve.q * curve.dg) @ _w) / 2 * y
    return 2 * np.pi * a**2 * (WEIGHT * X) @ (0.5 * p * (D - (a * X) ** 2 / 2 - A) + work)


@LAW
@pytest.mark.parametrize("material", [SOFT, HARD, RUBBER], ids=["soft", "hard", "rubber"])
def test_work_becomes_energy(law, material):
    """∫ P dD from first touch on is the elastic energy."""
    D1, keep = 1e-3, material | {"base": "layered", "micro": law, "rtol": 1e-9, "h": 0.02}
    t = 14 * (_t + 1)
    depths = D1 * np.exp(-t)
    work = 14 * _w @ (one(D=depths, **keep).P * depths)
    s = one(D=D1, x=X, **keep)
    assert np.all(s.status == Status.CONVERGED)
    assert_allclose(work, energy(s, law, material["n"]), rtol=2e-8, atol=0)
    assert_allclose(2 * np.pi * s.a[0] ** 2 * (WEIGHT * X) @ s.p[0], s.P[0], rtol=2e-8, atol=0)  # (5) on the profile


# ---- batches


def test_two_thousand_at_random():
    """All converge; some of them against the independent formulations, within the rtol that was asked."""
    size = 2000
    case = layered_cases(size, 31)
    case["micro"] = np.array(["smooth", "disc_cell", "power_law"])[np.arange(size) % 3]
    s = solve(Problem.of(**case))
    assert np.all(s.status == Status.CONVERGED)
    assert np.all(s.error <= 1e-6)
    checked = 0
    for i in np.flatnonzero((case["h"] > 0.1 * s.a) & (case["n"] < 100))[::60]:
        bonded, layer = case["bonding"][i] == "bonded", [case[name][i] for name in ("n", "nu1", "nu2")]
        a, h = s.a[i], case["h"][i]
        if case["micro"][i] == "smooth":
            unit = np.array([layer[0] * a**3, a**2, layer[0] * a])
            P, D, p0 = fredholm(h / a, *layer, bonded)[:3] * unit
            expected = [P, D, p0, p0, 1.0]  # smooth: real contact everywhere
        else:
            rest = [case[name][i] for name in ("Nbar", "Ra", "B", "beta")]
            expected = rough(48, case["micro"][i], a, h, *layer, bonded, *rest)
        assert_allclose(answers(s, i), expected, rtol=3e-6, atol=0)
        checked += 1
    assert checked > 15
