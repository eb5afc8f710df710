"""The exact layered base as physics and as a batch: no cliff, the three controls, stiffness, energy, neighbours."""

import numpy as np
import pytest
from layered_independent import answers, fredholm, rough
from numpy.testing import assert_allclose, assert_array_equal
from solver_cases import LOAD, MAIN, difference, one, random_cases

from solver import Problem, Status, solve
from solver.laws import disc_cell as micro

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


@LAW
def test_scaling(law):
    """R and E2* of any size give the same dimensionless answer."""
    R, E2 = 7.3e-3, 2.1e11
    reference = one(P=LOAD, base="layered", micro=law, x=X[::9], **HARD)
    case = MAIN | HARD | {"h": MAIN["h"] * R, "Ra": MAIN["Ra"] * R, "Nbar": MAIN["Nbar"] / R / R, "R": R, "E2": E2}
    s = solve(Problem.of(P=LOAD * R * R * E2, base="layered", micro=law, **case), X[::9])
    units = {
        "a": R,
        "D": R,
        "A0": R,
        "P": R * R * E2,
        "dP_dD": R * E2,
        "p0": E2,
        "p_max": E2,
        "p": E2,
        "Ar_An": 1,
        "lam": 1,
    }
    for name, unit in units.items():
        assert_allclose(getattr(s, name) / unit, getattr(reference, name), rtol=1e-12, atol=0, err_msg=name)


# ---- batches


def test_mixed_batch_is_its_single_cases():
    """Bases, laws, bondings, meshes and octaves of h/a in one batch, against one case at a time."""
    size, rng = 36, np.random.default_rng(8)
    case = random_cases(size, 8) | {"nu1": rng.uniform(0, 0.4, size), "nu2": rng.uniform(0.1, 0.5, size)}
    case["h"] = np.maximum(case["h"], 5e-3)
    case["base"] = np.array(["layered", "thin_layer", "layered", "half_space"])[np.arange(size) % 4]
    case["micro"] = np.array(["smooth", "disc_cell", "power_law"])[np.arange(size) % 3]
    case["rtol"] = np.where(np.arange(size) % 5 == 0, 1e-8, 1e-5)
    problem = Problem.of(**case)
    together = solve(problem)
    for i in range(size):
        alone = solve(problem.take(np.array([i])))
        assert alone.status[0] == together.status[i]
        for name in (*ALL, "A0"):
            assert_allclose(getattr(alone, name)[0], getattr(together, name)[i], rtol=1e-12, atol=0, err_msg=name)


def test_poisoned_neighbours():
    """Cases that cannot be solved, of every kind, do not touch those beside them."""
    size = 40
    good = layered_cases(size, 21) | {"micro": np.where(np.arange(size) % 2, "disc_cell", "smooth")}
    good["h"] = np.maximum(good["h"], 5e-3)
    bad, hurt = {k: np.array(v) for k, v in good.items() if k != "base"}, np.arange(0, size, 4)
    poison = [
        ("P", np.nan),
        ("h", np.inf),
        ("n", -1.0),
        ("nu1", 0.7),
        ("P", 0.0),
        ("Ra", np.nan),
        ("h", 0.0),
        ("n", np.nan),
    ]
    for i, (name, value) in zip(hurt, poison * 2, strict=False):
        bad[name][i] = value
    clean, found = solve(Problem.of(**good)), solve(Problem.of(**bad, base="layered"))
    healthy = np.setdiff1d(np.arange(size), hurt)
    spoiled = [i for i in hurt if not (bad["micro"][i] == "smooth" and np.isnan(bad["Ra"][i]))]  # smooth needs no Ra
    assert_array_equal(found.status[spoiled], Status.INVALID_INPUT)
    assert np.all(np.isnan(found.a[spoiled]))
    assert np.all(found.status[healthy] == Status.CONVERGED)
    for name in ALL:
        assert_allclose(getattr(found, name)[healthy], getattr(clean, name)[healthy], rtol=1e-12, atol=0)


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
