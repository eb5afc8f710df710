"""What a measured roughness hands to the solver: N̄, Ra, the spread of the heights and the highest summit."""

import math
import warnings

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from scipy.stats import norm
from surfaces import lattice, random_surface

import study
from study import roughness

CONTACT = {"R": "100 mm", "punch": "rigid", "E2": "2 GPa", "nu2": 0.3, "base": "half_space", "P": "0.1 N"}


def wafer(points=256, seed=1):
    """A scan with asperities 1.3 µm apart, and their heights 5 nm."""
    z, step = random_surface(points, 8, seed=seed)
    return roughness.height_map(z * 0.05, dx=step, name="wafer.csv")


@pytest.mark.parametrize("method", ["moments", "summits"])
def test_the_spread_of_the_heights_is_handed_over(method):
    """It was lost: N̄ and Ra alone are asperities of equal height."""
    answer = roughness.measure(wafer(), method=method)
    handed = answer.parameters()
    assert list(handed) == ["Nbar", "Ra", "sigma", "cut", "micro"] and handed["micro"] == "normal_heights"
    for name, unit, value in (
        ("Nbar", "1/m^2", answer.Nbar),
        ("Ra", "m", answer.Ra),
        ("sigma", "m", answer.sigma_summits),
    ):
        assert handed[name] == f"{value!r} {unit}" and float(handed[name].split()[0]) == value
    assert handed == answer.parameters(heights="normal")
    equal = answer.parameters(heights="equal")
    assert equal == {"Nbar": handed["Nbar"], "Ra": handed["Ra"], "micro": "disc_cell"}
    with pytest.raises(ValueError, match='heights = \'random\'; allowed are "normal" and "equal"'):
        answer.parameters("random")


def test_random_heights_press_harder_than_equal_ones():
    answer = roughness.measure(wafer())
    normal, equal = (study.solve(**CONTACT, **answer.parameters(heights)) for heights in ("normal", "equal"))
    assert normal.status == 0 and equal.status == 0
    assert normal.p_max > 1.05 * equal.p_max and normal.Ar_An < 0.95 * equal.Ar_An


@pytest.mark.parametrize(("points", "bound"), [(128, 3.0), (1024, None)])
def test_the_cut_is_that_of_the_number_of_summits(points, bound):
    scan = wafer(points)
    answer = roughness.measure(scan)
    number = answer.Nbar * (points * scan.steps[0]) ** 2
    assert_allclose(answer.summits, number, rtol=1e-12)
    expected = norm.isf(1 / number)
    assert_allclose(answer.cut, bound or expected, rtol=1e-12)
    assert answer.parameters()["cut"] == answer.cut
    (note,) = (note for note in answer.notes if note.startswith("cut = "))
    assert note.startswith(f"cut = {answer.cut:.3g}, ")
    assert f"1 - Φ(cut) = 1/N with the N = {number:.0f} summits of the scan" in note
    assert ("the law takes 3 to 5" in note) == (expected < 3)


def test_the_cut_ends_at_five():
    """3.5 million summits, which no scan of a test has."""
    scan = wafer()
    answer = roughness.measure(scan)
    many = type(answer)(answer.Nbar, answer.Ra, 1e-9, 1e-9, 1e9, "", "", "")
    assert (
        many.cut == 5
        and "since the law takes 3 to 5; " in many.about_cut()
        and many.about_cut().endswith("would give 6")
    )


def test_summits_of_a_profile_are_those_along_it():
    z, step = random_surface(100_000, 8, 1)
    answer = roughness.measure(roughness.profile(z, dx=step))
    assert_allclose(answer.cut, norm.isf(1 / (math.sqrt(answer.Nbar) * 100_000 * step)), rtol=1e-12)


def test_text_and_repr_say_what_is_handed_over():
    answer = roughness.measure(wafer())
    for said in (str(answer), repr(answer)):
        for word in ("sigma", "normal_heights", f"cut = {answer.cut:.3g}", *answer.notes):
            assert word in said
    assert f"sigma = {answer.sigma_summits * 1e9:.3g} nm" in str(answer)
    assert f"sigma={answer.sigma_summits!r}" in repr(answer)
    assert 'parameters(heights="equal") with micro = "disc_cell"' in str(answer)
    assert "They neglect that the highest summits touch first" in str(answer) and "p_max too small" in str(answer)


