"""Roughness from designs, and from surfaces whose moments, summits and radii are known in closed form."""

import math
import re

import numpy as np
import pytest
from numpy.testing import assert_allclose
from surfaces import ELL, SLOPE, lattice, random_surface, spectrum

from study import roughness
from study.specimen.heights import scan_peaks


def scatter(points: int, steps_per_length: int, dimensions: int, power: int) -> float:
    """Relative standard error of the mean of the power/2-th derivative squared, m0, m2, m4 for power 0, 2, 4.

    The mean is a sum of w |a_q|², w = q^power; the |a_q|² are exponential, and those of q and -q are the same number.
    """
    q = 2 * np.pi * np.fft.fftfreq(points) * steps_per_length
    weighted = np.meshgrid(*(q,) * dimensions)[0] ** power * spectrum(points, steps_per_length, dimensions)
    return math.sqrt(2 * np.sum(weighted**2)) / np.sum(weighted)


def sampled_moments(k: float) -> tuple[float, float, float]:
    """What differences over a step of ELL/k make of m0, m2, m4, from the correlation at one and two steps."""
    one, two = math.exp(-1 / (2 * k**2)), math.exp(-4 / (2 * k**2))
    m0 = (SLOPE * ELL) ** 2
    return m0, 2 * m0 * (1 - one) * (k / ELL) ** 2, m0 * (6 - 8 * one + 2 * two) * (k / ELL) ** 4


def scan_of(z, step):
    return roughness.profile(z, dx=step) if z.ndim == 1 else roughness.height_map(z, dx=step)


def test_lattices_and_area_fractions():
    assert roughness.square_lattice(2e-6) == 1 / 4e-12
    assert_allclose(roughness.hexagonal_lattice([1.0, 2.0]), [2 / math.sqrt(3), 0.5 / math.sqrt(3)], rtol=1e-15)
    touching = roughness.area_fraction(math.pi / (2 * math.sqrt(3)), 0.5)  # circles of a hexagonal lattice of pitch 1
    assert_allclose(touching, roughness.hexagonal_lattice(1.0), rtol=1e-15)
    assert_allclose(roughness.area_fraction(math.pi / 4, 0.5), roughness.square_lattice(1.0), rtol=1e-15)


def test_radius_of_a_cap():
    assert roughness.cap_radius(1.0, 2.0) == 1.0  # a half-sphere
    assert_allclose(roughness.cap_radius(7.0 - math.sqrt(49 - 9), 6.0), 7.0, rtol=1e-14)
    assert_allclose(roughness.cap_radius(np.array([1e-9, 2e-9]), 1e-6), [1.25e-4 + 5e-10, 6.25e-5 + 1e-9], rtol=1e-14)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: roughness.square_lattice(0.0), r"pitch = 0.0: must be > 0 and finite"),
        (lambda: roughness.hexagonal_lattice([1.0, math.nan]), r"pitch = \[ 1. nan\]: must be > 0"),
        (lambda: roughness.area_fraction(0.95, 1.0), r"fraction = 0.95: circles that do not overlap .* 0.9069"),
        (lambda: roughness.area_fraction(0.5, -1.0), r"base_radius = -1.0: must be > 0"),
        (lambda: roughness.cap_radius(1.1, 2.0), r"height = 1.1 on a base of width = 2.0: .* half as high as wide"),
        (lambda: roughness.square_lattice("20 um"), "pitch = '20 um': must be a number, all lengths in one unit"),
        (lambda: roughness.area_fraction("30 %", 1.0), "fraction = '30 %': must be a number"),
        (lambda: roughness.cap_radius(None, 2.0), "height = None: must be a number"),
        (lambda: roughness.cap_radius(math.inf, 2.0), r"height = inf: must be > 0 and finite"),
    ],
)
def test_designs_that_cannot_be(call, message):
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize(("points", "dimensions"), [(1024, 2), (100_000, 1)])
def test_moments_of_a_random_surface(points, dimensions):
    """To four standard errors, which the spectrum gives, around what the step makes of the moments."""
    k = 8
    z, step = random_surface(points, k, dimensions)
    known = sampled_moments(k)
    for found in scan_peaks.moments(z, (step,) * dimensions):
        for i in range(3):
            assert_allclose(found[i], known[i], rtol=4 * scatter(points, k, dimensions, 2 * i))
    # Along x and y the errors are about independent, but the mean of the two may err as much as one.
    errors = [4 * scatter(points, k, dimensions, power) for power in (0, 2, 4)]
    answer = roughness.measure(scan_of(z, step))
    m0, m2, m4 = known
    assert_allclose(answer.Nbar, m4 / m2 / (6 * math.pi * math.sqrt(3)), rtol=errors[1] + errors[2])
    assert_allclose(answer.Ra, 0.375 * math.sqrt(math.pi / m4), rtol=errors[2] / 2)
    assert_allclose(answer.iso_Ra, math.sqrt(2 / math.pi * m0), rtol=errors[0])
    alpha = m0 * m4 / m2**2
    assert_allclose(answer.sigma_summits, math.sqrt((1 - 0.8968 / alpha) * m0), rtol=errors[0] + errors[1])


