"""`study.plot_stresses`: every curve, map and mark against `study.stresses` and `study.extremes`."""

import sys
import warnings

import numpy as np
import pytest
from drawn import contours, frame, lines
from matplotlib.figure import Figure

import study
from study.figures.stresses.picture import drawn
from study.figures.stresses.regions import of_one_contact
from study.figures.stresses.sections import Units
from study.inputs.definition import StudyError

COATED = {"P": 1e-5, "h": 0.02, "n": 4.0, "nu1": 0.25, "bonding": "bonded", "micro": "smooth", "base": "layered"}
BALL = {"R": "5 mm", "E1": "625 GPa", "nu1": 0.17, "h": "20 um", "E2": "3.8 GPa", "nu2": 0.38, "micro": "smooth"}
BALL |= {"bonding": "bonded", "base": "layered", "P": "10 N"}


def picture(contact, mu=0.0, sigma_res=0.0) -> tuple[list, list]:
    """The panels, and the labels of the scales of colours."""
    figure = drawn(contact, mu, sigma_res, Figure)
    panels = [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]
    return panels, [axes.get_ylabel() for axes in figure.axes if axes.get_label() == "<colorbar>"]


def titles(panels) -> list[str]:
    return [axes.get_title(loc="left") for axes in panels]


@pytest.fixture(scope="module")
def coated():
    return study.solve(**COATED, x=5)


@pytest.fixture(scope="module")
def ball():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return study.solve(**BALL, Y2="50 MPa", x=5)


def test_maps_are_the_stresses_of_layer_and_body(coated):
    panels, bars = picture(coated)
    h = float(coated.h / coated.a)
    largest = study.extremes(coated)
    assert [title[:10] for title in titles(panels)] == ["(a) layer:", "(b) body: ", "(c) surfac", "(d) interf"]
    assert bars == [rf"von Mises stress$\,/\,(10^{{{power}}}\,E_2^*)$" for power in (-2, -3)]
    for axes, name, unit, (top, bottom) in zip(
        panels, ("mises1", "mises2"), (1e-2, 1e-3), ((0, h), (h, h + 1.6)), strict=False
    ):
        assert frame(axes)[2] == "$z/a$" and axes.get_xlim() == (0, 2)
        np.testing.assert_allclose(axes.get_ylim(), (bottom, top), rtol=1e-12)
        filled = contours(axes)[0]
        assert filled.levels[0] == 0 and filled.levels[-2] < float(largest[name]) / unit <= filled.levels[-1]
        cross = lines(axes)[0]
        assert cross.look.marker == "x"
        np.testing.assert_allclose([cross.x[0], cross.y[0]], [largest[f"{name}_r"], largest[f"{name}_z"]])
        line = contours(axes)[1]
        on = [(r, z) for r, z in line.get_paths()[2].vertices[::9] if top < z < bottom]
        at = [study.stresses(coated, r=[r], z=[z]).mises.item() / unit for r, z in on]
        assert len(at) > 3
        np.testing.assert_allclose(at, line.levels[2], rtol=0.05)  # it is straight between the nodes
    assert f"largest ${float(largest.mises1) / 1e-2:.3g}\\times10^{{-2}}\\,E_2^*$" in titles(panels)[0]
    assert panels[0].spines["bottom"].get_linewidth() == 2, "the interface"


def test_the_maps_meet_at_the_interface_each_with_its_own_side(coated):
    _, shown = of_one_contact(coated, 0.0, 0.0)
    assert shown.layer.z[-1] == shown.body.z[0] == shown.h
    fields = study.stresses(coated, r=shown.r, z=[0.0])
    np.testing.assert_allclose(shown.layer.mises[-1], fields.mises_above, rtol=1e-12)
    np.testing.assert_allclose(shown.body.mises[0], fields.mises_below, rtol=1e-12)
    np.testing.assert_allclose(shown.layer.mises[0], fields.mises[:, 0], rtol=1e-12)


