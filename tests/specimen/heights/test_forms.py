"""The form of a ball is no roughness: a quadratic or the sphere that fits takes it off, and its radius is said."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from surfaces import random_surface, rough

from study import roughness


@pytest.mark.parametrize("form", ["quadratic", "sphere", 1e-3, "1 mm"])
def test_a_ball_of_1_mm_under_a_roughness(form):
    """With the plane its curvature counted: three times the spread of the heights."""
    z, step = random_surface(256, 8)
    z, step = z * 48e-9 / z.std(), 2e-7
    x = (np.arange(256) - 80) * step
    ball = np.sqrt(1e-6 - np.add.outer(x**2, x**2)) - 1e-3
    flat = roughness.measure(roughness.height_map(z, dx=step))
    round_ = roughness.measure(roughness.height_map(z + ball, dx=step), form=form)
    # the form also takes what waves of the roughness as long as the scan have of it
    assert_allclose(round_.sigma_summits, flat.sigma_summits, rtol=0.03)
    assert roughness.measure(roughness.height_map(z + ball, dx=step)).sigma_summits > 2 * flat.sigma_summits
    if form == "sphere":
        assert "fitted radius" in round_.filter


def said(z, step, **given):
    scan = roughness.height_map(z, dx=step) if z.ndim == 2 else roughness.profile(z, dx=step)
    return [note for note in roughness.measure(scan, **given).notes if "of the variance of the heights" in note]


def forms(x, y):
    """Heights (m) of a ball and a cup of 1 mm, the bow of a wafer, cylinders along x and y, and a saddle."""
    return {
        "ball": np.sqrt(1e-6 - x**2 - y**2) - 1e-3,
        "cup": 1e-3 - np.sqrt(1e-6 - x**2 - y**2),
        "bow": 500 * (x - 1e-5) ** 2 + 1200 * y**2,
        "cylinder along y": np.sqrt(1e-6 - x**2) - 1e-3,
        "cylinder along x": np.sqrt(1e-6 - y**2) - 1e-3,
        "saddle": 300 * x * y,
    }


@pytest.mark.parametrize("name", forms(0.0, 0.0))
def test_a_form_that_is_left_is_said(name):
    """A ball's curvature counted as roughness without a note."""
    z, step = random_surface(256, 8)
    z, step = z * 48e-9 / z.std(), 2e-7
    x = (np.arange(256) - 128) * step
    form = np.broadcast_to(forms(*np.meshgrid(x, x))[name], z.shape)
    flat = z + form
    for given in ("plane", "mean"):
        (note,) = said(flat, step, form=given)
        curved = form - np.polynomial.polynomial.polyfit(x, form.mean(0), 1)[0] if given == "mean" else form
        share = np.var(curved) / np.var(z + curved)
        assert_allclose(float(note.split()[3]) / 100, share, atol=0.05)  # the tilt of the form is 0
        assert 'form="quadratic" or "sphere" removes them' in note
    assert not said(flat, step, form="quadratic")
    assert bool(said(flat, step, form="sphere")) == (name not in ("ball", "cup"))
    middle = flat[:, 128] if name == "cylinder along x" else flat[128]
    assert bool(said(middle, step)) == (name != "saddle") and not said(middle, step, form="quadratic")


def test_a_random_surface_has_no_form():
    """Of waves that are a tenth of the scan or shorter; only where most of the roughness is as long is it said."""
    for seed in range(20):
        assert not said(rough(128, 12, seed, 50e-9), 1e-7)
        assert not said(rough(128, 12, seed, 50e-9)[0], 1e-7)
    x = np.arange(128) / 128
    assert said(np.cos(2 * np.pi * np.add.outer(x, 0 * x) - 0.3) * 1e-9 + rough(128, 12, 0, 1e-10), 1e-7)


@pytest.mark.parametrize("ratio", [0.1, 0.6, 0.99])
def test_the_sphere_that_fits_a_scan_nearly_as_large(ratio):
    """The diagonal over the radius, and the steps that the comment of _STEPS states."""
    x = (np.arange(64) - 20.0) * 1e-6
    R = 63e-6 * np.sqrt(2) / ratio
    z = np.sqrt(R**2 - np.add.outer(x**2, (x + 5e-6) ** 2)) - R
    noise = 1e-9 * np.random.default_rng(0).normal(size=z.shape)
    answer = roughness.measure(roughness.height_map(z + noise, dx=1e-6), form="sphere")
    assert f"{R * 1e3:.3g} mm" in answer.filter or f"{R * 1e6:.3g} µm" in answer.filter
    assert_allclose(answer.iso_Ra, np.sqrt(2 / np.pi) * 1e-9, rtol=0.05)


@pytest.mark.parametrize(("form", "degree"), [("mean", 0), ("plane", 1), ("quadratic", 2)])
def test_a_polynomial_is_of_its_degree(form, degree):
    """What is left of a random profile on a cubic is what NumPy leaves: its mean height, the ISO Ra."""
    x = np.linspace(-1.0, 1.0, 512)
    z = rough(512, 12, 3, 50e-9)[0] + 1e-7 * (x + x**2 + x**3)
    left = z - np.polynomial.Polynomial.fit(x, z, degree)(x)
    answer = roughness.measure(roughness.profile(z, dx=2e-7), form=form)
    assert_allclose(answer.iso_Ra, np.abs(left - left.mean()).mean(), rtol=1e-9)  # two ways of least squares
