"""`study.fit` finds what the curve was made with, whatever the order, the offsets and the company of its points."""

import re

import numpy as np
import pytest
import xarray as xr
from measured_curves import DEPTHS, GEL, fit, gel, solved, status

import study

ROUGH = {"R": "10 mm", "E_punch": "207 GPa", "nu_punch": 0.29, "nu1": 0.25, "E2": "207 GPa", "nu2": 0.29}
ROUGH |= {"bonding": "bonded", "Nbar": "0.2 1/um^2", "Ra": "5 um"}
BARE = {"R": "5 um", "nu2": 0.3, "micro": "smooth", "base": "half_space"}

#: name -> x, y, x in SI, free inputs and their true values in SI, the rest of the call.
EXACT = {
    "gel": ("D", "P", DEPTHS, {"E1": 5e3}, GEL),
    "gel, h free": ("D", "P", DEPTHS, {"E1": 5e3, "h": 1.5e-6}, GEL),
    "gel on a rigid base": ("D", "P", DEPTHS, {"E1": 5e3}, GEL | {"E2": "rigid", "nu2": None}),
    "gel that slides": ("D", "P", DEPTHS, {"E1": 5e3}, GEL | {"bonding": "frictionless", "nu1": 0.3}),
    "body under a film": ("D", "P", DEPTHS / 8, {"E2": 3e9}, GEL | {"E1": "1 GPa", "E2": None}),
    "radius": ("D", "P", DEPTHS, {"R": 5e-6}, GEL | {"E1": "5 kPa"}),
    "half-space": ("D", "P", DEPTHS, {"E2": 2e5}, BARE),
    "thin layer": ("D", "P", DEPTHS / 40, {"E1": 5e3}, GEL | {"nu1": 0.3, "h": "500 nm", "base": "thin_layer"}),
    "optical contact": ("P", "a", np.linspace(0, 4e-8, 60), {"E1": 5e3}, GEL),
    "stiffness of a hard film": ("a", "dP_dD", np.linspace(0.05, 2, 60) * 1e-6, {"E1": 2e11}, GEL | {"nu1": 0.25}),
    "stiffness of a half-space": ("a", "dP_dD", np.linspace(0.05, 2, 60) * 1e-6, {"E2": 2e5}, BARE),
    "rough": ("D", "P", np.linspace(-0.2, 1, 60) * 2e-7, {"E1": 2e11}, ROUGH | {"h": "20 um"}),
    "asperities": ("D", "P", np.linspace(-0.2, 1, 60) * 2e-7, {"Nbar": 2e11}, ROUGH | {"E1": "200 GPa", "h": "20 um"}),
}  # fmt: skip
UNITS = {"D": "m", "P": "N", "a": "m", "dP_dD": "N/m", "E1": "Pa", "E2": "Pa", "h": "m", "R": "m", "Nbar": "1/m^2"}


@pytest.mark.parametrize("name", EXACT)
def test_without_noise_the_truth_comes_back(name):
    """To 1e-4, the bar: by curves of the solver, not of the table."""
    x, y, values, free, given = EXACT[name]
    given = {key: value for key, value in given.items() if value is not None}
    truth = {key: f"{value!r} {UNITS[key]}" for key, value in free.items()}
    measured = {x: (values, UNITS[x]), y: (solved(x, y, values, **given | truth), UNITS[y])}
    # a bound is a decade from the truth on one side, half of that on the other, so that the truth is not in the middle
    bounds = {key: (f"{value / 5!r} {UNITS[key]}", f"{10 * value!r} {UNITS[key]}") for key, value in free.items()}
    given = {key: value for key, value in given.items() if key not in free}
    fitted = study.fit(measured, x=x, y=y, free=bounds, intervals="fisher", progress=False, **given)
    assert status(fitted) == ["converged"]
    for key, value in free.items():
        np.testing.assert_allclose(fitted[key], value, rtol=1e-4)
        assert fitted[key].attrs["units"] == UNITS[key]
    scale = np.abs(measured[y][0]).max()
    np.testing.assert_allclose(fitted[f"{y}_fit"][0], measured[y][0], rtol=0, atol=1e-5 * scale)
    np.testing.assert_allclose(fitted.residual[0], measured[y][0] - fitted[f"{y}_fit"][0], rtol=0, atol=1e-12 * scale)


