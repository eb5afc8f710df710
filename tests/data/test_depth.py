"""Where the nominal pressure is largest, and how deep the coated body alone is pressed in."""

import numpy as np
import pytest
from scipy.special import j0

import study
from solver.kernels.closed_form import layered_kernel
from study.data import derived

SMOOTH = {"P": 1e-5, "micro": "smooth"}
ROUGH = {"P": 1e-5, "Nbar": 250000, "Ra": 0.004}
PLATE = {"h": 0.01, "n": 100, "bonding": "bonded"}


def test_the_largest_pressure_of_a_plate_is_in_a_ring():
    """At a point of the profile; of Hertz, and of a soft layer, it is p(0), whatever the rounding."""
    found = study.solve(a=0.03, micro="smooth", **PLATE, x=101)
    top, radius = derived.largest_nominal_pressure(found), derived.ring_radius(found)
    place = int(np.argmax(found.p.values))
    assert top == found.p[place] and top > 2 * found.p0
    assert radius == found.a * found.x[place] and 0.8 < radius / found.a < 1
    for plain in ({"base": "half_space"}, {"h": 0.01, "n": 0.1}, {"h": 0.01, "n": 0, "bonding": "bonded"}):
        found = study.solve(**SMOOTH, **plain)
        assert derived.ring_radius(found) == 0
        np.testing.assert_allclose(derived.largest_nominal_pressure(found), found.p0, rtol=1e-12)


def test_the_ring_of_each_case_and_of_none():
    found = study.solve(a=[0.005, 0.03], micro="smooth", **PLATE)
    assert (derived.ring_radius(found) > 0).values.tolist() == [False, True]
    gone = found.where(found.a > 0.01)
    assert np.isnan(derived.ring_radius(gone)[0]) and np.isnan(derived.largest_nominal_pressure(gone)[0])
    with pytest.raises(ValueError, match="p_ring needs the profile p, which profiles = false leaves out"):
        derived.largest_nominal_pressure(found.drop_vars("p"))
    with pytest.raises(ValueError, match="r_ring needs the profile p"):
        derived.ring_radius(found.drop_vars("p"))


@pytest.mark.parametrize("m", [0.0, 0.5, 2.0])
def test_of_hertz_each_body_has_its_share(m):
    found = study.solve(**SMOOTH, m=m, base="half_space")
    np.testing.assert_allclose(derived.depth_of_the_body(found), found.D / (1 + m), rtol=2e-6)  # 33 points


@pytest.mark.parametrize("micro", [SMOOTH, ROUGH, ROUGH | {"micro": "normal_heights", "sigma": 1e-5}])
@pytest.mark.parametrize("layer", [{"h": 0.02, "n": 0.5}, PLATE, {"h": 0.02, "n": 0, "bonding": "bonded"}])
def test_the_body_alone_is_what_its_kernel_makes_of_the_pressure(micro, layer):
    """u(0) of the layer, without the punch, by the Hankel transform of docs/model.md, and its part of A[p(0)]."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    angle, w = (nodes + 1) * np.pi / 4, weights * np.pi / 4  # r = a sin(angle)
    x, wx = np.sin(angle), w * np.cos(angle)
    found = study.solve(**micro, **layer, m=0.7, rtol=1e-6, x=np.r_[0, x, 1])
    a, p, n = float(found.a), found.p.values[1:-1], layer["n"] + (layer["n"] == 0)
    k, wk = np.polynomial.legendre.leggauss(400)
    top = 30 / layer["h"]  # L - 1 falls as exp(-2 k h)
    k, wk = top * (k + 1) / 2, top * wk / 2
    transform = j0(np.outer(k, a * x)) @ (wx * x * a**2 * p)
    L1 = layered_kernel(k * layer["h"], layer["n"], 0.3, 0.3, layer.get("bonding") == "bonded").L1
    half_space = a * np.sum(wx * p)  # ∫ p dr
    u0 = 2 / n * (half_space + np.sum(wk * L1 * transform))
    expected = u0 + float(found.A0) / 1.7
    both = u0 + 2 / n * 0.7 * half_space + float(found.A0)
    assert both == pytest.approx(float(found.D), rel=1e-4), "the sum of what docs/model.md says"
    assert derived.depth_of_the_body(found).item() == pytest.approx(expected, rel=1e-4)


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_with_units_it_is_the_same_in_m():
    scene = {"R": "5 mm", "E1": "5 GPa", "E2": "210 GPa", "h": "20 um", "P": "10 N", "Nbar": "0.1 1/um^2", "Ra": "5 um"}
    for more in ({"E2": ["70 GPa", "rigid"]}, {"base": "half_space"}):
        found = study.solve(**scene | more, E_punch="70 GPa")
        own = derived.depth_of_the_body(found)
        assert own.attrs["units"] == "m" and (own < found.D).all() and (own > 0).all()
        unit = 5e9 / (1 - 0.3**2) if "E2" in more else 210e9 / (1 - 0.3**2)
        m = unit / (70e9 / (1 - 0.3**2))
        dimensionless = {"m": m, "P": 10 / (unit * 25e-6), "Nbar": 0.1e12 * 25e-6, "Ra": 1e-3}
        layer = {"base": "half_space"} if "base" in more else {"h": 4e-3, "n": 0}
        plain = study.solve(**dimensionless, **layer)
        last = own.isel(E2=-1) if "E2" in own.dims else own
        np.testing.assert_allclose(last, derived.depth_of_the_body(plain) * 5e-3, rtol=1e-9)
    rigid = study.solve(**scene)
    np.testing.assert_array_equal(derived.depth_of_the_body(rigid.drop_vars("p")), rigid.D)


def test_a_profile_of_too_few_points_gives_no_number():
    """LOAD_MISSED: with more of the load missed D_body is NaN, with less its error is below that times D."""
    for given in (SMOOTH | {"base": "half_space"}, ROUGH | {"h": 0.02, "n": 0.5}, SMOOTH | PLATE):
        fine = study.solve(**given, m=3.0, x=769)
        right = derived.depth_of_the_body(fine)
        for points in (5, 7, 9, 17, 33):
            coarse = derived.depth_of_the_body(fine.isel(x=slice(None, None, 768 // (points - 1))))
            assert np.isnan(coarse) or abs(coarse - right) < derived.LOAD_MISSED * fine.D, points
        assert np.isfinite(coarse)
    assert np.isnan(derived.depth_of_the_body(study.solve(**ROUGH, h=0.02, n=0.5, m=3.0, x=5)))
    with pytest.raises(ValueError, match="D_body needs the profile p at 5 points or more, such as x = 33"):
        derived.depth_of_the_body(study.solve(**SMOOTH, base="half_space", m=1.0, x=2))
    with pytest.raises(ValueError, match="D_body needs the profile p, which profiles = false leaves out"):
        derived.depth_of_the_body(study.solve(**SMOOTH, base="half_space", m=1.0, profiles=False))


def test_where_auto_leaves_the_asperities_out_of_D_the_body_has_none():
    given = {"P": 1e-4, "h": 1.0, "n": 0.9, "Nbar": 1e10, "Ra": 1e-3, "m": 1.0, "base": "auto", "accuracy": 0.1}
    found = study.solve(**given)
    assert study.decode(found.model_used).item().startswith("smooth_") and found.A0 > 0
    bare = study.solve(**{name: given[name] for name in ("h", "n", "m", "base", "accuracy", "P")}, micro="smooth")
    np.testing.assert_allclose(derived.depth_of_the_body(found), derived.depth_of_the_body(bare), rtol=1e-9)
