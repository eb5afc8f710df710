"""Contacts that stick, after Johnson, Kendall and Roberts, against another code in long double, and by energy."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rows import SMOOTH, material, rows, shape

from solver import Problem, Status, solve
from solver.smooth.adhesion import pull

ROWS, SHAPES = rows("given_jkr.csv"), rows("given_jkr_shapes.csv")
HALF_SPACE = {"base": "half_space", "w_adhesion": 1e-4} | SMOOTH
PULL = np.pi * 1e-4


@pytest.mark.parametrize("row", ROWS, ids=[f"{row['case']:g}" for row in ROWS])
def test_another_code(row):
    """P(a), D(a), p(0) 1e-9 by a, P and D, on both branches; pull-off 1e-8, its radius 1e-6: what is asked for."""
    case = material(row) | {"m": row["m"], "w_adhesion": row["w"], "rtol": 1e-9} | SMOOTH
    for control, index in [(control, index) for control in "aPD" for index in "123"]:
        pull = "D" if control == "D" else "P"
        stable = row[f"a{index}"] >= row[f"a_pull_{pull}"]
        branch = "stable" if stable else "unstable"
        contact = solve(Problem.of(**{control: row[control + index]}, **case, branch=branch))
        assert contact.status == Status.CONVERGED and contact.stable == stable
        for name in "aPD":
            assert_allclose(getattr(contact, name), row[name + index], rtol=1e-9, atol=0)
        assert_allclose(contact.p0, row[f"p0_{index}"], rtol=1e-9, atol=0)
        assert contact.p[0, 1] == -np.inf
        assert_allclose(contact.P_off, row[f"P_pull_{pull}"], rtol=1e-8, atol=0)
        assert_allclose(contact.D_off, row[f"D_pull_{pull}"], rtol=1e-8, atol=0)
        assert_allclose(contact.a_off, row[f"a_pull_{pull}"], rtol=1e-6, atol=0)


@pytest.mark.parametrize("row", SHAPES, ids=[f"{row['case']:g} {row['shape']}" for row in SHAPES])
def test_other_shapes(row):
    """1e-9; the rows of flat punches are their pull-off."""
    case = shape(row) | material(row) | {"w_adhesion": row["w"], "rtol": 1e-9} | SMOOTH
    flat = row["shape"] == "flat"
    value = {"P": row["P"] * (1 - 1e-12)} if flat else {"a": row["a"]}
    contact = solve(Problem.of(**value, **case), x=[0.5, 1])
    assert contact.status == Status.CONVERGED
    load, depth = (contact.P_off, contact.D_off) if flat else (contact.P, contact.D)
    assert_allclose([load[0], depth[0], contact.p[0, 0]], [row["P"], row["D"], row["p_half_a"]], rtol=1e-9, atol=0)
    assert contact.p[0, 1] == -np.inf


def test_half_space():
    """a³ = (3/(4E)) [P + 3π w + sqrt(6π w P + (3π w)²)]; P_off = -1.5 π w; rounding."""
    P = np.array([-1.4, -0.5, 0.0, 10.0]) * PULL
    contact = solve(Problem.of(P=P, **HALF_SPACE))
    cube = 0.75 * (P + 3 * PULL + np.sqrt(6 * PULL * P + 9 * PULL**2))
    assert np.all(contact.status == Status.CONVERGED) and contact.stable.all()
    assert_allclose(contact.a**3, cube, rtol=1e-10, atol=0)
    assert_allclose(contact.P_off, -1.5 * PULL, rtol=1e-12, atol=0)
    assert_allclose(contact.a_in**3, 4.5 * PULL, rtol=1e-12, atol=0)
    assert np.all(contact.P_in == 0)
    fixed = solve(Problem.of(D=0.0, **HALF_SPACE))
    assert_allclose(fixed.P_off, -5 / 6 * PULL, rtol=1e-10, atol=0)
    assert_allclose(fixed.a, fixed.a_in, rtol=1e-12, atol=0)
    assert_allclose(fixed.P, -4 / 3 * PULL, rtol=1e-10, atol=0)
    assert solve(Problem.of(a=fixed.a_off, k_machine=np.inf, **HALF_SPACE)).dP_dD == np.inf


def test_branches():
    """Between P_off and 0 there are two radii, at which P is the same; elsewhere there is no other branch."""
    layer = {"h": 0.05, "n": 0.2, "nu1": 0.5, "bonding": "bonded", "w_adhesion": 1e-4} | SMOOTH
    P = np.array([1.01, 0.9, 0.01, 0.0, -1.0]) * solve(Problem.of(P=0.0, **layer)).P_off
    stable, other = (solve(Problem.of(P=P, branch=word, **layer)) for word in ("stable", "unstable"))
    assert stable.status.tolist() == [Status.PULLED_OFF, *4 * [Status.CONVERGED]]
    assert other.status.tolist() == [Status.PULLED_OFF, *2 * [Status.CONVERGED], *2 * [Status.PULLED_OFF]]
    assert np.all(stable.a[1:3] > stable.a_off[1:3]) and np.all(other.a[1:3] < other.a_off[1:3])
    assert not other.stable.any() and np.isnan(other.p[0]).all() and np.isnan(stable.a[0])
    assert np.all(np.isfinite(other.P_off) & np.isfinite(other.a_in) & (other.P == P))
    again = solve(Problem.of(a=other.a[1:3], **layer))
    assert_allclose(again.P, P[1:3], rtol=1e-11, atol=0)
    assert not again.stable.any() and np.all(again.dP_dD != 0)


@pytest.mark.parametrize("rtol", [1e-2, 1e-6, 1e-10])
def test_pull_in_does_not_depend_on_rtol(rtol):
    """At a_in, D + P/k is 0 to rounding, for each stiffness, however coarse the tolerance."""
    k = np.array([0.0, 1e-3, 0.1, 10.0, np.inf])
    layer = {"h": 0.02, "n": 30.0, "nu1": 0.3, "bonding": "bonded", "w_adhesion": 1e-4} | SMOOTH
    contact = solve(Problem.of(P=0.0, k_machine=k, rtol=rtol, **layer))
    at = solve(Problem.of(a=contact.a_in, **layer))
    assert np.all(np.abs(at.P / contact.P_off) < 1e-10 + (k > 0)) and np.all(contact.a_in > contact.a_off)
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = np.where(k == 0, at.P, at.D + at.P / np.where(k == 0, 1.0, k))
    scale = np.where(k == 0, contact.P_off, contact.D_off)
    assert np.all(np.abs(moved / scale) < 1e-11)
    assert np.all(np.diff(contact.a_off) < 0) and np.all(np.diff(contact.P_off) > 0)


def test_energy_release():
    """dU/da at fixed D is 2π a w, with U = ∫ P dD at each radius: at given a and D, U = P D - ... is not asked of the
    solver, but dP/da at fixed D follows from it: P(a, D) = P0 + S (D - D0), dS/da = S' and δ² = 4π a w/S'. 1e-6: from
    differences of S at a (1 ± 1e-3)."""
    a, step, w = np.array([0.02, 0.1, 0.2]), 1e-3, 1e-4
    layer = {"h": 0.05, "n": 0.2, "nu1": 0.5, "bonding": "bonded"} | SMOOTH
    stiffness = [solve(Problem.of(a=a * (1 + s), shape="sphere", **layer)) for s in (-step, 0.0, step)]
    slope = (stiffness[2].dP_dD - stiffness[0].dP_dD) / (2 * step * a)
    stuck = solve(Problem.of(a=a, shape="sphere", w_adhesion=w, **layer))
    delta = np.sqrt(4 * np.pi * a * w / slope)
    assert_allclose(stuck.D, stiffness[1].D - delta, rtol=0, atol=2e-6 * delta.max())
    assert_allclose(stuck.P, stiffness[1].P - stiffness[1].dP_dD * delta, rtol=2e-5, atol=0)


def test_stiffness_is_the_slope_of_the_curve():
    """dP/dD from radii (1 ± 1e-4) a: 1e-6, the square of the distance and rounding over it."""
    layer = {"h": 0.03, "n": 5.0, "nu1": 0.2, "bonding": "bonded", "w_adhesion": 1e-4} | SMOOTH
    a = np.array([0.01, 0.05, 0.2])
    less, at, more = (solve(Problem.of(a=a * (1 + s), **layer)) for s in (-1e-4, 0.0, 1e-4))
    assert_allclose((more.P - less.P) / (more.D - less.D), at.dP_dD, rtol=1e-6, atol=0)


def test_thin_limits_on_a_rigid_base():
    """-P_off/(π w) tends to 2 where a thin layer is a bed of springs, and to 3 where it is incompressible and bonded;
    1.5 where it is thick, and where it is a film on an elastic base. Values at a/h = 16.6 of the specification."""
    w, rigid = 1e-3, {"n": 0.0, "rtol": 1e-4} | SMOOTH
    for h, nu, bonding, limit in ((2e-3, 0.3, "frictionless", 2), (2e-3, 0.3, "bonded", 2), (6e-3, 0.5, "bonded", 3)):
        ratios = []
        for thickness in (h, 4 * h):
            contact = solve(Problem.of(P=0.0, h=thickness, nu1=nu, bonding=bonding, w_adhesion=w, **rigid))
            ratios.append(-contact.P_off[0] / (np.pi * w))
        assert ratios[1] < ratios[0] < limit and ratios[0] > 0.87 * limit
    for h in (3e-4, 50.0):
        contact = solve(Problem.of(P=0.0, h=h, n=0.5, nu1=0.3, w_adhesion=1e-4, bonding="bonded", rtol=1e-4, **SMOOTH))
        assert contact.status == Status.CONVERGED
        assert_allclose(contact.P_off, -1.5 * PULL, rtol=0.02, atol=0)


def test_a_minimum_is_searched_from_the_slopes_at_its_ends(monkeypatch):
    """Their ratio gives the first guess: with another one the search takes steps for nothing."""

    def checked(evaluate, low, high, g_low, g_high, tolerance):
        for x, slope in ((low, g_low), (high, g_high)):
            assert_allclose(evaluate(x, np.arange(len(x))), slope, rtol=1e-6, atol=0)
        sizes.append(len(low))
        return between(evaluate, low, high, g_low, g_high, tolerance)

    between, sizes = pull.between, []
    monkeypatch.setattr(pull, "between", checked)
    solve(Problem.of(P=0.0, h=[0.3, 1e-3], n=1e4, nu1=0.3, bonding="bonded", w_adhesion=1e-4, **SMOOTH))
    assert max(sizes) == 2


def test_several_minima():
    """A stiff plate: of the minima of P that with the largest radius is pull-off. The specification has 12.1 a_c for
    n = 1e4, h = 0.6 a_c, and does not say for which Poisson ratios: 3 %."""
    n, w = 1e4, 1.0
    a_c = (9 * np.pi * w / (8 * n)) ** (1 / 3)
    contact = solve(Problem.of(P=0.0, h=0.6 * a_c, n=n, nu1=0.3, nu2=0.3, bonding="bonded", w_adhesion=w, **SMOOTH))
    assert contact.status == Status.CONVERGED
    assert_allclose(contact.a_off / a_c, 12.1, rtol=0.03, atol=0)
    a = contact.a_off * np.array([0.98, 1.0, 1.02])
    near = solve(Problem.of(a=a, h=0.6 * a_c, n=n, nu1=0.3, nu2=0.3, bonding="bonded", w_adhesion=w, **SMOOTH))
    assert near.P[0] > near.P[1] < near.P[2]


@pytest.mark.parametrize("plate", [(0.05, 1e4, 0.1, 1e-4), (0.02, 1e3, 0.5, 1e-2)])
def test_stiff_plates_on_soft_stacks(plate):
    """Pull-off is far above the thickness, or the radius of a half-space of the plate: P falls to it from far above."""
    h, n, below, soft = plate
    case = {"layers": [{"h": h, "n": n}, {"h": below, "n": soft}], "w_adhesion": 1e-2, "rtol": 1e-4} | SMOOTH
    contact = solve(Problem.of(P=0.0, **case))
    assert contact.status == Status.CONVERGED
    wide = solve(Problem.of(a=contact.a_off * np.append(0.9, np.geomspace(1.1, 20, 12)), **case))
    assert np.nanmin(wide.P) > contact.P_off and np.all(np.diff(wide.P[1:]) > 0)


def test_flat_parts():
    """A frustum is pulled off at its corner, a = b; a flat punch at the load of Kendall, -sqrt(8π b³ E w)."""
    b, w = 0.05, 1e-4
    frustum = solve(Problem.of(P=[-1e-4, 0.0], shape="frustum", flat_radius=b, half_angle=70.0, **HALF_SPACE))
    kendall = -np.sqrt(8 * np.pi * b**3 * w)
    assert np.all(frustum.status == Status.CONVERGED) and np.all(frustum.a_off == b)
    assert_allclose(frustum.P_off, kendall, rtol=1e-12, atol=0)
    flat = solve(Problem.of(P=[1.01 * kendall, 0.99 * kendall, 0.0, 1.0], shape="flat", flat_radius=b, **HALF_SPACE))
    assert flat.status.tolist() == [Status.PULLED_OFF, *3 * [Status.CONVERGED]]
    assert_allclose(flat.P_off, kendall, rtol=1e-12, atol=0)
    assert flat.p[:, 1].tolist()[1:] == [-np.inf, 0.0, np.inf]
    rounded = solve(Problem.of(P=0.0, shape="rounded_flat", flat_radius=b, edge_radius=0.3, **HALF_SPACE))
    assert rounded.a_off > b and rounded.P_off < kendall


def test_dmt():
    """P = P0(a) - 2π w, D = D0(a); pulled off at a = 0; a_in is the radius without adhesion under 2π w."""
    layer = {"h": 0.1, "n": 0.2, "nu1": 0.4, "bonding": "bonded"} | SMOOTH
    w = 1e-4
    free = solve(Problem.of(a=[0.05, 0.2], **layer, rtol=1e-9))
    sticking = solve(Problem.of(P=free.P - 2 * PULL, **layer, w_adhesion=w, adhesion="dmt"))
    assert_allclose(sticking.a, free.a, rtol=1e-9, atol=0)
    assert_allclose(sticking.D, free.D, rtol=1e-9, atol=0)
    assert np.all(sticking.P_off == -2 * PULL) and np.all(sticking.a_off == 0) and np.all(sticking.D_off == 0)
    alone = solve(Problem.of(P=2 * PULL, **layer, rtol=1e-9))
    assert_allclose(sticking.a_in, alone.a[0], rtol=1e-9, atol=0)
    gone = solve(Problem.of(P=[-2.1 * PULL, -1.9 * PULL], **layer, w_adhesion=w, adhesion="dmt"))
    assert gone.status.tolist() == [Status.PULLED_OFF, Status.CONVERGED]


@pytest.mark.parametrize(
    "wrong",
    [
        {"micro": "disc_cell", "Nbar": 250000, "Ra": 0.004},
        {"adhesion": "dmt", "shape": "sphere"},
        {"adhesion": "dmt", "z0": 1e-3},
        {"adhesion": "maugis"},
        {"base": "thin_layer", "h": 0.1, "n": 0.5},
    ],
)
def test_what_does_not_go_together(wrong):
    assert solve(Problem.of(P=1e-3, **HALF_SPACE | wrong)).status == Status.INVALID_INPUT


@pytest.mark.parametrize("control", ["P", "D"])
def test_at_pull_off_itself(control):
    """The load, or depth, that was returned is the last one that holds, at a_off to 1e-6; a little less is too much. So
    also under a frustum, at its corner, and a flat punch."""
    layer = {"h": 0.03, "n": 0.4, "nu1": 0.3, "bonding": "bonded", "w_adhesion": np.array([1e-5, 1e-4])} | SMOOTH
    flat = {"flat_radius": 0.05, "half_angle": 70.0}
    for punch in ({"shape": "paraboloid"}, {"shape": "frustum"} | flat, {"shape": "flat", "flat_radius": 0.05}):
        value = getattr(solve(Problem.of(**{control: 0.01}, **layer, **punch)), f"{control}_off")
        last = solve(Problem.of(**{control: value}, **layer, **punch))
        assert np.all(last.status == Status.CONVERGED) and np.all(last.stable)
        assert_allclose(last.a, last.a_off, rtol=1e-6, atol=0)
        if control == "D" and punch["shape"] == "paraboloid":
            assert np.all(last.dP_dD == np.inf)
        gone = solve(Problem.of(**{control: value * (1 + 1e-9)}, **layer, **punch))
        assert np.all(gone.status == Status.PULLED_OFF)


def test_company():
    """A case that sticks has the same numbers alone and among others, of which some differ in the depth alone, to the
    last digit."""
    depths = [0.002, 0.002, 0.003, 0.002, 0.001]
    layer = {"h": np.array([0.01, 0.1, 0.1, 1.0, 0.1]), "n": 0.4, "nu1": 0.5, "bonding": "bonded"}
    case = layer | {"w_adhesion": 1e-4} | SMOOTH
    for punch in ({}, {"shape": "cone", "half_angle": 60.0}):
        together = solve(Problem.of(D=depths, **case, **punch))
        for i in (0, 2, 3, 4):
            alone = solve(Problem.of(D=depths[i], **case | {"h": case["h"][i]}, **punch))
            for name in ("a", "P", "dP_dD", "p0", "P_off", "a_off", "a_in"):
                assert getattr(together, name)[i] == getattr(alone, name)[0]


def test_the_unstable_branch_goes_on_to_the_axis():
    """However small a load or depth below 0 is: a radius has it, which tends to 0 as on a half-space, a ~ Q²."""
    case = {"h": 1.0, "n": 1e-3, "bonding": "bonded", "nu1": 0.49, "micro": "smooth", "w_adhesion": 1e-8}
    for control, values in {"D": [-1e-6, -1e-7, 0.0], "P": [-1e-11, -1e-12, 1e-9]}.items():
        unstable = solve(Problem.of(**case, **{control: values}, branch="unstable"))
        assert unstable.status.tolist() == [Status.CONVERGED] * 2 + [Status.PULLED_OFF]
        again = solve(Problem.of(**case, a=unstable.a[:1]))
        np.testing.assert_allclose(getattr(again, control), values[:1], rtol=1e-12)
        np.testing.assert_allclose(unstable.a[1] / unstable.a[0], 0.01 if control == "D" else 0.1 ** (2 / 3), rtol=1e-3)


def test_the_jump_into_contact_below_a_minimum_that_is_pressed():
    """Of a blunt tip on a stiff plate P is positive at the last minimum: the contact that first touches goes to the
    largest radius below it at which P rises through 0."""
    case = {"h": 0.02, "n": 1e4, "nu1": 0.3, "bonding": "bonded", "w_adhesion": 1e-4} | SMOOTH
    case |= {"shape": "power", "shape_power": 1.5, "shape_coefficient": 0.5}
    off = solve(Problem.of(P=0.0, **case))
    assert off.P_off > 0 and off.P_in == 0
    near = solve(Problem.of(a=off.a_in * np.array([0.999, 1.001]), **case)).P
    between = solve(Problem.of(a=np.geomspace(1.01 * off.a_in[0], off.a_off[0], 20), **case)).P
    assert near[0] < 0 < near[1] and (between > 0).all()
