"""Figures 1 and 2: lines, fills, letters and arrows against the dataset and the equations, heights as stretched."""

import numpy as np
import pytest
from drawn import arrows, fills, lines, texts

from study import open_results

NARROW = 1e-12  # rounding of coordinates of order 1


@pytest.fixture(scope="module")
def case(results):
    found = open_results(results / "main_case.nc").isel(case=0)
    assert found.label == "rough, layered"
    return found


def numbers(case, *names: str) -> tuple[float, ...]:
    return tuple(float(case[name]) for name in names)


def inside(corners: np.ndarray, low: np.ndarray, high: np.ndarray, r: np.ndarray) -> None:
    """A filled area between two curves over r: its corners lie on one or the other."""
    on = [np.abs(corners[:, 1] - np.interp(corners[:, 0], r, curve)) for curve in (low, high)]
    assert np.minimum(*on).max() < NARROW and min(on[0].min(), on[1].min()) < NARROW
    assert {i for i, distance in enumerate(on) if (distance > NARROW).any()} == {0, 1}, "both of them"


def test_the_contact_is_drawn_as_the_csv_says(drawing, case):
    """Deflections and the punch ten times, the thickness of the layer as it is."""
    figure, columns, _ = drawing("fig01")
    (axes,) = figure.axes
    (h,) = numbers(case, "h")
    interface, surface, punch, *_ = lines(axes)
    r = columns["r/R"]
    np.testing.assert_allclose(interface.y, 10 * columns["interface + h/R"] - h, rtol=1e-12)  # rounding of a difference
    np.testing.assert_allclose(surface.y, 10 * columns["surface/R"], rtol=1e-12)  # one product
    seen = np.isfinite(punch.y)
    np.testing.assert_allclose(punch.y[seen], 10 * columns["punch/R"][seen], rtol=1e-12)  # one product
    np.testing.assert_array_equal(seen, 10 * columns["punch/R"] < 1.75 * h)
    assert all((line.x == r).all() for line in (interface, surface, punch))
    assert axes.get_title() == "$r$ and $h$ to scale; heights of punch, asperities and deflections $\\times$ 10"
    assert axes.get_aspect() == 1 and not axes.axison
    (half_space, dark), (layer, light), (body, darkest) = fills(axes)
    assert dark < light and darkest < dark, "greys"
    inside(half_space, np.full(len(r), -2.6 * h), interface.y, r)
    inside(layer, interface.y, surface.y, r)
    corners = body[np.abs(body[:, 1] - 1.75 * h) > NARROW]  # the other side is the upper end
    assert np.abs(corners[:, 1] - np.interp(corners[:, 0], r, 10 * columns["punch/R"])).max() < NARROW


def test_the_punch_is_a_sphere_of_spheres_and_the_layer_obeys_its_law(drawing, case):
    _, columns, _ = drawing("fig01")
    a, h, n, D, Ra, Nbar = numbers(case, "a", "h", "n", "D", "Ra", "Nbar")
    r, punch = columns["r/R"], columns["punch/R"]
    assert r[0] == pytest.approx(-2.3 * a) and r[-1] == pytest.approx(2.3 * a)
    spacing = 1 / np.sqrt(Nbar)
    summits = spacing * np.arange(-60, 61)
    spheres = summits**2 / 2 - D + (r[:, None] - summits) ** 2 / (2 * Ra)
    # each is drawn over its own cell: the nearest summit, not the lowest sphere
    own = np.abs(r[:, None] - summits).argmin(1)
    np.testing.assert_allclose(punch, spheres[np.arange(len(r)), own], rtol=0, atol=1e-12)
    p = np.interp(np.abs(r), case.x.values * a, case.p.values, right=0.0)
    pressed = columns["interface + h/R"] - columns["surface/R"]
    np.testing.assert_allclose(pressed, h / n * p, rtol=0, atol=1e-15)  # C p with C = 2 A2 h/E1*, A2 = 1/2
    assert columns["interface + h/R"].max() < 0, "below where it was"


def test_letters_of_the_contact_measure_what_they_say(drawing, case):
    figure, _, _ = drawing("fig01")
    (axes,) = figure.axes
    a, h, D = numbers(case, "a", "h", "D")
    where = texts(axes)
    assert set(where) == {"$R$", "$h$", "$r$", "$z$", "$P$", "$a$", "$D$", r"$E_1,\ \nu_1$", r"$E_2,\ \nu_2$"}
    measured = {"$a$": (a, 0), "$h$": (0, h), "$D$": (0, 10 * D)}
    for letter, size in measured.items():
        (arrow,) = [
            (tail, head) for tail, head in arrows(axes) if np.allclose(np.add(tail, head) / 2, where[letter], atol=1e-9)
        ]
        np.testing.assert_allclose(np.abs(np.subtract(*arrow)), size, atol=1e-12)
    heads = {
        letter: np.array(head) for letter in "PRrz" for tail, head in arrows(axes) if near(where, letter, tail, head)
    }
    assert heads["P"][0] == 0 and heads["z"][0] == 0 and heads["r"][1] == 0
    assert heads["z"][1] < -h < 0 < heads["P"][1], "z down into the body, P down onto the punch"
    x, y = heads["R"]
    assert y / 10 == pytest.approx(x**2 / 2 - D), "on the sphere"
    interface, surface, *_ = lines(axes)
    levels = [np.interp(1.8 * a, line.x, line.y) for line in (interface, surface)]
    assert where[r"$E_2,\ \nu_2$"][1] < levels[0] < where[r"$E_1,\ \nu_1$"][1] < levels[1]
    dotted = [line.x[0] for line in lines(axes) if len(line.x) == 2 and line.x[0] == line.x[1] != 0]
    np.testing.assert_allclose(sorted(dotted), [-a, a])


