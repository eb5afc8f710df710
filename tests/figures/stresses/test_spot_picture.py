"""`study.plot_stresses` below the central spot, against `study.extremes` and the law."""

import numpy as np
import pytest
from drawn import lines
from matplotlib.figure import Figure

import study
from study.figures.stresses.picture import drawn
from study.figures.stresses.spot_stresses import of_central_spot
from study.inputs.definition import StudyError

H, PITCH = 0.001, 6.0
GIVEN = {"P": 5e-5, "h": H, "n": 10.0, "nu1": 0.25, "bonding": "bonded", "base": "layered", "Ra": 0.01, "x": 3}
GIVEN |= {"Nbar": 1 / (PITCH * H) ** 2}


@pytest.fixture(scope="module")
def contact():
    return study.solve(**GIVEN)


@pytest.fixture(scope="module")
def shown(contact):
    return of_central_spot(contact, 0.0)[1]


def test_lines_and_sections_are_those_below_the_spot(contact, shown):
    a, largest, middle = contact.a.item(), study.extremes(contact), len(shown.r) // 2
    b = np.sqrt(contact.lam0.item() / np.pi) * PITCH * H / a
    assert shown.edge == pytest.approx(b, rel=1e-9) and shown.h == pytest.approx(H / a, rel=1e-12)
    assert shown.r[[0, -1]] == pytest.approx(np.array([-1, 1]) * (4 / 3) ** 0.25 / 2 * PITCH * H / a, rel=1e-9)
    pressure = shown.surface["p"]
    assert pressure[middle] == pytest.approx(contact.p_max.item(), rel=1e-6)
    outside = pressure[np.abs(shown.r) > b * (1 + 1e-9)]
    assert np.abs(outside).max() < 1e-2 * contact.p0.item()  # none but by p, of which the cell takes the middle
    assert shown.interface["sr_above"][middle] == pytest.approx(largest.sr_interface1_spot.item(), rel=1e-6)
    assert np.abs(shown.interface["trz_above"]).max() == pytest.approx(largest.tau_interface_spot.item(), rel=1e-2)
    assert (shown.interface["trz_above"] == -shown.interface["trz_above"][::-1]).all()
    assert shown.layer.mises[:, middle].max() == pytest.approx(largest.mises1_spot.item(), rel=1e-3)
    assert shown.body.mises[:, middle].max() == pytest.approx(largest.mises2_spot.item(), rel=1e-3)
    assert shown.largest["mises1"] == shown.layer.mises.max()


def test_layer_and_body_stretch_alike_along_a_bond(shown):
    middle = len(shown.r) // 2  # there the stress around the axis is that along r
    sz, sides = shown.interface["sz_above"], (("sr_above", 0.25, 10 * (1 - 0.25**2)), ("sr_below", 0.3, 1 - 0.3**2))
    layer, body = (((1 - nu) * shown.interface[side] - nu * sz)[middle] / E for side, nu, E in sides)
    assert layer == pytest.approx(body, rel=1e-9)


def test_a_rigid_base_has_no_stresses():
    _, shown = of_central_spot(study.solve(**GIVEN | {"n": 0.0, "P": 1e-6}), 0.0)
    assert shown.body is None and set(shown.interface) == {"trz_above", "sz_above", "sr_above"}
    assert shown.largest["mises1"] == shown.layer.mises.max() and "mises2" not in shown.largest


def test_the_figure_says_what_it_shows(contact):
    figure = drawn(contact, 0.0, 0.0, Figure, "spot")
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert [title[:4] for title in titles if title] == ["(a) ", "(b) ", "(c) ", "(d) "]
    assert figure.get_suptitle().startswith("Below the central spot; means over the angle")
    assert len(lines(figure.axes[2])) >= 3


@pytest.mark.parametrize(
    "change, call, words",
    [
        ({"asperities_on": "half_space"}, {"below": "spot"}, "needs asperities that feel the layer"),
        ({"micro": "smooth"}, {"below": "spot"}, "needs asperities that feel the layer"),
        ({}, {"below": "spot", "mu": 0.3}, "without friction"),
        ({}, {"below": "asperity"}, 'must be "contact" or "spot"'),
    ],
)
def test_what_cannot_be_drawn_is_refused(change, call, words):
    contact = study.solve(**GIVEN | change)
    with pytest.raises(StudyError, match=words):
        study.plot_stresses(contact, **call)
