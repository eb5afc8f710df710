"""What users give to `plot` beside texts and numbers, and in another order."""

import numpy as np
import pytest

import study
from study.figures.registry import pick

pint = pytest.importorskip("pint")


@pytest.fixture(scope="module")
def found():
    given = {"R": "5 mm", "E2": "70 GPa", "base": "half_space", "micro": "smooth", "x": 2}
    return study.solve(**given, P=["10 N", "1 N", "5 N"], nu2=[0.3, 0.2])


def test_curves_run_from_left_to_right(found):
    line = study.plot(found, "P", "a", hue="nu2").axes[0].lines[0]
    assert line.get_xdata().tolist() == [1.0, 5.0, 10.0]
    np.testing.assert_allclose(line.get_ydata(), 1e6 * found.a.sel(nu2=0.3, P=[1.0, 5.0, 10.0]), rtol=1e-12)


def test_values_of_axes(found):
    axes = study.plot(found, "nu2", "a", P=pint.UnitRegistry().Quantity(5, "N")).axes[0]
    np.testing.assert_allclose(axes.lines[0].get_ydata(), 1e6 * found.a.sel(P="5 N")[::-1], rtol=1e-12)
    for wrong in (["5 N"], None, slice(0, 1)):
        with pytest.raises(study.StudyError, match="must be a force, such as"):
            study.plot(found, "nu2", "a", P=wrong)


def test_lengths_of_nanometres_are_told_apart():
    """In metres they are small numbers, which are as near to each other as any."""
    film = {"R": "5 um", "E1": "200 GPa", "E2": "70 GPa", "base": "layered", "micro": "smooth", "x": 2}
    found = study.solve(**film, P=["1 uN", "2 uN"], h=["2 nm", "3 nm", "5 nm"])
    axes = study.plot(found, "P", "a", h="3 nm").axes
    assert len(axes) == 1 and len(axes[0].lines) == 2, "a dotted line below a solid one"
    np.testing.assert_allclose(axes[0].lines[1].get_ydata(), 1e9 * found.a.sel(h=3e-9), rtol=1e-12)
    with pytest.raises(study.StudyError, match="h = 4 nm is not among these results"):
        study.plot(found, "P", "a", h="4 nm")
    cases = study.solve(**film, P="1 uN", cases=[{"h": "2 nm"}, {"h": "3 nm"}])
    assert float(pick(cases, h=3e-9).h) == 3e-9
    with pytest.raises(study.StudyError, match=r"0 cases have h = 2.5e-09"):
        pick(cases.assign_attrs(study_name="s"), h=2.5e-9)


def test_what_study_readable_made_is_stated_with_its_units(found):
    """It was "$R$, mm = 5"."""
    figure = study.plot(study.readable(found), "nu2", "a", P="5 N")
    assert figure.get_suptitle() == "$R$ = 5 mm, $E_2$ = 70 GPa, $P$ = 5 N"


def test_an_array_is_no_dataset_and_a_stacked_one_is_to_be_unstacked(found):
    with pytest.raises(study.StudyError, match=r'z is several axes in one: give dataset.unstack\("z"\)'):
        study.plot(found.stack(z=("P", "nu2")), "P", "a")
    with pytest.raises(study.StudyError, match="plot takes a dataset of contacts, not a DataArray"):
        study.plot(found.a, "P", "a")


def test_a_figure_without_a_number_is_not_drawn(found):
    """It was empty, after a RuntimeWarning of numpy."""
    with pytest.raises(study.StudyError, match="nothing to draw: no case has numbers for P and a; status says"):
        study.plot(found.where(found.P > 1e9), "P", "a", hue="nu2")


def test_numbers_of_a_logarithmic_axis_of_one_decade():
    """2, 3, 4 and 6 times 10¹ were written over each other."""
    given = {"R": "5 mm", "E2": "70 GPa", "base": "half_space", "micro": "smooth", "x": 2}
    axes = study.plot(study.solve(**given, a=[f"{a} um" for a in (15, 30, 70, 180)]), "a", "P").axes[0]
    low, high = axes.get_xlim()
    shown = [text.get_text() for text in axes.get_xticklabels() if low <= text.get_position()[0] <= high]
    assert shown == ["30", "100"] and not any(text.get_text() for text in axes.get_xticklabels(minor=True))