def test_hertz_gives_hertz():
    """To 1e-6, of loads by Hertz's formula: the bar."""
    E, R = 2.3e5, 5e-6
    P = 4 / 3 * E / (1 - 0.3**2) * np.sqrt(R) * np.maximum(DEPTHS, 0.0) ** 1.5
    fitted = study.fit({"D": (DEPTHS, "m"), "P": (P, "N")}, free=["E2"], progress=False, **BARE)
    np.testing.assert_allclose(fitted.E2, E, rtol=1e-6)


NUMBERS = ("E1", "E1_low", "E1_high", "E1_spread", "P0", "P0_spread", "D0_spread")


def numbers(fitted):
    return {name: fitted[name].values for name in NUMBERS}


def test_order_and_offsets_of_the_points_do_not_count():
    """Points in another order, with NaN among them, and a depth and a load from any zero: the same E1, other D0, P0."""
    P, _ = gel()
    usual = numbers(fit(DEPTHS, P))
    order = np.random.default_rng(0).permutation(len(P))
    holes = np.array([np.insert(A, [0, 50, 120], np.nan) for A in (DEPTHS, P)])
    points = {"order": (DEPTHS[order], P[order]), "backwards": (DEPTHS[::-1], P[::-1]), "NaN": holes}
    for name, (depths, loads) in points.items():
        other = fit(depths, loads)
        for key, value in usual.items():
            np.testing.assert_allclose(other[key], value, rtol=1e-6, atol=1e-14, err_msg=f"{name}, {key}")
    for D0, P0 in ((-5e-6, 1e-3), (-1e-7, -1e-6), (5e-6, -1e-6)):
        other = fit(DEPTHS + D0, P + P0)
        assert status(other) == ["converged"]
        np.testing.assert_allclose(other.E1, usual["E1"], rtol=1e-6)
        np.testing.assert_allclose(other.P0 - P0, usual["P0"], rtol=0, atol=1e-3 * usual["P0_spread"][0])


def test_repeated_depths():
    """Two readings at each depth count as two: spreads are smaller by the root of 2, with four more unknowns' worth."""
    P, _ = gel()
    once, twice = fit(DEPTHS, P), fit(np.repeat(DEPTHS, 2), np.repeat(P, 2))
    np.testing.assert_allclose(twice.E1, once.E1, rtol=1e-6)
    np.testing.assert_allclose(twice.E1_spread / once.E1_spread, np.sqrt((120 - 3) / (240 - 3)), rtol=1e-6)


@pytest.mark.parametrize("free", [("E1",), ("E1", "h")])
def test_the_bits_of_a_curve_do_not_depend_on_its_company(free):
    """Alone, among 70 others of other lengths and moduli, and in another order."""
    random = np.random.default_rng(5)
    depths = DEPTHS[::2]
    P, sigma = gel(depths=depths)
    count = 71 if free == ("E1",) else 5  # one block of 64 and a part of another
    curves = P * np.exp(random.uniform(-2, 2, count))[:, None] + sigma * random.standard_normal((count, len(P)))
    curves[1, 30:] = np.nan
    curves[2] = np.nan
    intervals = "fisher" if free == ("E1",) else "profile"
    together = fit(depths, curves, free, intervals)
    turned = fit(depths, curves[::-1], free, intervals).isel(curve=slice(None, None, -1))
    for name in together.data_vars:
        np.testing.assert_array_equal(turned[name].values, together[name].values, err_msg=name)
    for i in (0, 1, 3, count - 1):
        alone = fit(depths, curves[[i]], free, intervals)
        for name in together.data_vars:
            np.testing.assert_array_equal(alone[name].values[0], together[name].values[i], err_msg=f"{name} of {i}")


