"""Curves of any results: every line against the dataset, what the axes are called, and what cannot be drawn."""

import warnings

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from drawn import frame, legend, lines
from matplotlib.figure import Figure

import study
from study.__main__ import main
from study.figures.labels import axis_label, stated, value_text, written
from study.figures.plots import drawn, spaced_by_factors
from study.inputs.definition import StudyError

AXES = {"P": [1e-6, 1e-5, 1e-4], "n": [0.2, 0.5], "bonding": ["frictionless", "bonded"]}
ROUGH = {"h": 0.02, "Nbar": 250000, "Ra": 0.004}


@pytest.fixture(scope="module")
def found() -> xr.Dataset:
    return study.solve(**AXES, **ROUGH, x=5)


@pytest.fixture(scope="module")
def physical() -> xr.Dataset:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        steel = {"R": "5 mm", "E1": "200 GPa", "E2": "210 GPa", "micro": "smooth"}
        return study.solve(**steel, P=["1 N", "10 N"], h=["2 um", "5 um"], x=2)


def shown(dataset, x, y, hue="", **where):
    return drawn(dataset, x, y, hue, where, Figure)


def test_a_curve_for_each_hue_and_a_panel_for_each_of_the_rest(found):
    figure, columns = shown(found, "P", "p_max", "n")
    for axes, bonding in zip(figure.axes, AXES["bonding"], strict=True):
        assert axes.get_title() == f"{bonding} interface"
        for (whole, valid), n in zip(np.reshape(lines(axes), (-1, 2)), AXES["n"], strict=True):
            case = found.sel(n=n, bonding=bonding)
            np.testing.assert_array_equal(whole.x, AXES["P"])
            np.testing.assert_array_equal(whole.y, case.p_max)
            np.testing.assert_array_equal(valid.y, case.p_max.where(case.validity == 0))
            assert (whole.look.colour, whole.look.dashes != ("solid",)) == (valid.look.colour, True)
    assert (found.validity != 0).any() and (found.validity == 0).any(), "both are shown"
    (box,) = figure.legends
    entries = legend(box)
    assert box.get_title().get_text() == "$n$" and list(entries) == ["0.2", "0.5", "not valid"]
    assert entries["0.5"].colour == lines(figure.axes[0])[2].look.colour
    assert frame(figure.axes[0])[:4] == ("$P/(E_2^*\\,R^2)$", "log", "$p_{\\max}/E_2^*$", "linear")
    assert list(columns) == ["n", "bonding", "P", "p_max", "valid"] and len(columns["P"]) == 12
    at = (columns["n"] == 0.5) & (columns["bonding"] == "bonded")
    np.testing.assert_array_equal(columns["p_max"][at], found.p_max.sel(n=0.5, bonding="bonded"))


def test_a_quantity_against_another_one_runs_with_the_load(found):
    figure, _ = shown(found, "a", "E_eff", "bonding", n=0.5)
    for line, bonding in zip(lines(figure.axes[0])[::2], AXES["bonding"], strict=True):
        case = found.sel(n=0.5, bonding=bonding)
        np.testing.assert_array_equal(line.x, case.a)
        np.testing.assert_allclose(line.y, case.dP_dD / (2 * case.a), rtol=1e-14)  # one quotient
    assert figure.get_suptitle().startswith("$\\nu_1$ = 0.3, ") and "$n$ = 0.5" in figure.get_suptitle()


def test_profiles(found):
    figure, _ = shown(found, "x", "p", "P", n=0.5, bonding="bonded")
    for line, P in zip(lines(figure.axes[0])[::2], AXES["P"], strict=True):
        np.testing.assert_array_equal(line.y, found.p.sel(n=0.5, bonding="bonded", P=P))


EDGES = {  # contact, whose profile ends like sqrt(1 - x^2), flatter, or at infinity; error of its curve, over p(0)
    "hertz": ({"base": "half_space", "micro": "smooth"}, 1e-3),
    "layer": ({"h": 0.02, "n": 0.5, "bonding": "bonded", "micro": "smooth"}, 1e-3),
    "cone": ({"base": "half_space", "micro": "smooth", "shape": "cone", "half_angle": 85}, 6e-3),
    "rough": ({"h": 0.02, "n": 0.5, "bonding": "bonded", "Nbar": 250_000, "Ra": 0.004}, 8e-3),
    "adhesive": ({"base": "half_space", "micro": "smooth", "w_adhesion": 1e-5}, 1e-2),
}


