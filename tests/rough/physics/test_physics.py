"""Physics of the solutions: equilibrium, Eq. (14), energy, stiffness, units, controls."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import ALL_KINDS, KINDS, LOAD, MAIN, ROUGH, ROUGH_KINDS, difference, one, random_cases

from solver import Problem, solve
from solver.laws import disc_cell as micro

pytestmark = pytest.mark.usefixtures("each_path")

_t, _w = np.polynomial.legendre.leggauss(80)
#: x = sin φ with a rule of its own in φ: ∫ f dx = (WEIGHT cos φ) @ f.
PHI = np.pi / 4 * (_t + 1)
X, WEIGHT = np.sin(PHI), np.pi / 4 * _w * np.cos(PHI)

kinds = pytest.mark.parametrize(("base", "law"), KINDS, ids=["-".join(kind) for kind in KINDS])
all_kinds = pytest.mark.parametrize(("base", "law"), ALL_KINDS, ids=["-".join(kind) for kind in ALL_KINDS])
rough_kinds = pytest.mark.parametrize(("base", "law"), ROUGH_KINDS, ids=["-".join(kind) for kind in ROUGH_KINDS])


@all_kinds
def test_equilibrium(base, law):
    """Eq. (5) by another quadrature, on the profile between the nodes."""
    s = one(P=LOAD, base=base, micro=law, rtol=1e-11, x=X)
    load = 2 * np.pi * s.a[0] ** 2 * (WEIGHT * X) @ s.p[0]
    assert_allclose(load, LOAD, rtol=2e-10, atol=0)


@kinds
def test_depth_at_the_centre(base, law):
    """Eq. (14), where the solver has D from the edge; A1/E1* = 1/E2*."""
    s = one(P=LOAD, base=base, micro=law, rtol=1e-11, x=X)
    C = MAIN["h"] / MAIN["n"] if base == "thin_layer" else 0.0
    centre = 2 * s.a[0] * WEIGHT @ s.p[0] + C * s.p0[0] + s.A0[0]
    assert_allclose(centre, s.D[0], rtol=1e-9, atol=0)


@rough_kinds
def test_outputs_are_those_of_the_micro_law(base, law):
    """A[p(0)], p_max (13), λ (11) and Ar/An (12) again from the pressure, by the public functions."""
    s = one(P=LOAD, base=base, micro=law, rtol=1e-11, x=np.append(X, 0.0))
    scene = (MAIN["n"] if base == "thin_layer" else 1.0, MAIN["Nbar"], MAIN["Ra"])
    assert_allclose(s.p[0, -1], s.p0[0], rtol=1e-9, atol=0)
    assert_allclose(micro.largest_pressure(s.p0, *scene), s.p_max, rtol=1e-12, atol=0)
    assert_allclose(micro.contact_fraction(s.p, *scene), s.lam, rtol=1e-12, atol=0)
    A0 = micro.displacement(s.p0, *scene) if law == "disc_cell" else 0.1 * MAIN["Ra"] * (s.p0 / scene[0]) ** 0.5
    assert_allclose(s.A0, A0, rtol=1e-12, atol=0)
    assert_allclose(2 * (WEIGHT * X) @ s.lam[0, :-1], s.Ar_An[0], rtol=1e-8, atol=0)


@all_kinds
def test_profiles(base, law):
    """Pressure falls to zero at the edge; there it has the exponent of its law."""
    x = np.concatenate([np.linspace(0, 0.999, 400), 1 - np.geomspace(1e-4, 1e-8, 5), [1.0]])
    s = one(P=LOAD, base=base, micro=law, rtol=1e-9, x=x)
    p, lam = s.p[0], s.lam[0]
    assert p[-1] == 0
    assert np.all(np.diff(p) < 0)
    if law != "smooth":
        assert lam[-1] == 0
        assert np.all(np.diff(lam) < 0)
        assert np.all((lam >= 0) & (lam < 1))
        exponent = {"disc_cell": 1.5, "power_law": 1 / MAIN["beta"]}[law]
        assert_allclose(np.log10(p[-5:-2] / p[-4:-1]), exponent, rtol=0, atol=0.03)


def energy(s, base, law):
    """Elastic energy: half of p times what the base yields, and the work on the asperities, p A - ∫ A dp per area."""
    a, p, D = s.a[0], s.p[0], s.D[0]
    n = 1.0 if base == "half_space" else MAIN["n"]
    y = micro.spot_from_pressure(p / micro.scales(n, MAIN["Nbar"], MAIN["Ra"])[0])
    if law == "smooth":
        A = work = 0 * p
    elif law == "power_law":
        A = MAIN["B"] * MAIN["Ra"] * (p / n) ** MAIN["beta"]
        work = p * A * MAIN["beta"] / (1 + MAIN["beta"])
    else:  # ∫ q dg over y from 0, the nodes of a rule scaled to each pressure
        p_star, A_star = micro.scales(n, MAIN["Nbar"], MAIN["Ra"])
        A = micro.displacement(p, n, MAIN["Nbar"], MAIN["Ra"])
        v = (_t + 1) / 2
        curve = micro.spot_curve(y[:, None] * v)
        work = p_star * A_star * ((curve.q * curve.dg) @ _w) / 2 * y
    base_yields = D - (a * X) ** 2 / 2 - A
    return 2 * np.pi * a**2 * (WEIGHT * X) @ (0.5 * p * base_yields + work)


@all_kinds
def test_work_becomes_energy(base, law):
    """∫ P dD from first touch on = elastic energy; P(D) by depth control, 12 decades of D."""
    D1 = 1e-3
    t = 14 * (_t + 1)
    depths = D1 * np.exp(-t)
    loads = one(D=depths, base=base, micro=law, rtol=1e-10).P
    work = 14 * _w @ (loads * depths)
    s = one(D=D1, base=base, micro=law, rtol=1e-10, x=X)
    assert_allclose(work, energy(s, base, law), rtol=3e-9, atol=0)


@all_kinds
def test_stiffness(base, law):
    """dP/dD against a central difference, and ∫ (dP/dD) dD = P(D2) - P(D1)."""
    D = np.array([3e-4, 1e-3])
    keep = {"base": base, "micro": law, "rtol": 1e-11}
    step = 1e-4 * D
    difference_ = (one(D=D + step, **keep).P - one(D=D - step, **keep).P) / (2 * step)
    assert_allclose(one(D=D, **keep).dP_dD, difference_, rtol=1e-7, atol=0)
    t, w = np.polynomial.legendre.leggauss(16)
    depths = D[0] + (D[1] - D[0]) * (t + 1) / 2
    rise = (D[1] - D[0]) / 2 * w @ one(D=depths, **keep).dP_dD
    ends = one(D=D, **keep).P
    assert_allclose(rise, ends[1] - ends[0], rtol=1e-10, atol=0)


#: Units R and E2*, up to where the numbers of the case can still be written.
UNITS = np.array([(7.3, 2.1e11), (1e-9, 1e12), (1e9, 1e-9), (1e-100, 1e30), (1e140, 1e-3), (1e-150, 1.0), (1e150, 1.0),
                  (1.0, 1e-300), (1.0, 1e300), (1e-140, 1e290), (1e140, 1e-290)])  # fmt: skip
HARD = {"n": 10.0, "nu1": 0.5, "bonding": "bonded"}
SCALED = [(base, law, {}) for base, law in ALL_KINDS] + [("layered", law, HARD) for law in (*ROUGH, "smooth")]


@pytest.mark.parametrize(("base", "law", "layer"), SCALED, ids=str)
@pytest.mark.parametrize(("control", "value", "power"), [("P", LOAD, 2), ("D", 1e-3, 1)])
def test_scaling(base, law, layer, control, value, power):
    """R and E2* of any size and unit give the same dimensionless answer."""
    R, E2 = UNITS.T
    case = {"micro": law, "base": base} | MAIN | layer
    reference = one(**case, **{control: value}, x=X[::9])
    case |= {"h": MAIN["h"] * R, "Ra": MAIN["Ra"] * R, "Nbar": MAIN["Nbar"] / R / R, "R": R, "E2": E2}
    s = solve(Problem.of(**case, **{control: value * R**power * (E2 if control == "P" else 1.0)}), X[::9])
    assert np.all(s.status == 0)
    units = {"a": R, "D": R, "A0": R, "P": R * E2 * R, "dP_dD": R * E2} | dict.fromkeys(("p0", "p_max"), E2)
    units |= {"Ar_An": 1, "lam": 1, "p": E2[:, None]}
    for name, unit in units.items():
        found, expected = getattr(s, name) / unit, getattr(reference, name)
        assert_allclose(found, np.broadcast_to(expected, found.shape), rtol=1e-12, atol=0, err_msg=name)


@pytest.mark.parametrize("law", ROUGH)
def test_similarity(law):
    """Six parameters are three: another n, h, Ra, Nbar and load with the same X, Y, Z has the same profile."""
    factor, n = 3.0, 0.2  # a is `factor` times as large, n is 0.2 instead of 0.5
    # X ~ p*/a, Y ~ C p*/a², Z ~ A*/a²: p* and C grow by `factor`, A* by its square;
    # exact law: p* ~ n B̄/Ra, A* ~ B̄²/Ra
    soft = n / MAIN["n"]
    cell, Ra = factor * soft, soft**2
    case = {"n": n, "h": MAIN["h"] * factor * soft, "Nbar": MAIN["Nbar"] / cell**2, "Ra": MAIN["Ra"] * Ra}
    if law == "power_law":  # A = B Ra (p/n)^β
        case["B"] = MAIN["B"] * factor**2 / Ra / (factor / soft) ** MAIN["beta"]
    first = one(P=LOAD, micro=law, rtol=1e-10, x=X)
    second = one(P=LOAD * factor**3, micro=law, rtol=1e-10, x=X, **case)
    for name, unit in {"a": factor, "D": factor**2, "A0": factor**2, "p0": factor, "p": factor}.items():
        assert_allclose(getattr(second, name) / unit, getattr(first, name), rtol=1e-9, atol=1e-13, err_msg=name)


@all_kinds
def test_controls_agree(base, law):
    """The same contact from its load, its radius and its depth, over the ranges of the paper."""
    case = random_cases(200, 5) | {"base": base, "micro": law, "rtol": 0.5, "nodes": 32}
    by_load = solve(Problem.of(**case))
    assert np.all(by_load.status == 0)
    del case["P"]
    names = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD")
    for control in ("a", "D"):
        found = solve(Problem.of(**case, **{control: getattr(by_load, control)}))
        assert np.all(found.status == 0)
        assert difference(found, by_load, names).max() < 1e-11
