"""How sure a fit is where its points hang together, and what is said where they do not agree with the model."""

import numpy as np
import pytest
from conftest import ROOT

import study
from study.inverse.fits.residuals import noise_of

MEASURED = ROOT / "tests/inverse/misfit/measured"
BARE = {"R": "5 um", "punch": "rigid", "nu2": 0.3, "micro": "smooth", "base": "half_space", "progress": False}
FISH = {"R": "18.64 um", "punch": "rigid", "nu2": 0.5, "micro": "smooth", "base": "half_space", "progress": False}
E = 5e3
DEPTHS = np.linspace(-0.3, 1, 150) * 1e-6


def hertz(depths, E=E):
    return 4 / 3 * E / (1 - 0.3**2) * np.sqrt(5e-6) * np.maximum(depths, 0.0) ** 1.5


def correlated(factor, shape, seed=0):
    """Noise of which each point is `factor` of the one before and something new, of standard deviation 1."""
    random = np.random.default_rng(seed)
    noise = random.standard_normal(shape)
    for i in range(1, shape[1]):
        noise[:, i] = factor * noise[:, i - 1] + np.sqrt(1 - factor**2) * noise[:, i]
    return noise


@pytest.mark.parametrize(("factor", "low", "high"), [(0.0, 0.91, 0.985), (0.5, 0.89, 1.0), (0.8, 0.9, 1.0)])
def test_intervals_hold_the_truth_whether_or_not_points_hang_together(factor, low, high):
    """In 95 % of 200 curves; points that count as independent ones make it half of them with 0.8."""
    P = hertz(DEPTHS)
    curves = P + 0.02 * P.max() * correlated(factor, (200, len(P)))
    fitted = study.fit({"D": (DEPTHS, "m"), "P": (curves, "N")}, free=["E2"], intervals="fisher", **BARE)
    covered = ((fitted.E2_low < E) & (fitted.E2_high > E)).values
    assert low <= covered.mean() <= high
    independent = fitted.effective_points.values == len(DEPTHS)
    assert independent.mean() > 0.95 if factor == 0 else independent.mean() < 0.1


def test_profiles_and_fisher_are_as_wide():
    P = hertz(DEPTHS)
    noisy = P + 0.005 * P.max() * correlated(0.9, (1, len(P)))
    ways = [study.fit({"D": (DEPTHS, "m"), "P": (noisy, "N")}, free=["E2"], intervals=way, **BARE)
            for way in ("profile", "fisher")]  # fmt: skip
    widths = [(fitted.E2_high - fitted.E2_low).item() for fitted in ways]
    assert widths[0] == pytest.approx(widths[1], rel=0.05)
    assert ways[0].effective_points < 50


def cell(count=None):
    """The approach to a cell; of `count` points between its 500, which say nothing new."""
    curve = study.curves(MEASURED / "approach_zebrafish.csv")
    D, P = curve.D.values[0], curve.P.values[0]
    if count is None:
        return {"D": (D, "m"), "P": (P, "N")}
    places = np.linspace(0, len(D) - 1, count)
    D, P = (np.interp(places, np.arange(len(D)), column) for column in (D, P))
    return {"D": (D, "m"), "P": (P, "N")}


def test_a_curve_is_as_sure_at_any_sampling():
    """E ± 2 Pa with 125 to 10,000 points, where it was 0.8, 0.4 and 0.09; blocks that are drawn anew have some 1.5."""
    fits = [study.fit(cell(count), free=["E2"], intervals="fisher", **FISH) for count in (125, None, 10_000)]
    spreads = [fitted.E2_spread.item() for fitted in fits]
    assert all(1.0 < spread < 3.0 for spread in spreads) and max(spreads) < 1.4 * min(spreads)
    for fitted in fits:
        assert fitted.E2.item() == pytest.approx(72.9, abs=0.8)


def test_what_does_not_agree_is_said():
    fitted = study.fit(cell(), free=["E2"], **FISH)
    text = str(study.summary(fitted))
    assert fitted.misfit_larger and fitted.misfit_ratio == pytest.approx(3.1, abs=0.2) and fitted.changes
    for words in (
        "The residuals are correlated: 500 points",
        "as far from the fit as before it",
        "E2 changes with the",
    ):
        assert words in text
    assert "E2 by quarters of the depth, the shallowest first: 8" in text and fitted.E2_over_depth.shape == (1, 4)
    parts = fitted.E2_over_depth.values[0]
    np.testing.assert_allclose(parts[1:], [70, 71.6, 73.4], rtol=0.02)


def test_a_film_measured_with_drift_has_no_clean_bill():
    """5 % of drift of the stiffness make 230 GPa of 200."""
    film = {"R": "1 mm", "h": "500 nm", "nu1": 0.2, "bonding": "bonded", "body": "silicon", "punch": "rigid"}
    a = np.linspace(50, 1500, 60) * 1e-9
    radii = [f"{float(radius)!r} m" for radius in a]
    solved = study.solve(**film, micro="smooth", E1="200 GPa", a=radii, x=2, profiles=False, progress=False)
    stiffness = solved.dP_dD.values
    noise = 1 + 0.003 * np.random.default_rng(1).standard_normal(len(a))
    texts = []
    for drift in (0.0, 0.05):
        data = {"a": (a, "m"), "dP_dD": (stiffness * noise * (1 + drift * a / a.max()), "N/m")}
        fitted = study.fit(data, **film, micro="smooth", free=["E1"], x="a", y="dP_dD", progress=False)
        texts.append(str(study.summary(fitted)))
    assert "none of the checked assumptions" in texts[0] and "are correlated" not in texts[0]
    assert "none of the assumptions" not in texts[1] and "E1 changes with the depth" in texts[1]