@pytest.mark.parametrize(("points", "dimensions"), [(1024, 2), (100_000, 1)])
def test_summits_of_a_random_surface_are_those_of_nayak(points, dimensions):
    """To four standard errors and, for the step, which makes m4 1.3 % low, 2 %.

    The errors are 1/√n of a number of summits (they have less, since they repel each other), 1/√2n of their spread, and
    of their mean curvature its own spread over √n, 0.344 of it for summits and 0.523 for peaks.
    """
    k = 8
    z, step = random_surface(points, k, dimensions)
    answer = roughness.measure(scan_of(z, step), method="summits")
    n = int(re.search(r"(\d+) (?:summits|peaks) found", answer.method)[1])
    known = 3 / (6 * math.pi * math.sqrt(3) * ELL**2)
    expected = known * (points * step) ** 2 if dimensions == 2 else math.sqrt(3) / (2 * math.pi) * points / k
    assert abs(n - expected) < 4 * math.sqrt(expected) + 0.02 * expected
    spread = 0.344 if dimensions == 2 else 0.523
    assert_allclose(answer.Nbar, known, rtol=(3 - dimensions) * 4 / math.sqrt(n) + 0.02)
    assert_allclose(answer.Ra, 0.375 * math.sqrt(math.pi / 3) * ELL / SLOPE, rtol=4 * spread / math.sqrt(n) + 0.02)
    sigma = math.sqrt(1 - 0.8968 / 3) * SLOPE * ELL
    assert_allclose(answer.sigma_summits, sigma, rtol=4 / math.sqrt(2 * n) + 0.02)


@pytest.mark.parametrize("shift", [0.0, 0.3, 0.5])  # of the tips against the points; 0: four points are equally high
def test_a_lattice_of_paraboloids(shift):
    step, radius = 1e-7, 5e-6
    z = lattice(7, 12, step, radius, shift)
    answer = roughness.measure(roughness.height_map(z, dx=step), method="summits", form="mean")
    assert_allclose(answer.Nbar, roughness.square_lattice(12 * step), rtol=1e-12)
    assert_allclose(answer.Ra, radius, rtol=1e-10)
    assert answer.sigma_summits < 1e-12 * np.ptp(z)


def test_steps_of_x_and_y_keep_their_places():
    u, v = np.meshgrid((np.arange(-1, 49) % 16 - 8) * 2e-7, (np.arange(-1, 97) % 32 - 16) * 1e-7)
    z = -(u**2) / 2e-5 - v**2 / 6e-5
    answer = roughness.measure(roughness.height_map(z, dx=2e-7, dy=1e-7), method="summits", form="mean")
    assert_allclose(answer.Nbar, roughness.square_lattice(3.2e-6), rtol=1e-12)
    assert_allclose(answer.Ra, 2 / (1 / 1e-5 + 1 / 3e-5), rtol=1e-10)
    with pytest.raises(ValueError, match="cutoff = 5e-07 m; .* at least three steps, 6e-07 m"):
        roughness.measure(roughness.height_map(z, dx=2e-7, dy=1e-7), cutoff=5e-7)
    assert "50 × 98 points 200 nm × 100 nm apart, 9.8 µm × 9.7 µm" in answer.resolution


def test_a_sinusoidal_surface():
    """A cos qx cos qy: q²/(2π²) summits in a unit of area, of curvature A q². Moments, which suppose a random surface,
    give α = 1 and q²/(6π√3), and say so."""
    step, points, A, phase = 1e-7, 32, 2e-8, 0.04
    q = 2 * math.pi / (points * step)
    wave = np.cos(q * step * np.arange(-1, 8 * points + 1) + phase)
    scan = roughness.height_map(A * np.outer(wave, wave), dx=step)
    answer = roughness.measure(scan, method="summits")
    sampled = (2 - 2 * math.cos(q * step)) / step**2  # q² by second differences
    assert_allclose(answer.Nbar, q**2 / (2 * math.pi**2), rtol=1e-12)
    assert_allclose(answer.Ra, 1 / (A * sampled * math.cos(phase) ** 2), rtol=1e-9)  # beside the tip, by the phase
    moments = roughness.measure(scan)
    assert_allclose(moments.Nbar, q**2 / (6 * math.pi * math.sqrt(3)), rtol=0.02)  # the waves end where the scan does
    assert any("not Gaussian" in note or "Gaussian surface has" in note for note in moments.notes)


def test_a_sinusoidal_profile():
    """cos qx has q/2π peaks in a unit of length, so 2π/(3√3) of its square in a unit of area, and curvatures A q²."""
    step, points, A, phase = 1e-7, 32, 2e-8, 0.04
    q = 2 * math.pi / (points * step)
    z = A * np.cos(q * step * np.arange(-1, 20 * points + 1) + phase)
    answer = roughness.measure(roughness.profile(z, dx=step), method="summits")
    sampled = (2 - 2 * math.cos(q * step)) / step**2
    assert_allclose(answer.Nbar, 2 * math.pi / (3 * math.sqrt(3)) * (q / (2 * math.pi)) ** 2, rtol=1e-12)
    curvature = 8 * math.sqrt(2) / (3 * math.pi) * A * sampled * math.cos(phase)
    assert_allclose(answer.Ra, 1 / curvature, rtol=1e-9)
    assert answer.sigma_summits == 0  # the peaks are equal, and summits spread less