@pytest.mark.parametrize("kind", EDGES)
def test_the_curve_of_a_profile_has_no_corner_at_the_edge(kind):
    """33 points of it are solved; straight lines between them were 6 % of p(0) off at r/a = 0.99 of a smooth punch."""
    given, error = EDGES[kind]
    fine = np.sin(np.linspace(0, np.pi / 2, 1200))
    contact, many = (study.solve(a=0.04, **given, x=x) for x in (33, [*fine[:-1], 1.0]))
    figure, columns = shown(contact, "x", "p")
    line, p = lines(figure.axes[0])[0], contact.p.values  # the second line is of valid contacts
    there, scale = np.isfinite(line.y), np.abs(p[np.isfinite(p)]).max()
    drawn = (fine >= line.x[there][0]) & (fine <= line.x[there][-1])
    angles = np.arcsin(line.x[there])  # steps of the line are even over these
    curve = np.interp(np.arcsin(fine[drawn]), angles, line.y[there])
    np.testing.assert_allclose(curve, many.p.values[drawn], rtol=0, atol=error * scale)
    np.testing.assert_array_equal(columns["p"], p)  # the numbers are those that were solved
    at = np.isin(line.x, contact.x) & there
    np.testing.assert_allclose(line.y[at], p[np.isfinite(p)], rtol=1e-12, atol=1e-15)


def test_physical_results_have_units_that_are_read_easily(physical):
    figure, columns = shown(physical, "P", "a", "h")
    assert frame(figure.axes[0])[0:3:2] == ("$P$, N", "$a$, µm")
    np.testing.assert_allclose(lines(figure.axes[0])[0].y, physical.a.sel(h="2 um") * 1e6, rtol=1e-14)  # one product
    np.testing.assert_array_equal(columns["a [m]"][:2], physical.a.sel(h=2e-6))
    assert list(columns) == ["h [m]", "P [N]", "a [m]", "valid"], "the .csv had no units, and the axes have others"
    assert list(legend(figure.legends[0]))[:2] == ["2", "5"]
    assert figure.legends[0].get_title().get_text() == "$h$, µm"
    assert shown(physical, "P", "a", h="2 um")[1]["a [m]"].tolist() == physical.a.sel(h=2e-6).values.tolist()


def test_a_band_shows_the_spread_of_what_is_drawn():
    ball = {"R": "5 mm", "E2": "210 ± 20 GPa", "base": "half_space", "micro": "smooth"}
    found = study.solve(**ball, P=["1 N", "10 N"], x=2)
    figure, columns = shown(found, "P", "a")
    (band,) = figure.axes[0].collections
    edges = band.get_paths()[0].vertices[:, 1]
    np.testing.assert_allclose(edges.min(), 1e6 * (found.a - found.a_spread).min(), rtol=1e-12)
    np.testing.assert_allclose(edges.max(), 1e6 * (found.a + found.a_spread).max(), rtol=1e-12)
    np.testing.assert_array_equal(columns["a_spread [m]"], found.a_spread)
    assert list(legend(figure.legends[0])) == ["± one standard\ndeviation"]
    assert not shown(found, "P", "iterations")[0].axes[0].collections, "which has no spread"


def test_labels_of_cases_and_gaps_of_failed_ones():
    rows = [{"label": "thin", "h": 0.01}, {"label": "incompressible", "h": 0.01, "nu1": 0.5, "bonding": "bonded"}]
    found = study.solve(cases=rows, P=[1e-6, 1e-5], n=0.5, base="thin_layer", micro="smooth", x=2)
    figure, columns = shown(found, "P", "D", "label")
    assert list(legend(figure.legends[0]))[:2] == ["thin", "incompressible"]
    assert columns["label"].tolist() == ["thin"] * 2 + ["incompressible"] * 2, "not numbers alone"
    assert np.isnan(lines(figure.axes[0])[2].y).all() and np.isfinite(lines(figure.axes[0])[0].y).all()


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        (("P", "pmax", ""), '"pmax" is not in these results; did you mean "p_max"?'),
        (("P", "a", "h"), "hue = h is not an axis of a; its axes: P, n, bonding"),
        (("h", "a", "n"), "x = h has one value only; axes: P, bonding"),
        (("P", "n", ""), "y = n is an axis of these results: it may be x or the hue"),
        (("P", "a", "P"), "x and hue are both P"),
        (("bonding", "a", ""), "bonding has texts: they are not drawn, but may be the hue"),
        (("P", "base", ""), "base has texts: they are not drawn, but may be the hue"),
    ],
)
def test_what_is_not_there(found, wanted, message):
    with pytest.raises(StudyError) as caught:
        shown(found, *wanted)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("where", "message"),
    [
        ({"n": 0.3}, "n = 0.3 is not among these results; there are 0.2, 0.5"),
        ({"bonding": "glued"}, "bonding = glued is not among these results; there are frictionless, bonded"),
        ({"hh": 1}, "hh is not an axis of these results; known: "),
        ({"n": "thick"}, 'n = "thick": must be a number'),
    ],
)
def test_values_that_are_not_there(found, where, message):
    with pytest.raises(StudyError) as caught:
        shown(found, "P", "a", **where)
    assert str(caught.value).startswith(message)