def test_readings_at_one_depth_are_independent():
    """The noise of two readings of each depth is white, though neighbours in the list are alike."""
    random = np.random.default_rng(2)
    x, X = np.repeat(np.arange(60.0), 2), np.ones((120, 1))
    e = np.repeat(random.standard_normal(60), 2)
    assert noise_of(x, e - e.mean(), X, x > 1e9).middle is None
    waves = noise_of(np.arange(120.0), e - e.mean(), X, x > 1e9)
    assert waves.middle is not None and waves.middle[0, 0] > 1.3 * (e**2).sum()


def test_a_part_of_the_depth():
    """Its points alone are in contact; those before the contact stay. The contact point is that of all points."""
    P = hertz(DEPTHS - 1e-7) * (1 + 0.4 * (DEPTHS > 6e-7))
    data = {"D": (DEPTHS, "m"), "P": (P, "N")}
    whole = study.fit(data, free=["E2"], **BARE)
    part = study.fit(data, free=["E2"], depth=("0 nm", "400 nm"), **BARE)
    assert whole.E2.item() > 1.2 * E and part.E2.item() == pytest.approx(E, rel=1e-5)
    kept = np.isfinite(part.residual.values[0])
    assert kept[DEPTHS < 0].all() and not kept[DEPTHS > 6e-7].any()
    fewer = study.fit(data, free=["E2"], depth=(-2e-7, 4e-7), **BARE)
    assert fewer.E2.item() == pytest.approx(E, rel=1e-5) and np.isnan(fewer.residual.values[0, 0])


@pytest.mark.parametrize(
    ("depth", "message"),
    [
        (3, "depth = 3: must be (low, high)"),
        (("1 um",), "must be (low, high)"),
        (("2 um", "1 um"), "depth = (2 um, 1 um): the low end must be below the high one"),
        (("-2 um", "-1 um"), "and that above 0"),
        (("0 nm", np.inf), "depth = (0 nm, inf): the low end must be below the high one"),
        ((-np.inf, "1 um"), "depth = (-inf, 1 um): the low end must be below the high one"),
        ((np.nan, "1 um"), "depth = (nan, 1 um): the low end must be below the high one"),
        (("0 nN", "1 nN"), "is a force: must be a length"),
    ],
)
def test_parts_that_are_none(depth, message):
    with pytest.raises(study.StudyError) as error:
        study.fit({"D": (DEPTHS, "m"), "P": (hertz(DEPTHS), "N")}, free=["E2"], depth=depth, **BARE)
    assert message in str(error.value)


LAYER = {"R": "18.64 um", "punch": "rigid", "nu1": 0.5, "E2": "rigid", "bonding": "bonded", "micro": "smooth"}


@pytest.mark.parametrize("free", [["E1"], ["E1", "h"]])
def test_points_that_hang_together_do_not_overrule_a_prior(free):
    """h = 100 ± 10 µm of a curve whose misfit takes it for 21 µm; the ± of an input that is free is a prior too."""
    fitted = study.fit(cell(), free=free, h="100 ± 10 um", intervals="fisher", progress=False, **LAYER)
    assert fitted.h.item() == pytest.approx(1e-4, rel=0.06) and fitted.h_spread.item() == pytest.approx(1e-5, rel=0.1)
    assert fitted.fit_status.item() == 0


def test_long_curves_have_the_answer_of_all_points():
    """1,500 points with noise, fitted by averages first, against a search by all of them."""
    from study.inverse.fits import block

    D = np.linspace(-0.3, 1, 1500) * 1e-6
    P = hertz(D) + 0.02 * hertz(1e-6) * np.random.default_rng(3).standard_normal(len(D))
    order = np.random.default_rng(4).permutation(len(D))
    fits = [study.fit({"D": (D[rows], "m"), "P": (P[rows], "N")}, free=["E2"], **BARE) for rows in (slice(None), order)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(block, "LONG", 10_000)
        whole = study.fit({"D": (D, "m"), "P": (P, "N")}, free=["E2"], **BARE)
    for fitted in fits:
        for name, sure in {"E2": 1e-6, "E2_spread": 1e-6, "E2_low": 5e-5, "E2_high": 5e-5}.items():
            assert fitted[name].item() == pytest.approx(whole[name].item(), rel=sure), name
        np.testing.assert_allclose(fitted.residual.values.std(), whole.residual.values.std(), rtol=1e-8)


def test_a_curve_that_contradicts_a_prior_says_so():
    """Loads of 5 kPa with hardly a noise, and 3 ± 0.1 kPa in the call."""
    P = hertz(DEPTHS) * (1 + 1e-3 * np.random.default_rng(5).standard_normal(len(DEPTHS)))
    data = {"D": (DEPTHS, "m"), "P": (P, "N")}
    texts = []
    for prior in ("3 ± 0.1 kPa", "5 ± 0.1 kPa"):
        fitted = study.fit(data, free=["E2"], E2=prior, intervals=None, **BARE)
        texts.append(str(study.summary(fitted)))
    assert "standard deviations from its value in the call" in texts[0] and "its value in the call" not in texts[1]
    assert abs(fitted.E2_from_prior.item()) < 1
