"""The table that fits read, against the solver at random places."""

import numpy as np
import pytest

from study.inputs.definition import from_call
from study.inverse.fits.model import HERTZ, CurveModel
from study.inverse.fits.tables.ratio_table import STEP, Cubics, RatioTable
from study.inverse.fits.tables.tiles import WIDE, Chebyshev, Lattice

GEL = {"R": "5 um", "nu1": 0.45, "h": "1.5 um", "E2": "1 MPa", "nu2": 0.3, "bonding": "bonded", "E1": "1 MPa"}
ROUGH = {"R": "50 um", "micro": "disc_cell", "Nbar": "1 1/um^2", "Ra": "1 um"}
#: inputs, unknowns, x and y, and by what part the table may be off: with three coordinates it has fewer points.
CASES = {
    "layer": (GEL | {"micro": "smooth"}, ("E1",), ("D", "P"), 5e-6),
    "thickness": (GEL | {"micro": "smooth"}, ("E1", "h"), ("D", "P"), 5e-6),
    "radius": (GEL | {"micro": "smooth"}, ("E1",), ("P", "a"), 5e-6),
    "stiffness": (GEL | {"micro": "smooth", "E_punch": "1 MPa"}, ("E1",), ("a", "dP_dD"), 5e-6),
    "rough": (GEL | ROUGH, ("E1",), ("D", "P"), 5e-6),
    "rough, thickness": (GEL | ROUGH, ("E1", "h"), ("D", "P"), 1e-3),
}
ABSCISSA = {"D": ("1 nm", 3e-9, 3e-7), "P": ("1 nN", 1e-9, 1e-6), "a": ("1 nm", 3e-8, 3e-6)}


@pytest.mark.parametrize("name", CASES)
def test_as_the_solver(name):
    given, unknowns, (x, y), tolerance = CASES[name]
    text, low, high = ABSCISSA[x]
    model = CurveModel.of(from_call(given | {x: text}, [], False, {}), x, y, unknowns, ())
    random = np.random.default_rng(1)
    values = {"E1": np.exp(random.uniform(np.log(1e5), np.log(1e7), 25))}
    values |= {"h": np.exp(random.uniform(np.log(5e-7), np.log(5e-6), 25))} if "h" in unknowns else {}
    places = np.exp(random.uniform(np.log(low), np.log(high), 25))
    exact = model.solved(values, places)
    assert np.isfinite(exact).all()
    u = model.log_u(values, places)
    first = np.floor(u / WIDE).astype(int) - 1
    coordinates = np.stack([model.coordinate(axis, values[axis]) for axis in model.axes], axis=1)
    rows = RatioTable(model).rows(coordinates, first, 3)
    g, _ = Cubics(((u - first * WIDE) / STEP)[:, None], rows.shape[2]).read(rows[0])
    table = model.hertz(values, places, HERTZ[x, y][0]) * np.exp(g[:, 0])
    np.testing.assert_allclose(table, exact, rtol=tolerance)


AXES, TILE_WIDTHS, POINTS = (Chebyshev(6), Chebyshev(5)), (1.0, 0.25), 4


def polynomials(made):
    """A lattice, and the function of its tiles: the parts x + c₀² c₁ and x c₁³ of an abscissa x and two coordinates.
    Their derivatives by the one moved input are three times as large. `made` gets the place of each tile."""

    def tile(place, moved):
        made.append((place, moved))
        x = (place[0] * POINTS + np.arange(POINTS))[:, None]
        pairs = zip(AXES, place[1:], TILE_WIDTHS, strict=True)
        c0, c1 = np.meshgrid(*((number + 0.5 + axis.t / 2) * wide for axis, number, wide in pairs), indexing="ij")
        parts = np.array([x + (c0**2 * c1).ravel(), x * (c1**3).ravel()])
        return (3 * parts if moved else parts)[None]

    return Lattice([*AXES], [*TILE_WIDTHS], 2, POINTS), tile


def test_a_lattice_has_polynomials_and_their_derivatives():
    """Across tiles too; each is made once, and a curve has the same bits alone."""
    random, made = np.random.default_rng(2), []
    (lattice, tile), c, first = polynomials(made), random.uniform(-1.0, 1.0, (40, 2)), random.integers(-2, 3, 40)
    rows = lattice.read(tile, first, lattice.position(c), 2, 1)
    x, (c0, c1) = first[:, None] * POINTS + np.arange(2 * POINTS), c.T[:, :, None]
    parts = np.stack([x + c0**2 * c1, x * c1**3], axis=1)
    by_0, by_1 = np.stack([2 * c0 * c1 + 0 * x, 0 * x], axis=1), np.stack([c0**2 + 0 * x, 3 * x * c1**2], axis=1)
    np.testing.assert_allclose(rows[[0, 3]], [parts, 3 * parts], rtol=0, atol=1e-12)
    # the formula of the slope cancels digits next to a Chebyshev point
    np.testing.assert_allclose(rows[1:3], [by_0, by_1], rtol=0, atol=1e-8)
    assert len(made) == len({*made}) and {moved for _, moved in made} == {False, True}
    alone = lattice.read(tile, first[7:8], lattice.position(c[7:8]), 2, 1)
    assert alone.tobytes() == np.ascontiguousarray(rows[:, 7:8]).tobytes() and len(made) == len({*made})