def test_sigma_as_a_number_a_text_and_an_array():
    P, sigma = gel()
    ways = (sigma, f"{1e9 * float(sigma)!r} nN", np.full(len(P), sigma), np.full((1, len(P)), sigma))
    fits = [fit(DEPTHS, P, sigma=way) for way in ways]
    for other in fits[1:]:
        np.testing.assert_allclose(other.E1_spread, fits[0].E1_spread, rtol=1e-9)
    by_scatter = fit(DEPTHS, P)
    chi = np.sqrt((by_scatter.residual.values**2).sum() / (len(P) - 3)) / sigma
    np.testing.assert_allclose(by_scatter.E1_spread, fits[0].E1_spread * chi, rtol=1e-6)
    np.testing.assert_allclose(fits[0].E1, by_scatter.E1, rtol=1e-6)


def test_intervals_and_covariance():
    """Fisher's ends are exp(ln E1 ± t sd), of D0 and P0 linear; Student's t of N - 3. The covariance is in SI."""
    from scipy.stats import norm, t

    P, sigma = gel()
    for level in (0.5, 0.95):
        fitted, sure = fit(DEPTHS, P, level=level), fit(DEPTHS, P, level=level, sigma=sigma)
        for result, quantile in ((fitted, t.ppf((1 + level) / 2, 117)), (sure, norm.ppf((1 + level) / 2))):
            width = quantile * result.E1_spread / result.E1
            np.testing.assert_allclose(result.E1_low, result.E1 * np.exp(-width), rtol=1e-9)
            np.testing.assert_allclose(result.E1_high, result.E1 * np.exp(width), rtol=1e-9)
            for name in ("D0", "P0"):
                half = quantile * result[f"{name}_spread"]
                np.testing.assert_allclose(result[f"{name}_high"] - result[name], half, rtol=1e-9)
                np.testing.assert_allclose(result[name] - result[f"{name}_low"], half, rtol=1e-9)
            assert result.covariance.cov_i.values.tolist() == ["E1", "D0", "P0"]
            for name in ("E1", "D0", "P0"):
                variance = result.covariance.sel(cov_i=name, cov_j=name)
                np.testing.assert_allclose(np.sqrt(variance), result[f"{name}_spread"], rtol=1e-9)
    assert fit(DEPTHS, P, intervals=None).E1_spread > 0 and "E1_low" not in fit(DEPTHS, P, intervals=None)


def test_profiles_of_a_curve_that_says_much_are_fisher_s():
    P, _ = gel(noise=1e-3)
    profile, fisher = fit(DEPTHS, P, intervals="profile"), fit(DEPTHS, P)
    for name in ("E1_low", "E1_high"):
        np.testing.assert_allclose(profile[name] - profile.E1, fisher[name] - fisher.E1, rtol=0.02)


def test_spreads_of_other_inputs_are_taken_over():
    """Of R ± 2 %: by how much E1 of the same curve differs if R is moved by that."""
    P, _ = gel(noise=1e-4)
    fitted, exact = fit(DEPTHS, P, R="5 ± 0.1 um"), fit(DEPTHS, P)
    moved = [fit(DEPTHS, P, R=f"{radius} um").E1.item() for radius in (5.01, 4.99)]
    follows = (moved[0] - moved[1]) / 0.02 * 0.1
    np.testing.assert_allclose(fitted.E1_spread, np.hypot(exact.E1_spread, follows), rtol=2e-3)
    np.testing.assert_allclose(fitted.E1, exact.E1, rtol=1e-9)
    ratio = fit(DEPTHS, P, nu1="0.45 ± 0.01", nu_punch="0 ± 0.1", E_punch="70 GPa")
    assert status(ratio) == ["converged"] and ratio.E1_spread > 2 * exact.E1_spread


