"""What a measured roughness says of itself: numbers, doubts, and whether an Ra looks like that of ISO 4287."""

import dataclasses
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from pages import check_examples
from surfaces import random_surface

from study import roughness
from study.specimen.heights.measured_asperities import counted_density, density, length
from study.specimen.quantities import quantity
from study.studies.paper.numbers import TABLE1


def test_the_answer_in_sentences():
    z, step = random_surface(256, 8)
    answer = roughness.measure(roughness.height_map(z, dx=step, name="wafer.csv"))
    said = str(answer)
    assert "the radius of an asperity. The ISO roughness Ra (mean height) is" in said
    assert f"{answer.Nbar / 1e12:.3g} µm⁻²" in said and f"Ra = {answer.Ra * 1e6:.3g} µm" in said
    for part in (answer.method, answer.filter, answer.resolution, "wafer.csv, 256 × 256 points 125 nm × 125 nm apart"):
        assert part in said
    number = answer.Nbar * (256 * step) ** 2
    assert f"about {number:.0f} asperities: N̄ is uncertain by some 10 %" in said
    with pytest.raises(dataclasses.FrozenInstanceError):
        answer.Ra = 1.0
    times = answer.sigma_summits * 3 * math.pi * answer.Nbar * answer.Ra
    assert f"the spread of the heights is {times:.2g} times that" in said
    assert_allclose(times, 0.375 * math.sqrt(math.pi / 12 * (3 - 0.8968)), rtol=0.1)  # of N̄, Ra, σ_s by moments
    text, unit = answer.parameters()["Nbar"].split()
    assert float(text) == answer.Nbar and unit == "1/m^2" and answer.units == "m"


def test_doubts_are_named():
    noise = np.random.default_rng(0).normal(size=(64, 64)) * 1e-9
    unresolved = roughness.measure(roughness.height_map(noise, dx=1e-7), method="summits")
    assert any("3 points apart, 5 are needed" in note for note in unresolved.notes)
    z, step = random_surface(256, 8)
    stretched = roughness.measure(roughness.height_map(z, dx=step, dy=3 * step))
    assert any("3.1 times" in note or "3 times" in note or "2.9 times" in note for note in stretched.notes)
    worn = roughness.measure(roughness.height_map(np.minimum(z, 0), dx=step))
    assert any("skewness -" in note and 'method="summits"' in note for note in worn.notes)
    assert any("isotropic" in note for note in roughness.measure(roughness.profile(z[0], dx=step)).notes)


def test_an_iso_ra_is_known_by_its_size():
    """The surfaces of the paper are silent, and random ones; their ISO Ra, given as Ra, is not."""
    assert not any(roughness.looks_like_iso_ra(Ra, Nbar) for Ra, Nbar, *_ in TABLE1)
    z, step = random_surface(256, 8)
    answer = roughness.measure(roughness.height_map(z, dx=step))
    assert roughness.looks_like_iso_ra(answer.Ra, answer.Nbar) is None
    said = roughness.looks_like_iso_ra(answer.iso_Ra, answer.Nbar)
    assert "radius of an asperity" in said and "ISO 4287" in said and "cap_radius" in said
    assert "Ra = 4e-07 is small for Nbar = 1e+10: the asperities are 25 radii apart" in roughness.looks_like_iso_ra(
        np.array([1e-5, 4e-7]), np.array([1e9, 1e10])
    )


def test_the_page_prints_what_stands_there(tmp_path):
    check_examples("docs/roughness.md", tmp_path)


@pytest.mark.parametrize(
    ("heading", "columns", "given", "message"),
    [
        ("", 1, {"dx": "0.5 s"}, 'dx = "0.5 s" is in second: must be a length, such as "2 mm"'),
        ("", 20, {"dx": 1, "dy": "2"}, "dy = '2': must be a number, in um"),
        ("", 2, {"dx": "1 um"}, r"20 rows of 2 column\(s\) with dx = 1.0; .* A comma cannot separate columns and"),
        (
            "x [mm]; z (nm)",
            2,
            {},
            'height_unit is um, but the heading has nm: "x .mm.; z .nm.". Give height_unit=.nm., o',
        ),
        ("z [um]", 1, {"dx": 1, "unit": "nm"}, "height_unit is nm, but the heading has um"),
    ],
)
def test_units_of_a_scan_are_those_of_its_heading(tmp_path, heading, columns, given, message):
    """And a distance is a number: its unit is given once, for all."""
    rows = "\n".join(";".join(["0.5"] * columns) for _ in range(20))
    (tmp_path / "a.csv").write_text(f"{heading}\n{rows}\n", encoding="utf-8")
    with pytest.raises(ValueError, match=f"^a.csv: {message}"):
        roughness.read(tmp_path / "a.csv", **{"unit": "um"} | given)


def test_units_of_the_call_hold_against_those_of_a_heading(tmp_path):
    """They were refused, and the heading had to be mended."""
    z = np.round(np.sin(np.arange(20.0)), 6)
    for heading, columns, arguments, steps, notes in (
        ("x [mm]; z (nm)", 2, {"height_unit": "nm"}, 5e-7, ["positions are in um, as unit says; the heading has mm"]),
        (
            "z [um]",
            1,
            {"height_unit": "nm", "dx": 1},
            1e-6,
            ["heights are in nm, as height_unit says; the heading has um"],
        ),
    ):
        rows = "\n".join(f"{i / 2};{each}" if columns == 2 else f"{each}" for i, each in enumerate(z))
        (tmp_path / "a.csv").write_text(f"{heading}\n{rows}\n", encoding="utf-8")
        scan = roughness.read(tmp_path / "a.csv", unit="um", **arguments)
        np.testing.assert_allclose(scan.z, z * 1e-9, rtol=1e-12)
        assert scan.steps == (pytest.approx(steps),) and list(scan.notes) == notes


def test_a_heading_with_more_units_than_are_read(tmp_path):
    rows = "\n".join(f"{i / 2};{i % 3};7" for i in range(20))
    (tmp_path / "a.csv").write_text(f"x [um]; z [nm]; gain [V]\n{rows}\n", encoding="utf-8")
    scan = roughness.read(tmp_path / "a.csv", unit="µm", height_unit="nm", columns=(0, 1))
    assert scan.steps == (pytest.approx(5e-7),) and scan.z.max() == 2e-9
    with pytest.raises(ValueError, match="height_unit is um, but the heading has V"):
        roughness.read(tmp_path / "a.csv", unit="um", columns=(0, 2))


def test_densities_and_lengths_that_are_said_are_read_again():
    """To three digits, over all that surfaces have."""
    for power in range(2, 19):
        assert quantity("Nbar", density(1.234 * 10.0**power), "1/m^2").value == pytest.approx(1.23 * 10.0**power)
    for power in range(-10, 4):
        assert quantity("Ra", length(1.234 * 10.0**power), "m").value == pytest.approx(1.23 * 10.0**power)
    assert [density(1.25e9), density(4.321e15)] == ["1250 mm⁻²", "4320 µm⁻²"]  # they were 1.25e+03


def test_a_density_as_people_write_it():
    for Nbar, words in ((1.2512e10, "12,510 1/mm²"), (3e5, "0.3 1/mm²"), (9.87654e11, "987,700 1/mm²")):
        assert counted_density(Nbar) == words
    assert counted_density(2.5e12) == "2.5 1/µm²"
    z, step = random_surface(64, 8)
    answer = roughness.measure(roughness.height_map(z, dx=step))
    assert f"(Nbar = {counted_density(answer.Nbar)}): one asperity" in str(answer)
