"""The smooth sphere on a half-space with other codes, if they are installed (extra `peers`): time against error of D.

Both solve on a square grid of three contact radii with a free (not periodic) kernel. Beside them stands this solver on
the exact layer, bonded to a half-space of its own material: a Hertz contact that it does not know to be one. Its basis
holds the pressure of Hertz, so that its error is that of rounding.
"""

from importlib.util import find_spec

import numpy as np

from solver import Problem, solve
from solver.closed_forms import hertz

LOAD = 1e-5
WIDTH = 3.0  # of the grid, in contact radii
GRIDS = (16, 32, 64, 128)
BATCH = 1000


def tamaas(points: int) -> float:
    """D of Tamaas (Polonsky-Keer on DC-FFT) on points x points."""
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    width = WIDTH * float(hertz(P=LOAD).a)
    model = tm.Model(tm.model_type.basic_2d, [width, width], [points, points])
    model.E, model.nu = 1.0, 0.0
    x = (np.arange(points) - points / 2) * width / points
    surface = -(x[:, None] ** 2 + x**2) / 2
    tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tm.PolonskyKeerRey(
        model, surface, 1e-10, tm.PolonskyKeerRey.pressure, tm.PolonskyKeerRey.pressure
    )  # fmt: skip
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 5000
    solver.solve(LOAD / width**2)
    displacement = np.zeros_like(model.traction)
    model.operators["dcfft"](model.traction, displacement)
    return float((displacement - surface)[model.traction > 0].mean())


def contact_mechanics(points: int) -> float:
    """D of ContactMechanics (constrained conjugate gradients, free boundaries) on points x points."""
    from ContactMechanics import FreeFFTElasticHalfSpace
    from ContactMechanics.Factory import make_system
    from SurfaceTopography import make_sphere

    width, D = WIDTH * float(hertz(P=LOAD).a), float(hertz(P=LOAD).D)
    half_space = FreeFFTElasticHalfSpace((points, points), 1.0, (width, width))
    system = make_system(substrate=half_space, surface=make_sphere(1.0, (points, points), (width, width)))
    system.minimize_proxy(external_force=LOAD, pentol=1e-8 * D)
    return float(system.offset)


CODES = {"tamaas": tamaas, "ContactMechanics": contact_mechanics}


def ours(rtol: float, size: int) -> float:
    """D of this solver for `size` cases at once."""
    loads = np.full(size, LOAD)
    h = float(hertz(P=LOAD).a)
    return float(
        solve(Problem.of(P=loads, h=h, n=1.0, micro="smooth", bonding="bonded", rtol=rtol, base="layered")).D[0]
    )


def peers(seconds) -> list[dict]:
    """Seconds a case and relative error of D of every code; a message for those that are not installed."""
    exact, rows = float(hertz(P=LOAD).D), []
    for name, code in CODES.items():
        if find_spec(name) is None:
            rows.append({"code": name, "skipped": "not installed: pip install roughcoat[peers]"})
            continue
        for points in GRIDS:
            error = abs(code(points) / exact - 1)
            rows.append({"code": name, "grid": points, "seconds": seconds(lambda: code(points)), "error": error})  # noqa: B023
    for rtol in (1e-3, 1e-6, 1e-9):
        for size in (1, BATCH):
            error = abs(ours(rtol, size) / exact - 1)
            used = seconds(lambda: ours(rtol, size)) / size  # noqa: B023
            rows.append({"code": "roughcoat", "rtol": rtol, "batch": size, "seconds": used, "error": error})
    return rows