def test_a_prior_is_an_unknown_of_its_own():
    """h = 1.5 ± 0.1 µm: h is an output, and E1 knows less. ± 0 is exact; a wide prior is none."""
    P, _ = gel()
    prior, exact, none = fit(DEPTHS, P, h="1.5 ± 0.1 um"), fit(DEPTHS, P), fit(DEPTHS, P, free=("E1", "h"))
    assert list(prior.covariance.cov_i.values) == ["E1", "h", "D0", "P0"]
    assert exact.E1_spread < prior.E1_spread < none.E1_spread
    assert prior.h_spread < 1.01e-7
    assert "h" not in fit(DEPTHS, P, h="1.5 ± 0 um")
    tight = fit(DEPTHS, P, h="1.5 ± 0.000001 um")
    np.testing.assert_allclose(tight.E1, exact.E1, rtol=1e-4)
    np.testing.assert_allclose(tight.E1_spread, exact.E1_spread, rtol=0.01)


def test_a_named_layer_gives_its_ratio_and_its_modulus_is_fitted():
    """Poisson's ratio of PTFE, whose spread is taken over."""
    P, _ = gel(nu1=0.46)
    named, by_hand = fit(DEPTHS, P, layer="PTFE", nu1=None), fit(DEPTHS, P, nu1=study.materials.get("PTFE").nu)
    np.testing.assert_allclose(named.E1, by_hand.E1, rtol=1e-6)
    assert named.E1_spread > by_hand.E1_spread


def _plan(D, P, sigma):
    """Of a dataset that has the loads too: they say nothing of a plan."""
    both = xr.Dataset({"D": ("point", D, {"units": "m"}), "P": ("point", 7 * P, {"units": "N"})})
    return study.fit(both, free=["E1"], plan=True, sigma=sigma, E1="5 kPa", progress=False, **GEL)


def test_a_plan_takes_a_file_or_a_dataset_of_loads(tmp_path):
    """One column is enough, whichever x is."""
    loads = np.linspace(0.1, 2, 40)
    (tmp_path / "loads.csv").write_text("P [nN]\n" + "\n".join(map(repr, loads.tolist())), encoding="utf-8")
    dataset = xr.Dataset({"P": ("point", loads, {"units": "nN"})})
    sources = (tmp_path / "loads.csv", dataset, {"P": (loads, "nN")})
    options = {"x": "P", "y": "a", "free": ["E1"], "sigma": "5 nm", "plan": True, "E1": "5 kPa", "progress": False}
    planned = [study.fit(source, **options, **GEL).E1_spread.item() for source in sources]
    assert 1 < planned[0] < 1e3 and len({*planned}) == 1
    with pytest.raises(study.StudyError, match="D is not there, P is; x = D, y = P are to be fitted"):
        study.fit(dataset, **options | {"x": "D", "y": "P", "sigma": "1 pN"}, **GEL)


def test_plan_says_how_sure_a_fit_would_be():
    """The spreads of a plan are those of fits of curves with that noise."""
    P, sigma = gel()
    planned = study.fit({"D": (DEPTHS, "m")}, free=["E1"], plan=True, sigma=sigma, E1="5 kPa", progress=False, **GEL)
    np.testing.assert_allclose(planned.E1_spread, fit(DEPTHS, P, sigma=sigma).E1_spread, rtol=0.05)
    np.testing.assert_array_equal(planned.E1_spread, _plan(DEPTHS, P, sigma).E1_spread)
    assert "residual" not in planned and "P_fit" not in planned and status(planned) == ["converged"]
    text = str(study.summary(planned))
    assert "nu1 = 0.49, E1 = 5 kPa, " in text or "E1 = 5 kPa, nu1 = 0.49, " in text
    assert re.search(r"E1 = assumed, ± \d+ Pa\n", text)


def test_names_of_curves_stay():
    P, _ = gel()
    dims = ("curve", "point")
    columns = {"D": (dims, [DEPTHS, DEPTHS], {"units": "m"}), "P": (dims, [P, P], {"units": "N"})}
    curves = xr.Dataset(columns, {"curve": ["left", "right"]})
    fitted = study.fit(curves, free=["E1"], intervals=None, progress=False, **GEL)
    assert fitted.E1.sel(curve="right").item() == fitted.E1.sel(curve="left").item()
