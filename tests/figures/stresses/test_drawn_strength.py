"""What first yields or cracks: the two figures against the largest stresses, by formulas of their own."""

import warnings

import numpy as np
import pytest
from conftest import opened
from drawn import frame, legend, lines, mesh
from yielding import first_yield, largest

import study
from study.studies.systems.strength import FRICTION, MODES, THICKNESS, first, nominal_at_asperity_yield, strength


@pytest.fixture(scope="module")
def coated(results):
    return opened(results / "what_fails_first.nc")


def test_pressures_of_first_yield(drawing, results):
    contacts = opened(results / "first_yield.nc")
    figure, columns, _ = drawing("first_yield")
    assert [axes.get_title(loc="left") for axes in figure.axes] == [
        f"({letter}) {body}, {bonding} interface"
        for letter, body, bonding in zip(
            "abcd", ("layer",) * 2 + ("body",) * 2, ("bonded", "frictionless") * 2, strict=True
        )
    ]
    assert frame(figure.axes[2])[:4] == ("$h/a$", "log", "$p(0)/Y_2$ at first yield", "log")
    assert list(legend(figure.legends[0])) == [f"{n:g}" for n in contacts.n.values]
    case = contacts.sel(bonding="frictionless").isel(n=-1)
    top = largest(case, "mises1", "mises2")
    for axes, name in ((figure.axes[1], "mises1"), (figure.axes[3], "mises2")):
        line = lines(axes)[contacts.n.size - 1]
        np.testing.assert_allclose(line.x, case.h / case.a, rtol=1e-14)
        np.testing.assert_allclose(line.y, case.p0 / top[name], rtol=1e-9)
    thick = (columns["h/a"] == columns["h/a"].max()) & (columns["bonded"] == 1)
    np.testing.assert_allclose(columns["p0/Y1"][thick], 1.613, rtol=0.15)  # nearly a half-space of the layer
    assert (columns["p0/Y2"][thick] > 15).all(), "a thick layer protects the body"


def test_what_is_reached_first():
    """The curve runs to and fro: at h = 3 it has three loads."""
    h, P = np.array([1.0, 4.0, 2.0, 5.0]), np.array([10.0, 40.0, 80.0, 200.0])
    np.testing.assert_allclose(first(np.array([1.0, 3.0, 4.5]), h, P)[:2], [10.0, 30.0], rtol=1e-12)
    assert np.isnan(first(np.array([0.5, 6.0]), h, P)).all(), "no load is known there"
    assert 160 < first(np.array([4.5]), h, P)[0] < 200


def test_loads_at_which_stresses_reach_the_strengths(drawing, coated):
    """A contact that is solved at the load of a curve has the strength as its largest stress."""
    figure, columns, _ = drawing("what_fails_first")
    h = coated.h.values
    for number, mode in enumerate(MODES):
        factor = strength(mode, coated) / largest(coated.isel(h=0), mode.stress, mu=0.4)[mode.stress].item()
        load = coated.P.values[0] * factor**3 / 0.005**2
        chosen = (columns["mode"] == number) & (columns["mu"] == 0.4)
        at = h[0] * factor / 0.005
        if at > THICKNESS[0]:
            np.testing.assert_allclose(
                np.exp(np.interp(np.log(at), np.log(columns["h/R"][chosen]), np.log(columns["P/R^2 [Pa]"][chosen]))),
                load,
                rtol=0.02,  # the first point of the curve lies between two thicknesses
            )
    steel = [strength(mode, coated) for mode in MODES]
    np.testing.assert_allclose(steel, [8e9 / 2.84, 60e9 / 2.84, 7.3e9])


def test_loads_are_those_of_first_yield(coated):
    """What grows like a/R, and the search over the load, give the same."""
    case = coated.isel(h=0)
    factor = strength(MODES[0], coated) / largest(case, "mises2").mises2.item()
    inputs = {name: case[name].item() for name in ("punch", "layer", "body", "bonding", "micro", "base")}
    found = first_yield("body", **inputs, R="5 mm", h=f"{case.h.item() * factor * 1e6!r} um")
    np.testing.assert_allclose(found.P_Y2, case.P * factor**3, rtol=1e-5)


def test_a_contact_of_opened_results_is_drawn(coated):
    titles = [axes.get_title(loc="left") for axes in study.plot_stresses(coated.isel(h=-1)).axes]
    assert titles[0].endswith("yields at 21.1 GPa, interface at $z$ = 4$\\,a$")


def test_map_of_what_comes_first(drawing):
    figure, columns, _ = drawing("what_fails_first")
    assert list(legend(figure.legends[0])) == [*(mode.words for mode in MODES), "interface shear 1 GPa"]
    which = mesh(figure.axes[1]).get_array().reshape(121, len(THICKNESS))
    for row, mu in ((0, FRICTION[0]), (-1, FRICTION[-1])):
        for i in (40, 80, 120):
            at = (columns["mu"] == mu) & (columns["h/R"] == THICKNESS[i])
            assert which[row, i] == columns["mode"][at][columns["P/R^2 [Pa]"][at].argmin()]


def test_pressure_at_which_asperities_yield(coated):
    """On both sides of it, contacts of the same materials."""
    p = nominal_at_asperity_yield(coated)
    flat = {"R": "5 m", "punch": "steel 52100", "body": "DLC ta-C", "base": "half_space", "hardness": "8 GPa", "x": 2}
    texture = {"Nbar": "4 1/um^2", "Ra": "2 um"}
    loads = np.geomspace(1e4, 3e6, 40)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that is what is looked at
        contacts = study.solve(**flat, **texture, P=[f"{P} N" for P in loads], workers=1)
    yields = contacts.validity.values & 1024 != 0
    at = int(yields.argmax())
    assert contacts.p0.values[at - 1] < p < contacts.p0.values[at]