def test_values_that_are_not_there_have_their_unit(physical):
    with pytest.raises(StudyError, match="^h = 3 um is not among these results; there are 2e-06, 5e-06 m$"):
        shown(physical, "P", "a", h="3 um")


def test_where_takes_the_value_itself_rather_than_one_within_rounding_of_it():
    near = study.solve(P=AXES["P"], n=[0.3, 0.30000015], **ROUGH, x=2)
    _, columns = shown(near, "P", "a", n=0.30000015)
    np.testing.assert_array_equal(columns["a"], near.a.sel(n=0.30000015))


def test_where_takes_all_cases_that_have_the_value():
    """It took the first of them without a word."""
    rows = {"n": ("case", [0.3, 0.5, 0.5]), "bonding": ("case", ["bonded", "bonded", "frictionless"])}
    rows = {name: xr.DataArray(values, dims=dim) for name, (dim, values) in rows.items()}
    three = study.solve(P=AXES["P"], **rows, **ROUGH, x=2)
    figure, columns = shown(three, "P", "a", n=0.5)
    assert [axes.get_title() for axes in figure.axes] == ["case 1", "case 2"]
    np.testing.assert_array_equal(columns["a"], three.a.transpose("case", "P").values[1:].ravel())
    _, columns = shown(three, "P", "a", n=0.5, bonding="frictionless")
    np.testing.assert_array_equal(columns["a"], three.a.isel(case=2))


def test_a_dimension_without_a_coordinate_is_numbered(found):
    bare = found.isel(bonding=0).drop_vars("n")
    figure, columns = shown(bare, "P", "a", "n")
    assert list(legend(figure.legends[0]))[:2] == ["0", "1"] and set(columns["n"]) == {0, 1}
    np.testing.assert_array_equal(shown(bare, "P", "a", n=1)[1]["a"], bare.a.isel(n=1))


def test_texts_of_pandas_name_concatenated_results(physical):
    joined = xr.concat([physical] * 2, pd.Index(["one", "two"], name="coating"), coords="minimal")
    figure, columns = shown(joined, "P", "a", "coating", h="2 um")
    assert list(legend(figure.legends[0]))[:2] == ["one", "two"] and columns["coating"].dtype.kind in "UO"
    assert len(shown(joined, "P", "a", "h", coating="two")[1]["a [m]"]) == 4


def test_axes_of_one_value_and_inputs_over_fewer_axes_than_the_results(found):
    one = study.solve(P=AXES["P"], n=[0.2], **ROUGH, x=2)
    np.testing.assert_array_equal(shown(one, "P", "a")[1]["a"], one.a.sel(n=0.2))
    _, columns = shown(found.assign_coords(E1=("n", [1.0, 2.0])), "P", "E1", "n")
    assert list(columns) == ["n", "P", "E1"], "validity is of bonding too, which a point does not have"
    np.testing.assert_array_equal(columns["E1"], [1, 1, 1, 2, 2, 2])


def test_every_lowest_panel_has_its_abscissa():
    """The last row may be shorter than the others: the panel above a gap is the lowest of its column."""
    found = study.solve(P=[1e-6, 1e-5], h=[0.01, 0.02, 0.03, 0.04, 0.05], n=0.5, micro="smooth", x=2)
    figure, _ = shown(found, "P", "a")
    figure.draw_without_rendering()
    panels = figure.axes[:5]
    assert [bool(axes.get_xlabel()) for axes in panels] == [False, False, True, True, True]
    assert [any(one.label1.get_visible() for one in axes.xaxis.get_major_ticks()) for axes in panels] == [
        False, False, True, True, True
    ]  # fmt: skip


