"""What the words say of the asperities' part: how large its error is, whose they are, and of whom the depth is."""

import re
import warnings

import numpy as np
import pytest
from conftest import ROOT

import study
from study.rules.assumptions import HARDEST, SEEN
from study.rules.rule import RULES

SPARSE = {"P": 1e-5, "h": 0.002, "n": 2.0, "Ra": 0.004, "x": 2, "asperities_on": "half_space"}
MASKS = ("spot_not_small_against_h", "pitch_not_small_against_h")


def said(found) -> list[str]:
    lines = [line.removeprefix("Beware: ") for line in study.summary(found).splitlines()]
    return [line for line in lines if any(line.startswith(RULES[mask].sentence) for mask in MASKS)]


def at(pitch: float, **more):
    """A contact whose asperities stand `pitch` thicknesses of the layer apart."""
    return study.solve(**SPARSE | {"Nbar": 1 / (pitch * SPARSE["h"]) ** 2} | more)


def test_the_table_is_that_of_the_page():
    page = (ROOT / "docs/validate.md").read_text(encoding="utf-8")
    head, _, *rows = re.search(r"\| pitch/h \| 1 \|(?:.*\n)(?:\|.*\n)+", page)[0].splitlines()
    cells = [[float(cell.strip(" %")) for cell in row.split("|")[2:-1]] for row in (head, *rows)]
    assert dict(zip(cells[0], zip(*cells[1:3], strict=True), strict=True)) == SEEN
    assert f"5 layers, n = 0.2 to {HARDEST}" in page


@pytest.mark.parametrize("pitch", [1.5, 2.5, 3.0, 5.0])
def test_the_error_comes_with_its_size(pitch):
    """Between the pitches that were measured it is interpolated: larger than at the one below, and less than above."""
    sentences = said(at(pitch))
    assert len(sentences) == 1 + (pitch > 2)
    below, above = (max(one for one in SEEN if one <= pitch), min(one for one in SEEN if one >= pitch))
    for sentence in sentences:
        named, of_A, of_p_max = map(
            float, re.search(r"is (\S+) h, .* by about (\S+) % and pmax by (\S+) %", sentence).groups()
        )
        assert named == pytest.approx(pitch, rel=0.05)
        for i, error in enumerate((of_A, of_p_max)):
            assert 0.95 * SEEN[below][i] <= error <= 1.05 * SEEN[above][i]
        assert sentence.endswith(" at worst.") and "docs/validate.md (n from 0.2 to 20)" in sentence


def test_far_below_and_beyond_what_was_measured():
    (near,) = said(at(0.5))
    assert near.endswith(
        " Here the pitch 1/sqrt(Nbar) is 0.5 h: up to a pitch of h the test cases of docs/validate.md show no such "
        "error."
    )
    for sentence in said(at(24.0)):
        assert "is 24 h, more than in the test cases" in sentence and "at 16 h missed A[p] by about 89 %" in sentence
    assert all(sentence.endswith("at worst; a harder layer errs more.") for sentence in said(at(3.0, n=50.0)))


def test_a_pitch_of_cases_that_keep_to_the_assumption_does_not_count():
    """Sparse sharp asperities have spots that are small against the layer, whatever their pitch."""
    rows = [{"Nbar": 1 / (0.5 * 0.002) ** 2, "Ra": 0.004}, {"Nbar": 1 / (4 * 0.002) ** 2, "Ra": 1e-7}]
    found = study.solve(cases=rows, P=1e-5, h=0.002, n=2.0, x=2, asperities_on="half_space")
    assert (found.validity & 4).values.tolist() == [4, 0]
    (doubt,) = (text for text in study.in_words.doubts(found) if RULES[MASKS[0]].sentence in text)
    assert doubt.startswith("1 of 2 cases: ") and "Here the pitch 1/sqrt(Nbar) is 0.5 h" in doubt


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_of_several_cases_it_is_the_worst_and_units_do_not_matter():
    grid = study.solve(**SPARSE | {"Nbar": [1 / (pitch * 0.002) ** 2 for pitch in (0.5, 2.5, 4.0)]})
    doubts = [text for text in study.in_words.doubts(grid) if "spots are not small" in text]
    assert doubts[0].startswith("3 of 3 cases: ") and "The largest pitch 1/sqrt(Nbar) is 4 h" in doubts[0]
    units = study.to_physical(grid, R=5e-3, E2_star=1e11)
    assert study.in_words.doubts(units)[:2] == study.in_words.doubts(grid)[:2]
    readable = [text for text in study.in_words.doubts(study.readable(units)) if "spots are not small" in text]
    assert readable and "pitch 1/sqrt" not in readable[0], "µm and 1/µm² are no pure number"


def test_the_depth_of_an_elastic_punch_is_said_to_be_of_both():
    soft = {"P": 1e-5, "base": "half_space", "micro": "smooth", "x": 2}
    assert "  indentation depth (approach of both bodies)  D      = " in study.summary(study.solve(**soft, m=0.5))
    assert "approach" not in study.summary(study.solve(**soft))
    scene = {"R": "5 mm", "E2": "70 GPa", "base": "half_space", "micro": "smooth", "x": 2}
    for control in ({"P": "1 N"}, {"D": "1 um"}):
        for punch, words in (("steel 52100", True), ("rigid", False)):
            text = study.summary(study.solve(**scene, **control, punch=punch))
            assert ("indentation depth (approach of both bodies)" in text) == words


def test_whose_asperities():
    words = "The asperities belong to the punch. A rough surface under a polished punch is the same contact"
    for layer in ({"base": "half_space"}, {"h": 0.02, "n": 0.5}, {"h": 0.02, "n": 0.5, "base": "thin_layer"}):
        rough = study.summary(study.solve(P=1e-5, **layer, Nbar=250000, Ra=0.004, x=2))
        assert re.search(rf"\nModel: .*\. {words}", rough)
        assert words not in study.summary(study.solve(P=1e-5, **layer, micro="smooth", x=2))


def test_a_sum_of_two_rough_surfaces_is_made_of_summed_moments():
    """docs/model.md, Elastic punch: two equal surfaces make Nbar, Ra/sqrt(2) and sqrt(2) sigma."""
    draw = np.random.default_rng(5)
    k = np.hypot(*np.meshgrid(*[np.fft.fftfreq(256)] * 2))
    first, second = (
        np.fft.ifft2(np.fft.fft2(draw.normal(size=k.shape)) * np.exp(-((k / 0.05) ** 2))).real for _ in "12"
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        one, other, both = (
            study.roughness.measure(study.roughness.height_map(1e-6 * z, dx=1e-4, unit="m", height_unit="m"))
            for z in (first, second, first + second)
        )
    # 256² points of a surface correlated over 5: the moments scatter by some per cent
    assert both.Nbar == pytest.approx((one.Nbar + other.Nbar) / 2, rel=0.05)
    assert both.Ra == pytest.approx((one.Ra + other.Ra) / 2 / np.sqrt(2), rel=0.05)
    assert both.sigma_summits == pytest.approx((one.sigma_summits + other.sigma_summits) / 2 * np.sqrt(2), rel=0.05)
