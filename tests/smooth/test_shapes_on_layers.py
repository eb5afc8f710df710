"""Smooth contacts of every shape on layers, against another code in long double, and identities that hold for each."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rows import SMOOTH, material, rows, shape

from solver import Problem, Status, solve
from solver.shapes import shape_of

ROWS = rows("given_shapes.csv")
IDS = [f"{int(row['case'])} {row['shape']}" for row in ROWS]
RADII, PRESSURES = (0.0, 0.5, 0.9), ("p_0", "p_half_a", "p_0.9a")


@pytest.mark.parametrize("row", ROWS, ids=IDS)
def test_another_code(row):
    """1e-10, which is asked for, under each control; the punch lifts off where the other code sees tension."""
    for control in "PD" if row["shape"] == "flat" else "aPD":
        case = {control: row[control]} | shape(row) | material(row)
        contact = solve(Problem.of(**case, **SMOOTH, rtol=3e-10), x=RADII)
        if row["tensile_somewhere"]:
            assert contact.status == Status.LIFT_OFF and np.isnan(contact.p).all()
            continue
        assert contact.status == Status.CONVERGED
        for name in ("a", "P", "D", "dP_dD"):
            assert_allclose(getattr(contact, name), row[name], rtol=1e-10, atol=0)
        p = np.array([row[name] for name in PRESSURES])
        # rounding at the edge of a plate, where it presses most, moves p in its middle: by 1.1e-10 with AVX-512
        largest = np.abs(p[np.isfinite(p)]).max() if float(row["n"]) >= 50 else 0.0
        assert_allclose(contact.p[0], p, rtol=1e-10, atol=1e-10 * largest)
        assert contact.p0 == contact.p_max == contact.p[0, 0]
        off = max(np.abs(contact.P / row["P"] - 1), np.abs(contact.D / row["D"] - 1), np.abs(contact.a / row["a"] - 1))
        assert off <= contact.error


HALF_SPACE = {
    "paraboloid": ({"shape": "paraboloid"}, lambda a: 4 / 3 * a**3, lambda a: a**2),
    "sphere": ({"shape": "sphere"}, lambda a: (a**2 + 1) * np.arctanh(a) - a, lambda a: a * np.arctanh(a)),
    "cone": ({"shape": "cone", "half_angle": 45.0}, lambda a: np.pi / 2 * a**2, lambda a: np.pi / 2 * a),
    "power": (
        {"shape": "power", "shape_coefficient": 3.0, "shape_power": 3.0},
        lambda a: 2 * 3 * (3 * np.pi / 4) * 3 / 4 * a**4,
        lambda a: 3 * (3 * np.pi / 4) * a**3,
    ),
    "frustum": (
        {"shape": "frustum", "flat_radius": 0.1, "half_angle": 45.0},
        lambda a: a**2 * np.arccos(0.1 / a) + 0.1 * np.sqrt(a**2 - 0.01),
        lambda a: a * np.arccos(0.1 / a),
    ),
    "blunt_cone": (
        {"shape": "blunt_cone", "tip_radius": 0.1, "half_angle": 45.0},
        lambda a: 20 * (
            2 / 3 * a**3 - a**2 * (q := np.sqrt(a**2 - 0.01)) + q**3 / 3
            + a**2 * 0.1 * np.arccos(0.1 / a) / 2 + 0.01 * q / 2
        ),
        lambda a: 10 * a * (a - np.sqrt(a**2 - 0.01) + 0.1 * np.arccos(0.1 / a)),
    ),
    "rounded_flat": (
        {"shape": "rounded_flat", "flat_radius": 0.1, "edge_radius": 0.5},
        lambda a: 4 * (
            a**2 * (q := np.sqrt(a**2 - 0.01)) - q**3 / 3 - 0.01 * q / 2 - a**2 * 0.1 * np.arccos(0.1 / a) / 2
        ),
        lambda a: 2 * a * (np.sqrt(a**2 - 0.01) - 0.1 * np.arccos(0.1 / a)),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", HALF_SPACE)
def test_half_space_and_a_very_thick_layer(name):
    """Section 2 of the specification: P and D of each shape, by each control. Rounding, 1e-11, of the longest formula,
    where a is a little above b. On a layer of a thousand times a the base adds (a/h) ∫(L - 1): 1e-3."""
    parameters, load, depth = HALF_SPACE[name]
    a = np.array([0.11, 0.2, 0.7])
    exact = {"a": a, "P": load(a), "D": depth(a)}
    for control in "aPD" if name != "paraboloid" else "a":
        contact = solve(Problem.of(**{control: exact[control]}, **parameters, **SMOOTH, base="half_space", rtol=1e-10))
        assert np.all(contact.status == Status.CONVERGED)
        for quantity, values in exact.items():
            assert_allclose(getattr(contact, quantity), values, rtol=1e-11, atol=0)
        assert_allclose(contact.dP_dD, 2 * a, rtol=1e-11, atol=0)
    thick = solve(Problem.of(a=a, **parameters, **SMOOTH, h=1000 * a, n=0.5, nu1=0.4, bonding="bonded"))
    for quantity in "PD":
        assert_allclose(getattr(thick, quantity), 0.5 ** (quantity == "P") * exact[quantity], rtol=1e-3, atol=0)


def test_the_pressure_of_a_cone_and_its_load():
    """p = (E cot/2) arcosh(a/r): infinite on the axis, and right to 1e-10 next to it and to the edge. Near the edge the
    formula is artanh(s)."""
    x = np.array([1e-6, 1e-3, 0.3, 0.9, 1 - 1e-9])
    contact = solve(Problem.of(a=0.2, shape="cone", half_angle=30.0, base="half_space", **SMOOTH), x=[0, *x, 1])
    assert np.isinf(contact.p0) and np.isinf(contact.p[0, 0]) and contact.p[0, -1] == 0
    exact = np.where(x < 0.5, np.arccosh(1 / x), np.arctanh(np.sqrt((1 - x) * (1 + x))))
    assert_allclose(contact.p[0, 1:-1], np.sqrt(3) / 2 * exact, rtol=1e-10, atol=0)


@pytest.mark.parametrize("name", [name for name in HALF_SPACE if name != "paraboloid"])
def test_load_is_the_integral_of_the_pressure_and_stiffness_its_slope(name):
    """On layers: 2π ∫ p r dr by 60 Gauss points a panel in r = b + (a - b) y² to 1e-7, for p has a logarithm at the
    corner of a frustum; and dP/dD from two radii to 1e-6, the square of their distance."""
    parameters, *_ = HALF_SPACE[name]
    layer = {"h": 0.1, "n": np.array([0.2, 3.0]), "nu1": 0.4, "bonding": "bonded"} | SMOOTH | parameters
    y, w = np.polynomial.legendre.leggauss(60)
    y, w = (y + 1) / 2, w / 2
    x, weights = [], []
    for low, high in ((0.0, 0.5), (0.5, 0.75), (0.75, 1.0)):  # b = 0.1 is at 0.5
        t = y**2 * (3 - 2 * y)
        x.append(low + (high - low) * t)
        weights.append((high - low) * 6 * y * (1 - y) * w)
    x, weights = np.concatenate(x), np.concatenate(weights)
    contact = solve(Problem.of(a=0.2, **layer), x=x)
    assert_allclose(2 * np.pi * 0.04 * (contact.p * x) @ weights, contact.P, rtol=1e-7, atol=0)
    less, more = (solve(Problem.of(a=0.2 * (1 + s), **layer)) for s in (-1e-3, 1e-3))
    assert_allclose((more.P - less.P) / (more.D - less.D), contact.dP_dD, rtol=1e-5, atol=0)


@pytest.mark.parametrize("base", ["layered", "stack"])
def test_reciprocity(base):
    """P = S D - 2π ∫ p1 f r dr with the flat punch of unit depth, p1: 1e-9."""
    layers = [{"h": 0.1, "n": 0.3, "nu": 0.45, "bonding": "bonded"}]
    body = {"layers": layers} if base == "stack" else {"h": 0.1, "n": 0.3, "nu1": 0.45, "bonding": "bonded"}
    y, w = np.polynomial.legendre.leggauss(80)
    s, w = (y + 1) / 2, w / 2  # r dr = -s ds, and p1 ~ 1/s
    x = np.sqrt((1 - s) * (1 + s))
    flat = solve(Problem.of(D=1.0, shape="flat", flat_radius=0.2, **body, **SMOOTH), x=x)
    sphere = solve(Problem.of(a=0.2, shape="sphere", **body, **SMOOTH))
    f = 1 - np.sqrt(1 - (0.2 * x) ** 2)
    lost = 2 * np.pi * 0.04 * (flat.p[0] * f * s) @ w
    assert_allclose(flat.dP_dD * sphere.D - lost, sphere.P, rtol=1e-9, atol=0)
    assert np.isinf(solve(Problem.of(D=1.0, shape="flat", flat_radius=0.2, **body, **SMOOTH)).p[0, 1])


def test_very_stiff_layers():
    """n = 1e9: 1e-8 against n = 1e9 (1 - 1e-9), in between which P changes by less than that."""
    layer = {"a": 0.2, "h": np.array([0.05, 0.2, 2.0]), "nu1": 0.3, "shape": "sphere", "rtol": 1e-8} | SMOOTH
    one, other = (solve(Problem.of(**layer, n=1e9 * (1 - s))) for s in (0.0, 1e-9))
    assert set(one.status.tolist()) <= {Status.CONVERGED, Status.LIFT_OFF} and one.status[-1] == Status.CONVERGED
    assert_allclose(one.P[-1], other.P[-1], rtol=1e-8, atol=0)


def test_films():
    """h/a from 1e-3 to 1e-6: the half-space under them, which the sphere touches, up to the order of h/a; and each
    error is true against thinner ones by the order of h/a."""
    thin = 10.0 ** -np.arange(3, 7)
    contact = solve(Problem.of(a=0.2, h=0.2 * thin, n=0.3, shape="sphere", bonding="bonded", **SMOOTH, rtol=1e-4))
    assert np.all(contact.status == Status.CONVERGED)
    bare = (0.2**2 + 1) * np.arctanh(0.2) - 0.2
    assert_allclose(contact.P, bare, rtol=20e-3, atol=0)
    assert np.all(np.abs(contact.P / bare - 1) < 20 * thin)


def test_company():
    """A case has the same numbers alone and among others, to the last digit."""
    a, h = np.geomspace(0.01, 0.3, 25), np.geomspace(0.3, 0.01, 25)
    for parameters in ({"shape": "sphere"}, {"shape": "frustum", "flat_radius": 0.005, "half_angle": 60.0}):
        case = {"n": 0.4, "nu1": 0.5, "bonding": "bonded"} | SMOOTH | parameters
        together = solve(Problem.of(D=0.3 * a**2, h=h, **case))
        for i in (0, 7, 24):
            alone = solve(Problem.of(D=0.3 * a[i] ** 2, h=h[i], **case))
            for name in ("a", "P", "dP_dD", "p0"):
                assert getattr(together, name)[i] == getattr(alone, name)[0]


@pytest.mark.parametrize(
    "wrong",
    [
        {"a": 1.0, "shape": "sphere"},
        {"a": 0.05, "shape": "frustum", "flat_radius": 0.05, "half_angle": 60.0},
        {"a": 0.05, "shape": "flat", "flat_radius": 0.05},
        {"P": 1e-3, "shape": "sphere", "base": "thin_layer"},
        {"P": 1e-3, "shape": "sphere", "scheme": "picard"},
    ],
)
def test_what_does_not_go_together(wrong):
    assert solve(Problem.of(**{"h": 0.1, "n": 0.5} | SMOOTH | wrong)).status == Status.INVALID_INPUT


def test_beyond_the_last_row_of_a_table(tmp_path, monkeypatch):
    """A table of a paraboloid's rows is its own shape, near to it; the radius cannot go beyond the last row."""
    monkeypatch.chdir(tmp_path)
    r = np.linspace(0, 0.3, 31)
    np.savetxt("tip.csv", np.column_stack([r, r**2 / 2]), delimiter=",")
    case = {"shape": "table:tip.csv", "h": 0.1, "n": 0.5} | SMOOTH
    measured = solve(Problem.of(a=0.2, **case))
    smooth = solve(Problem.of(a=0.2, h=0.1, n=0.5, **SMOOTH))
    assert measured.status == Status.CONVERGED
    assert_allclose(measured.P, smooth.P, rtol=1e-9, atol=0)
    assert solve(Problem.of(P=10.0, **case)).status == Status.OUTSIDE_LAW
    assert solve(Problem.of(a=0.31, **case)).status == Status.OUTSIDE_LAW