def test_too_many_panels():
    found = study.solve(P=[1e-6, 1e-5], h=np.linspace(0.01, 0.02, 13), n=0.5, micro="smooth", x=2)
    with pytest.raises(StudyError, match=r"13 panels, of h \(13\): at most 12; choose by NAME=VALUE, or --where"):
        shown(found, "P", "a")


def test_the_command_and_the_methods(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "studies").mkdir()
    (tmp_path / "studies/mine.toml").write_text(
        'axes.P = [1e-6, 1e-5]\naxes.h = [0.01, 0.02]\nmodel.n = 0.5\nmodel.micro = "smooth"', encoding="utf-8"
    )
    assert main(["plot", "mine", "--run", "--x", "P", "--y", "a", "--hue", "h", "--figures", "there"]) == 0
    assert capsys.readouterr().out.splitlines()[1:] == [f"there/mine_a.{kind}" for kind in ("csv", "pdf", "png")]
    found = study.load("studies/mine.toml").open()
    rows = (tmp_path / "there/mine_a.csv").read_text().splitlines()
    assert rows[0] == "h,P,a,valid" and rows[1].split(",")[2] == repr(found.a.sel(h=0.01)[0].item())
    assert main(["plot", "results/mine.nc", "--x", "P", "--y", "D", "--where", "h=0.01"]) == 0
    figure = study.load("studies/mine.toml").plot("P", "a", hue="h")
    np.testing.assert_array_equal(lines(figure.axes[0])[0].y, found.a.sel(h=0.01))
    for command, message in (
        ("plot mine --x P", "curves of results need both --x and --y, such as --x P --y p_max"),
        ("plot none.nc --x P --y a", "none.nc: does not exist"),
        ("plot mine --x P --y a --where h=0.01 --where h=0.02", "--where h is given twice"),
        ("plot mine", "mine is a study, not a figure: give --x and --y to draw curves of it, such as --x P --y a"),
    ):
        assert main(command.split()) == 2
        assert capsys.readouterr().err.splitlines()[-1] == message


def test_scales_follow_the_spacing():
    assert spaced_by_factors(np.geomspace(1e-6, 1e-4, 21)) and not spaced_by_factors(np.linspace(1e-8, 5e-5, 251))
    assert not spaced_by_factors(np.array([0.1, 0.2])) and not spaced_by_factors(np.array(["a", "b"]))


def test_names_and_numbers_of_labels(found):
    wanted = {"h": "$h/R$", "Nbar": "$\\bar N\\,R^2$", "n": "$n$", "dP_dD": "$(dP/dD)/(E_2^*\\,R)$", "x": "$r/a$"}
    assert {name: axis_label(name, found[name]) for name in wanted} == wanted
    assert axis_label("iterations", found["iterations"]) == "iterations"
    physical = study.to_physical(found, R=0.01, E2_star=2e11)
    assert axis_label("a", physical["a"]) == "$a$, µm"
    numbers = {0.02: "0.02", 250000.0: "250000", 2.7040777e-5: "$2.704\\times10^{-5}$", 1e-6: "$10^{-6}$"}
    assert {value: written(value) for value in numbers} == numbers
    assert value_text("Nbar", physical["Nbar"], 5e11) == "$\\bar N$ = 5$\\times10^{5}$ 1/mm²"


def test_only_what_is_used_is_stated():
    bare = study.solve(
        P=1e-5, h=0.02, n=0.5, Nbar=250000, Ra=0.004, B=0.1, beta=0.5, base="half_space", micro="smooth", x=2
    )
    assert stated([bare]) == ["$P/(E_2^*\\,R^2)$ = $10^{-5}$"]
    power = study.solve(P=1e-5, h=0.02, n=0.5, micro="power_law", Nbar=250000, Ra=0.004, B=0.1, beta=0.5)
    assert stated([power])[1:] == [
        "$h/R$ = 0.02", "$n$ = 0.5", "frictionless interface", "$\\bar N\\,R^2$ = 250000", "$R_a/R$ = 0.004",
        "$B$ = 0.1 $R_a/E_1^{*\\beta}$", "$\\beta$ = 0.5"
    ]  # fmt: skip


def test_a_rigid_base_is_stated():
    gel = study.solve(P=1e-5, h=0.02, n=0, micro="smooth", x=2)
    assert stated([gel]) == ["rigid base", "$P/(E_1^*\\,R^2)$ = $10^{-5}$", "$h/R$ = 0.02", "frictionless interface"]
    assert "rigid base" not in stated([gel, study.solve(P=1e-5, h=0.02, n=0.5, micro="smooth", x=2)])