def near(where: dict, letter: str, tail, head) -> bool:
    return any(np.allclose(where[f"${letter}$"], end, atol=1e-12) for end in (tail, head))


def test_the_spot_is_drawn_as_the_csv_says(drawing, case):
    """Heights three times; Eqs (6) and (11) in the middle of the contact."""
    figure, columns, _ = drawing("fig02")
    (axes,) = figure.axes
    Ra, Nbar, p0, n = numbers(case, "Ra", "Nbar", "p0", "n")
    cell = 1 / np.sqrt(np.pi * Nbar)
    b = cell * np.sqrt(float(case.lam[0]))
    A = b**2 / Ra - 2 * p0 / n * np.sqrt(cell**2 - b**2)
    np.testing.assert_allclose(A, case.A0, rtol=0.1)  # of the power law, which the dataset has in its place
    r = columns["r/R"]
    assert (r[0], r[-1]) == (pytest.approx(-2.2 * cell), pytest.approx(2.2 * cell))
    # rounding of heights of 1e-3
    np.testing.assert_allclose(columns["asperity/R"], r**2 / (2 * Ra) - A, rtol=0, atol=1e-15)
    touching = np.abs(r) < 0.95 * b
    np.testing.assert_allclose(columns["surface/R"][touching], columns["asperity/R"][touching], rtol=2e-3)
    apart = np.abs(r) > 1.05 * b
    assert (columns["surface/R"][apart] < columns["asperity/R"][apart]).all()
    asperity, surface, *_ = lines(axes)
    np.testing.assert_allclose(surface.y, 3 * columns["surface/R"], rtol=1e-12)  # one product
    seen = np.isfinite(asperity.y)
    np.testing.assert_array_equal(seen, 3 * columns["asperity/R"] < 1.3 * cell)
    np.testing.assert_allclose(asperity.y[seen], 3 * columns["asperity/R"][seen], rtol=1e-12)  # one product
    assert axes.get_title() == "along $r$ to scale; heights $\\times$ 3" and axes.get_aspect() == 1
    (body, light), (above, dark) = fills(axes)
    assert dark < light
    inside(body, np.full(len(r), -1.5 * cell), surface.y, r)
    corners = above[np.abs(above[:, 1] - 1.3 * cell) > NARROW]
    lowest = np.maximum(3 * columns["asperity/R"], surface.y)
    assert np.abs(corners[:, 1] - np.interp(corners[:, 0], r, lowest)).max() < NARROW


def test_letters_of_the_spot_measure_what_they_say(drawing, case):
    figure, columns, _ = drawing("fig02")
    (axes,) = figure.axes
    cell = 1 / np.sqrt(np.pi * float(case.Nbar))
    b = cell * np.sqrt(float(case.lam[0]))
    # the two letters p are one text at two places
    found = {text.get_text(): text.xy for text in axes.texts if text.get_text() and hasattr(text, "xy")}
    assert set(found) == {"$b$", r"$\bar B = 1/\sqrt{\pi\bar N}$", "$R_a$"}
    for letter, size in {"$b$": b, r"$\bar B = 1/\sqrt{\pi\bar N}$": cell}.items():
        (arrow,) = [ends for ends in arrows(axes) if np.allclose(np.add(*ends) / 2, found[letter], atol=1e-12)]
        np.testing.assert_allclose(np.abs(np.subtract(*arrow)), (size, 0), atol=1e-15)
    (on,) = [head for tail, head in arrows(axes) if np.allclose(tail, found["$R_a$"], atol=1e-15)]
    assert on[1] == pytest.approx(3 * np.interp(on[0], columns["r/R"], columns["asperity/R"]), rel=1e-3)
    down = [(tail, head) for tail, head in arrows(axes) if tail[0] == head[0] and abs(tail[0]) >= cell * (1 - 1e-9)]
    assert len(down) == 14 and all(tail[1] > head[1] > 0 for tail, head in down), "p, outside the cell only"
    plain = [(text.get_text(), np.sign(text.get_position()[0])) for text in axes.texts if not hasattr(text, "xy")]
    assert sorted(plain) == [(r"$E_1,\ \nu_1$", -1), ("$p$", -1), ("$p$", 1)]
    dotted = sorted(line.x[0] for line in lines(axes) if len(line.x) == 2 and line.x[0] == line.x[1] != 0)
    np.testing.assert_allclose(dotted, [-cell, -b, b, cell])