@pytest.mark.parametrize("more", [{}, {"w_adhesion": 1e-5}], ids=["free", "jkr"])
def test_all_kinks_of_a_table_count(more, tmp_path):
    """The slope of 200 noisy rows has 199 kinks. By reciprocity the load is S D - 2π ∫ p1 f r dr, with the pressure p1
    of the flat punch of unit depth: by 20 Gauss points between every two rows to 1e-8; with 24 of the kinks it is off
    by 2e-7. An edge that sticks adds P = S δ to the load, and δ to the depth."""
    rng, a = np.random.default_rng(3), 0.2
    r = np.linspace(0, 0.3, 201)
    f = np.append(0, np.cumsum(np.cumsum(np.maximum(0, rng.normal(1, 1, 200))) * r[1] ** 2))
    path = tmp_path / "tip.csv"
    np.savetxt(path, np.column_stack([r, f]), delimiter=",", fmt="%.17g")
    layer = {"h": 0.1, "n": 0.3, "nu1": 0.4, "bonding": "bonded"} | SMOOTH
    contact = solve(Problem.of(a=a, shape=f"table:{path}", rtol=1e-9, **layer, **more))
    assert contact.status == Status.CONVERGED and contact.error < 1e-10
    ends = np.sqrt(np.maximum(1 - (np.append((r[1:] + r[:-1]) / 2, 0) / a) ** 2, 0))
    ends = np.unique(np.append(ends, [0.0, 1.0]))
    y, w = np.polynomial.legendre.leggauss(20)
    s = (ends[:-1, None] + np.diff(ends)[:, None] * (y + 1) / 2).ravel()
    weights = (np.diff(ends)[:, None] * w / 2).ravel()
    x = np.sqrt((1 - s) * (1 + s))
    flat = solve(Problem.of(D=1.0, shape="flat", flat_radius=a, **layer), x=x)
    height = shape_of(Problem.of(a=a, shape=f"table:{path}", **layer)).height(a * x[None])[0]
    lost = 2 * np.pi * a**2 * (flat.p[0] * height * s) @ weights
    assert_allclose(flat.dP_dD * contact.D - lost, contact.P, rtol=1e-8, atol=0)
