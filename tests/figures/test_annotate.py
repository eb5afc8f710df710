"""Marks on axes: names of curves, and the shading of loads at which a curve breaks an assumption."""

import numpy as np
import pytest
import xarray as xr
from drawn import WORDS, bands, legend
from matplotlib.figure import Figure

from study.data.derived import ASSUMPTIONS
from study.figures.annotate import bands as intervals
from study.figures.annotate import name_curve, name_panels, note_violations, shade_violations
from study.rules.rule import RULES


def test_bands_begin_at_zero_and_end_halfway():
    P = np.array([1.0, 2.0, 4.0, 6.0])
    assert intervals(P, np.array([True, False, False, True])) == [(0.0, 1.5), (5.0, 6.0)]
    assert intervals(P, np.zeros(4, dtype=bool)) == []


def test_shading_names_the_assumption_and_its_curves():
    axes = Figure().subplots()
    attributes = {"flag_masks": np.array(list(ASSUMPTIONS)), "flag_meanings": " ".join(ASSUMPTIONS.values())}
    first, P = xr.DataArray([3, 1, 0, 0], dims="P", attrs=attributes), np.array([1e-6, 2e-6, 3e-6, 4e-6])
    shade_violations(axes, P, {"1": first, "2": first.copy(data=[0] * 4)})
    assert axes.get_legend_handles_labels()[1] == [f"not valid: {WORDS[1]} (1)", f"not valid: {WORDS[2]} (1)"]
    assert axes.get_title("left") == ""
    bands_so_far = len(axes.patches)
    nowhere, one, two = (first.copy(data=[mask] * 4) for mask in (0, 1, 3))
    shade_violations(axes, P, {"3": one, "4": nowhere, "5": two})
    assert axes.get_title("left") == f"3, 5: {WORDS[1]}\n5: {WORDS[2]}"
    shade_violations(axes, P, {"6": first.copy(data=[1, 1, 1, 0])})
    unit = r"\times 10^{-5} E_2^* R^2$"
    assert axes.get_title("left") == f"6: {WORDS[1]}, $P < 0.35 {unit}"
    gaps = xr.DataArray([2, 2, 0, 2, 2, 2], dims="P", attrs=attributes)
    shade_violations(axes, 1e-5 * np.arange(1, 7), {"7": gaps})
    assert axes.get_title("left") == f"7: {WORDS[2]}, $P < 2.5 {unit}, $3.5 < P < 6 {unit}"
    assert len(axes.get_legend_handles_labels()[1]) == 2
    assert len(axes.patches) == bands_so_far


def test_a_note_says_which_curves_break_what():
    axes = Figure().subplots()
    attributes = {"flag_masks": np.array(list(ASSUMPTIONS)), "flag_meanings": " ".join(ASSUMPTIONS.values())}
    flags = {name: xr.DataArray(value, attrs=attributes) for name, value in {"1": 1, "2": 0, "3": 18}.items()}
    note_violations(axes, flags)
    assert axes.get_title("left") == f"1: {WORDS[1]}\n3: {WORDS[2]}\n3: {WORDS[16]}"
    note_violations(axes, {"2": flags["2"]})
    assert axes.get_title("left") == ""


def test_a_name_stands_above_or_below_and_to_the_side_that_is_asked():
    axes = Figure().subplots()
    own = axes.plot([0, 2], [0, 2]) + axes.plot([0, 2], [2, 6])
    name_curve(axes, own, "over", 1.0)
    name_curve(axes, own, "under", 0.5, side="below", align="right")
    over, under = axes.texts
    assert over.xy == (1, 4) and under.xy == (0.5, 0.5)
    assert (over.get_va(), over.get_ha(), over.xyann) == ("bottom", "center", (0, 1))
    assert (under.get_va(), under.get_ha(), under.xyann) == ("top", "right", (0, -1))


@pytest.mark.parametrize("mask", WORDS)
def test_each_assumption_has_its_words_and_its_grey(mask):
    axes = Figure().subplots()
    words = "layer_not_thin few_spots spot_not_small_against_h n_not_below_one spots_merging strain_not_small"
    words += " asperity_strain_not_small pitch_not_small_against_h wide_in_cup body_yields asperities_yield"
    words += " spot_lifts_off slope_not_small not_jkr interior_tension"
    attributes = {"flag_masks": np.array(list(WORDS)), "flag_meanings": words}
    flags = xr.DataArray([0, mask, 0], dims="P", attrs=attributes)
    shade_violations(axes, np.array([1e-5, 2e-5, 4e-5]), {"7": flags})
    assert bands(axes) == [(pytest.approx(1.5), pytest.approx(3.0), bands(axes)[0][2])]
    axes.legend()
    assert list(legend(axes.get_legend())) == [f"not valid: {WORDS[mask]} (7)"]
    assert axes.patches[0].get_zorder() < 0, "under the curves"
    assert list(ASSUMPTIONS.values()) == words.split()
    assert len({RULES[word].grey for word in words.split()}) == len(WORDS)


def test_one_entry_of_the_legend_stands_for_all_bands_of_the_curves_that_have_some():
    axes = Figure().subplots()
    attributes = {"flag_masks": np.array(list(WORDS)), "flag_meanings": " ".join(ASSUMPTIONS.values())}
    flags = {"1": [2, 0, 0, 0, 0], "2": [0, 0, 2, 0, 2], "3": [0] * 5}
    shade_violations(
        axes,
        np.array([1e-5, 2e-5, 3e-5, 4e-5, 5e-5]),
        {curve: xr.DataArray(values, dims="P", attrs=attributes) for curve, values in flags.items()},
    )
    assert [band[:2] for band in bands(axes)] == [pytest.approx(band) for band in ((0, 1.5), (2.5, 3.5), (4.5, 5))]
    assert axes.get_legend_handles_labels()[1] == ["not valid: fewer than 100 spots (1, 2)"]


def test_a_file_of_an_earlier_version_has_fewer_masks():
    """Curves of two files, one computed before the last mask was there: KeyError, or the mask was not shown."""
    axes, masks = Figure().subplots(), list(ASSUMPTIONS)
    words = list(ASSUMPTIONS.values())
    old, new = (
        xr.DataArray(flags, attrs={"flag_masks": np.array(masks[:count]), "flag_meanings": " ".join(words[:count])})
        for flags, count in ((2, len(masks) - 1), (2 + masks[-1], len(masks)))
    )
    for curves in ({"old": old, "new": new}, {"new": new, "old": old}):
        note_violations(axes, curves)
        assert axes.get_title("left") == f"{', '.join(curves)}: {WORDS[2]}\nnew: {WORDS[masks[-1]]}"


def test_panels_have_letters_unless_their_titles_have():
    panels = Figure().subplots(1, 4)
    panels[1].set_title("(b) titled")
    panels[2].plot([0, 1], label="curve")
    panels[2].legend(title="(c) Ra = 1")
    name_panels(panels)
    assert [[text.get_text() for text in axes.texts] for axes in panels] == [["(a)"], [], [], ["(d)"]]


def test_a_stroke_joins_a_name_to_its_curve_where_others_are_between():
    axes = Figure().subplots()
    curve, dotted = axes.plot([0, 2], [3, 3], color="red") + axes.plot([0, 2], [1, 1])
    name_curve(axes, [curve, dotted], "over", 1.0)
    assert not axes.collections
    name_curve(axes, [curve, dotted], "under", 1.0, side="below")
    (stroke,) = axes.collections
    np.testing.assert_array_equal(stroke.get_segments(), [[[1, 1], [1, 3]]])
    assert stroke.get_color()[0, :3].tolist() == [1, 0, 0]