def test_curves_are_the_stresses_of_surface_and_interface(coated):
    surface, interface = picture(coated)[0][2:]
    radii = lines(surface)[0].x
    assert 1.0 in radii and radii[0] == 0 and radii[-1] == 2
    fields, largest = study.stresses(coated, r=radii, z=[0.0]), study.extremes(coated)
    wanted = {r"$\sigma_r$": fields.sr[:, 0], r"$\sigma_\theta$": fields.st[:, 0], "$p$": -fields.sz[:, 0]}
    unit = 1e-2
    for line, (label, values) in zip(lines(surface), wanted.items(), strict=False):
        assert line.label == label
        np.testing.assert_allclose(line.y * unit, values, rtol=1e-12, atol=1e-16)
    np.testing.assert_allclose(lines(surface)[0].x, radii)
    sides = {r"$\tau_{rz}$": "trz_above", r"$\sigma_z$": "sz_above"}
    sides |= {r"$\sigma_r$, layer": "sr_above", r"$\sigma_r$, body": "sr_below"}
    unit = 1e-3
    for line, (label, name) in zip(lines(interface), sides.items(), strict=False):
        assert line.label == label
        np.testing.assert_allclose(line.y * unit, fields[name], rtol=1e-12, atol=1e-16)
    rings = [(line.x[0], line.y[0] * unit) for line in lines(interface) if line.look.marker == "o"]
    wanted = [(largest.sr_interface1_r, largest.sr_interface1), (largest.tau_interface_r, -largest.tau_interface)]
    np.testing.assert_allclose(rings, wanted, rtol=1e-12)
    ring = next(line for line in lines(surface) if line.look.marker == "o")
    np.testing.assert_allclose([ring.x[0], ring.y[0] * 1e-2], [largest.s1_surface_r, largest.s1_surface], rtol=1e-12)


def test_physical_units_and_a_line_around_what_yields(ball):
    """Hard on soft: the layer has 1.5 GPa, the body 70 MPa, which are two scales of colours."""
    panels, bars = picture(ball)
    assert bars == ["von Mises stress, GPa", "von Mises stress, MPa"]
    assert [axes.get_ylabel() for axes in panels] == ["$z$, µm"] * 2 + ["stress, GPa"] * 2
    assert panels[1].get_xlabel() == panels[3].get_xlabel() == "$r$, µm"
    np.testing.assert_allclose(panels[0].get_ylim(), (20, 0), rtol=1e-12)
    largest = study.extremes(ball)
    assert f"largest {largest.mises1.item() / 1e9:.3g} GPa" in titles(panels)[0]
    assert titles(panels)[1].endswith(f"largest {largest.mises2.item() / 1e6:.3g} MPa, yields at 50 MPa")
    assert len(contours(panels[0])) == 2 and "yields" not in titles(panels)[0], "its strength is not known"
    yields = contours(panels[1])[2]
    np.testing.assert_allclose(yields.levels, 50e6)
    edge = next(line for line in panels[2].lines if len(line.get_xdata()) == 2 and line.get_xdata()[0] > 1)
    np.testing.assert_allclose(edge.get_xdata(), ball.a.item() * 1e6)


