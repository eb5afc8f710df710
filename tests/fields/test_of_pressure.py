"""The field of a given pressure: reference rows, what every field obeys, limits, and bad input."""

import warnings

import numpy as np
import pytest
from field_rows import SHAPES, body_of, table
from numpy.testing import assert_allclose

from solver.fields import of_pressure, waves

NORMAL = ("sr", "st", "sz", "trz")
SLIDING = ("sr_c", "st_c", "sz_c", "srt_s", "sxz_0", "sxz_2")
HERTZ = SHAPES[0]
LAYER = {"h": 0.4, "n": 3.0, "nu1": 0.2, "nu2": 0.4, "bonding": "bonded"}


@pytest.mark.parametrize("config", [f"G{i}" for i in range(1, 9)])
@pytest.mark.parametrize(("file", "mu"), [("stress_normal", 0.0), ("stress_friction", 1.0)])
def test_reference(config, file, mu):
    """To 1e-13 of the largest stress or displacement; blank where a reference has none."""
    rows = table(file)
    rows = rows[rows["config"] == config]
    names = rows.dtype.names[rows.dtype.names.index("side") + 1 :]
    for side in np.unique(rows["side"]):
        here = rows[rows["side"] == side]
        arguments = body_of(here[0]) | {"side": ("layer", "base")[side], "mu": mu}
        field = of_pressure(SHAPES[here["shape"][0]], here["r"], here["z"], **arguments)
        for group in (NORMAL + SLIDING, ("ur", "uz", "uz_c", "ux_0", "ux_2")):
            wanted = {name: here[name] for name in names if name in group and np.isfinite(here[name]).any()}
            size = np.nanmax(np.abs(list(wanted.values()))) if wanted else 0.0
            for name, values in wanted.items():
                some = np.isfinite(values)
                assert_allclose(field[name][some], values[some], rtol=0, atol=1e-13 * size)


@pytest.mark.parametrize("bonding", ["bonded", "frictionless"])
def test_stresses_are_continuous_and_balanced(bonding):
    """Across the interface, and div sigma = 0 in layer and body by differences of 4th order, step 2e-3."""
    body = LAYER | {"bonding": bonding}
    above, below = (of_pressure(HERTZ, [0.0, 0.7, 1.0, 1.6], 0.4, **body, side=side) for side in ("layer", "base"))
    for name in ("sz", "trz", "uz") + ("ur",) * (bonding == "bonded"):
        assert_allclose(above[name], below[name], rtol=0, atol=1e-13)
    assert bonding == "bonded" or np.abs(above["trz"]).max() < 1e-14
    step, weights = 2e-3, np.array([1, -8, 0, 8, -1]) / (12 * 2e-3)
    across = np.arange(-2, 3) * step
    for r, z in ((0.5, 0.02), (0.9, 0.2), (0.6, 0.5), (1.5, 1.0)):
        along, down = of_pressure(HERTZ, r + across, z, **body), of_pressure(HERTZ, r, z + across, **body)
        radial = weights @ along["sr"] + weights @ down["trz"] + (along["sr"] - along["st"])[2] / r
        axial = weights @ along["trz"] + weights @ down["sz"] + along["trz"][2] / r
        assert abs(radial) < 1e-7 and abs(axial) < 1e-7


def test_every_depth_bears_the_load():
    """2 pi ∫ sz r dr = -P."""
    t, w = np.polynomial.legendre.leggauss(90)
    r = 30 * ((1 + t) / 2) ** 2  # beyond, sz bears (z/r)³ of the load
    for z in (0.2, 0.39, 0.7):
        sz = of_pressure(HERTZ, r, z, **LAYER)["sz"]
        assert_allclose(2 * np.pi * np.sum(sz * r * w * 15 * (1 + t)), -2 * np.pi / 3, rtol=1e-4)


def test_a_layer_of_the_same_material_is_no_layer():
    """And a very thick or thin one is felt as the half-space of the one or the other material."""
    r, z = np.array([0.0, 0.6, 1.0, 1.4])[:, None], np.array([0.0, 0.01, 0.3, 0.9])
    bare = {"n": 1.0, "nu1": 0.3, "nu2": 0.3, "bonding": "bonded"}
    wanted = of_pressure(HERTZ, r, z, h=7.0, **bare)
    for h, n in ((0.3, 1.0), (0.3, 1 + 1e-9), (1e4, 5.0)):
        field = of_pressure(HERTZ, r, z, h=h, **bare | {"n": n})
        assert all(np.abs(field[name] - wanted[name]).max() < 1e-8 for name in NORMAL)
    under = of_pressure(HERTZ, r, z[2:], **LAYER | {"h": 1e-3, "nu2": 0.3})
    assert all(np.abs(under[name] - wanted[name][:, 2:]).max() < 0.02 for name in NORMAL)


def test_what_the_thinnest_films_miss(monkeypatch):
    """Waves that end too soon for a film: MISSED next to the edge goes like the root of their length, here 80 times the
    usual one, and far from it the error is smaller by a factor of 50."""
    r, z = np.array([0.0, 0.6, 0.9, 0.999, 1.0, 1.001])[:, None], np.array([0.0, 1e-3])
    film = {"h": 1e-3, "n": 10.0, "nu1": 0.2, "nu2": 0.3, "bonding": "bonded"}
    exact = of_pressure(HERTZ, r, z, **film)
    monkeypatch.setattr(waves, "SHORTEST", waves.SHORTEST / 80)
    missed = of_pressure(HERTZ, r, z, **film)
    largest = max(np.abs(exact[name]).max() for name in NORMAL)
    off = np.max([np.abs(missed[name] - exact[name]).max(axis=1) for name in NORMAL], axis=0) / largest
    bound = waves.MISSED * np.sqrt(80)
    assert bound / 20 < off.max() < bound and off[:3].max() < bound / 50