def test_constants_are_those_of_the_distribution_of_curvatures():
    """Nayak's, by quadrature of the density of curvatures at summits that their comment gives."""
    from scipy.integrate import quad

    def integral(power):
        density = lambda k: k**power * ((k**2 - 2) * math.exp(-(k**2) / 4) + 2 * math.exp(-3 * k**2 / 4))  # noqa: E731
        return quad(density, 0, 40, epsabs=1e-13)[0]

    mean, square = (integral(power) / integral(0) for power in (1, 2))
    assert_allclose(mean / math.sqrt(3), scan_peaks.CURVATURE, rtol=1e-10)
    assert_allclose(1.5 - 9 / 4 * (square - mean**2) / 3, scan_peaks.HEIGHTS, rtol=1e-9)
    # Of the peaks of a profile: their curvatures have the density k exp(-k²/2), in √m4 (Rice).
    mean, square = (quad(lambda k, n=n: k ** (n + 1) * math.exp(-(k**2) / 2), 0, 40)[0] for n in (1, 2))
    assert_allclose(mean, scan_peaks.PEAK_CURVATURE, rtol=1e-10)
    assert_allclose(1 - (square - mean**2), scan_peaks.PEAK_HEIGHTS, rtol=1e-9)
    assert_allclose((scan_peaks.CURVATURE, scan_peaks.HEIGHTS), (1 / (0.375 * math.sqrt(math.pi)), 0.8968), rtol=2e-5)


@pytest.mark.parametrize("R", [2e-3, -2e-3])
def test_a_ball_and_a_cup_are_taken_off(R):
    """With a top beside the middle of the scan, and the tilt that this is."""
    z = lattice(8, 16, 1e-6, 2e-4, 0.3)
    x = (np.arange(130) - 50.0) * 1e-6
    squared = np.add.outer(x**2, (x - 2e-5) ** 2)
    ball = math.copysign(1, R) * np.sqrt(R**2 - squared) - R
    flat, round_ = (
        roughness.measure(roughness.height_map(heights, dx=1e-6), method="summits", form=form)
        for heights, form in ((z, "plane"), (z + ball, R))
    )
    for name in ("Nbar", "Ra", "sigma_summits", "iso_Ra"):
        assert_allclose(getattr(round_, name), getattr(flat, name), rtol=1e-4, err_msg=name)
    assert f"a sphere of radius {'-' * (R < 0)}2 mm" in round_.filter


def test_the_low_pass_is_that_of_iso_16610():
    """Half of a wave of the cutoff's length passes, 2^-(cutoff/length)² of any other, along x, y and between."""
    x = np.arange(200) * 1.0
    for direction in ((1, 0), (0, 1), (0.6, 0.8)):
        for length in (20.0, 30.0, 60.0):
            wave = np.cos(2 * np.pi / length * np.add.outer(direction[0] * x, direction[1] * x))
            passed = scan_peaks.low_pass(wave, (1.0, 1.0), 30.0)
            cut = (200 - len(passed)) // 2
            assert_allclose(passed, 2 ** -((30 / length) ** 2) * wave[cut:-cut, cut:-cut], atol=2e-4)
            assert 200 - 2 * cut == len(passed) and cut == math.ceil(0.75 * 30)


def test_a_filtered_random_surface_has_the_known_moments():
    """The Gaussian filter makes ELL² to ELL² + (α λc)²/π."""
    k, cutoff = 8, 2 * ELL
    z, step = random_surface(1024, k)
    longer = 1 + scan_peaks.ALPHA**2 * 4 / math.pi
    plain, filtered = (roughness.measure(roughness.height_map(z, dx=step), cutoff=c) for c in (None, cutoff))
    assert_allclose(filtered.Nbar * longer, plain.Nbar, rtol=0.03)  # two errors of 1.5 %, in part common
    assert_allclose(filtered.Ra / longer**1.5, plain.Ra, rtol=0.03)  # m0 falls by ELL²/longer, m4 with its cube
    assert "Gaussian low-pass (ISO 16610) with a cutoff of 2 µm" in filtered.filter
    assert "no low-pass" in plain.filter


def test_the_iso_ra_is_of_what_the_filter_leaves():
    """Not about the mean of the whole scan: without its borders, a wave of its length has another."""
    x = np.arange(400) / 400
    scan = roughness.profile(1e-3 * np.cos(2 * np.pi * x) + 1e-5 * np.cos(40 * np.pi * x), dx=1 / 400)
    inner = scan.z[30:-30] - scan.z[30:-30].mean()
    assert_allclose(roughness.measure(scan, form="mean", cutoff=0.1).iso_Ra, np.mean(np.abs(inner)), rtol=0.02)
