"""Missing points of a scan: filled in where they are few, refused where they are many."""

import numpy as np
import pytest
from surfaces import rough

from study import roughness
from study.specimen.heights import scan_peaks
from study.specimen.heights.missing import filled

STEP = 1e-7


def holed(seed, share):
    z = rough(seed=seed)
    holes = np.random.default_rng(seed + 1).random(z.shape) < share
    return z, np.where(holes, np.nan, z)


@pytest.mark.parametrize("seed", range(4))
def test_filling_one_point_in_a_hundred_changes_the_numbers_by_less_than_one_percent(seed):
    whole, holes = holed(seed, 0.009)  # a little below the limit of 1 %, which the share of a random mask may exceed
    before, after = (roughness.measure(roughness.height_map(z, dx=STEP, dy=STEP)) for z in (whole, holes))
    np.testing.assert_allclose([after.Nbar, after.Ra], [before.Nbar, before.Ra], rtol=0.01, atol=0)


def test_more_are_refused_with_the_share_and_both_ways_out():
    with pytest.raises(ValueError, match=r"2\.\d+ %(.|\n)*skip"):
        roughness.height_map(holed(0, 0.025)[1], dx=STEP, dy=STEP)


def skipped(z, **given):
    return roughness.measure(roughness.height_map(z, dx=STEP, missing="skip"), **given)


@pytest.mark.parametrize("share", [0.05, 0.2, 0.35])
@pytest.mark.parametrize("method", ["moments", "summits"])
def test_any_share_is_skipped_where_it_is_asked_for(share, method):
    """To three standard errors of the summits that are left, whose stencils are whole: (1 - share)⁹ of them."""
    whole, holes = holed(3, share)
    before, after = (
        roughness.measure(roughness.height_map(whole, dx=STEP), method=method),
        skipped(holes, method=method),
    )
    left = before.Nbar * (256 * STEP) ** 2 * (1 - share) ** 9
    error = 3 / np.sqrt(left) if method == "summits" else 0.05
    np.testing.assert_allclose(after.Nbar, before.Nbar, rtol=error, atol=0)
    np.testing.assert_allclose(after.Ra, before.Ra, rtol=error, atol=0)
    np.testing.assert_allclose(after.sigma_summits, before.sigma_summits, rtol=max(error, 0.05), atol=0)
    assert any(f"{100 * np.isnan(holes).mean():.2g} % of the heights are missing" in note for note in after.notes)


def test_statistics_are_of_points_whose_stencil_is_whole():
    """Against loops over the points."""
    z = holed(1, 0.2)[1][:40, :50]
    z = z - np.nanmean(z)
    first, second, summits, inner = [], [], [], 0
    for table in (z, z.T):
        for row in table:
            first += [(b - a) ** 2 for a, b in zip(row, row[1:], strict=False) if np.isfinite(a + b)]
            bends = (a - 2 * b + c for a, b, c in zip(row, row[1:], row[2:], strict=False))
            second += [bend**2 for bend in bends if np.isfinite(bend)]
    for i in range(1, 39):
        for j in range(1, 49):
            stencil = z[i - 1 : i + 2, j - 1 : j + 2]
            if np.isfinite(stencil).all():
                inner += 1
                if z[i, j] == stencil.max():
                    summits.append(z[i, j])
    answer = skipped(z, form="mean")
    m2, m4 = np.mean(first) / STEP**2, np.mean(second) / STEP**4
    # along x and y there are not quite as many
    np.testing.assert_allclose(answer.Nbar, m4 / m2 / (6 * np.pi * np.sqrt(3)), rtol=0.01, atol=0)
    np.testing.assert_allclose(answer.Ra, 0.375 * np.sqrt(np.pi / m4), rtol=0.01, atol=0)
    counted = skipped(z, form="mean", method="summits")
    np.testing.assert_allclose(counted.Nbar, len(summits) / (inner * STEP**2), rtol=1e-12, atol=0)
    np.testing.assert_allclose(counted.sigma_summits, np.std(summits), rtol=1e-12, atol=0)
    # the asperities that are expected, and the cut, are those of the measured points
    share = np.isfinite(z).mean()
    np.testing.assert_allclose(counted.summits, counted.Nbar * share * z.size * STEP**2, rtol=1e-12, atol=0)


