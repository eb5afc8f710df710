"""`study.stresses` and `study.extremes`: dimensions, units, what is NaN, messages."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study

HARD = {"E1": "200 GPa", "nu1": 0.2, "E2": "210 GPa", "R": "5 mm", "h": "20 um", "bonding": "bonded"}
PLAIN = {"h": 0.02, "n": 0.5, "bonding": "bonded", "micro": "smooth"}


@pytest.fixture(scope="module")
def contact():
    return study.solve(**HARD, P=["1 N", "10 N"], micro="smooth")


def test_units_and_dimensions(contact):
    """Those of the contact; a surface bears its pressure; a residual stress is the layer's alone."""
    r, z = [0.0, 0.5, 1.0], [0.0, 0.2, 8.0]
    field, stretched = (study.stresses(contact, r, z, sigma_res=s) for s in (0.0, "-2 GPa"))
    assert field.sr.dims == ("P", "r", "z") and field.mises_below.dims == ("P", "r") and "x" not in field.coords
    assert field.sz.attrs["units"] == "Pa" and field.uz.attrs["units"] == "m" and "tension" in field.sz.attrs["comment"]
    assert_allclose(field.sz.isel(z=0, r=0), -contact.p0, rtol=1e-6)
    assert_allclose(field.r_length.isel(r=2), contact.a, rtol=1e-6)
    changed = (stretched - field) / -2e9
    assert_allclose(changed.sr.isel(P=0), np.tile([1.0, 1.0, 0.0], (3, 1)), rtol=0, atol=1e-6)
    assert_allclose([changed.st_above.max(), changed.st_below.max(), changed.sz.max()], [1, 0, 0], rtol=0, atol=1e-6)
    assert np.all(field.stress_error < 1e-6) and np.all(field.mises >= 0)
    assert_allclose(field.mises_above.isel(r=0), abs(field.sr_above - field.sz_above).isel(r=0), rtol=1e-12)


def test_the_plane_of_sliding_is_no_mirror_image(contact):
    field = study.stresses(contact, r=[-1.0, 1.0], z=[0.0], mu=0.3)
    assert np.all(field.sr.sel(r=-1) > 0) and np.all(field.sr.sel(r=1) < 0), "tension behind the contact"
    assert_allclose(field.trz.sel(r=-1), field.trz.sel(r=1), rtol=0, atol=1)
    assert study.stresses(contact, z=[0.0], mu=0.3).r.values.min() == -2


def test_extremes_of_a_dataset(contact):
    made = study.extremes(contact)
    assert made.mises1.dims == ("P",) and made.mises1.attrs["units"] == "Pa" and "units" not in made.mises1_r.attrs
    for i in (0, 1):
        r, z = (made[f"mises1_{axis}"].values[i] for axis in "rz")
        at_it = study.stresses(contact, r=[r], z=[z]).mises.values[i, 0, 0]
        assert_allclose(made.mises1.values[i], at_it, rtol=1e-6)
    part = study.extremes(contact.isel(P=1), mu=0.25)
    assert part.s1_surface.dims == () and part.s1_surface_r < 0 < part.tau_interface


def test_what_is_not_solved_is_nan():
    contact = study.solve(P=[1e-5, 2e-5], **PLAIN, nu1=0.5)
    contact["status"] = ("P", np.array([0, 7], dtype=np.int8))
    made, field = study.extremes(contact), study.stresses(contact, z=[0.0])
    assert np.isfinite(made.mises2[0]) and np.isnan(made.mises2[1])
    assert np.isfinite(field.sr[0]).all() and np.isnan(field.sr[1]).all() and np.isnan(field.stress_error[1])
    assert "units" not in made.mises1.attrs and "E2*" in made.mises1.attrs["scale"]


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"mu": -0.1}, "mu = -0.1: must be a finite number, at least 0"),
        ({"mu": np.nan}, "mu = nan: must be"),
        ({"sigma_res": "1 GPa"}, 'sigma_res = "1 GPa": the contact has no units'),
        ({"sigma_res": np.inf}, "sigma_res = inf: must be finite"),
        ({"r": [0.0, -1.0]}, "r = -1: must be one-dimensional, with finite numbers in units of a, and at least 0"),
        ({"r": np.nan, "mu": 0.1}, "r = nan: must be"),
        ({"z": [-0.1], "mu": 0.1}, "z = -0.1: must be"),
        ({"z": [[1.0]]}, r"z of shape \(1, 1\): must be one-dimensional"),
        ({"z": "deep"}, 'z = "deep": must be numbers'),
    ],
)
def test_messages_name_the_argument(arguments, text):
    contact = study.solve(P=1e-5, **PLAIN)
    with pytest.raises(study.StudyError, match=text):
        study.stresses(contact, **arguments)
    if not {"r", "z"} & {*arguments}:
        with pytest.raises(study.StudyError, match=text):
            study.extremes(contact, **arguments)


def test_far_away_is_refused_where_it_would_take_minutes():
    """A half-space is a closed form, at any distance that of a point load."""
    bare = study.solve(P=1e-5, base="half_space", nu2=0.3, micro="smooth")
    r = 1e5 * bare.a.item()
    far = study.stresses(bare, r=[1e5], z=[0.0])
    assert_allclose(far.sr.item(), 0.4 * 1e-5 / (2 * np.pi * r**2), rtol=1e-6)
    assert_allclose(far.uz.item(), 1e-5 / (np.pi * r), rtol=1e-9)
    layered = study.solve(a=[0.01, 0.1], **PLAIN | {"h": 1e-3})
    for r, contact, most in ((-2e5, layered.isel(a=0), "2.78e.03"), (3e3, layered, "277"), (1e10, bare, "1e.09")):
        with pytest.raises(study.StudyError, match=f"^r = {re.escape(f'{abs(r):g}')}: must be at most {most}"):
            study.stresses(contact, r=[r], mu=0.1)


def test_messages_of_datasets(contact):
    for function in (study.stresses, study.extremes):
        with pytest.raises(study.StudyError, match=f"^{function.__name__} takes a dataset of study.solve"):
            function(contact.p)
        with pytest.raises(study.StudyError, match="sigma_res = 1.0: needs a unit|sigma_res"):
            function(contact, sigma_res=1.0)