def test_single_cases_are_points():
    """Random cases were joined by a line, to and fro."""
    rows = [{"P": f"{P} N", "R": f"{R} mm"} for P, R in ((1, 3), (5, 2), (2, 5))]
    cases = study.solve(cases=rows, E2="70 ± 5 GPa", base="half_space", micro="smooth", x=2)
    figure = study.plot(cases, "P", "a")
    styles = [(line.get_linestyle(), line.get_marker(), line.get_fillstyle()) for line in figure.axes[0].lines]
    assert styles == [("None", "o", "none"), ("None", "o", "full")]
    with pytest.raises(study.StudyError, match='^r is not an axis of these results; did you mean "R"'):
        study.plot(cases, "P", "a", r="3 mm")  # over the cases, as R is, but no dimension
    (bars,) = figure.axes[0].collections
    np.testing.assert_allclose(np.ptp(bars.get_segments(), axis=1)[:, 1], 2e6 * cases.a_spread, rtol=1e-9)


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_a_long_legend_is_below_what_is_stated():
    """Its title stood on the parameters. And of many values the nearest are named, not the first."""
    given = {
        "R": "5 mm",
        "E1": "2 ± 0.1 GPa",
        "E2": "70 GPa",
        "E_punch": "210 GPa",
        "Nbar": "1e4 1/mm^2",
        "Ra": "20 um",
    }
    h = [f"{one} um" for one in range(1, 25)]
    found = study.solve(**given, bonding="bonded", h=h, P=["1 N", "20 N"], x=2, profiles=False)
    figure = study.plot(found, "P", "a", hue="h")
    figure.canvas.draw()
    assert "not valid" in [text.get_text() for text in figure.legends[0].get_texts()]
    assert figure.legends[0].get_window_extent().y1 < figure._suptitle.get_window_extent().y0
    with pytest.raises(
        study.StudyError, match="^h = 23.4 um is not among these results; there are 2.3e-05, 2.4e-05, 2.2e-05"
    ):
        study.plot(found, "P", "a", h="23.4 um")


def test_the_load_against_the_depth():
    """The curve of an indenter: the load was "an axis of these results". What has a ± is the depth."""
    gel = {"R": "2 um", "E2": "5 ± 1 kPa", "nu2": 0.5, "base": "half_space", "micro": "smooth", "x": 2}
    found = study.solve(**gel, P=["10 pN", "20 pN", "40 pN"])
    figure = study.plot(found, "D", "P")
    (line, _), (band,) = figure.axes[0].lines, figure.axes[0].collections
    np.testing.assert_allclose(line.get_xdata(), 1e9 * found.D, rtol=1e-12)
    np.testing.assert_allclose(line.get_ydata(), [0.01, 0.02, 0.04], rtol=1e-12)
    widths = [
        np.ptp(band.get_paths()[0].vertices[np.isclose(band.get_paths()[0].vertices[:, 1], P), 0]) for P in (0.01, 0.04)
    ]
    np.testing.assert_allclose(widths, 2e9 * found.D_spread[[0, 2]], rtol=1e-9)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["± one standard\ndeviation"]
    for x in ("P", "nu2"):
        with pytest.raises(study.StudyError, match="y = P is an axis of these results"):
            study.plot(found, x, "P")


def test_the_value_that_is_written_goes_before_those_near_to_it():
    """A value that Python has computed, 0.1 + 0.2, is 0.3; of two neighbours the one that is meant is drawn."""
    h = [0.02, 0.02 * (1 + 5e-7), 0.03]
    found = study.solve(P=[1e-6, 1e-5], h=h, n=0.5, micro="smooth", x=2)
    for value, nearest in ((h[0], h[0]), (h[1], h[1]), (0.03 * (1 + 1e-7), 0.03)):
        (axes,) = study.plot(found, "P", "a", h=value).axes
        np.testing.assert_array_equal(axes.lines[-2].get_ydata(), found.a.sel(h=nearest))
