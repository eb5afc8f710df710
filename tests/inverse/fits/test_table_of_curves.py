"""The table that fits read, against the solver at random places."""

import numpy as np
import pytest

from study.inputs.reading import from_call
from study.inverse.fits.model import HERTZ, CurveModel
from study.inverse.fits.tables.lattice import WIDE
from study.inverse.fits.tables.ratio_table import STEP, Cubics, RatioTable

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