def test_strengths_of_the_named_materials():
    """PEEK has 95 MPa, ta-C a hardness of 60 GPa: neither is exceeded."""
    named = {"R": "5 mm", "layer": "DLC ta-C", "body": "PEEK", "h": "20 um", "bonding": "bonded", "base": "layered"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        contact = study.solve(**named, P="10 N", micro="smooth", x=2)
    panels, _ = picture(contact)
    assert [title.rpartition("yields at ")[2] for title in titles(panels)[:2]] == ["21.1 GPa", "95 MPa"]
    assert [len(contours(axes)) for axes in panels[:2]] == [2, 2]


def test_a_strength_is_stated_as_it_was_given():
    """1 GPa has come back from units of E2* as 999.9999999999999 MPa."""
    for largest, label in ((1e9 - 1e-5, "1 GPa"), (1e9, "1 GPa"), (2.5e6, "2.5 MPa")):
        contact = study.solve(R="5 mm", E2="70 GPa", P="1 N", base="half_space", micro="smooth", x=2)
        assert Units.of(contact, largest, False).text(largest) == label


def test_one_scale_where_layer_and_body_differ_little():
    panels, bars = picture(study.solve(**COATED | {"n": 1.2, "P": 1e-4}, x=2))
    assert len(bars) == 1 and len(panels) == 4
    levels = [contours(axes)[0].levels for axes in panels[:2]]
    np.testing.assert_array_equal(*levels)


def test_what_is_not_there_has_no_panel():
    half = study.solve(P=1e-5, micro="smooth", base="half_space", nu2=0.35, x=2)
    panels, _ = picture(half)
    assert [title[:9] for title in titles(panels)] == ["(a) body:", "(b) surfa"]
    assert r"$\nu_2$ = 0.35" in panels[0].figure.get_suptitle(), "stresses depend on it, the pressure does not"
    rigid = study.solve(**COATED | {"n": 0.0}, nu2=0.35, x=2)
    panels, bars = picture(rigid)
    assert [title[:9] for title in titles(panels)] == ["(a) layer", "(b) surfa", "(c) inter"]
    assert "E_1^*" in bars[0] and r"$\nu_2$" not in panels[0].figure.get_suptitle()
    assert not [line for line in lines(panels[2]) if line.label.endswith("body")]
    thick = study.solve(**COATED | {"h": 0.2}, x=2)
    panels, _ = picture(thick)
    assert [title[:9] for title in titles(panels)] == ["(a) layer", "(b) surfa"]
    assert titles(panels)[0].endswith(f"interface at $z$ = {(thick.h / thick.a).item():.3g}$\\,a$")
    assert panels[0].get_ylim() == (3.0, 0.0)


def test_a_thick_layer_that_bends_is_shown_as_a_whole():
    """A hard plate of 4 a on a soft body is torn at its lower side."""
    plate = study.solve(**COATED | {"n": 1e4, "h": 0.004}, x=2)
    panels, _ = picture(plate)
    h, largest = (plate.h / plate.a).item(), study.extremes(plate)
    assert h > 4 and len(panels) == 4 and largest.sr_interface1 > 0.3 * largest.mises1
    np.testing.assert_allclose(panels[0].get_ylim(), (h, 0), rtol=1e-12)
    assert titles(panels)[0] == f"(a) layer: largest ${largest.mises1.item():.3g}\\,E_2^*$"


def test_in_sliding_the_plane_of_sliding_is_shown(coated):
    panels, _ = picture(coated, mu=0.3, sigma_res=-0.01)
    assert panels[0].get_xlim() == (-2, 2) and panels[3].get_xlabel() == "$x/a$"
    x = lines(panels[2])[0].x
    fields = study.stresses(coated, r=x, z=[0.0], mu=0.3, sigma_res=-0.01)
    np.testing.assert_allclose(lines(panels[2])[0].y * 1e-2, fields.sr[:, 0], rtol=1e-12, atol=1e-16)
    assert [line.label for line in lines(panels[2])[:3]] == [r"$\sigma_x$", r"$\sigma_y$", "$p$"]
    said = panels[0].figure.get_suptitle()
    assert r"$\mu$ = 0.3, $\sigma_{\mathrm{res}}$" " = \u22120.01" in said.replace("\n", " ")
    edges = [line.get_xdata()[0] for line in panels[2].lines if line.get_xdata()[0] == line.get_xdata()[-1]]
    assert {-1.0, 1.0} <= set(edges)


def test_what_the_model_does_not_allow_is_said():
    merging = study.solve(P=1e-5, h=0.02, n=0.1, Nbar=250000, Ra=0.004, x=2)
    assert "not valid: spots merge" in picture(merging)[0][0].figure.get_suptitle()


def test_one_contact_that_is_solved():
    several = study.solve(P=[1e-5, 2e-5], h=[0.02], n=0.5, micro="smooth", x=2)
    with pytest.raises(StudyError, match=r"one contact, not those of P \(2\): choose one, as \.isel\(P=0\)"):
        study.plot_stresses(several)
    assert study.plot_stresses(several.isel(P=0)).axes, "an axis of one value does no harm"
    wrong = study.solve(P=1e-5, h=0.02, n=0.5, base="thin_layer", micro="smooth", bonding="bonded", x=2)
    wrong["status"] = wrong.status * 0 + 3
    with pytest.raises(StudyError, match="plot_stresses: the contact has no solution: "):
        study.plot_stresses(wrong)
    with pytest.raises(StudyError, match="plot_stresses takes a dataset of study.solve"):
        study.plot_stresses(several.P)
    with pytest.raises(StudyError, match="mu = -1: must be"):
        study.plot_stresses(several.isel(P=0), mu=-1)


def test_it_leaves_pyplot_alone(coated, monkeypatch):
    monkeypatch.delitem(sys.modules, "matplotlib.pyplot", raising=False)
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)  # importing it is an error
    assert study.plot_stresses(coated)._repr_png_().startswith(b"\x89PNG")