def test_grid_points_and_scattered_points_agree():
    random = np.random.default_rng(0)
    r, z = random.random((2, 40)) * [[1.5], [1.0]]
    scattered = of_pressure(HERTZ, r, z, **LAYER, mu=0.3)
    one_by_one = [of_pressure(HERTZ, *point, **LAYER, mu=0.3) for point in zip(r[:4], z[:4], strict=True)]
    for name, values in scattered.items():
        assert_allclose(values[:4], [field[name] for field in one_by_one], rtol=0, atol=1e-13)
    grid = of_pressure(HERTZ, r[:5, None], z[:5], **LAYER)
    assert_allclose(np.diag(grid["sr"]), scattered["sr"][:5], rtol=0, atol=1e-13)


def test_friction_is_proportional_to_mu_and_adds_nothing_to_the_rest():
    point = {"r": [0.3, 1.0], "z": [0.0, 0.2]} | LAYER
    without, half, whole = (of_pressure(HERTZ, mu=mu, **point) for mu in (0.0, 0.5, 1.0))
    assert set(without) == {*NORMAL, "ur", "uz"}
    for name, values in whole.items():
        assert_allclose(half[name], values if name in without else values / 2, rtol=1e-14, atol=0)


def test_friction_at_the_trailing_edge():
    """s1/p0 = (1 - 2 nu)/3 + mu pi (4 + nu)/8 behind a half-space contact (Hamilton and Goodman)."""
    nu, mu = 0.3, 0.4
    field = of_pressure(HERTZ, 1.0, 0.0, h=1.0, n=1.0, nu1=nu, nu2=nu, bonding="bonded", mu=mu)
    trailing = field["sr"] - field["sr_c"]
    assert_allclose(trailing, (1 - 2 * nu) / 3 + mu * np.pi * (4 + nu) / 8, rtol=1e-13)


@pytest.mark.parametrize("bonding", ["bonded", "frictionless"])
@pytest.mark.parametrize("n", [0.0, 1e-6, 0.1, 3.0, 1e6])
def test_extreme_bodies_warn_of_nothing(n, bonding):
    r, z = np.array([0.0, 0.99, 1.0, 2.0])[:, None], np.array([0.0, 1e-300, 1e-9, 0.03, 0.05, 0.051, 4.0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for nu in (0.0, 0.5):
            field = of_pressure(HERTZ, r, z, h=0.05, n=n, nu1=nu, nu2=0.5 - nu, bonding=bonding, mu=0.2)
            for name, values in field.items():
                absent = (name == "ux_0" and bonding == "frictionless") | ((n == 0) & (z > 0.05))
                assert np.all(np.isnan(values) == absent) and not np.isinf(values).any()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"r": -0.1}, "r = -0.1: must be finite and at least 0"),
        ({"r": [0.1, np.inf]}, "r = inf"),
        ({"z": -1e-9}, "z = -1e-09"),
        ({"z": np.nan}, "z = nan"),
        ({"h": 0.0}, "h = 0.0: must be a finite number > 0"),
        ({"h": np.inf}, "h = inf"),
        ({"n": -1.0}, "n = -1.0: must be a finite number in"),
        ({"nu1": 0.6}, "nu1 = 0.6"),
        ({"nu2": -1.0}, "nu2 = -1.0"),
        ({"bonding": "glued"}, 'bonding = "glued": must be one of frictionless, bonded'),
        ({"mu": -0.1}, "mu = -0.1: must be finite and at least 0"),
        ({"mu": np.nan}, "mu = nan"),
        ({"r": [0.5, 1e6]}, "r = 1e+06: must be at most"),
        ({"side": "body"}, 'side = "body": must be None, "layer" or "base"'),
        ({"p": lambda x: np.sqrt(1 - x)}, "p: must be a polynomial of up to 60 degrees"),
        ({"p": lambda x: np.nan * x}, "p: must give a finite number"),
        ({"p": lambda x: 1.0}, "p: must give a finite number for each radius"),
    ],
)
@pytest.mark.filterwarnings("ignore:divide by zero")
def test_bad_input_is_told(change, said):
    arguments = {"p": HERTZ, "r": 0.5, "z": 0.1} | LAYER | change
    with pytest.raises(ValueError, match=said.replace("(", r"\(").replace("+", r"\+")):
        of_pressure(**arguments)


@pytest.mark.parametrize("degree", [2, 7, 60])
def test_any_polynomial(degree):
    """The deep field of s^j against that of the waves of few others: linear in p."""
    r, z = np.array([0.0, 0.8, 1.0])[:, None], np.array([0.0, 0.01, 0.2])
    high = of_pressure(lambda x: np.sqrt(1 - x**2) ** degree, r, z, **LAYER)
    both = of_pressure(lambda x: np.sqrt(1 - x**2) ** degree + HERTZ(x), r, z, **LAYER)
    hertz = of_pressure(HERTZ, r, z, **LAYER)
    for name in NORMAL:
        assert_allclose(high[name] + hertz[name], both[name], rtol=0, atol=1e-11)