def test_a_gap_has_no_asperities():
    """Half of the scan was not measured: the density is that of the other half."""
    z = holed(2, 0.0)[0]
    surface_with_gap = z.copy()
    surface_with_gap[:, 128:] = np.nan
    half = roughness.measure(roughness.height_map(z[:, :128], dx=STEP), method="summits")
    gap = skipped(surface_with_gap, method="summits")
    assert (gap.Nbar, gap.Ra) == pytest.approx((half.Nbar, half.Ra), rel=1e-12)
    assert gap.summits == pytest.approx(half.summits, rel=1e-12)


def test_the_doubt_counts_the_summits_that_are_found():
    """Of 300 asperities on the area, gaps leave some ten that can be seen."""
    answer = skipped(holed(3, 0.35)[1], method="summits")
    found = int(answer.method.split()[0])
    assert found < 30 and answer.summits > 100
    assert any(f"about {found} asperities: N̄ is uncertain by some" in note for note in answer.notes)
    with pytest.raises(ValueError, match="no summits: none of 256 × 256 points with all their neighbours is higher"):
        skipped(holed(3, 0.5)[1], method="summits")


@pytest.mark.parametrize("method", ["moments", "summits"])
def test_too_few_points_are_refused(method):
    """Of 90 % missing at random, hardly any has all its neighbours; a profile needs eight."""
    z = holed(0, 0.9)[1]
    with pytest.raises(
        ValueError, match=r"^the map: \d+ of 65536 points have all their neighbours; at least 64 are need"
    ):
        skipped(z, method=method)
    line = np.where(np.arange(60) % 3 == 0, np.nan, rough()[0, :60])
    with pytest.raises(
        ValueError, match="^the profile: 0 of 60 points have all their neighbours; at least 8 are needed"
    ):
        roughness.measure(roughness.profile(line, dx=STEP, missing="skip"), method=method)
    # also those that a low-pass leaves
    spots = np.full((256, 256), np.nan)
    spots[::40, ::40] = rough()[::40, ::40]
    with pytest.raises(ValueError, match="points have all their neighbours"):
        skipped(spots, method=method, cutoff=6e-7, form="mean")


def moments(z):
    found = scan_peaks.gaussian_summits(scan_peaks.mean_moments(scan_peaks.moments(z, (STEP, STEP))))
    return np.array([found.density, found.curvature])


@pytest.mark.parametrize("share", [0.05, 0.2])
def test_a_low_pass_over_gaps_as_wide_as_asperities(share):
    """As the comment of MEASURED says; against the mean of the points that are there, too."""
    steps, cutoff = (STEP, STEP), 1e-6
    for seed in range(3):
        whole, gaps = rough(seed=seed), rough(shortest=20, seed=seed + 50)
        holes = np.where(gaps > np.quantile(gaps, 1 - share), np.nan, whole)
        known = moments(scan_peaks.low_pass(whole, steps, cutoff))
        np.testing.assert_allclose(moments(scan_peaks.low_pass(holes, steps, cutoff)), known, rtol=0.01, atol=0)
        there = np.isfinite(holes)
        means = scan_peaks.low_pass(np.where(there, holes, 0.0), steps, cutoff) / scan_peaks.low_pass(
            1.0 * there, steps, cutoff
        )
        assert moments(means)[0] > (1.1 if share < 0.1 else 1.6) * known[0]
        answer = skipped(holes, cutoff=cutoff)
        np.testing.assert_allclose(answer.Nbar, known[0], rtol=0.02, atol=0)  # with the plane removed


def test_errors_of_filled_points():
    """As the comment of TENSION says, in parts of the rms."""
    for seed in range(3):
        whole, single = holed(seed, 0.009)
        border = whole.copy()
        border[:, :2] = np.nan
        for z, least, most in ((single, 0.002, 0.006), (border, 0.1, 0.25)):
            error = np.sqrt(np.mean((filled(z) - whole)[np.isnan(z)] ** 2)) / whole.std()
            assert least < error < most


def test_refuse_and_fill_say_what_they_do():
    z = np.where(np.arange(65536).reshape(256, 256) == 777, np.nan, rough())
    with pytest.raises(ValueError, match='1 of 65536 heights .*missing="refuse" allows none'):
        roughness.height_map(z, dx=STEP, missing="refuse")
    (note,) = roughness.height_map(z, dx=STEP).notes
    assert note == "1 of 65536 heights (0.0015 %) was missing, and interpolated"
    with pytest.raises(ValueError, match='missing = \'drop\'; allowed are "fill", "skip" and "refuse"'):
        roughness.height_map(z, dx=STEP, missing="drop")