@pytest.mark.parametrize("method", ["moments", "summits"])
def test_tiny_and_designed_scans_can_be_solved(method):
    """σ of 1e-13 m, or of rounding, or 0."""
    z, step = random_surface(16, 4)
    scans = [
        roughness.height_map(z, dx=step),
        roughness.height_map(1.1e-12 * z / z.std(), dx=step),
        roughness.height_map(lattice(7, 12, 1e-7, 5e-6, 0.3), dx=1e-7),
        roughness.profile(1e-8 * np.cos(2 * np.pi * (np.arange(641) + 0.3) / 32), dx=1e-7),
    ]
    for scan in scans:
        answer = roughness.measure(scan, method=method, form="mean")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # few asperities, and blunt ones
            contact = study.solve(**CONTACT, **answer.parameters(), x=2)
        assert contact.status == 0 and np.isfinite(contact.p_max), scan.name


def test_a_list_of_cutoffs_is_an_axis_of_one_call():
    scan, cutoffs = wafer(), [5e-7, 1e-6, 2e-6]
    many = roughness.measure(scan, cutoff=cutoffs)
    singles = [roughness.measure(scan, cutoff=c) for c in cutoffs]
    for name in ("Nbar", "Ra", "sigma_summits", "sigma", "iso_Ra", "cut", "summits", "cutoff"):
        values = cutoffs if name == "cutoff" else [getattr(one, name) for one in singles]
        assert isinstance(getattr(many, name), np.ndarray) and getattr(many, name).tolist() == values
    handed = many.parameters()
    for name, unit in (("Nbar", "1/m^2"), ("Ra", "m"), ("sigma", "m"), ("cut", None)):
        assert isinstance(handed[name], xr.DataArray) and handed[name].dims == ("cutoff",)
        assert handed[name].attrs.get("units") == unit
        assert handed[name].cutoff.values.tolist() == cutoffs and handed[name].cutoff.attrs["units"] == "m"
    assert set(many.parameters("equal")) == {"Nbar", "Ra", "micro"}
    contact = study.solve(**CONTACT, **handed, x=2)
    assert contact.p_max.dims == ("cutoff",) and contact.cutoff.values.tolist() == cutoffs
    assert contact.cutoff.attrs["units"] == "m" and (contact.status == 0).all()
    alone = [study.solve(**CONTACT, **one.parameters(), x=2) for one in singles]
    for name in ("p_max", "Ar_An", "a", "D"):
        assert_allclose(contact[name], [one[name] for one in alone], rtol=1e-9, err_msg=name)
    assert float(contact.p_max[0]) > 1.1 * float(contact.p_max[-1])  # what the scan leaves open


def test_the_text_of_a_list_has_a_line_for_each_cutoff():
    many = roughness.measure(wafer(), cutoff=(5e-7, 4e-6))
    first, second = (roughness.measure(wafer(), cutoff=c) for c in (5e-7, 4e-6))
    said = str(many)
    assert f"cutoff 500 nm: N̄ = {first.Nbar / 1e12:.3g} µm⁻²" in said
    assert f"cutoff 4 µm: N̄ = {second.Nbar / 1e12:.3g} µm⁻²" in said
    assert f"at the cutoff 500 nm: {first.method}; at the cutoff 4 µm: {second.method}" == many.method
    assert "normal_heights" in said and "cutoff=array" in repr(many)
    assert many.filter.endswith("with each cutoff, borders of 0.75 cutoffs cut away")
    few = next(note for note in second.notes if "N̄ is uncertain" in note)
    assert f"at the cutoff 4 µm: {few}" in many.notes


@pytest.mark.parametrize(
    ("cutoffs", "message"),
    [
        ([], "a list must have one cutoff or more, each of them once"),
        ([1e-6, 1e-6], "each of them once"),
        ([[1e-6, 2e-6]], "a list must have"),
        ([1e-6, None], "cutoff = None: must be a number, in m"),
        (["1 um"], "cutoff = '1 um': must be a number, in m"),
        ([1e-6, 1e-8], "cutoff = 1e-08 m; it must be finite and at least three steps"),
        ([1e-6, 2e-5], "points are left by a cutoff of 2e-05 m"),
    ],
)
def test_cutoffs_that_cannot_be(cutoffs, message):
    with pytest.raises(ValueError, match=f"^wafer.csv: .*{message}"):
        roughness.measure(wafer(128), cutoff=cutoffs)
