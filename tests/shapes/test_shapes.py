"""Shapes against their definitions, by quadrature of f' alone."""

import numpy as np
import pytest
from scipy.integrate import quad

from solver import Problem
from solver.shapes import SHAPES, lines, shape_of, table

NUMBERS = {"half_angle": 60.0, "flat_radius": 0.1, "tip_radius": 0.3, "edge_radius": 0.2}
NUMBERS |= {"shape_power": 3.0, "shape_coefficient": 0.7}
CASES = [(name, {}) for name in SHAPES] + [("blunt_cone", {"tip": "sphere"})]
RADII = (0.05, 0.12, 0.25, 0.4)
S = np.array([1.0, 0.9, 0.5, 0.1, 0.01])


def made(name, more=()):
    """The shape of one case."""
    numbers = {key: NUMBERS[key] for key in SHAPES[name].parameters if key in NUMBERS} if name in SHAPES else {}
    numbers |= dict(more)
    return shape_of(Problem.of(P=1e-3, base="half_space", micro="smooth", shape=name, **numbers))


def at(function, r):
    """The value of a function of a shape at one radius."""
    return float(function(np.array([[r]]))[0, 0])


@pytest.mark.parametrize(("name", "more"), CASES)
@pytest.mark.parametrize("a", RADII)
@np.errstate(all="ignore")
def test_each_is_what_its_slope_says(name, more, a):
    shape = made(name, more)
    inner = [kink for kink in shape.kinks()[0] if kink < a]

    def integral(function, low, high, points):
        # without points between the kinks a quadrature would not reach 1e-12
        return quad(function, low, high, points=points or None, limit=300, epsabs=1e-16, epsrel=1e-13)[0]

    def slope_on_circle(z):
        return a * at(shape.slope, a * np.sin(z))

    F = at(shape.lifted, a)
    wanted = integral(slope_on_circle, 0, np.pi / 2, [np.arcsin(kink / a) for kink in inner])
    load = integral(lambda t: F - at(shape.lifted, t), 0, a, inner)
    height = integral(lambda r: at(shape.slope, r), 0, a, inner)
    np.testing.assert_allclose(F, wanted, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(shape.lifted_load(np.array([a]))[0], load, rtol=1e-11, atol=1e-15)
    np.testing.assert_allclose(at(shape.height, a), height, rtol=1e-12, atol=1e-16)
    x = np.sqrt(1 - S**2)
    drops = 2 / a**2 * (at(shape.height, a) - shape.height((a * x)[None])[0])
    # the difference on the right has the rounding of f(a)
    np.testing.assert_allclose(shape.drop(np.array([a]), S)[0], drops, rtol=1e-12, atol=2e-15 * drops[0])
    step = 1e-6 * a
    moved = (at(shape.lifted, a + step) - at(shape.lifted, a - step)) / (2 * step)
    # a difference over 2e-6 a has lost nine digits
    np.testing.assert_allclose(at(shape.lifted_slope, a), moved, rtol=1e-7, atol=1e-12)


@pytest.mark.parametrize(("name", "more"), CASES)
@np.errstate(all="ignore")
def test_next_to_the_edge_and_near_the_axis_no_digits_are_lost(name, more):
    shape, a = made(name, more), np.array([0.4])
    slope = at(shape.slope, 0.4)
    s = 1e-7  # a - r is a s²/2 there, f(a) - f(r) that times f'(a)
    np.testing.assert_allclose(shape.drop(a, np.array([s]))[0, 0], slope / 0.4 * s**2, rtol=1e-12)
    small = np.array([1e-4])
    if shape.least()[0] == 0:  # ∫ t F' dt is about what three terms of F say: F is a power of t there
        k = at(shape.lifted_slope, 1e-4) * 1e-4 / at(shape.lifted, 1e-4)
        power = k / (k + 1) * at(shape.lifted, 1e-4) * 1e-4
        np.testing.assert_allclose(shape.lifted_load(small)[0], power, rtol=1e-7)


def test_a_blunt_cone_touches_its_cone():
    """Slope and height have no jump where the tip ends; and far out F is that of the cone, less what the tip lacks."""
    for tip in ("paraboloid", "sphere"):
        shape = made("blunt_cone", {"tip": tip})
        b = shape.b[0]
        for function in (shape.height, shape.slope, shape.lifted, shape.lifted_slope):
            np.testing.assert_allclose(at(function, b * (1 + 1e-13)), at(function, b * (1 - 1e-13)), rtol=1e-5)


def test_a_table_is_the_shape_between_its_rows(tmp_path):
    """Rows of a paraboloid are the paraboloid: the slopes of its chords are its slopes in their middle."""
    path = tmp_path / "tip.csv"
    r = np.linspace(0, 0.5, 7)
    path.write_text("r, f\n" + "\n".join(f"{x:.17g}, {x * x / 2:.17g}" for x in r))
    shape = shape_of(Problem.of(P=1e-3, base="half_space", micro="smooth", shape=f"table:{path}"))
    t = np.array([[0.0, 0.03, 0.2, 0.49]])
    np.testing.assert_allclose(shape.height(t), t**2 / 2, rtol=1e-14, atol=1e-17)
    np.testing.assert_allclose(shape.lifted(t), t**2, rtol=1e-14, atol=1e-17)
    np.testing.assert_allclose(shape.drop(np.array([0.3]), S), [S**2], rtol=1e-13)
    assert not shape.pointed[0]
    assert np.isnan(shape.height(np.array([[0.51]]))).all()


def test_a_table_of_any_convex_profile(tmp_path):
    path = tmp_path / "tip.csv"
    r = np.linspace(0, 0.5, 9)
    path.write_text("# a tip\nr [um], f [nm]\n" + "\n".join(f"{x:.17g}, {1e3 * (x**3 + 0.1 * x):.17g}" for x in r))
    word = f"table:{path}"
    in_um = {"table_unit": 1e6}
    assert made(word, in_um).pointed[0]
    for a in RADII:
        test_each_is_what_its_slope_says(word, in_um, a)
    assert table.identity(table.read(word)) != word


def word_of(path, r):
    """The word of a table of r³ + r/10 with rows at r."""
    path.write_text("\n".join(f"{x:.17g}, {x**3 + 0.1 * x:.17g}" for x in r), encoding="utf-8")
    return f"table:{path}"


@pytest.mark.parametrize("rows", [23, 24, 100])
def test_a_long_table_has_series_that_are_the_sum_over_its_lines(tmp_path, rows):
    """Without them it would be as right, and slow. A table has one more knot than rows."""
    random = np.random.default_rng(5)
    r = np.append(0.0, np.cumsum(random.uniform(0.5, 1.5, rows - 1)))
    shape = made(word_of(tmp_path / "tip.csv", 0.5 * r / r[-1]))
    assert (shape.rows.series is not None) == (rows + 1 > lines.FEW)
    summed = shape._replace(rows=shape.rows._replace(series=None))
    t = np.append(shape.rows.r, random.uniform(0, 0.5, 300))[None]
    for name in ("lifted", "lifted_slope"):
        exact = getattr(summed, name)(t)
        np.testing.assert_allclose(getattr(shape, name)(t), exact, rtol=0, atol=1e-12 * np.abs(exact).max())


def test_a_table_whose_series_would_be_off_has_none(tmp_path):
    """Rows that lie close together, beside others far apart."""
    word = word_of(tmp_path / "tip.csv", np.append(np.linspace(0, 1e-3, 30), RADII))
    shape, (_, a, *_) = made(word), RADII
    assert shape.rows.series is None
    kinks = [np.arcsin(kink / a) for kink in shape.kinks()[0] if kink < a]
    wanted = quad(lambda z: a * at(shape.slope, a * np.sin(z)), 0, np.pi / 2, points=kinks, epsabs=0, epsrel=1e-12)
    np.testing.assert_allclose(at(shape.lifted, a), wanted[0], rtol=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("r,f\n0,0\n1,1\n2,1.5\n", "is not convex beyond the row with r = 1"),
        ("r,f\n0,0\n1,1\n2,3\n3,4\n4,6\n", "is not convex beyond the row with r = 2: the slope of f must not fall"),
        ("r,f\n0.1,0\n1,1\n2,3\n", "must be 0 in the first row"),
        ("r,f\n0,0\n1,1\n", "3 to 1000 rows"),
        ("r [um],f [parsec]\n0,0\n1,1\n2,3\n", "must name a length"),
        ("r,f\n0,0\n1,nan\n2,3\n", "line 3: 1, nan: must be two numbers"),
        ("r,f\n0,0\n1,x\n2,3\n", "line 3: 1, x: must be two numbers"),
    ],
)
def test_a_table_that_cannot_be_used_is_told(tmp_path, text, message):
    path = tmp_path / "tip.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=message):
        Problem.of(P=1e-3, base="half_space", micro="smooth", shape=f"table:{path}")


def test_a_parameter_of_a_shape_is_missing():
    with pytest.raises(ValueError, match='half_angle is missing: shape = "cone" needs it'):
        Problem.of(P=1e-3, base="half_space", micro="smooth", shape="cone")
